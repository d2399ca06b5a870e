# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How a slip ends, ẋ = 0: stick, or a reversal at once where a rigid contact cannot hold |F_d + F_e| at N mu_s(0)."""

import math
from dataclasses import replace
from functools import partial

import pytest

from stickslip_sim.axis import Friction, RigidContact
from stickslip_sim.axis.codes import (
    ACCELERATING,
    ARREST,
    BREAKAWAY,
    COASTING,
    DECELERATING,
    REVERSE,
    STICK,
    YIELD,
    YIELDING,
)
from stickslip_sim.axis.forces import applied_force, contact_force
from stickslip_sim.axis.layout import Parameters
from stickslip_sim.axis.mode_entry import choose_slip
from stickslip_sim.axis.motion import begin_motion, move_start
from stickslip_sim.axis.state_record import State
from stickslip_sim.axis.transitions import arrest, release, turn
from stickslip_sim.friction import KineticTable
from tests.support.axes import Contact
from tests.support.plain_axes import (
    BACKWARD,
    COMPLIANT,
    CONVENTIONAL,
    FRICTION,
    SIDED,
    STATIC,
    applied,
    ended,
    parameters,
    slip,
    state,
)

both_ways = pytest.mark.parametrize('direction', [1.0, -1.0])
HIGHER = replace(FRICTION, static=replace(STATIC, initial=0.375))      # above mu_k(0) = 0.25
arrested, released = partial(ended, arrest), partial(ended, release)


@both_ways
@pytest.mark.parametrize('push', [0.0, 16.0, -16.0, 5.0])
def test_a_force_within_the_limit_is_held(push: float, direction: float) -> None:
    """Also one that is exactly on it; the event has the friction of the slip, N mu_k(0)."""
    p = parameters()
    s = slip(p, DECELERATING, 0.0, direction=direction, push=push, excess=0.25, acceleration=-direction, rest=9.0,
             second=2.0, fraction=0.25, origin=5.0, position=0.5, drive=0.75, spring=0.25)
    row = arrested(p, s)
    assert (row.kind, row.mode, row.direction) == (ARREST, STICK, direction)
    assert (row.friction, row.static) == (direction * 16.0, 0.25)
    assert (row.second, row.fraction, row.position, row.drive, row.velocity) == (2.0, 0.25, 5.5, 5.75, 0.0)
    assert row.drive_force == 1024.0 * 0.25
    assert (s.mode, s.velocity, s.rest, s.acceleration) == (STICK, 0.0, 0.0, 0.0)


@both_ways
@pytest.mark.parametrize('friction', [FRICTION, HIGHER])
def test_a_force_beyond_the_limit_turns_the_slider_round(friction: object, direction: float) -> None:
    """It breaks away with mu_s(0) of the new direction, and E = mu_s(0) − mu_k(0)."""
    p = parameters(friction=friction)
    static = p.static_initial
    s = slip(p, DECELERATING, 0.0, direction=direction, push=-(64.0 * static + 6.0), excess=0.125)
    row = arrested(p, s)
    assert (row.kind, row.mode, row.direction, row.static) == (REVERSE, ACCELERATING, -direction, static)
    assert row.friction == direction * 16.0          # that of the slip which ends
    assert (s.mode, s.direction, s.excess) == (ACCELERATING, -direction, static - 0.25)
    assert s.acceleration == -direction * 6.0 / 2.0


def test_without_branches_friction_drops_as_the_slider_turns() -> None:
    p = parameters(friction=replace(HIGHER, excess=None))
    s = slip(p, DECELERATING, 0.0, push=-(24.0 + 6.0))
    assert arrested(p, s).kind == REVERSE
    assert (s.excess, s.acceleration) == (0.0, -(6.0 + 64.0 * (0.375 - 0.25)) / 2.0)
    assert arrested(parameters(friction=CONVENTIONAL), slip(p, DECELERATING, 0.0, push=-16.0)).kind == ARREST


