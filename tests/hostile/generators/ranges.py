# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Laws and inputs to the ends of their ranges, and combinations that nobody tunes."""

import math
import random

from stickslip_sim.core.errors import SolverError
from stickslip_sim.core.types import EventKind

from ..case import Case, Values, all_events
from . import draw, machines


def static_laws(rng: random.Random) -> Case:
    """Rises of static friction from a jump to a crawl, of any shape, met by forces that rise or come back."""
    law = rng.choice(('exponential', 'kato', 'kato', 'hyperbolic', 'logarithmic'))
    initial = 0.12
    rise = rng.choice((draw.powers(rng, 1e-9, 10.0), draw.powers(rng, 0.1, 1.0)))
    values = draw.paper() | draw.static(initial, initial * (1.0 + rise), draw.powers(rng, 1e-6, 1e4), law,
                                        draw.powers(rng, 0.05, 20.0))
    values |= rng.choice((draw.contact(), draw.contact(5e6, rng.choice((0.0, 15000.0)))))
    values |= draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0, rng.random() < 0.3)
    feed = draw.powers(rng, 1e-4, 0.05)
    values |= draw.constant(feed, rng.choice((0.0, rng.uniform(-300.0, 300.0))))
    form = rng.random()
    if form < 0.3:
        values |= {'drive.course': 'ramp', 'drive.velocity': feed * rng.choice((0.0, 1.0, -1.0)),
                   'drive.acceleration': feed * rng.choice((1.0, -1.0))}
    elif form < 0.5:
        values |= {'drive.course': 'sine', 'drive.amplitude': feed, 'drive.frequency': draw.powers(rng, 0.1, 50.0),
                   'drive.phase': rng.uniform(-3.0, 3.0)}
    return Case(values | {'initial.rest_time': rng.choice((0.0, 1e-3, 1.0, 1e6))}, rng.choice((1.0, 5.0)))


def late(rng: random.Random) -> Case:
    """Drives so slow that the first break-away comes after hours or centuries."""
    feed = draw.powers(rng, 1e-13, 1e-6)
    values = draw.paper() | rng.choice((draw.contact(), draw.contact(5e6, 15000.0)))
    values |= draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0, rng.random() < 0.5)
    values |= draw.static(0.12, 0.24, draw.powers(rng, 1e-2, 1e6)) | draw.constant(feed)
    if rng.random() < 0.3:
        at = math.floor(0.0013 / feed) * rng.uniform(0.2, 1.0)
        del values['force.constant']
        values |= draw.steps('force', 'forces', [0.0, at], [0.0, rng.choice((-100.0, 100.0, 900.0))])
    return Case(values, 0.0014 / feed * rng.choice((1.0, 3.0)))


def whole_range(rng: random.Random) -> Case:
    """All parameters over the whole range that a scene may have."""
    mass, stiffness = draw.powers(rng, 1e-9, 1e12), rng.choice((0.0, draw.powers(rng, 1e-6, 1e18)))
    damping = rng.choice((0.0, draw.powers(rng, 1e-6, 1e15)))
    normal = rng.choice((0.0, draw.powers(rng, 1e-9, 1e15), draw.powers(rng, 1e-9, 1e15)))
    values = draw.axis(mass, stiffness, damping, normal)
    values |= rng.choice((draw.contact(), draw.contact(draw.powers(rng, 1e-6, 1e18),
                                                       rng.choice((0.0, draw.powers(rng, 1e-6, 1e15))))))
    at_rest = draw.powers(rng, 1e-6, 1e3)
    values |= draw.static(at_rest, rng.choice((None, min(at_rest * draw.powers(rng, 1.0, 1e3), 1e3))),
                          draw.powers(rng, 1e-12, 1e15))
    breakpoints = sorted({0.0, *(draw.powers(rng, 1e-12, 1e6) for _ in range(rng.randint(0, 3)))})
    values |= draw.kinetic(breakpoints, [at_rest, *(at_rest * rng.random() for _ in breakpoints[1:])],
                           rng.choice((0.0, draw.powers(rng, 1e-9, 1e9))), len(breakpoints) > 1 and rng.random() < 0.3)
    values |= draw.constant(rng.choice((-1.0, 1.0)) * draw.powers(rng, 1e-12, 1e6),
                            rng.choice((0.0, draw.powers(rng, 1e-9, 1e15))))
    rates = [r for r in (math.sqrt(stiffness / mass), damping / mass) if r > 0.0] or [1.0]
    duration = min(draw.powers(rng, 1.0, 1e3) / rng.choice(rates), 1e9)   # as long as `simulate` takes
    return Case(values | draw.starts(rng, draw.powers(rng, 1e-12, 1e6)), duration)


