# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A compliant contact that begins exactly on its limit and is pulled away from it: its force comes back in time.

Value and slope of the guard are 0 there, and a ramp of the drive bends it, too.  The force is the sum of a parabola and
two exponentials, looked at closely.
"""

import math
import random

import numpy as np
import pytest

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.input_profile import constant, ramp
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import instant

LIMIT = 0.25           # mu_s, and mu_k at rest: an arrest lands on the limit
FRICTION = Friction(StaticLaw(StaticLawKind.CONSTANT, LIMIT, LIMIT), KineticTable((0.0, 1.0), (LIMIT, 0.12)), None)
LOOKS, PERIODS = 40_000, 4.0
ROUNDING = 1e-11       # of the limit


def force_of(axis: Axis, stretch: float, deflection: float, velocity: float, acceleration: float, times: Numbers
             ) -> Numbers:
    """Return what holds the slider from rest on, N: the force of the contact, or of the drive that ends the stick."""
    contact = axis.contact
    assert isinstance(contact, CompliantContact)
    k, d, c, h, m = axis.drive_stiffness, axis.drive_damping, contact.stiffness, contact.damping, axis.mass
    push, push_rate = k * stretch + d * velocity - c * deflection, k * velocity + d * acceleration   # N, N/s
    gamma, square = 0.5 * (d + h) / m, (k + c) / m
    second = k * acceleration / m / square
    first = (push_rate / m - 2.0 * gamma * second) / square
    zeroth = (push / m - 2.0 * gamma * first - second) / square
    root = np.emath.sqrt(gamma ** 2 - square)
    roots = np.array([-gamma + root, -gamma - root])
    parts = np.linalg.solve(np.array([[1.0, 1.0], roots]), np.array([-zeroth, -first], complex))
    free = parts[:, None] * np.exp(roots[:, None] * times)
    y = (zeroth + (first + 0.5 * second * times) * times + free.sum(axis=0)).real
    u = (first + second * times + (roots[:, None] * free).sum(axis=0)).real
    if contact.ends_by_drive:
        moved = (velocity + 0.5 * acceleration * times) * times - y
        found: Numbers = k * (stretch + moved) + d * (velocity + acceleration * times - u)
    else:
        found = c * (deflection + y) + h * u
    return found


@pytest.mark.parametrize('damped', [False, True])
@pytest.mark.parametrize('by_drive', [False, True])
def test_the_first_return_to_the_limit_is_a_break_away(by_drive: bool, damped: bool) -> None:
    rng = random.Random(f'{by_drive} {damped}')
    returns = 0
    for _ in range(250):
        mass, k, c, normal = (10.0 ** rng.uniform(low, high) for low, high in ((-1, 2), (2, 6), (2, 7), (0, 4)))
        limit, side, square = LIMIT * normal, rng.choice((-1.0, 1.0)), (k + c) / mass
        d, h = (10.0 ** rng.uniform(-3, -0.5) * math.sqrt(square) * mass * damped for _ in range(2))
        inside = limit * (1.0 - 10.0 ** rng.uniform(-3, -0.1))
        pace = rng.choice((1.0, 0.0, -1.0)) * rng.random() if not (by_drive or damped) else 0.0
        velocity = pace * limit * math.sqrt(square) / k
        acceleration = rng.choice((-1.0, 1.0)) * limit * square / k * 10.0 ** rng.uniform(-2, 0.5)
        stretch, deflection = ((limit, inside) if by_drive else (inside, limit))
        stretch, deflection = side * stretch / k, side * deflection / c
        if abs(k * stretch if by_drive else c * deflection) != limit:   # beside its limit by rounding
            continue
        axis = Axis(mass, k, d, normal, CompliantContact(c, h, ends_by_drive=by_drive), FRICTION)
        end = PERIODS * 2.0 * math.pi / math.sqrt(square)
        simulator = Simulator(axis, InitialState(rest_time=0.0, stretch=stretch, deflection=deflection),
                              ramp(velocity, acceleration, math.inf), constant(0.0))
        first = next((event.time for event in simulator.advance(instant(end))), math.inf)
        times = np.linspace(0.0, end, LOOKS + 1, dtype=np.float64)
        beyond = np.abs(force_of(axis, stretch, deflection, velocity, acceleration, times)) - limit
        late = times[beyond > ROUNDING * limit]
        assert first <= (late[0] if len(late) else math.inf)
        assert first == math.inf or np.abs(force_of(
            axis, stretch, deflection, velocity, acceleration, np.array([first]))) == pytest.approx(limit, rel=ROUNDING)
        returns += 0.0 < first < math.inf
    assert returns > 20