@pytest.mark.parametrize(('direction', 'force', 'kind', 'static'), [
    (1.0, -20.0, ARREST, 0.25), (1.0, -24.0, ARREST, 0.25), (1.0, -26.0, REVERSE, 0.375), (-1.0, 15.0, ARREST, 0.375),
    (-1.0, 18.0, REVERSE, 0.25)])
def test_the_limit_is_that_against_the_force(direction: float, force: float, kind: float, static: float) -> None:
    """16 N against a force forwards, 24 N against one backwards; the event states mu_s(0) of its own direction."""
    p = parameters(friction=SIDED)
    s = slip(p, DECELERATING, 0.0, direction=direction, push=direction * force)
    row = arrested(p, s)
    assert (row.kind, row.static, row.direction) == (kind, static, direction if kind == ARREST else -direction)
    assert row.friction == direction * 64.0 * (0.25 if direction > 0.0 else 0.125)


@both_ways
def test_a_compliant_contact_holds_any_force_at_first(direction: float) -> None:
    """It goes on from the friction force, and yields: F_c decides, unless stick ends by the drive."""
    p = parameters(contact=COMPLIANT)
    s = slip(p, DECELERATING, 0.0, direction=direction, push=-30.0)
    assert arrested(p, s).kind == ARREST
    assert (s.mode, s.deflection) == (STICK, direction * 16.0 / 4096.0)
    assert s.acceleration == -direction * (30.0 + 16.0) / 2.0
    p = parameters(contact=replace(COMPLIANT, ends_by_drive=True))
    s = slip(p, DECELERATING, 0.0, direction=direction, push=-30.0)
    assert arrested(p, s).kind == REVERSE
    assert (s.direction, s.acceleration) == (-direction, -direction * (30.0 - 16.0) / 2.0)


@pytest.mark.parametrize('force', [2.0 ** -46, -2.0 ** -46, 0.0])
def test_a_contact_that_holds_nothing_is_at_rest_under_no_force_but_rounding(force: float) -> None:
    """Ended by the drive, it would break away and rest again at one instant for ever."""
    p = parameters(contact=replace(COMPLIANT, ends_by_drive=True), normal_force=0.0)
    s = state(mode=DECELERATING, direction=1.0, spring=0.0625, f=force - 0.0625 * p.stiffness)
    assert applied_force(p, s) == force
    assert (arrested(p, s).kind, s.mode, s.acceleration) == (ARREST, STICK, 0.0)


@pytest.mark.parametrize('contact', [RigidContact(), COMPLIANT, replace(COMPLIANT, ends_by_drive=True)],
                         ids=['rigid', 'contact_force', 'drive_force'])
@both_ways
def test_a_free_swing_dies_out_in_the_rounding_of_its_largest_force(contact: Contact, direction: float) -> None:
    """Nothing holds the slider: 8 N turned it, so that it rests at 8 N · 2⁻⁴⁹, and is turned by more."""
    p = parameters(contact=contact, normal_force=0.0)
    for force, rests in ((8.0, False), (2.0 ** -45, False), (2.0 ** -46, True), (0.0, True)):
        s = slip(p, DECELERATING, 0.0, direction=direction, push=-force, swing=8.0 if force < 8.0 else 0.0)
        row = arrested(p, s)
        turned = s.acceleration == -direction * force / 2.0 and force > 0.0
        assert turned is not rests
        assert (row.kind == ARREST or not rests, s.swing) == (True, 8.0)
        if rests:   # and stays so under inputs that are no others
            assert (s.mode, applied(p, s), s.acceleration) == (STICK, None, 0.0)


@pytest.mark.parametrize('contact', [RigidContact(), COMPLIANT, replace(COMPLIANT, ends_by_drive=True)])
def test_a_swing_is_forgotten_where_something_holds(contact: Contact) -> None:
    p = parameters(contact=contact)
    s = slip(p, DECELERATING, 0.0, push=-4.0, swing=8.0)
    arrested(p, s)
    assert s.swing == 0.0


