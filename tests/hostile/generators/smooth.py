# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Smooth laws of kinetic friction."""

import random

from ..case import Case
from . import draw, machines


def smooth(rng: random.Random) -> Case:
    """A Stribeck, exponential or hyperbolic law, as a table of many breakpoints; two branches or one."""
    case = machines.any_machine(rng)
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
