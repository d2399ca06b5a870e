# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An input or a parameter that jumps chooses the mode anew at that instant; docs/model.md, "Rules at the edges"."""

import math
from dataclasses import replace

import pytest

from stickslip_sim.axis.codes import (
    ACCELERATE,
    ACCELERATING,
    ARREST,
    BREAKAWAY,
    COAST,
    COASTING,
    DECELERATE,
    DECELERATING,
    REVERSE,
    STICK,
)
from stickslip_sim.axis.layout import Parameters
from stickslip_sim.axis.rows import EventRow, Events
from stickslip_sim.axis.state_record import State
from stickslip_sim.axis.transitions import apply_inputs
from tests.support.plain_axes import COMPLIANT, FRICTION, SIDED, STATIC, parameters, slip, state

both_ways = pytest.mark.parametrize('direction', [1.0, -1.0])


def applied(p: Parameters, s: State) -> EventRow | None:
    """Apply the inputs that the state has; return the event if there is one."""
    events = Events(1)
    return events.rows[0] if apply_inputs(p, s, events, 0) else None


@both_ways
@pytest.mark.parametrize(('push', 'kind', 'mode', 'gain', 'friction'), [
    (30.0, ACCELERATE, ACCELERATING, (30.0 - 24.0) / 2.0, 24.0), (20.0, COAST, COASTING, 0.0, 20.0),
    (12.5, COAST, COASTING, 0.0, 12.5), (11.0, DECELERATE, DECELERATING, (11.0 - 12.0) / 2.0, 12.0),
    (-9.0, DECELERATE, DECELERATING, (-9.0 - 12.0) / 2.0, 12.0)])
@pytest.mark.parametrize('before', [ACCELERATING, COASTING, DECELERATING])
def test_a_slip_takes_the_sub_mode_of_the_new_force(before: float, push: float, kind: float, mode: float, gain: float,
                                                    friction: float, direction: float) -> None:
    """At 0.125 m/s N mu_k = 12 N and N (mu_k + E psi) = 24 N; an event only where the mode changes."""
    p = parameters()
    s = slip(p, before, 0.125, direction=direction, push=push, excess=0.25)
    row = applied(p, s)
    assert (s.mode, s.acceleration, s.excess, s.direction) == (mode, direction * gain, 0.25, direction)
    assert s.velocity == direction * 0.125
    assert (row is None) == (mode == before)
    if row is not None:
        assert (row.kind, row.mode, row.direction, row.friction) == (kind, mode, direction, direction * friction)
        assert (row.static, row.rest) == (0.25, 0.0)
    if mode == COASTING:
        assert s.residual == push - 12.0


@both_ways
@pytest.mark.parametrize('rest', [math.inf, 2.0, 0.0])
def test_stick_holds_up_to_its_limit(rest: float, direction: float) -> None:
    """A force that stays exactly on the limit holds."""
    p = parameters()
    limit = 64.0 * {math.inf: 0.5, 2.0: 0.5 - 0.25 / math.e, 0.0: 0.25}[rest]
    for force in (0.0, 0.5 * limit, limit):
        s = state(mode=STICK, f=direction * force, rest=rest)
        assert applied(p, s) is None
        assert (s.mode, s.rest, s.velocity) == (STICK, rest, 0.0)
    s = state(mode=STICK, f=direction * (limit + 3.0), rest=rest)
    row = applied(p, s)
    assert row is not None
    assert (row.kind, row.mode, row.direction, row.rest) == (BREAKAWAY, ACCELERATING, direction, rest)
    assert (row.friction, s.acceleration) == pytest.approx((direction * limit, direction * 3.0 / 2.0), rel=1e-14)


@pytest.mark.parametrize(('force', 'holds'), [(16.0, True), (17.0, False), (-24.0, True), (-17.0, True),
                                              (-25.0, False)])
def test_each_direction_holds_as_much_as_its_own_limit(force: float, holds: bool) -> None:
    p = parameters(friction=SIDED)
    s = state(mode=STICK, f=force, rest=0.0)
    assert (applied(p, s) is None) is holds


@both_ways
def test_a_normal_force_that_falls_lets_go(direction: float) -> None:
    """N jumps from 64 N to 32 N: the limit is 16 N, and what the force is beyond it accelerates the slider."""
    s = state(mode=STICK, f=direction * 20.0, rest=math.inf)
    assert applied(parameters(), s) is None
    row = applied(parameters(normal_force=32.0), s)
    assert row is not None
    assert (row.kind, row.friction, s.acceleration) == (BREAKAWAY, direction * 16.0, direction * (20.0 - 16.0) / 2.0)


@both_ways
def test_a_compliant_contact_yields_to_a_jump(direction: float) -> None:
    """Its own force is below the limit, however strong the drive: m ẍ = F_d + F_e − F_c."""
    p = parameters(contact=COMPLIANT)
    s = state(mode=STICK, f=direction * 100.0, deflection=direction * 8.0 / 4096.0, velocity=direction * 0.0625,
              rest=math.inf)
    assert applied(p, s) is None
    assert s.acceleration == direction * (100.0 - 32.0 * 0.0625 - 8.0 - 64.0 * 0.0625) / 2.0
    assert (s.mode, s.deflection) == (STICK, direction * 8.0 / 4096.0)
    by_drive = parameters(contact=replace(COMPLIANT, ends_by_drive=True))
    row = applied(by_drive, s)
    assert row is not None
    assert (row.kind, row.direction, row.friction) == (BREAKAWAY, direction, direction * 32.0)


@both_ways
def test_a_slip_at_standstill_ends_or_turns_round(direction: float) -> None:
    """A velocity that is backwards by rounding alone counts as standstill."""
    p = parameters(friction=replace(FRICTION, static=replace(STATIC, initial=0.375)))
    for push, kind, mode in ((10.0, ARREST, STICK), (-20.0, ARREST, STICK), (-30.0, REVERSE, ACCELERATING)):
        s = slip(p, DECELERATING, 0.0, direction=direction, push=push, excess=0.25)
        s.velocity = -direction * 1e-18
        row = applied(p, s)
        assert row is not None
        assert (row.kind, row.mode, s.mode, s.velocity) == (kind, mode, mode, 0.0)
    s = slip(p, DECELERATING, 0.0, direction=direction, push=16.0 + 16.0 + 5.0, excess=0.25)
    row = applied(p, s)      # pushed on: the slip goes on
    assert row is not None
    assert (row.kind, s.mode, s.acceleration, s.direction) == (ACCELERATE, ACCELERATING, direction * 2.5, direction)


@both_ways
def test_steady_sliding_stays(direction: float) -> None:
    """ẋ = v within the band is an equilibrium."""
    p = parameters()
    for push in (12.0, 18.0, 24.0):
        s = slip(p, COASTING, 0.125, direction=direction, push=push, excess=0.25, v=direction * 0.125)
        assert applied(p, s) is None
        assert (s.mode, s.residual, s.velocity) == (COASTING, push - 12.0, direction * 0.125)
