# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The belt and the brake of the paper's Fig. 1 are this axis, seen from the belt."""

import math
from collections.abc import Iterator

import pytest

from stickslip_sim.axis import Axis, Friction, InitialState, RigidContact
from stickslip_sim.core.input_profile import constant, ramp
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import instant

NORMAL, STATIC, KINETIC = 100.0, 0.3, 0.2   # N


def coulomb(mass: float, stiffness: float, damping: float = 0.0) -> Axis:
    friction = Friction(StaticLaw(StaticLawKind.CONSTANT, STATIC, STATIC), KineticTable((0.0,), (KINETIC,)), None)
    return Axis(mass, stiffness, damping, NORMAL, RigidContact(), friction)


def times(end: float) -> Iterator[float]:
    return (end * k / 200 for k in range(1, 201))


def test_a_spring_that_is_fixed_over_a_belt() -> None:
    """In its own frame: x grows with the belt up to F_s/c, then swings about F_k/c until it moves as the belt again."""
    mass, stiffness, belt = 2.0, 800.0, 0.05
    omega, held, middle = math.sqrt(stiffness / mass), NORMAL * STATIC / stiffness, NORMAL * KINETIC / stiffness
    until = held / belt
    slip = 2.0 * (math.pi - math.atan((held - middle) * omega / belt)) / omega
    simulator = Simulator(coulomb(mass, stiffness), InitialState(), constant(-belt), constant(0.0))
    for time in times(until + slip):
        simulator.advance(instant(time))
        sample = simulator.sample()
        since = max(time - until, 0.0)
        x = min(belt * time, held) if since == 0.0 else (
            middle + (held - middle) * math.cos(omega * since) + belt / omega * math.sin(omega * since))
        assert sample.position + belt * time == pytest.approx(x, abs=1e-13)
        assert (sample.mode == Mode.STICK) == (since == 0.0 or since >= slip)


def test_a_belt_that_speeds_up_adds_the_force_of_its_inertia() -> None:
    """On the belt x = a t²/2, so that the limit is reached where c a t²/2 + m a = F_s."""
    mass, stiffness, a = 2.0, 800.0, 0.4
    simulator = Simulator(coulomb(mass, stiffness), InitialState(), ramp(0.0, -a, math.inf), constant(-mass * a))
    first = next(event for event in simulator.advance(instant(1.0)) if event.kind == EventKind.BREAKAWAY)
    assert first.time == pytest.approx(math.sqrt(2.0 * (NORMAL * STATIC - mass * a) / (stiffness * a)), rel=1e-14)


def test_a_brake_is_a_belt_of_the_speed_of_its_disc() -> None:
    """The damped block on a turning disc: angle, and the torque that holds it, by J, k, d and Ω alone."""
    inertia, arm, spring, damper, disc = 0.03, 0.1, 9.0, 0.06, 0.5   # kg m², m, N m/rad, N m s/rad, rad/s
    axis = coulomb(inertia / arm**2, spring / arm**2, damper / arm**2)
    simulator = Simulator(axis, InitialState(), constant(-disc * arm), constant(0.0))
    until = (NORMAL * STATIC * arm - damper * disc) / (spring * disc)   # k Ω t + d Ω = F_s r
    gamma, omega2 = 0.5 * damper / inertia, spring / inertia
    nu = math.sqrt(omega2 - gamma**2)
    begin, middle = disc * until, NORMAL * KINETIC * arm / spring
    for time in times(until + 0.5 / nu):
        simulator.advance(instant(time))
        since = max(time - until, 0.0)
        swing = math.exp(-gamma * since) * ((begin - middle) * math.cos(nu * since)
                                            + (disc + gamma * (begin - middle)) / nu * math.sin(nu * since))
        angle = disc * time if since == 0.0 else middle + swing
        assert simulator.sample().position / arm + disc * time == pytest.approx(angle, abs=1e-12)
