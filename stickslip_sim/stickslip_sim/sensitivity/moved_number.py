# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A number of a scene that is moved a little: its value, its step, and the scene with another value."""

import math
from dataclasses import dataclass

import numpy as np

from ..core.errors import InputError
from ..scene import PARAMETERS, Scene
from ..study.points import scene_at
from ..study.variation import MOTION_SECTIONS, number_at, parameter_of
from .stencil import STENCILS, Stencil

SMALLEST, LARGEST = 1e-9, 0.1   # of a value, a step
_TABLES = ('friction.kinetic.tolerance', 'friction.excess.tolerance')   # they decide no motion, but its error


@dataclass(frozen=True)
class MovedNumber:
    """The number `name` of a scene, its `value` there, and the `step` of its differences on the sides of `stencil`."""

    scene: Scene
    name: str
    value: float
    step: float
    stencil: Stencil

    @property
    def unit(self) -> str:
        """As in the schema."""
        return parameter_of(self.name)[0].unit

    def at(self, offset: float) -> float:
        """Return the value that is so many steps from its own."""
        return self.value + offset * self.step

    def scene_with(self, value: float) -> Scene:
        """Return the scene with another value; raises InputError where it may not be."""
        return scene_at(self.scene.values, [self.name], np.array([value]))


def moved_number(scene: Scene, name: str, step: float) -> MovedNumber:
    """Return a number that is moved by `step` times its own size, to both sides or the one that is allowed.

    The size of 0 is that of the scene's other numbers in this unit.  Raises InputError on a name that is no number of
    the scene, and on a number that cannot be moved.
    """
    value = number_at(scene.values, name)
    if value is None or not math.isfinite(value):
        given = scene.values.get(parameter_of(name)[0].name)
        raise InputError('parameter', name, f'a finite number of this scene, which has {_in_words(given)}',
                         'ask for another, or give it with --set')
    size = abs(value) or _size(scene, parameter_of(name)[0].unit)
    refused: InputError | None = None
    for stencil in STENCILS:
        moved = MovedNumber(scene, name, value, step * size, stencil)
        try:
            for offset in (stencil.offsets[0], stencil.offsets[-1]):
                moved.scene_with(moved.at(offset))
        except InputError as error:
            refused = error
        else:
            return moved
    raise InputError('parameter', name, 'a number that can be larger or smaller', f'here neither is a scene: {refused}')


def moved_numbers(scene: Scene, step: float) -> list[MovedNumber]:
    """Return all numbers that decide the motion of a scene and can be moved."""
    found = []
    for name in _names(scene):
        try:
            found.append(moved_number(scene, name, step))
        except InputError:   # as the speed 0 at which a table begins
            continue
    return found


def _names(scene: Scene) -> list[str]:
    names: list[str] = []
    for entry in PARAMETERS:
        value = scene.values.get(entry.name)
        if entry.name.partition('.')[0] not in MOTION_SECTIONS or entry.name.startswith('solver.') or (
                entry.name in _TABLES):
            continue
        if entry.type == 'double' and isinstance(value, float):
            names.append(entry.name)
        elif entry.type == 'double_array' and isinstance(value, tuple):
            names += [f'{entry.name}[{k}]' for k in range(len(value))]
    return names


def _in_words(given: object) -> str:
    return 'none there' if given is None else f'{given!r} there' if not isinstance(given, tuple) else (
        f'{len(given)} numbers there, counted from 0')


def _size(scene: Scene, unit: str) -> float:
    """Return what is large in a unit, by the other numbers of a scene."""
    axis = scene.axis
    force = axis.normal_force * max(axis.friction.static.initial, axis.friction.static.limit) or 1.0
    stiffness = axis.drive_stiffness or force
    impedance, period = math.sqrt(stiffness * axis.mass), math.sqrt(axis.mass / stiffness)
    return {'N': force, 'N/m': stiffness, 'm': force / stiffness, 's': period, 'm/s': force / impedance,
            'N s/m': impedance, 'kg': axis.mass, 'm/s²': force / axis.mass, 'N/s': force / period,
            'Hz': 1.0 / period, 's/m': impedance / force}.get(unit, 1.0)
