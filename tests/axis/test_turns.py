# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What happens within a slip: its acceleration vanishes, coasting ends, the speed crosses a breakpoint."""

import pytest

from stickslip_sim.axis.codes import (
    ACCELERATE,
    ACCELERATING,
    COAST,
    COASTING,
    DECELERATE,
    DECELERATING,
    KNOT,
)
from stickslip_sim.axis.friction_segments import breakpoint_speed
from stickslip_sim.axis.rows import EventRow, Events
from stickslip_sim.axis.transitions import cross_breakpoint, leave_coast, turn
from tests.support.plain_axes import CONVENTIONAL, SIDED, parameters, slip

both_ways = pytest.mark.parametrize('direction', [1.0, -1.0])


@both_ways
@pytest.mark.parametrize(('mode', 'friction', 'residual'), [(ACCELERATING, 12.0 + 12.0, 12.0),
                                                            (DECELERATING, 12.0, 0.0)])
def test_a_slip_coasts_where_its_acceleration_vanishes(mode: float, friction: float, residual: float, direction: float
                                                       ) -> None:
    """On the upper edge of the band, R = B = N E psi, or on the lower one, R = 0; friction goes on."""
    p = parameters()
    s = slip(p, mode, 0.125, direction=direction, push=friction, excess=0.25, v=direction * 0.0625,
             acceleration=1e-9, second=4.0, fraction=0.5)
    events = Events(1)
    turn(p, s, events, 0)
    row = events.rows[0]
    assert (row.kind, row.mode, row.direction, row.friction) == (COAST, COASTING, direction, direction * friction)
    assert (row.second, row.fraction, row.velocity, row.static, row.rest) == (4.0, 0.5, direction * 0.125, 0.25, 0.0)
    assert (s.mode, s.residual, s.acceleration, s.velocity) == (COASTING, residual, 0.0, direction * 0.125)


@both_ways
@pytest.mark.parametrize(('mode', 'kind', 'follows', 'begin'), [
    (ACCELERATING, DECELERATE, DECELERATING, 0.0), (DECELERATING, ACCELERATE, ACCELERATING, 0.25)])
def test_one_branch_passes_to_the_other_where_both_are_one(mode: float, kind: float, follows: float, begin: float,
                                                           direction: float) -> None:
    """Without an excess there is no band; at a breakpoint the segment is the one it goes into."""
    p = parameters(friction=CONVENTIONAL)
    s = slip(p, mode, 0.25, direction=direction, push=8.0, acceleration=1e-9)
    events = Events(1)
    turn(p, s, events, 0)
    assert (events.rows[0].kind, events.rows[0].mode, events.rows[0].friction) == (kind, follows, direction * 8.0)
    assert (s.mode, s.acceleration, breakpoint_speed(p, int(s.segment))) == (follows, 0.0, begin)


@pytest.mark.parametrize('mode', [ACCELERATING, DECELERATING])
def test_steady_sliding_takes_the_drives_velocity(mode: float) -> None:
    """Sliding at ẋ = v but for rounding is an equilibrium and stays one."""
    p = parameters(friction=CONVENTIONAL)
    s = slip(p, mode, 0.125 * (1.0 - 2.0 ** -52), push=12.0, v=0.125)
    events = Events(1)
    turn(p, s, events, 0)
    assert (events.rows[0].kind, s.mode, s.velocity, s.acceleration) == (COAST, COASTING, 0.125, 0.0)


def test_a_force_that_rises_is_no_steady_sliding() -> None:
    """At ẋ = v, too."""
    p = parameters(friction=CONVENTIONAL)
    for inputs in ({'f_rate': 1.0}, {'v_rate': 1.0}, {'v_rate': 0.03125, 'f_rate': -1.0}):
        s = slip(p, DECELERATING, 0.125, push=12.0, v=0.125, **inputs)
        turn(p, s, Events(1), 0)
        assert s.mode == ACCELERATING


