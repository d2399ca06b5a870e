# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""When a compliant contact yields, how it begins and how it ends; docs/model.md, "Yielding".

N mu_k(0) is 16 N, N mu_s 32 N after a long rest; 2 kg, c_c = 4096 N/m, h_c = 64 N s/m.
"""

import math
from dataclasses import replace

import pytest

from stickslip_sim.axis import Friction
from stickslip_sim.axis.codes import ACCELERATING, ARREST, BREAKAWAY, DECELERATING, STICK, YIELD, YIELDING
from stickslip_sim.axis.forces import contact_force
from stickslip_sim.axis.layout import Parameters
from stickslip_sim.axis.mode_entry import choose_slip
from stickslip_sim.axis.motion import begin_motion, move_start
from stickslip_sim.axis.rows import EventRow, Events
from stickslip_sim.axis.state_record import State
from stickslip_sim.axis.transitions import apply_inputs, arrest, release, turn
from tests.support.plain_axes import COMPLIANT, CONVENTIONAL, FRICTION, parameters, slip, state

both_ways = pytest.mark.parametrize('direction', [1.0, -1.0])
UNDAMPED = replace(COMPLIANT, damping=0.0)


def released(p: Parameters, s: State) -> EventRow:
    events = Events(1)
    release(p, s, events, 0)
    return events.rows[0]


def applied(p: Parameters, s: State) -> EventRow | None:
    events = Events(1)
    return events.rows[0] if apply_inputs(p, s, events, 0) else None


def yielding(p: Parameters, direction: float, **numbers: float) -> State:
    return state(mode=YIELDING, direction=direction, **numbers)


@both_ways
@pytest.mark.parametrize('rest', [math.inf, 2.0, 0.0])
def test_a_contact_at_its_limit_yields_where_the_slider_moves_the_other_way(rest: float, direction: float) -> None:
    """F_c = N mu_s and ẋ the other way: F drops to N mu_k(0), δ and ẋ stay, the rest time ends."""
    p = parameters(contact=COMPLIANT)
    limit = 64.0 * {math.inf: 0.5, 2.0: 0.5 - 0.25 / math.e, 0.0: 0.25}[rest]
    deflection = direction * (limit + 64.0 * 0.125) / 4096.0
    s = state(mode=STICK, velocity=-direction * 0.125, deflection=deflection, rest=rest, f=direction * 4.0, second=3.0)
    row = released(p, s)
    assert (row.kind, row.mode, row.direction, row.rest, row.second) == (YIELD, YIELDING, direction, rest, 3.0)
    assert [row.friction, row.static] == pytest.approx([direction * limit, limit / 64.0], rel=1e-15)
    assert (s.mode, s.direction, s.rest, s.velocity, s.deflection) == (YIELDING, direction, 0.0, -direction * 0.125,
                                                                       deflection)
    assert s.acceleration == direction * (4.0 + 32.0 * 0.125 - 16.0) / 2.0


@both_ways
def test_without_a_damper_the_deflection_jumps_to_the_kinetic_force(direction: float) -> None:
    p = parameters(contact=UNDAMPED)
    s = state(mode=STICK, velocity=-direction * 0.125, deflection=direction * 32.0 / 4096.0, rest=math.inf)
    assert released(p, s).kind == YIELD
    assert s.deflection == direction * 16.0 / 4096.0


@both_ways
@pytest.mark.parametrize('velocity', [0.0, 1e-19, -1e-19])
def test_at_standstill_the_force_says_where_it_moves_next(velocity: float, direction: float) -> None:
    """A velocity within rounding of 0 counts as 0: 40 N of 32 N break away, 20 N let the contact yield."""
    p = parameters(contact=COMPLIANT, normal_force=32.0)   # N mu_s = 16 N, below what the contact carries
    for force, kind in ((20.0, BREAKAWAY), (12.0, YIELD)):
        s = state(mode=STICK, velocity=velocity, deflection=direction * 20.0 / 4096.0, rest=math.inf,
                  f=direction * force)
        s.acceleration = direction * (force - 20.0) / 2.0
        row = applied(p, s)
        assert row is not None
        assert (row.kind, row.direction) == (kind, direction)
        assert s.velocity == (0.0 if velocity * direction < 0.0 and kind == BREAKAWAY else velocity)


@both_ways
@pytest.mark.parametrize(('n_rate', 'kind'), [(-40.0, BREAKAWAY), (-8.0, YIELD), (0.0, YIELD)])
def test_a_tie_at_standstill_is_decided_by_what_moves_faster(n_rate: float, kind: float, direction: float) -> None:
    """The force and the limit are both 16 N; the force falls by 8 N/s, the limit by 20, 4 or 0 N/s."""
    p = parameters(contact=COMPLIANT, normal_force=32.0)
    s = state(mode=STICK, deflection=direction * 16.0 / 4096.0, rest=math.inf, f=direction * 16.0,
              f_rate=-direction * 8.0, n_rate=n_rate)
    assert released(p, s).kind == kind


@pytest.mark.parametrize('contact', [replace(COMPLIANT, ends_by_drive=True), None])
def test_a_stick_that_the_drive_ends_never_yields(contact: object) -> None:
    p = parameters() if contact is None else parameters(contact=contact)
    assert released(p, state(mode=STICK, f=40.0, rest=math.inf)).kind == BREAKAWAY


@both_ways
def test_it_ends_in_stick_with_the_motion_as_it_is(direction: float) -> None:
    """F stays N mu_k(0), and nothing but the rest time begins anew."""
    p = parameters(contact=COMPLIANT)
    deflection = direction * (16.0 + 64.0 * 0.125) / 4096.0
    s = yielding(p, direction, velocity=-direction * 0.125, deflection=deflection)
    events = Events(1)
    arrest(p, s, events, 0)
    row = events.rows[0]
    assert (row.kind, row.mode, row.direction, row.friction, row.static) == (ARREST, STICK, direction,
                                                                             direction * 16.0, 0.25)
    assert (s.mode, s.direction, s.rest, s.velocity, s.deflection) == (STICK, 0.0, 0.0, -direction * 0.125, deflection)
    assert contact_force(p, s.deflection, s.velocity) == direction * 16.0
    assert s.acceleration == direction * (32.0 * 0.125 - 16.0) / 2.0


@both_ways
@pytest.mark.parametrize('friction', [FRICTION, CONVENTIONAL])
def test_it_ends_in_slip_where_the_slider_turns(friction: Friction, direction: float) -> None:
    """E = 0: friction stays N mu_k(0), and the contact lets go of its deflection."""
    p = parameters(contact=COMPLIANT, friction=friction)
    s = yielding(p, direction, velocity=direction * 1e-18, deflection=direction * 0.005, f=direction * 20.0)
    row = released(p, s)
    assert (row.kind, row.mode, row.direction, row.friction, row.velocity) == (BREAKAWAY, ACCELERATING, direction,
                                                                               direction * 16.0, 0.0)
    assert (row.static, row.rest) == (0.25, 0.0)
    assert (s.mode, s.velocity, s.deflection, s.excess) == (ACCELERATING, 0.0, 0.0, 0.0)
    assert s.acceleration == direction * 4.0 / 2.0


@both_ways
def test_a_jump_of_the_normal_force_chooses_anew(direction: float) -> None:
    """The interface slides on while its force at rest is above N mu_k(0); pressed harder, it stops."""
    deflection = direction * (20.0 + 64.0 * 0.125) / 4096.0
    for normal_force, goes_on in ((64.0, True), (32.0, True), (96.0, False)):
        p = parameters(contact=COMPLIANT, normal_force=normal_force)
        s = yielding(p, direction, velocity=-direction * 0.125, deflection=deflection)
        row = applied(p, s)
        assert (row is None, s.deflection) == (goes_on, deflection)
        if row is None:
            assert (s.mode, s.acceleration) == (YIELDING, direction * (4.0 - 0.25 * normal_force) / 2.0)
        else:
            assert (row.kind, s.mode, s.rest, row.friction) == (ARREST, STICK, 0.0, direction * 20.0)


@both_ways
def test_a_jump_of_the_force_leaves_it_as_it_is(direction: float) -> None:
    p = parameters(contact=COMPLIANT)
    s = yielding(p, direction, velocity=-direction * 0.125, deflection=direction * 24.5 / 4096.0, f=direction * 100.0)
    assert applied(p, s) is None
    assert (s.mode, s.acceleration) == (YIELDING, direction * (100.0 + 4.0 - 16.0) / 2.0)


@both_ways
@pytest.mark.parametrize(('n_rate', 'goes_on'), [(-2100.0, True), (-1900.0, False)])
def test_a_tie_of_the_interface_is_decided_by_the_rates(n_rate: float, goes_on: bool, direction: float) -> None:
    """Without a damper: c_c ẋ = −512 N/s against N' mu_k(0) = −525 or −475 N/s."""
    p = parameters(contact=UNDAMPED)
    s = yielding(p, direction, velocity=-direction * 0.125, deflection=direction * 16.0 / 4096.0, n_rate=n_rate)
    assert (applied(p, s) is None) is goes_on


