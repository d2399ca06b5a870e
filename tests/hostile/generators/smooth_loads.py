# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Normal forces that vary smoothly: sines, ramps, tables and their sums, slow and fast, up to where N touches 0."""

import math
import random

from ..case import Case, Values
from . import draw, machines, ranges, sides

_BASES = (machines.any_machine, machines.any_machine, machines.two_breakpoints, sides.two_directions,
          sides.mid_cycle, ranges.excesses)
_FREQUENCIES = 0.5, 50.0   # Hz


def paper_loads(rng: random.Random) -> Case:
    """The paper's axis, or one near it, under a load of 5 to 100 % at 0.5 to 50 Hz; any drive."""
    mass = 350.0 * rng.choice((1.0, draw.powers(rng, 0.3, 3.0)))
    normal = mass * 9.80665
    values = draw.axis(mass, 6e5 * draw.powers(rng, 0.5, 2.0), rng.choice((4000.0, draw.powers(rng, 300.0, 8000.0))),
                       normal)
    values |= rng.choice((draw.contact(), draw.contact(5e6 * draw.powers(rng, 0.3, 3.0), rng.choice((0.0, 15000.0)))))
    at_rest = rng.choice((0.12, rng.uniform(0.05, 0.3)))
    initial = at_rest * rng.choice((1.0, 1.0, rng.uniform(1.0, 1.2)))
    values |= draw.static(initial, initial * rng.uniform(1.05, 2.5), draw.powers(rng, 0.02, 2.0),
                          rng.choice(('exponential', 'hyperbolic')))
    speeds = [0.0, *sorted(draw.powers(rng, 0.002, 0.06) for _ in range(rng.choice((1, 1, 3))))]
    values |= draw.kinetic(speeds, [at_rest, *(at_rest * rng.uniform(0.2, 1.0) for _ in speeds[1:])],
                           rng.choice((0.0, 1.0)), rng.random() < 0.6)
    feed = draw.powers(rng, 3e-4, 0.03)
    values |= _drive(rng, feed) | {'initial.rest_time': rng.choice((0.0, 1.0, math.inf))}
    return Case(values | _load(rng, normal, _FREQUENCIES, 3.0), 3.0)


def smooth_loads(rng: random.Random) -> Case:
    """A scene of another kind under a load that varies slowly, as fast as the slider swings, or faster."""
    case = rng.choice(_BASES)(rng)
    values, normal = case.values, case.values['axis.normal_force']
    swing = math.sqrt(values['axis.drive_stiffness'] / values['axis.mass']) / (2.0 * math.pi) or 1.0
    slowest = max(0.02 * swing, 1e-3)
    found = _load(rng, normal, (slowest, max(3.0 * swing, 2.0 * slowest)), case.duration)
    if 'initial.deflection' in values:   # which the contact can hold without a load
        found |= {name: 0.0 for name in ('normal_load.phase',) if name in found}
        if found['normal_load.course'] != 'sine' or 'normal_load.amplitudes' in found:
            values = {name: value for name, value in values.items() if name != 'initial.deflection'}
    return Case(values | found, case.duration)


def _load(rng: random.Random, normal: float, frequencies: tuple[float, float], duration: float) -> Values:
    """Return a load whose sum with the normal force is never below 0."""
    form, left = rng.choice(('sine', 'sine', 'ramp', 'table', 'sum')), normal
    values: Values = {'normal_load.course': 'constant', 'normal_load.constant': 0.0}
    if (form in ('ramp', 'sum') and rng.random() < 0.7) or form == 'ramp':
        share, lasts = rng.uniform(-0.9, 1.0), duration * rng.uniform(0.1, 1.0)
        values = {'normal_load.course': 'ramp', 'normal_load.constant': 0.0, 'normal_load.duration': lasts,
                  'normal_load.rate': share * normal / lasts}
        left *= 1.0 + min(share, 0.0)
    elif form in ('table', 'sum'):
        count = rng.randint(2, 6)
        times = [0.0, *sorted(rng.uniform(0.02, 0.98) * duration for _ in range(count))]
        forces = [0.0, *(normal * rng.choice((rng.uniform(-0.95, 1.0), rng.uniform(-0.3, 0.3))) for _ in times[1:])]
        values = {'normal_load.course': 'table', 'normal_load.times': times, 'normal_load.forces': forces}
        if rng.random() < 0.4:
            values['normal_load.period'] = times[-1] * rng.uniform(1.05, 1.5)
        left += min(forces)
    left *= 1.0 - 1e-9
    if form == 'sine':
        return {'normal_load.course': 'sine', 'normal_load.constant': 0.0,
                'normal_load.amplitude': normal * rng.choice((1.0, rng.uniform(0.05, 0.5), rng.uniform(0.05, 1.0))),
                'normal_load.frequency': draw.powers(rng, *frequencies), 'normal_load.phase': rng.uniform(-3.0, 3.0)}
    if form == 'sum':
        count = rng.randint(1, 4)
        shares = [rng.random() for _ in range(count)]
        most = left * rng.choice((1.0, rng.uniform(0.05, 1.0)))
        values |= {'normal_load.amplitudes': [most * share / sum(shares) for share in shares],
                   'normal_load.frequencies': [draw.powers(rng, *frequencies) for _ in shares],
                   'normal_load.phases': [rng.uniform(-3.0, 3.0) for _ in shares]}
    return values


def _drive(rng: random.Random, feed: float) -> Values:
    form = rng.choice(('constant', 'constant', 'ramp', 'sine'))
    if form == 'constant':
        return draw.constant(rng.choice((feed, feed, -feed, 0.0)), rng.choice((0.0, 0.0, rng.uniform(-600.0, 600.0))))
    if form == 'ramp':
        return {'drive.course': form, 'drive.velocity': rng.choice((0.0, feed)),
                'drive.acceleration': rng.choice((1.0, -1.0)) * feed, 'drive.duration': rng.choice((math.inf, 1.5))}
    return {'drive.course': form, 'drive.velocity': rng.choice((0.0, feed)), 'drive.amplitude': feed,
            'drive.frequency': draw.powers(rng, 0.2, 10.0), 'drive.phase': rng.uniform(-3.0, 3.0)}
