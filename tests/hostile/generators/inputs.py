# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs that come as close to an event as numbers can."""

import math
import random

from stickslip_sim.core.types import EventKind
from stickslip_sim.proof.axes import GRAZING_FREQUENCIES, PHASES, grazing_drive

from ..case import Case, Values
from . import draw, edges, machines


def grazing_sine(rng: random.Random) -> Case:
    """A sine on the drive whose force peak passes the static limit by little, or does not."""
    values = draw.paper() | rng.choice((draw.contact(), draw.contact(5e6, 15000.0)))
    overshoot = rng.choice((-1.0, 1.0)) * draw.powers(rng, 1e-12, 1e-3)
    frequency = rng.uniform(*GRAZING_FREQUENCIES)
    case = Case(values, rng.choice((1.0, 2.0)) / frequency)
    sinusoid = grazing_drive(case.scene.axis, overshoot, frequency, rng.uniform(*PHASES)).sinusoids[0]
    return Case(values | {'drive.course': 'sine', 'drive.velocity': 0.0, 'drive.amplitude': sinusoid.amplitude,
                          'drive.frequency': sinusoid.frequency, 'drive.phase': sinusoid.phase}, case.duration)


def grazing_ramp(rng: random.Random) -> Case:
    """A force that rises to the static limit, or nearly, and turns; a drive that goes there and back."""
    limit = 0.24 * 3432.3275
    peak = limit * (1.0 + rng.choice((-1.0, 0.0, 1.0)) * draw.powers(rng, 1e-15, 1e-3))
    at = rng.choice((0.5, 1.0, rng.uniform(0.2, 2.0)))
    values = draw.paper() | rng.choice((draw.contact(), draw.contact(5e6, rng.choice((0.0, 15000.0)))))
    if rng.random() < 0.5:
        values |= {'force.course': 'table', 'force.times': [0.0, at, 2.0 * at], 'force.forces': [0.0, peak, 0.0]}
    else:
        # a drive that slows down, turns and comes back: a parabola of the force
        speed = 2.0 * peak / (6e5 * at)
        values |= {'axis.drive_damping': 0.0, 'drive.course': 'ramp', 'drive.velocity': speed,
                   'drive.acceleration': -speed / at}
    if rng.random() < 0.3:
        values |= {'initial.rest_time': rng.choice((0.0, 0.1))}
    return Case(values, 2.0 * at)


def peak_at_breakpoint(rng: random.Random) -> Case:
    """A breakpoint within rounding of the greatest speed of a slip, which meets it without acceleration."""
    case = machines.two_breakpoints(rng)
    peaks = [abs(e.velocity) for e in case.events if e.kind in (EventKind.COAST, EventKind.DECELERATE,
                                                                 EventKind.ACCELERATE) and e.velocity]
    if not peaks:
        return case
    speed = rng.choice(peaks[:4]) * (1.0 + rng.choice((0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-8, -1e-8, 1e-4, -1e-4)))
    breakpoints, falls = case.values['friction.kinetic.velocities'], case.values['friction.kinetic.coefficients']
    table = dict(zip(breakpoints, falls))
    # on the line as it is, so that the motion up to there stays; what follows may bend
    table[speed] = falls[-1] if speed >= breakpoints[1] else falls[0] + (falls[1] - falls[0]) * speed / breakpoints[1]
    speeds = sorted(table)
    values = case.values | {'friction.kinetic.velocities': speeds,
                            'friction.kinetic.coefficients': [table[v] for v in speeds]}
    if rng.random() < 0.3 and speed > breakpoints[1]:
        values['friction.kinetic.end_slope'] = rng.choice((1.0, 1e-6)) * falls[0] / speed
    return Case(values, case.duration)


def steady_at_breakpoint(rng: random.Random) -> Case:
    """A drive that moves with the speed of a breakpoint, within rounding, and a slider that does so, too."""
    breakpoint = rng.choice((0.035, 0.01, 0.5))
    table = rng.choice(([0.12, 0.05, 0.05], [0.12, 0.05, 0.1], [0.12, 0.12, 0.05], [0.12, 0.08, 0.0]))
    values = draw.paper() | draw.kinetic([0.0, breakpoint, 2.0 * breakpoint], table, 0.0, rng.random() < 0.4)
    values |= rng.choice((draw.contact(), draw.contact(5e6, 15000.0)))
    if rng.random() < 0.3:
        values['axis.drive_damping'] = rng.choice((0.0, 2.0 * math.sqrt(6e5 * 350.0)))
    feed = draw.beside(rng, rng.choice((1.0, 2.0)) * breakpoint)
    return Case(values | draw.constant(feed, rng.choice((0.0, 0.05 * 3432.3275, -100.0))) | {
        'initial.velocity': draw.beside(rng, rng.choice((1.0, 2.0)) * breakpoint), 'initial.rest_time': 0.0}, 2.0)


