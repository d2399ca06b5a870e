# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Machines that one may meet, drawn at random."""

import math
import random

from ..case import Case, Values
from . import draw

_LAWS = 'exponential', 'kato', 'hyperbolic', 'logarithmic'


def two_breakpoints(rng: random.Random) -> Case:
    """Friction that falls linearly to v_gr; any mass, stiffness and damping that a machine has."""
    mass = draw.powers(rng, 1.0, 1e5)
    stiffness = mass * (2.0 * math.pi * draw.powers(rng, 1.0, 200.0)) ** 2
    damping = rng.choice((0.0, rng.uniform(0.0, 0.2), rng.uniform(0.0, 2.0))) * 2.0 * math.sqrt(stiffness * mass)
    normal = mass * 9.80665 * rng.choice((1.0, rng.uniform(0.2, 3.0)))
    at_rest = rng.uniform(0.05, 1.5)
    limit = draw.powers(rng, 5e-5, 0.05)
    values = draw.axis(mass, stiffness, damping, normal) | _contact(rng, mass, stiffness)
    values |= draw.kinetic([0.0, limit], [at_rest, at_rest * rng.uniform(0.02, 0.98)], 0.0, rng.random() < 0.4)
    values |= _static(rng, at_rest)
    feed = rng.choice((-1.0, 1.0)) * draw.powers(rng, 1e-5, 0.1)
    values |= draw.constant(feed, rng.choice((0.0, rng.uniform(-0.5, 0.5) * at_rest * normal)))
    values |= draw.starts(rng, feed) | draw.closures(rng, values)
    slow = at_rest * normal / stiffness / abs(feed)
    return Case(values, min(draw.powers(rng, 1.0, 60.0), 30.0 * slow + 20.0 / math.sqrt(stiffness / mass)))


def fig4_sweep(rng: random.Random) -> Case:
    """The paper's axis with friction that falls steeply, under a fast feed."""
    values = draw.paper() | draw.kinetic([0.0, draw.powers(rng, 5e-5, 5e-4)], [0.12, 0.05])
    return Case(values | draw.constant(0.01), 10.0)


def any_machine(rng: random.Random) -> Case:
    """Any law, one to five breakpoints, either contact, inputs with jumps and ramps."""
    mass = draw.powers(rng, 0.1, 1e5)
    omega = draw.powers(rng, 3.0, 1e3)
    stiffness = mass * omega * omega
    damping = 2.0 * math.sqrt(stiffness * mass) * rng.choice((0.0, rng.uniform(0.0, 0.5), rng.uniform(0.0, 2.0), 30.0))
    normal = mass * draw.powers(rng, 1.0, 30.0)
    at_rest = rng.uniform(0.01, 1.0)
    speed = normal * at_rest / (mass * omega)
    breakpoints = sorted({0.0, *(speed * draw.powers(rng, 1e-3, 3.0) for _ in range(rng.randint(1, 4)))})
    falls = [at_rest, *(at_rest * rng.uniform(0.02, 1.0) for _ in breakpoints[1:])]
    values = draw.axis(mass, stiffness, damping, normal) | _contact(rng, mass, stiffness)
    values |= draw.kinetic(breakpoints, falls, rng.choice((0.0, 0.0, 0.1 * at_rest / speed)), rng.random() < 0.4)
    values |= _static(rng, at_rest)
    feed = speed * draw.powers(rng, 1e-3, 1.0)
    duration = rng.uniform(5.0, 60.0) / omega + min(3.0 * at_rest * normal / stiffness / feed, 100.0 / omega)
    values |= _drive(rng, feed, duration) | _force(rng, normal * at_rest, duration) | draw.starts(rng, feed)
    return Case(values | draw.closures(rng, values), duration)


def smooth(rng: random.Random) -> Case:
    """A Stribeck, exponential or hyperbolic law, as a table of many breakpoints; two branches or one."""
    case = any_machine(rng)
    values = {name: value for name, value in case.values.items() if not name.startswith('friction.kinetic.')}
    at_rest = case.values['friction.kinetic.coefficients'][0]
    speed = case.values['friction.kinetic.velocities'][1]
    values |= {'friction.kinetic.law': rng.choice(('stribeck', 'exponential', 'hyperbolic')),
               'friction.kinetic.initial': at_rest, 'friction.kinetic.limit': at_rest * rng.uniform(0.1, 1.0),
               'friction.kinetic.stribeck_velocity': speed, 'friction.kinetic.tolerance': 0.01 * at_rest,
               'friction.kinetic.viscous': rng.choice((0.0, 0.1 * at_rest / speed))}
    if values['friction.kinetic.law'] == 'stribeck':
        values['friction.kinetic.exponent'] = draw.powers(rng, 0.5, 4.0)
    if values['friction.acceleration_dependence'] and rng.random() < 0.5:
        values['friction.excess.law'] = 'cosine'
    return Case(values, case.duration)


def _contact(rng: random.Random, mass: float, stiffness: float) -> Values:
    if rng.random() < 0.5:
        return draw.contact()
    stiffer = stiffness * draw.powers(rng, 1.0, 300.0)
    return draw.contact(stiffer, rng.choice((0.0, rng.uniform(0.0, 0.3), 1.5)) * 2.0 * math.sqrt(mass * stiffer))


def _static(rng: random.Random, at_rest: float) -> Values:
    initial = at_rest * rng.choice((1.0, 1.0, rng.uniform(1.0, 1.3)))
    if rng.random() < 0.25:
        return draw.static(initial) | _scatter(rng)
    law = rng.choice(_LAWS[:3])
    return _scatter(rng) | draw.static(initial, initial * rng.uniform(1.01, 2.5), draw.powers(rng, 1e-3, 10.0), law,
                       rng.choice((0.3, 0.7, 1.0, 2.0)))


def _scatter(rng: random.Random) -> Values:
    """Return a scatter of static friction, of every third machine."""
    own = random.Random(f'scatter {rng.getstate()}')    # the other numbers stay what they were
    if own.random() < 0.67:
        return {}
    return {'friction.static.scatter': draw.powers(own, 1e-3, 0.5), 'friction.static.scatter_run':
            own.choice((0.0, 0.1)), 'seed': own.choice((0, own.randrange(2 ** 63)))}


def _drive(rng: random.Random, feed: float, duration: float) -> Values:
    form = rng.choice(('constant', 'steps', 'ramp', 'table'))
    values = [feed * rng.choice((1.0, -1.0, 0.0, 0.3)) for _ in range(4)]
    times = [0.0, *sorted(rng.uniform(0.05, 0.95) * duration for _ in range(3))]
    if form == 'constant':
        return {'drive.course': form, 'drive.velocity': values[0] or feed}
    if form == 'ramp':
        return {'drive.course': form, 'drive.velocity': values[0], 'drive.acceleration': 2.0 * feed / duration,
                'drive.duration': rng.choice((math.inf, 0.5 * duration))}
    return {'drive.course': form, 'drive.times': times, 'drive.velocities': values}


def _force(rng: random.Random, limit: float, duration: float) -> Values:
    size = limit * rng.choice((0.0, rng.uniform(-0.5, 0.5), rng.uniform(-2.0, 2.0)))
    form = rng.choice(('constant', 'steps', 'table'))
    if form == 'constant':
        return {'force.course': form, 'force.constant': size}
    times = [0.0, *sorted(rng.uniform(0.05, 0.95) * duration for _ in range(2))]
    return {'force.course': form, 'force.times': times, 'force.forces': [0.0, size, -size * rng.random()]}
