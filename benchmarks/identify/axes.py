# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Synthetic axes: the scene that is true, what was measured of it, and what an identification begins with."""

import math
from itertools import accumulate, product
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import EventKind
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import Scene, scene_from_values
from stickslip_sim.study.points import scene_at

from .measuring import USUAL, Sensors

# Feed axes as they might stand in a hall: the values of a scene, drawn at random, with feeds that excite them.
#
# All numbers are SI.  The feeds follow from the axis: one of slip / T makes it stick and slip about every T seconds.

STATIC_LAWS = ('exponential', 'kato', 'hyperbolic', 'logarithmic', 'constant')
KINETIC_LAWS = ('table', 'stribeck', 'exponential', 'hyperbolic')
CONTACTS = ('rigid', 'compliant')
DURATION = 10.0   # s
REST_TIME = 10.0  # s, before the run

_LENGTHS = (2.2, 1.8, 1.5, 1.2, 1.0, 2.3)   # s, of the feeds: four with stick-slip, a fast one, and one back
_PERIODS = (1.0, 0.6, 0.35, 0.2)            # s, of the stick-slip of the first four
_PERIOD_BACK = 0.7                          # s
_GRAVITY = 9.80665                          # m/s²

Values = dict[str, object]


def machine_values(rng: Generator, contact: str, static: str, kinetic: str) -> Values:
    """Return the values of a scene with this contact and these laws of friction."""
    mass = even_ratios(rng, 50.0, 1000.0)
    stiffness = mass * (2.0 * math.pi * even_ratios(rng, 3.0, 12.0))**2
    damping = 2.0 * even_ratios(rng, 0.05, 0.25) * math.sqrt(stiffness * mass)
    normal = mass * _GRAVITY * between(rng, 0.7, 1.3)
    at_rest = between(rng, 0.10, 0.18)
    low, bend = at_rest * between(rng, 0.35, 0.65), even_ratios(rng, 0.004, 0.02)
    highest, rest = _static(rng, static, at_rest)
    slip = 2.0 * normal * (highest - low) / stiffness
    return {
        'scene': 'synthetic', 'axis.mass': mass, 'axis.drive_stiffness': stiffness, 'axis.drive_damping': damping,
        'axis.normal_force': normal, 'contact.model': contact, **_contact(rng, contact, mass, stiffness), **rest,
        **_kinetic(rng, kinetic, at_rest, low, bend), 'friction.acceleration_dependence': bool(rng.integers(2)),
        **_feeds(rng, slip, bend), 'initial.rest_time': REST_TIME}


def _contact(rng: Generator, model: str, mass: float, drive_stiffness: float) -> Values:
    if model == 'rigid':
        return {}
    stiffness = drive_stiffness * between(rng, 5.0, 15.0)
    return {'contact.stiffness': stiffness,
            'contact.damping': 2.0 * even_ratios(rng, 0.1, 0.4) * math.sqrt(stiffness * mass)}


def _static(rng: Generator, law: str, at_rest: float) -> tuple[float, Values]:
    """Return the highest static coefficient of the run, about, and the law."""
    if law == 'constant':
        highest = at_rest * between(rng, 1.3, 1.8)
        return highest, {'friction.static.law': law, 'friction.static.initial': highest}
    initial = at_rest * between(rng, 1.05, 1.25)
    limit = initial + between(rng, 0.04, 0.12)
    values: Values = {'friction.static.law': law, 'friction.static.initial': initial, 'friction.static.limit': limit,
                      'friction.static.time_constant': even_ratios(rng, 0.1, 1.0)}
    if law == 'kato':
        values['friction.static.exponent'] = between(rng, 0.4, 0.9)
    return limit, values


def _kinetic(rng: Generator, law: str, at_rest: float, low: float, bend: float) -> Values:
    if law == 'table':
        return {'friction.kinetic.law': law, 'friction.kinetic.velocities': (0.0, 2.0 * bend),
                'friction.kinetic.coefficients': (at_rest, low), 'friction.kinetic.end_slope': between(rng, 0.1, 0.6)}
    return {'friction.kinetic.law': law, 'friction.kinetic.initial': at_rest, 'friction.kinetic.limit': low,
            'friction.kinetic.stribeck_velocity': bend, 'friction.kinetic.viscous': between(rng, 0.1, 0.6)}


def _feeds(rng: Generator, slip: float, bend: float) -> Values:
    """Return feeds in steps: of stick-slip in any order, a fast one beyond the bend of the curve, and one back."""
    slow = [slip / period * between(rng, 0.8, 1.2) for period in rng.permutation(_PERIODS).tolist()]
    feeds = (*slow, bend * between(rng, 3.0, 5.0), -slip / _PERIOD_BACK)
    return {'drive.course': 'steps', 'drive.times': tuple(accumulate(_LENGTHS[:-1], initial=0.0)),
            'drive.velocities': feeds}


def between(rng: Generator, low: float, high: float) -> float:
    return float(rng.uniform(low, high))


def even_ratios(rng: Generator, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


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
