# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Feed axes as they might stand in a hall: the values of a scene, drawn at random, with feeds that excite them.

All numbers are SI.  The feeds follow from the axis: one of slip / T makes it stick and slip about every T seconds.
"""

import math
from itertools import accumulate

from numpy.random import Generator

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
