# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes of other kinds, changed: friction by direction, starts in mid-cycle, normal forces that jump or vary smoothly.

A load jumps to nothing and back, at events, with other inputs, and onto the force that is held.  A smooth one is of
sines, ramps, tables and their sums, slow and fast, up to where N touches 0.
"""

import math
import random

from stickslip_sim.core.types import EventKind

from ..case import Case, Values
from . import draw, edges, inputs, machines

_MACHINES = (machines.two_breakpoints, machines.any_machine, machines.any_machine, machines.smooth, inputs.sines)
_ODD = (edges.slopes, edges.critical_slip, edges.equal_eigenvalues, edges.limit_velocities,
        edges.contacts, edges.touching, edges.ties, inputs.grazing_sine, inputs.grazing_ramp,
        edges.static_laws, edges.whole_range, edges.excesses, edges.odd_sines, edges.periodic)
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


_JUMPING = (machines.any_machine, machines.any_machine, machines.two_breakpoints, inputs.sines, inputs.step_at_event,
          edges.excesses, edges.periodic, edges.static_laws, edges.ties, two_directions,
          odd_directions, mid_cycle)


def loads(rng: random.Random) -> Case:
    """A scene of another kind under a load that jumps."""
    case = rng.choice(_JUMPING)(rng)
    normal = case.values['axis.normal_force']
    times = [0.0, *_jumps(rng, case)]
    forces = [normal * rng.choice((0.0, 0.0, -1.0, -0.5, rng.uniform(-1.0, 0.0), rng.uniform(0.0, 2.0), 1e-12))
              for _ in times]
    if 'initial.deflection' in case.values:   # which the contact can hold without a load
        forces[0] = 0.0
    values: Values = case.values | draw.steps('normal_load', 'forces', times, forces)
    if rng.random() < 0.3:
        values['normal_load.period'] = max(times[-1] * rng.uniform(1.01, 1.5), 1e-6)
    return Case(values, case.duration)


def load_onto_force(rng: random.Random) -> Case:
    """A load that falls until the limit is what the slider holds, within rounding, or jumps together with the force."""
    values = draw.paper() | rng.choice((draw.contact(), draw.contact(5e6, rng.choice((0.0, 15000.0)))))
    values |= draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0, rng.random() < 0.5)
    values = {name: value for name, value in values.items() if not name.startswith('friction.static.')}
    values |= rng.choice((draw.static(0.24), draw.static(0.12, 0.24, 0.2)))
    normal = values['axis.normal_force']
    at = rng.uniform(0.1, 2.0)
    share = rng.choice((0.5, 0.25, rng.uniform(0.1, 0.9)))
    force = 0.24 * normal * share * rng.choice((1.0, -1.0))
    off = rng.choice((0.0, 0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-6, -1e-6))
    values |= draw.steps('normal_load', 'forces', [0.0, at, 1.5 * at],
                         [0.0, normal * (share * (1.0 + off) - 1.0), normal * rng.choice((0.0, 1.0))])
    if rng.random() < 0.5:
        values |= {'drive.course': 'constant', 'drive.velocity': rng.choice((0.0, 0.002))}
        values |= {'force.course': 'constant', 'force.constant': force}
    else:   # both at once: the limit rises with the force, or falls with it
        values |= draw.constant(rng.choice((0.0, 0.002)))
        del values['force.constant']
        values |= draw.steps('force', 'forces', [0.0, at, 1.5 * at],
                             [force * rng.choice((0.0, 1.0)), force, rng.choice((force, 2.0 * force))])
    return Case(values, 2.0 * at)


def _jumps(rng: random.Random, case: Case) -> list[float]:
    """Return when the load jumps: anywhere, at events or beside them, and where other inputs jump."""
    end = case.duration
    times = {rng.uniform(0.02, 0.98) * end for _ in range(rng.randint(1, 4))}
    events = [event.time for event in case.events[:40] if event.kind != EventKind.KNOT]
    times |= {draw.beside(rng, time) for time in rng.sample(events, min(len(events), 2)) if rng.random() < 0.5}
    borders = [*case.values.get('drive.times', ()), *case.values.get('force.times', ())]
    times |= {time for time in borders if rng.random() < 0.4}
    return sorted(time for time in times if time > 1e-12)


_SMOOTHLY = (machines.any_machine, machines.any_machine, machines.two_breakpoints, two_directions,
          mid_cycle, edges.excesses)
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
    values |= _any_drive(rng, feed) | {'initial.rest_time': rng.choice((0.0, 1.0, math.inf))}
    return Case(values | _load(rng, normal, _FREQUENCIES, 3.0), 3.0)


def smooth_loads(rng: random.Random) -> Case:
    """A scene of another kind under a load that varies slowly, as fast as the slider swings, or faster."""
    case = rng.choice(_SMOOTHLY)(rng)
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


def _any_drive(rng: random.Random, feed: float) -> Values:
    form = rng.choice(('constant', 'constant', 'ramp', 'sine'))
    if form == 'constant':
        return draw.constant(rng.choice((feed, feed, -feed, 0.0)), rng.choice((0.0, 0.0, rng.uniform(-600.0, 600.0))))
    if form == 'ramp':
        return {'drive.course': form, 'drive.velocity': rng.choice((0.0, feed)),
                'drive.acceleration': rng.choice((1.0, -1.0)) * feed, 'drive.duration': rng.choice((math.inf, 1.5))}
    return {'drive.course': form, 'drive.velocity': rng.choice((0.0, feed)), 'drive.amplitude': feed,
            'drive.frequency': draw.powers(rng, 0.2, 10.0), 'drive.phase': rng.uniform(-3.0, 3.0)}