def excesses(rng: random.Random) -> Case:
    """Excess tables of their own, and break-aways of a compliant contact where psi has all but ended."""
    case = machines.any_machine(rng)
    values: Values = case.values
    breakpoints = values['friction.kinetic.velocities']
    values['friction.acceleration_dependence'] = True
    if rng.random() < 0.5:
        inner = sorted({breakpoints[-1] * draw.powers(rng, 1e-3, 3.0) for _ in range(rng.randint(1, 3))})
        fractions = sorted((rng.choice((rng.random(), draw.powers(rng, 1e-12, 1.0))) for _ in inner[:-1]), reverse=True)
        values |= {'friction.excess.velocities': [0.0, *inner], 'friction.excess.fractions': [1.0, *fractions, 0.0]}
        return Case(values, case.duration)
    stiffness, mass = values['axis.drive_stiffness'], values['axis.mass']
    values |= draw.contact(stiffness * draw.powers(rng, 0.5, 10.0),
                           rng.choice((0.0, 0.2)) * math.sqrt(stiffness * mass))
    try:
        speeds = [abs(e.velocity) for e in all_events(Case(values, case.duration).parts)
                  if e.kind == EventKind.BREAKAWAY and e.velocity]
    except SolverError:
        speeds = []
    if speeds:
        end = speeds[0] * (1.0 + rng.choice((1.0, 1.0, -1.0)) * draw.powers(rng, 1e-15, 1e-1))
        values |= {'friction.excess.velocities': [0.0, end], 'friction.excess.fractions': [1.0, 0.0]}
    return Case(values, case.duration)


def odd_sines(rng: random.Random) -> Case:
    """Many sines, very slow and very fast ones, and sines that cancel."""
    values = draw.paper() | rng.choice((draw.contact(), draw.contact(5e6, rng.choice((0.0, 15000.0)))))
    values |= draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0, rng.random() < 0.5) | draw.constant(
        rng.choice((0.0, 0.002, 0.02)))
    kind = rng.random()
    if kind < 0.3:
        count = rng.randint(3, 12)
        frequencies = [draw.powers(rng, 0.1, 100.0) for _ in range(count)]
        amplitudes = [draw.powers(rng, 1e-4, 0.05) for _ in frequencies]
    elif kind < 0.6:
        frequency = draw.powers(rng, 0.5, 30.0)
        frequencies = [frequency, draw.near(rng, frequency, 1e-14, 1e-3)]
        amplitudes = [0.02, -0.02]
    else:
        # below 1e-5 Hz the account of energy loses digits to the way that such a sine goes (2e-9 at 4e-9 Hz)
        frequencies = [rng.choice((draw.powers(rng, 1e-5, 1e-2), draw.powers(rng, 100.0, 3000.0)))]
        amplitudes = [draw.powers(rng, 1e-3, 1.0)]
    values |= {'drive.amplitudes': amplitudes, 'drive.frequencies': frequencies,
               'drive.phases': [rng.choice((0.0, 0.5 * math.pi, rng.uniform(-3.0, 3.0))) for _ in frequencies]}
    return Case(values, rng.choice((0.3, 1.0)))


def periodic(rng: random.Random) -> Case:
    """Inputs that begin anew with short periods, some of them in step with the axis."""
    case = machines.any_machine(rng)
    values = {name: value for name, value in case.values.items() if not name.startswith(('drive.', 'force.'))}
    omega = math.sqrt(values['axis.drive_stiffness'] / values['axis.mass'])
    limit = values['axis.normal_force'] * values['friction.static.initial']
    speed = limit / math.sqrt(values['axis.drive_stiffness'] * values['axis.mass'])
    for name, item, size in (('drive', 'velocities', speed), ('force', 'forces', limit)):
        period = rng.choice((1.0, 0.5, 2.0, draw.powers(rng, 0.05, 3.0))) * 2.0 * math.pi / omega
        values |= {f'{name}.course': rng.choice(('steps', 'table')), f'{name}.period': max(period, 1e-5),
                   f'{name}.times': [0.0, 0.25 * max(period, 1e-5), 0.5 * max(period, 1e-5)],
                   f'{name}.{item}': [size * rng.choice((0.0, 1.0, -1.0, rng.uniform(-1.0, 1.0))) for _ in range(3)]}
    return Case(values, 30.0 / omega)
