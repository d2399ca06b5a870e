# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What generators draw from."""

import math
import random
from typing import Any

from ..case import Values


def powers(rng: random.Random, low: float, high: float) -> float:
    """Return a number between two positive ones, uniform in its logarithm."""
    return float(low * (high / low) ** rng.random())


def near(rng: random.Random, value: float, low: float = 1e-13, high: float = 1e-5) -> float:
    """Return a number beside another one, on either side, sometimes the number itself."""
    off = rng.choice((-1.0, 1.0)) * powers(rng, low, high)
    return value if rng.random() < 0.05 else value * (1.0 + off)


def beside(rng: random.Random, value: float) -> float:
    """Return a number, or one of its two neighbours."""
    return rng.choice((value, math.nextafter(value, math.inf), math.nextafter(value, -math.inf)))


def axis(mass: float, stiffness: float, damping: float, normal: float) -> Values:
    """Return the values of an axis."""
    return {'axis.mass': mass, 'axis.drive_stiffness': stiffness, 'axis.drive_damping': damping,
            'axis.normal_force': normal}


def contact(stiffness: float | None = None, damping: float = 0.0) -> Values:
    """Return the values of a contact, rigid without a stiffness."""
    if stiffness is None:
        return {'contact.model': 'rigid'}
    return {'contact.model': 'compliant', 'contact.stiffness': stiffness, 'contact.damping': damping}


def static(initial: float, limit: float | None = None, tau: float = 0.2, law: str = 'exponential',
           exponent: float | None = None) -> Values:
    """Return the values of a static law, constant without a limit."""
    values: Values = {'friction.static.law': 'constant' if limit is None else law, 'friction.static.initial': initial}
    if limit is not None:
        values |= {'friction.static.limit': limit, 'friction.static.time_constant': tau}
        if law == 'kato':
            values['friction.static.exponent'] = exponent
    return values


def kinetic(velocities: list[float], coefficients: list[float], end_slope: float = 0.0,
            branches: bool = False) -> Values:
    """Return the values of a kinetic table."""
    return {'friction.kinetic.velocities': velocities, 'friction.kinetic.coefficients': coefficients,
            'friction.kinetic.end_slope': end_slope, 'friction.acceleration_dependence': branches}


def constant(velocity: float, force: float = 0.0) -> Values:
    """Return the values of constant inputs."""
    return {'drive.course': 'constant', 'drive.velocity': velocity, 'force.course': 'constant',
            'force.constant': force}


def steps(name: str, values: str, times: list[float], given: list[float]) -> Values:
    """Return the values of an input that jumps: `name` is drive or force, `values` velocities or forces."""
    return {f'{name}.course': 'steps', f'{name}.times': times, f'{name}.{values}': given}


def starts(rng: random.Random, speed: float) -> Values:
    """Return a start: mostly at prolonged rest, or sliding, or just stopped."""
    what = rng.random()
    if what < 0.6:
        return {'initial.rest_time': math.inf}
    if what < 0.8:
        return {'initial.rest_time': rng.choice((0.0, 1.0))}
    return {'initial.velocity': rng.choice((-1.0, 1.0)) * speed, 'initial.rest_time': 0.0}


def closures(rng: random.Random, values: Values, share: float = 0.12) -> Values:
    """Return the switches of how stick begins and ends, each with a probability of `share`."""
    found: Values = {}
    if values['contact.model'] == 'compliant':
        found = {name: way for name, way in (('contact.arrest', 'undeflected'), ('contact.break_away', 'drive_force'))
                 if rng.random() < share}
    if rng.random() < share:
        found['axis.damper'] = 'slideway'
    tau = values.get('friction.static.time_constant')
    if tau is not None and rng.random() < share:
        found['friction.static.delay'] = min(tau * powers(rng, 1e-3, 30.0), 1e6)
    return found


def paper(**changes: Any) -> Values:
    """Return the values of the paper's axis with a rigid contact and one branch, without inputs."""
    return (axis(350.0, 6e5, 4000.0, 3432.3275) | contact() | static(0.12, 0.24, 0.2)
            | kinetic([0.0, 0.035], [0.12, 0.05]) | changes)