def step_at_event(rng: random.Random) -> Case:
    """Inputs that jump at the time of an event, or an ulp beside it."""
    case = rng.choice((machines.two_breakpoints, edges.ties, machines.fig4_sweep))(rng)
    events = [e.time for e in case.events if 0.0 < e.time < case.duration]
    if not events or 'drive.velocity' not in case.values:
        return case
    times = sorted({draw.beside(rng, t) for t in rng.sample(events[:30], min(len(events[:30]), 3))})
    feed = case.values['drive.velocity']
    force = case.values.get('force.constant', 0.0)
    plain: Values = {name: value for name, value in case.values.items() if not name.startswith(('drive.', 'force.'))}
    plain |= draw.steps('drive', 'velocities', [0.0, *times],
                        [feed, *(feed * rng.choice((1.0, 0.0, -1.0, 1.0 + 1e-12, 2.0)) for _ in times)])
    normal = case.values['axis.normal_force'] * case.values['friction.static.initial']
    forces = [force, *(force + normal * rng.choice((0.0, 0.0, 0.5, -2.0, 1e-12)) for _ in times)]
    plain |= draw.steps('force', 'forces', [0.0, *times], forces)
    return Case(plain, case.duration)


def resonance(rng: random.Random) -> Case:
    """Sines near the resonance of a slip or of the contact."""
    contact = rng.random() < 0.5
    values = draw.paper() | (draw.contact(5e6, rng.choice((0.0, 1500.0, 15000.0))) if contact else draw.contact())
    values |= draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0, rng.random() < 0.5)
    if rng.random() < 0.5:
        values['axis.drive_damping'] = 0.0
    omega = math.sqrt((6e5 + (5e6 if contact and rng.random() < 0.7 else 0.0)) / 350.0)
    frequency = draw.near(rng, omega / (2.0 * math.pi), 1e-12, 1e-1)
    values |= {'drive.course': 'sine', 'drive.velocity': rng.choice((0.0, 0.002, 0.02)),
               'drive.amplitude': draw.powers(rng, 1e-4, 0.05), 'drive.frequency': frequency,
               'drive.phase': rng.choice((0.0, rng.uniform(-3.0, 3.0)))}
    if rng.random() < 0.5:
        values |= {'force.course': 'sine', 'force.constant': 0.0, 'force.amplitude': draw.powers(rng, 1.0, 1000.0),
                   'force.frequency': rng.choice((frequency, draw.near(rng, frequency), 2.0 * frequency))}
    return Case(values, 1.5)


def sines(rng: random.Random) -> Case:
    """Any machine under sines on drive and force."""
    case = machines.any_machine(rng)
    values, stiffness, mass = case.values, case.values['axis.drive_stiffness'], case.values['axis.mass']
    frequency = math.sqrt(stiffness / mass) / (2.0 * math.pi)
    limit = values['axis.normal_force'] * values['friction.static.initial']
    speed = limit / math.sqrt(stiffness * mass)
    for name, size in (('drive', speed), ('force', limit)):
        count = rng.choice((0, 1, 1, 2))
        if count:
            values[f'{name}.amplitudes'] = [size * draw.powers(rng, 1e-2, 1.0) for _ in range(count)]
            values[f'{name}.frequencies'] = [frequency * rng.choice((1.0, draw.powers(rng, 0.05, 8.0)))
                                             for _ in range(count)]
            values[f'{name}.phases'] = [rng.choice((0.0, rng.uniform(-3.0, 3.0))) for _ in range(count)]
    return Case(values, case.duration)


def shaken(rng: random.Random) -> Case:
    """A rigid contact with two branches under sines: nothing but rates decides its break-aways."""
    case = sines(rng)
    values = {name: value for name, value in case.values.items() if not name.startswith('contact.')}
    values |= draw.contact() | {'friction.acceleration_dependence': True}
    swing = math.sqrt(values['axis.drive_stiffness'] / values['axis.mass']) / (2.0 * math.pi)
    size = values['axis.normal_force'] * values['friction.static.initial'] * rng.uniform(0.3, 3.0)
    count = rng.randint(1, 3)
    values |= {'force.amplitudes': [size * rng.uniform(0.01, 1.0) for _ in range(count)],
               'force.frequencies': [swing * rng.choice((1.0, draw.powers(rng, 0.03, 10.0))) for _ in range(count)],
               'force.phases': [rng.choice((0.0, 0.5 * math.pi, rng.uniform(-3.0, 3.0))) for _ in range(count)]}
    return Case(values, case.duration)
