# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Synthetic axes: the scene that is true, what was measured of it, and what an identification begins with."""

from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import EventKind
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import Scene, scene_from_values
from stickslip_sim.study.points import scene_at

from .machines import CONTACTS, DURATION, KINETIC_LAWS, STATIC_LAWS, machine_values
from .measuring import USUAL, Sensors

FREE = (6, 8)               # parameters, at least and at most
FARTHEST, NEAREST = 0.4, 0.2   # of a start from the truth, as a share of it
LEAST_SLIPS = 8             # else the axis is drawn again: without stick-slip there is nothing to be found

_ALWAYS = ('axis.drive_stiffness', 'friction.static.initial', 'friction.static.limit', 'friction.static.time_constant',
           'friction.kinetic.initial', 'friction.kinetic.limit', 'friction.kinetic.coefficients[0]',
           'friction.kinetic.coefficients[1]')
_SOMETIMES = ('axis.mass', 'axis.drive_damping', 'contact.stiffness', 'contact.damping', 'friction.static.exponent',
              'friction.kinetic.stribeck_velocity', 'friction.kinetic.viscous', 'friction.kinetic.velocities[1]',
              'friction.kinetic.end_slope')
RANGE = (0.5, 2.0)         # of a free parameter, in times its start: the truth lies at 0.71 to 1.67 of it
_MOST_TRIES = 1000


class SyntheticAxis(NamedTuple):
    """An axis: `truth` is what it is, `start` what its user takes it for, `free` what he is not sure of.

    `seed` is that of its noise; it is measured for `duration` (s) through `sensors`.
    """

    name: str
    truth: Scene
    start: Scene
    free: tuple[str, ...]
    seed: int
    duration: float = DURATION
    sensors: Sensors = USUAL

    def true_values(self) -> dict[str, float]:
        """Return the true value of each free parameter."""
        return {name: value_of(self.truth, name) for name in self.free}

    def free_file(self) -> dict[str, object]:
        """Return the file of free parameters, as YAML gives it."""
        low, high = RANGE
        return {'seed': 0, 'parameters': {
            name: {'distribution': 'uniform', 'low': low * value, 'high': high * value}
            for name, value in ((name, value_of(self.start, name)) for name in self.free)}}


def axes(count: int, seed: int = 0) -> list[SyntheticAxis]:
    """Return the first axes of a seed: contacts, laws of friction and numbers of parameters mixed evenly."""
    rng = np.random.default_rng(seed)
    models = list(product(CONTACTS, STATIC_LAWS, KINETIC_LAWS))
    order: list[int] = []
    while len(order) < count:
        order += rng.permutation(len(models)).tolist()
    return [synthetic_axis(np.random.default_rng([seed, k]), f'axis {k}', *models[order[k]]) for k in range(count)]


def synthetic_axis(rng: Generator, name: str, contact: str, static: str, kinetic: str) -> SyntheticAxis:
    """Return an axis with this contact and these laws of friction."""
    while True:
        truth = scene_from_values(machine_values(rng, contact, static, kinetic))
        events = simulate_events(truth, DURATION).events
        if sum(event.kind is EventKind.BREAKAWAY for event in events) >= LEAST_SLIPS:
            break
    free = _free_of(rng, truth)
    return SyntheticAxis(name, truth, start_of(rng, truth, free), free, int(rng.integers(2**31)))


def value_of(scene: Scene, name: str) -> float:
    """Return the number of a scene that a free parameter names."""
    entry, bracket, index = name.partition('[')
    value = scene.values[entry]
    number = value[int(index[:-1])] if bracket and isinstance(value, tuple) else value
    assert isinstance(number, float)
    return number


def any_free_of(rng: Generator, truth: Scene, least: int, most: int) -> tuple[str, ...]:
    """Return the names of `least` to `most` free parameters, any that a scene has."""
    names = [name for name in (*_ALWAYS, *_SOMETIMES) if _has(truth, name) and value_of(truth, name) != 0.0]
    count = int(rng.integers(least, most, endpoint=True))
    return tuple(sorted(rng.permutation(names).tolist()[:count]))


def _free_of(rng: Generator, truth: Scene) -> tuple[str, ...]:
    always = [name for name in _ALWAYS if _has(truth, name)]
    others = rng.permutation([name for name in _SOMETIMES if _has(truth, name)]).tolist()
    count = int(rng.integers(FREE[0], FREE[1], endpoint=True))
    return tuple(sorted([*always, *others[:max(count - len(always), 0)]]))


def _has(scene: Scene, name: str) -> bool:
    return name.partition('[')[0] in scene.values


def start_of(rng: Generator, truth: Scene, free: tuple[str, ...]) -> Scene:
    """Return the scene with each free parameter off by `NEAREST` to `FARTHEST`, up or down, as far as it is one."""
    true = np.array([value_of(truth, name) for name in free])
    for _ in range(_MOST_TRIES):
        off = rng.uniform(NEAREST, FARTHEST, len(free)) * rng.choice((-1.0, 1.0), len(free))
        try:
            return scene_at(truth.values, free, true * (1.0 + off))
        except InputError:   # as static friction below the kinetic
            continue
    raise RuntimeError('no start was found')
