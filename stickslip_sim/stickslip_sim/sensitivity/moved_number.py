# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A number of a scene that is moved a little: its value, its step, and the scene with another value."""

import math
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..scene import PARAMETERS, Scene
from ..study.points import scene_at
from ..study.variation import MOTION_SECTIONS, number_at, parameter_of

# Differences by Richardson: the derivative from two steps, and an error that is no smaller than its own.
#
# On both sides, with D(h) = (f(p + h) − f(p − h))/2h = f′ + c h² + …, two steps give R = (4 D(h/2) − D(h))/3 to the
# order h⁴; its error is taken as |R − D(h/2)|, which is that of the better one of the two.  On one side three steps do
# the same to the order h³.

_ROUNDING = 2.0 ** -50


@dataclass(frozen=True)
class Stencil:
    """Where a function is taken for its derivative: the parameter plus `offsets` times the step."""

    side: str
    offsets: tuple[float, float, float, float]

    def derivative(self, values: Numbers, step: float, size: float, scale: float = 0.0) -> tuple[Numbers, Numbers]:
        """Return the derivative and its error from `values` (4, ...) at the offsets.

        `size` is that of the parameter: its rounding counts as an error, and so does that of the values, or of the
        `scale` of what they are made from.
        """
        derivative, error = (_both_sides if self.side == BOTH else _one_side)(values, step * self._sign)
        rounding = _ROUNDING * (np.maximum(np.abs(values).max(axis=0), scale) + np.abs(derivative) * size) / abs(step)
        return derivative, error + rounding

    @property
    def _sign(self) -> float:
        return -1.0 if self.side == BELOW else 1.0


BOTH, ABOVE, BELOW = 'both', 'above', 'below'
CENTRAL = Stencil(BOTH, (-1.0, -0.5, 0.5, 1.0))
STENCILS = (CENTRAL, Stencil(ABOVE, (0.0, 0.25, 0.5, 1.0)), Stencil(BELOW, (0.0, -0.25, -0.5, -1.0)))


def _both_sides(values: Numbers, step: float) -> tuple[Numbers, Numbers]:
    coarse, fine = (values[3] - values[0]) / (2.0 * step), (values[2] - values[1]) / step
    derivative = (4.0 * fine - coarse) / 3.0
    return derivative, np.abs(derivative - fine)


def _one_side(values: Numbers, step: float) -> tuple[Numbers, Numbers]:
    fine, middle, coarse = ((values[k] - values[0]) / (offset * step) for k, offset in ((1, 0.25), (2, 0.5), (3, 1.0)))
    first, second = 2.0 * middle - coarse, 2.0 * fine - middle
    derivative = (4.0 * second - first) / 3.0
    return derivative, np.abs(derivative - second)


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