def test_what_rounding_left_of_the_speed_is_gone() -> None:
    s = slip(parameters(), DECELERATING, 1e-17, push=3.0)
    assert (arrested(parameters(), s).velocity, s.velocity) == (0.0, 0.0)


# How stick ends: exactly at |F| = N mu_s(t⁻), in the direction of F; docs/model.md, "Rules at the edges".

@both_ways
@pytest.mark.parametrize(('rest', 'static'), [(math.inf, 0.5), (2.0, 0.5 - 0.25 / math.e), (0.0, 0.25)])
def test_friction_is_the_static_limit_and_the_excess_makes_up_for_it(rest: float, static: float, direction: float
                                                                     ) -> None:
    """Reached from below by a spring that is stretched on."""
    p = parameters()
    s = state(mode=STICK, spring=direction * 64.0 * static / 1024.0, v=direction * 0.25, rest=rest,
              f=-direction * 32.0 * 0.25, second=3.0, fraction=0.5, origin=10.0, position=1.0, drive=1.5)
    row = released(p, s)
    assert (row.kind, row.mode, row.direction, row.rest) == (BREAKAWAY, ACCELERATING, direction, rest)
    assert (row.second, row.fraction, row.position, row.drive, row.velocity) == (3.0, 0.5, 11.0, 11.5, 0.0)
    assert row.static == pytest.approx(static, rel=1e-15)
    assert row.friction == pytest.approx(direction * 64.0 * static, rel=1e-15)
    assert row.drive_force == pytest.approx(direction * (64.0 * static + 32.0 * 0.25), rel=1e-15)
    assert s.excess == pytest.approx(static - 0.25, abs=1e-15)
    assert (s.mode, s.direction, s.acceleration, s.rest) == (ACCELERATING, direction, 0.0, 0.0)


@both_ways
def test_what_is_beyond_the_limit_accelerates_the_slider(direction: float) -> None:
    """After a jump of the force, by 4 N: m ẍ = |F| − N mu_s; without branches |F| − N mu_k."""
    for friction, beyond in ((parameters().branches, 4.0), (0.0, 4.0 + 32.0 - 16.0)):
        p = parameters() if friction else parameters(friction=CONVENTIONAL)
        s = state(mode=STICK, f=direction * 36.0, rest=math.inf)
        assert released(p, s).friction == direction * 32.0
        assert s.acceleration == direction * beyond / 2.0


@both_ways
def test_a_compliant_contact_is_released_by_its_own_force(direction: float) -> None:
    """F_c = c_c δ + h_c ẋ = N mu_s; the drive has 35 N, and m ẍ = 35 N − N mu_s goes on."""
    p = parameters(contact=COMPLIANT)
    deflection = (32.0 - 64.0 * 0.125) / 4096.0
    s = state(mode=STICK, velocity=direction * 0.125, deflection=direction * deflection, f=direction * 39.0,
              acceleration=direction * 1.5, rest=math.inf)
    row = released(p, s)
    assert (row.direction, row.friction, row.velocity) == (direction, direction * 32.0, direction * 0.125)
    assert s.acceleration == direction * (39.0 - 32.0 * 0.125 - 32.0) / 2.0
    assert (s.mode, s.excess, s.deflection) == (ACCELERATING, (0.5 - 0.1875) / 0.75, 0.0)


def test_a_compliant_stick_may_end_by_the_force_of_the_drive() -> None:
    """F_d + F_e = N mu_s, not what the contact carries."""
    p = parameters(contact=replace(COMPLIANT, ends_by_drive=True))
    s = state(mode=STICK, velocity=-0.125, deflection=0.001, f=-36.0, rest=math.inf)    # F_d = 4 N
    row = released(p, s)
    assert (row.direction, row.friction) == (-1.0, -32.0)
    # the spring is relieved as the slider moves: the slip begins on the upper edge of its band, and goes inwards
    assert (s.mode, s.acceleration, s.excess) == (COASTING, 0.0, (0.5 - 0.1875) / 0.75)


