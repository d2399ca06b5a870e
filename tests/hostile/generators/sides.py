# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction that depends on the direction, and starts in mid-cycle."""

import math
import random

from ..case import Case, Values
from . import degenerate, draw, inputs, machines, ranges, smooth

_MACHINES = (machines.two_breakpoints, machines.any_machine, machines.any_machine, smooth.smooth, inputs.sines)
_ODD = (degenerate.slopes, degenerate.critical_slip, degenerate.equal_eigenvalues, degenerate.limit_velocities,
        degenerate.contacts, degenerate.touching, degenerate.ties, inputs.grazing_sine, inputs.grazing_ramp,
        ranges.static_laws, ranges.whole_range, ranges.excesses, ranges.odd_sines, ranges.periodic)
_STATIC, _KINETIC, _EXCESS = 'friction.static', 'friction.kinetic', 'friction.excess'


def two_directions(rng: random.Random) -> Case:
    """Machines with another friction backwards: static, kinetic, viscous, or all of it."""
    return _sided(rng, rng.choice(_MACHINES)(rng))


def odd_directions(rng: random.Random) -> Case:
    """Scenes near a degeneracy, with another friction backwards: a little less, or none at all."""
    return _sided(rng, rng.choice(_ODD)(rng))


def mid_cycle(rng: random.Random) -> Case:
    """Machines whose spring, and contact, are loaded when they start: within the static limit, at it, or beyond."""
    case = rng.choice(_MACHINES)(rng)
    values = case.values if rng.random() < 0.5 else _sided(rng, case).values
    return Case(values | _displacements(rng, values), case.duration)


def _sided(rng: random.Random, case: Case) -> Case:
    values = case.values
    static, kinetic = _static(rng, values), _kinetic(rng, values)
    scale = rng.choice((1.0, 1.0, 1.0, 0.0, draw.near(rng, 1.0), draw.powers(rng, 1e-6, 3.0)))
    for name in (*static, *kinetic):
        if name.rpartition('.')[2] in ('initial', 'limit', 'coefficients', 'end_slope', 'viscous'):
            of = static if name in static else kinetic
            of[name] = [scale * mu for mu in of[name]] if isinstance(of[name], list) else scale * of[name]
    changes = static | kinetic | _excess(rng, values)
    return Case(_turning(rng, values) | {_backward(name): value for name, value in changes.items()}, case.duration)


def _backward(name: str) -> str:
    section, _, leaf = name.rpartition('.')
    return f'{section}.backward.{leaf}'


def _static(rng: random.Random, values: Values) -> Values:
    factor = rng.choice((1.0, rng.uniform(1.0, 2.0)))
    initial = values[f'{_STATIC}.initial'] * factor
    found = {f'{_STATIC}.initial': min(initial, 1e3)}
    if f'{_STATIC}.limit' in values:
        limit = rng.choice((found[f'{_STATIC}.initial'], values[f'{_STATIC}.limit'] * factor * rng.uniform(1.0, 2.0)))
        found[f'{_STATIC}.limit'] = min(limit, 1e3)
        if rng.random() < 0.4:
            found[f'{_STATIC}.time_constant'] = values[f'{_STATIC}.time_constant'] * draw.powers(rng, 0.1, 10.0)
        if values[f'{_STATIC}.law'] == 'kato' and rng.random() < 0.5:
            found[f'{_STATIC}.exponent'] = draw.powers(rng, 0.3, 3.0)
    return found


def _kinetic(rng: random.Random, values: Values) -> Values:
    factor = rng.choice((1.0, 1.0, rng.random()))
    if f'{_KINETIC}.coefficients' not in values:
        found = {f'{_KINETIC}.{name}': factor * values[f'{_KINETIC}.{name}'] for name in ('initial', 'limit')}
        if rng.random() < 0.5:
            name = f'{_KINETIC}.stribeck_velocity'
            found[name] = values[name] * draw.powers(rng, 0.3, 3.0)
        return found | {f'{_KINETIC}.viscous': rng.choice((0.0, 2.0)) * values.get(f'{_KINETIC}.viscous', 0.0)}
    speeds, falls = values[f'{_KINETIC}.velocities'], values[f'{_KINETIC}.coefficients']
    found = {f'{_KINETIC}.coefficients': [factor * mu for mu in falls],
             f'{_KINETIC}.end_slope': rng.choice((0.0, 1.0, 3.0)) * min(values.get(f'{_KINETIC}.end_slope', 0.0), 1e8)}
    if len(speeds) > 1 and rng.random() < 0.4:
        wider = draw.powers(rng, 0.1, 10.0)
        found[f'{_KINETIC}.velocities'] = [min(wider * speed, 1e6) for speed in speeds]
    elif len(speeds) > 2 and rng.random() < 0.4:
        gone = rng.randrange(1, len(speeds))
        found[f'{_KINETIC}.velocities'] = [*speeds[:gone], *speeds[gone + 1:]]
        found[f'{_KINETIC}.coefficients'] = [factor * mu for k, mu in enumerate(falls) if k != gone]
    return found


def _excess(rng: random.Random, values: Values) -> Values:
    breakpoints = values.get(f'{_KINETIC}.velocities', [0.0])
    if (not values.get('friction.acceleration_dependence') or values.get(f'{_EXCESS}.law', 'table') != 'table'
            or len(breakpoints) < 2 or rng.random() < 0.5):
        return {}
    return {f'{_EXCESS}.velocities': [0.0, breakpoints[-1] * draw.powers(rng, 0.1, 3.0)],
            f'{_EXCESS}.fractions': [1.0, 0.0]}


def _turning(rng: random.Random, values: Values) -> Values:
    """Return values with a drive that goes backwards, or there and back."""
    if values.get('drive.course') != 'constant' or 'drive.velocity' not in values:
        return values
    feed = values['drive.velocity']
    if rng.random() < 0.3:
        return values | {'drive.velocity': -feed}
    turned = {name: value for name, value in values.items() if not name.startswith('drive.')}
    period = draw.powers(rng, 0.1, 2.0)
    return turned | draw.steps('drive', 'velocities', [0.0, 0.5 * period], [feed, -feed]) | {'drive.period': period}


def _displacements(rng: random.Random, values: Values) -> Values:
    """Return a start with a stretched spring, and a deflected contact."""
    holds = values['axis.normal_force'] * values.get(f'{_STATIC}.limit', values[f'{_STATIC}.initial'])
    share = rng.choice((1.0, -1.0)) * rng.choice((rng.random(), 1.0, draw.near(rng, 1.0), rng.uniform(1.0, 3.0)))
    found: Values = {'initial.rest_time': rng.choice((0.0, 1e-3, math.inf))}
    if values.get(f'{_STATIC}.law') == 'logarithmic':
        found['initial.rest_time'] = rng.choice((0.0, 1e-3, 1.0))
    if values['axis.drive_stiffness'] > 0.0:
        found['initial.stretch'] = max(-1e12, min(share * holds / values['axis.drive_stiffness'], 1e12))
    if values.get('contact.model') == 'compliant' and rng.random() < 0.7:
        at_once = values['axis.normal_force'] * min(values[f'{_STATIC}.initial'],
                                                    values.get(f'{_STATIC}.backward.initial', math.inf))
        force = rng.choice((1.0, -1.0)) * rng.choice((0.999, rng.random())) * at_once
        found['initial.deflection'] = force / values['contact.stiffness']
        found['initial.velocity'] = 0.0
    return found