@both_ways
@pytest.mark.parametrize(('force', 'kind'), [(10.0, ARREST), (-60.0, BREAKAWAY)])
def test_another_contact_that_does_not_yield_holds_or_lets_go(force: float, kind: float, direction: float) -> None:
    p = parameters(contact=replace(COMPLIANT, ends_by_drive=True))
    s = yielding(p, direction, deflection=direction * 16.0 / 4096.0, f=direction * force)
    row = applied(p, s)
    assert row is not None
    assert (row.kind, s.mode) == (kind, STICK if kind == ARREST else ACCELERATING)


@both_ways
def test_the_motion_is_that_of_a_constant_force_and_a_contact_that_follows(direction: float) -> None:
    """Without a drive: m ẍ = −N mu_k(0), and δ falls to N mu_k(0)/c_c with h_c/c_c = 1/64 s."""
    p = parameters(contact=COMPLIANT, drive_stiffness=0.0, drive_damping=0.0)
    s = yielding(p, direction, velocity=-direction * 0.125, deflection=direction * 32.0 / 4096.0,
                 acceleration=-direction * 8.0)
    begin_motion(p, s)
    move_start(p, s, 0.0, 0.015625, 0.015625)
    assert s.velocity == pytest.approx(-direction * (0.125 + 8.0 * 0.015625), rel=1e-15)
    assert s.deflection == pytest.approx(direction * (16.0 + 16.0 * math.exp(-1.0)) / 4096.0, rel=1e-15)
    assert s.rest == 0.0


@both_ways
@pytest.mark.parametrize(('n_rate', 'moves'), [(-16.0, True), (-4.0, False)])
def test_a_tie_of_a_slip_counts_the_rate_of_the_normal_force(n_rate: float, moves: bool, direction: float) -> None:
    """R = B = 0 at standstill under a force that falls by 2 N/s; friction, mu 0.5, falls by 8 or 2 N/s."""
    p = parameters()
    s = state(direction=direction, excess=0.25, f_rate=-2.0 * direction, n_rate=n_rate)
    assert choose_slip(p, s, 0.0, 16.0, 1e-12) is moves


def test_a_feed_under_a_falling_normal_force_is_no_steady_sliding() -> None:
    """The slider is as fast as its drive, and friction falls: it accelerates."""
    for n_rate, mode in ((0.0, 'coasts'), (-16.0, 'goes on')):
        p = parameters(friction=CONVENTIONAL)
        s = slip(p, DECELERATING, 0.125, v=0.125, n_rate=n_rate, push=12.0)
        events = Events(1)
        turn(p, s, events, 0)
        assert (s.mode == ACCELERATING) is (mode == 'goes on')