def test_a_slip_by_the_force_of_the_drive_goes_along_the_velocity() -> None:
    """Where F_d + F_e ends a stick that moves the other way: friction was +32 N, and opposes the motion from now on."""
    p = parameters(contact=replace(COMPLIANT, ends_by_drive=True))
    s = state(mode=STICK, velocity=-0.125, deflection=0.0, rest=math.inf, f=28.0)      # F_d = 4 N
    row = released(p, s)
    assert (row.direction, row.friction) == (-1.0, 32.0)
    # friction pushes forwards with the drive: the slider, moving backwards, is slowed down
    assert (s.mode, s.direction, s.acceleration) == (DECELERATING, -1.0, (32.0 + 64.0 * 0.1875) / 2.0)


@pytest.mark.parametrize(('force', 'rest', 'direction', 'static'), [
    (32.0, math.inf, 1.0, 0.5), (-48.0, math.inf, -1.0, 0.75), (16.0, 0.0, 1.0, 0.25), (-24.0, 0.0, -1.0, 0.375)])
def test_each_direction_has_its_own_limit(force: float, rest: float, direction: float, static: float) -> None:
    """It holds while −N mu_s⁻ <= F <= N mu_s⁺."""
    p = parameters(friction=SIDED)
    s = state(mode=STICK, f=force, f_rate=direction, rest=rest)
    row = released(p, s)
    assert (row.direction, row.static, row.friction) == (direction, static, force)
    assert s.excess == static - (0.25 if direction > 0.0 else 0.125)


@both_ways
def test_a_limit_of_0_is_met_by_no_force_at_all(direction: float) -> None:
    """The nearer limit is the one that is met, though the force has no sign."""
    back = replace(BACKWARD, kinetic=KineticTable((0.0, 0.125), (0.0, 0.0)),
                   static=replace(BACKWARD.static, initial=0.0))
    p = parameters(friction=replace(FRICTION, backward=back) if direction < 0.0 else replace(back, backward=FRICTION))
    row = released(p, state(mode=STICK, rest=0.0))
    assert (row.direction, row.static, abs(row.friction)) == (direction, 0.0, 0.0)


@both_ways
def test_without_a_force_the_next_derivative_says_where_to(direction: float) -> None:
    """No normal force, so any force breaks the stick: its rate, then the rate of that, has the direction."""
    for inputs in ({'v': direction * 0.5}, {'f_rate': direction},
                   {'v_rate': direction * 0.5, 'f_rate': -direction * 16.0}):
        p = parameters(normal_force=0.0)
        s = state(mode=STICK, rest=math.inf, f=-32.0 * inputs.get('v', 0.0), **inputs)
        assert released(p, s).direction == direction
        assert (s.mode, s.direction, s.acceleration) == (ACCELERATING, direction, 0.0)


@both_ways
def test_a_moving_contact_without_a_force_goes_on_as_it_moves(direction: float) -> None:
    p = parameters(normal_force=0.0, contact=replace(COMPLIANT, damping=0.0))
    s = state(mode=STICK, rest=math.inf, velocity=direction * 0.125, f=direction * 4.0, acceleration=0.0)
    assert released(p, s).direction == direction
    s = state(mode=STICK, rest=math.inf, f=direction * 4.0, acceleration=direction * 2.0)
    assert released(p, s).direction == direction
    assert s.acceleration == direction * 2.0


# When a compliant contact yields, how it begins and how it ends; docs/model.md, "Yielding".
#
# N mu_k(0) is 16 N, N mu_s 32 N after a long rest; 2 kg, c_c = 4096 N/m, h_c = 64 N s/m.

UNDAMPED = replace(COMPLIANT, damping=0.0)


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
    row = arrested(p, s)
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
        ended(turn, p, s)
        assert (s.mode == ACCELERATING) is (mode == 'goes on')