@both_ways
@pytest.mark.parametrize(('kind', 'mode', 'begin'), [(ACCELERATE, ACCELERATING, 0.25), (DECELERATE, DECELERATING, 0.0)])
def test_coasting_ends_upwards_or_downwards(kind: float, mode: float, begin: float, direction: float) -> None:
    """Friction is F_d + F_e up to there, and the acceleration begins with 0."""
    p = parameters()
    s = slip(p, COASTING, 0.25, direction=direction, push=8.0 if mode == DECELERATING else 16.0, excess=0.25)
    events = Events(1)
    leave_coast(p, s, events, 0, kind)
    row = events.rows[0]
    assert (row.kind, row.mode, row.direction) == (kind, mode, direction)
    assert row.friction == direction * (8.0 if mode == DECELERATING else 16.0)
    assert (s.mode, s.acceleration, breakpoint_speed(p, int(s.segment))) == (mode, 0.0, begin)


def crossed(mode: float, direction: float, acceleration: float, before: float, *, excess: float = 0.0,
            push: float = 8.0, gamma: float = 0.0, spring: float = 0.0) -> tuple[EventRow, float, float, float]:
    """Cross the breakpoint at 0.25 m/s; return the event, the velocity, the segment's begin and the acceleration."""
    p = parameters()
    s = slip(p, mode, 0.25, direction=direction, push=push, excess=excess, acceleration=acceleration,
             spring=spring)
    s.oscillator.gamma = gamma
    s.segment = 0.0 if mode == ACCELERATING else 1.0     # the one that it comes from
    s.velocity *= 1.0 + 2.0 ** -50
    events = Events(1)
    cross_breakpoint(p, s, events, 0, before)
    return events.rows[0], s.velocity, breakpoint_speed(p, int(s.segment)), s.acceleration


@both_ways
@pytest.mark.parametrize(('mode', 'begin', 'friction', 'gain'), [(ACCELERATING, 0.25, 8.0 + 64.0 * 0.25 * 0.5, 3.0),
                                                                 (DECELERATING, 0.0, 8.0, -3.0)])
def test_a_breakpoint_is_crossed_at_its_speed(mode: float, begin: float, friction: float, gain: float, direction: float
                                              ) -> None:
    row, velocity, segment, acceleration = crossed(mode, direction, direction * gain, direction * gain, excess=0.25)
    assert (row.kind, row.mode, row.direction, row.velocity) == (KNOT, mode, direction, direction * 0.25)
    assert (row.friction, row.static) == (direction * friction, 0.25)
    assert (velocity, segment, acceleration) == (direction * 0.25, begin, direction * gain)


@both_ways
@pytest.mark.parametrize('mode', [ACCELERATING, DECELERATING])
def test_a_speed_that_peaks_on_a_breakpoint_has_no_acceleration(mode: float, direction: float) -> None:
    """A rounding of the wrong sign is a tie, which the rate of the force decides."""
    wrong = -1e-15 if mode == ACCELERATING else 1e-15
    assert crossed(mode, direction, direction * wrong, 0.0)[3] == 0.0


@both_ways
def test_after_a_steep_segment_the_balance_of_forces_has_the_acceleration(direction: float) -> None:
    """m ẍ = F_d + F_e − F: what the closed form lost on the way is much more than the forces are off."""
    for before, gamma in ((1e9, 0.0), (-1e9, 0.0), (0.0, 1e9), (0.0, -1e9)):     # a fast begin, or a steep segment
        row, *_, acceleration = crossed(ACCELERATING, direction, direction * 1.75, before, gamma=gamma, push=8.0 + 3.0)
        assert row.friction == direction * 8.0
        assert acceleration == direction * 3.0 / 2.0
    # the forces are off by more than that: a spring of 2 kN is in their sum
    assert crossed(ACCELERATING, direction, direction * 1.75, 1e4, push=8.0 + 3.0, spring=2.0)[3] == direction * 1.75


def test_the_breakpoints_backwards_are_their_own() -> None:
    p = parameters(friction=SIDED)
    s = slip(p, ACCELERATING, 0.0625, direction=-1.0, push=20.0, excess=0.25, acceleration=-6.0)
    s.velocity = -0.125
    events = Events(1)
    cross_breakpoint(p, s, events, 0, -6.0)
    assert (events.rows[0].velocity, events.rows[0].friction, events.rows[0].static) == (-0.125, -2.0, 0.375)
