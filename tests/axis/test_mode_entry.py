# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Which mode begins: the table of sub-modes of docs/model.md, its ties, the excess of a break-away, and stick.

With sigma the direction, R = sigma (F_d + F_e) − N mu_k and B = N e: accelerating for R > B with m ẍ = R − B, coasting
for 0 <= R <= B, decelerating for R < 0 with m ẍ = R.  A tie is decided by where the force moves next.
"""

import pytest

from stickslip_sim.axis.codes import ACCELERATE, ACCELERATING, COAST, COASTING, DECELERATE, DECELERATING, KNOT, STICK
from stickslip_sim.axis.forces import breakpoint_speed
from stickslip_sim.axis.mode_entry import break_away, choose_slip, enter_branch, rest
from stickslip_sim.axis.rows import EventRow
from stickslip_sim.axis.transitions import cross_breakpoint, leave_coast, turn
from tests.support.plain_axes import COMPLIANT, CONVENTIONAL, SIDED, ended, parameters, slip, state

both_ways = pytest.mark.parametrize('direction', [1.0, -1.0])
BAND = 64.0 * 0.25 * 0.75    # N, at 0.125 m/s and with E = 0.25


@both_ways
@pytest.mark.parametrize(('lower', 'mode', 'gain'), [
    (BAND + 4.0, ACCELERATING, 4.0 / 2.0), (BAND - 1.0, COASTING, 0.0), (1.0, COASTING, 0.0),
    (-6.0, DECELERATING, -6.0 / 2.0)])
def test_the_force_beyond_friction_chooses_the_sub_mode(lower: float, mode: float, gain: float, direction: float
                                                        ) -> None:
    p = parameters()
    s = slip(p, DECELERATING, 0.125, direction=direction, push=64.0 * 0.1875 + lower, excess=0.25)
    assert choose_slip(p, s, lower - BAND, lower, 1e-12)
    assert (s.mode, s.acceleration) == (mode, direction * gain)
    if mode == COASTING:
        assert s.residual == lower


@both_ways
@pytest.mark.parametrize(('rate', 'second_rate', 'above', 'below'), [
    (+1.0, 0.0, ACCELERATING, COASTING), (-1.0, 0.0, COASTING, DECELERATING),
    (+1.0, -9.0, ACCELERATING, COASTING), (-1.0, 9.0, COASTING, DECELERATING),
    (0.0, +1.0, ACCELERATING, COASTING), (0.0, -1.0, COASTING, DECELERATING), (0.0, 0.0, COASTING, COASTING)])
@pytest.mark.parametrize('off', [0.0, 7e-15, -7e-15])
def test_on_a_border_the_rate_of_the_force_decides_then_its_rate(rate: float, second_rate: float, above: float,
                                                                 below: float, off: float, direction: float) -> None:
    """On R = B, and on R = 0, off by a rounding of 32 N, too; `rate` and `second_rate` are along the slip."""
    p = parameters()
    ramp = direction * second_rate / 1024.0
    s = slip(p, DECELERATING, 0.125, direction=direction, push=64.0 * 0.1875, excess=0.25, v=direction * 0.125,
             v_rate=ramp, f_rate=direction * rate - 32.0 * ramp)
    assert choose_slip(p, s, off, BAND + off, 1e-12)
    assert (s.mode, s.acceleration) == (above, 0.0)
    assert choose_slip(p, s, off - BAND, off, 1e-12)
    assert (s.mode, s.acceleration) == (below, 0.0)


@both_ways
def test_without_a_band_the_slip_accelerates_or_decelerates(direction: float) -> None:
    """Conventional friction: coasting is steady sliding alone."""
    p = parameters(friction=CONVENTIONAL)
    for lower, rate, mode in ((3.0, -1.0, ACCELERATING), (-3.0, 1.0, DECELERATING), (0.0, 1.0, ACCELERATING),
                              (0.0, -1.0, DECELERATING), (0.0, 0.0, COASTING)):
        s = slip(p, COASTING, 0.125, direction=direction, push=64.0 * 0.1875 + lower, v=direction * 0.125,
                 f_rate=direction * rate)
        assert choose_slip(p, s, lower, lower, 1e-12)
        assert (s.mode, s.acceleration) == (mode, direction * lower / 2.0)


@both_ways
@pytest.mark.parametrize(('residual', 'rate', 'goes_on'), [
    (1.0, -1.0, True), (0.0, 1.0, True), (0.0, -1.0, False), (0.0, 0.0, False), (-1.0, 1.0, False)])
def test_a_slider_at_standstill_slips_only_if_it_is_pushed(residual: float, rate: float, goes_on: bool, direction: float
                                                           ) -> None:
    p = parameters()
    s = slip(p, DECELERATING, 0.0, direction=direction, push=16.0, excess=0.25, f_rate=direction * rate)
    assert choose_slip(p, s, residual, residual + 16.0, 1e-12) is goes_on
    if goes_on:
        assert (s.mode, s.acceleration) == (ACCELERATING, direction * residual / 2.0)


@both_ways
@pytest.mark.parametrize(('mode', 'begin'), [(ACCELERATING, 0.25), (DECELERATING, 0.0)])
def test_on_a_breakpoint_a_branch_takes_the_segment_it_goes_into(mode: float, begin: float, direction: float) -> None:
    """Faster, the segment above it; slower, the one below."""
    p = parameters()
    s = slip(p, COASTING, 0.25, direction=direction, acceleration=9.0)
    enter_branch(p, s, mode)
    assert (s.mode, s.acceleration, breakpoint_speed(p, int(s.segment))) == (mode, 0.0, begin)
    residual = 1.0 if mode == ACCELERATING else -20.0
    s = slip(p, COASTING, 0.25, direction=direction, excess=0.25)
    assert choose_slip(p, s, residual, residual + 8.0, 1e-12)
    assert (s.mode, breakpoint_speed(p, int(s.segment))) == (mode, begin)


@both_ways
@pytest.mark.parametrize(('speed', 'limit', 'excess'), [
    (0.0, 0.5, 0.5 - 0.25), (0.125, 0.5, (0.5 - 0.1875) / 0.75), (0.375, 0.5, (0.5 - 0.09375) / 0.25),
    (0.0, 0.25, 0.0)])
def test_the_excess_makes_friction_continuous(speed: float, limit: float, excess: float, direction: float) -> None:
    """mu_k(w) + E psi(w) = mu_b.  What the force is beyond friction accelerates the slider."""
    p = parameters()
    s = slip(p, STICK, speed, direction=direction, push=64.0 * limit + 3.0, rest=7.0)
    break_away(p, s, direction, limit, 3.0)
    assert (s.mode, s.excess, s.acceleration) == (ACCELERATING, excess, direction * 3.0 / 2.0)
    assert (s.direction, s.rest, s.deflection) == (direction, 0.0, 0.0)


@both_ways
def test_friction_drops_where_there_is_no_excess(direction: float) -> None:
    """Without acceleration dependence m ẍ = N (mu_s − mu_k) at once; and where psi has ended, at 0.5 m/s."""
    for p, speed, kinetic in ((parameters(friction=CONVENTIONAL), 0.0, 0.25), (parameters(), 0.5, 0.0625)):
        s = slip(p, STICK, speed, direction=direction, push=32.0, excess=0.125)
        break_away(p, s, direction, 0.5, 0.0)
        assert (s.mode, s.excess, s.acceleration) == (ACCELERATING, 0.0, direction * 64.0 * (0.5 - kinetic) / 2.0)


@both_ways
def test_a_break_away_below_kinetic_friction_has_no_excess(direction: float) -> None:
    """At 0.875 m/s mu_k is 0.25 again; psi would have ended, too.  So a table whose mu_k rises while psi is left."""
    p = parameters()
    p.segments[0].slope = 1.0            # mu_k(0.125) = 0.375
    s = slip(p, STICK, 0.125, direction=direction, push=64.0 * 0.25)
    break_away(p, s, direction, 0.25, 0.0)
    assert (s.mode, s.excess, s.acceleration) == (DECELERATING, 0.0, direction * 64.0 * (0.25 - 0.375) / 2.0)


def test_a_break_away_that_is_exact_follows_the_drive() -> None:
    """|F| = N mu_s and no margin: the force rises with the stretch, so the slip begins with ẍ = 0."""
    p = parameters()
    s = slip(p, STICK, 0.0, push=32.0, v=0.5)
    break_away(p, s, 1.0, 0.5, 0.0)
    assert (s.mode, s.acceleration, s.excess) == (ACCELERATING, 0.0, 0.25)
    s = slip(p, STICK, 0.0, push=32.0, v=-0.5)
    break_away(p, s, 1.0, 0.5, 0.0)
    assert (s.mode, s.rest) == (STICK, 0.0)


def test_a_compliant_contact_breaks_away_in_motion_and_keeps_its_acceleration() -> None:
    """F_c = N mu_s before, friction N mu_s after: m ẍ = F_d + F_e − N mu_s goes on."""
    p = parameters(contact=COMPLIANT)
    s = slip(p, STICK, 0.125, push=35.0, acceleration=(35.0 - 32.0) / 2.0, deflection=0.0078125)
    break_away(p, s, 1.0, 0.5, 0.0)
    assert (s.mode, s.acceleration, s.deflection, s.velocity) == (ACCELERATING, 1.5, 0.0, 0.125)
    assert s.excess == (0.5 - 0.1875) / 0.75


@pytest.mark.parametrize(('share', 'mode'), [(-2e-15, COASTING), (-5e-16, ACCELERATING), (2e-15, ACCELERATING)])
def test_a_coast_too_short_to_be_known_is_left_out(share: float, mode: float) -> None:
    """A residual below 1e-15 of the friction force, 32 N: the force rises, so the slip accelerates."""
    p = parameters(contact=COMPLIANT)
    s = slip(p, STICK, 0.125, push=32.0, v=0.5, acceleration=share * 32.0 / 2.0)
    break_away(p, s, 1.0, 0.5, 0.0)
    assert s.mode == mode


@both_ways
def test_a_rigid_contact_rests(direction: float) -> None:
    s = slip(parameters(), DECELERATING, 0.125, direction=direction, acceleration=3.0, rest=5.0)
    rest(parameters(), s)
    assert (s.mode, s.velocity, s.acceleration, s.rest, s.direction, s.deflection) == (STICK, 0.0, 0.0, 0.0, 0.0, 0.0)


@both_ways
def test_a_compliant_contact_takes_the_friction_over(direction: float) -> None:
    """δ = sigma N mu_k(0)/c_c, so m ẍ = F_d + F_e − sigma N mu_k(0); or undeflected, and m ẍ = F_d + F_e."""
    p = parameters(contact=COMPLIANT, friction=SIDED)
    friction = 64.0 * (0.25 if direction > 0.0 else 0.125)
    s = slip(p, DECELERATING, 0.0, direction=direction, push=2.0)
    rest(p, s)
    assert (s.mode, s.deflection, s.direction) == (STICK, direction * friction / 4096.0, 0.0)
    assert s.acceleration == direction * (2.0 - friction) / 2.0
    p.arrest_share = 0.0                 # contact.arrest: undeflected
    s = slip(p, DECELERATING, 0.0, direction=direction, push=2.0)
    rest(p, s)
    assert (s.deflection, s.acceleration) == (0.0, direction * 2.0 / 2.0)


def test_a_start_at_rest_has_no_direction_and_no_deflection() -> None:
    p = parameters(contact=COMPLIANT)
    s = state(f=3.0)
    rest(p, s)
    assert (s.mode, s.deflection, s.acceleration) == (STICK, 0.0, 1.5)
    assert state().segment == 0.0


# What happens within a slip: its acceleration vanishes, coasting ends, the speed crosses a breakpoint.

@both_ways
@pytest.mark.parametrize(('mode', 'friction', 'residual'), [(ACCELERATING, 12.0 + 12.0, 12.0),
                                                            (DECELERATING, 12.0, 0.0)])
def test_a_slip_coasts_where_its_acceleration_vanishes(mode: float, friction: float, residual: float, direction: float
                                                       ) -> None:
    """On the upper edge of the band, R = B = N E psi, or on the lower one, R = 0; friction goes on."""
    p = parameters()
    s = slip(p, mode, 0.125, direction=direction, push=friction, excess=0.25, v=direction * 0.0625,
             acceleration=1e-9, second=4.0, fraction=0.5)
    row = ended(turn, p, s)
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
    row = ended(turn, p, s)
    assert (row.kind, row.mode, row.friction) == (kind, follows, direction * 8.0)
    assert (s.mode, s.acceleration, breakpoint_speed(p, int(s.segment))) == (follows, 0.0, begin)


@pytest.mark.parametrize('mode', [ACCELERATING, DECELERATING])
def test_steady_sliding_takes_the_drives_velocity(mode: float) -> None:
    """Sliding at ẋ = v but for rounding is an equilibrium and stays one."""
    p = parameters(friction=CONVENTIONAL)
    s = slip(p, mode, 0.125 * (1.0 - 2.0 ** -52), push=12.0, v=0.125)
    assert (ended(turn, p, s).kind, s.mode, s.velocity, s.acceleration) == (COAST, COASTING, 0.125, 0.0)


def test_a_force_that_rises_is_no_steady_sliding() -> None:
    """At ẋ = v, too."""
    p = parameters(friction=CONVENTIONAL)
    for inputs in ({'f_rate': 1.0}, {'v_rate': 1.0}, {'v_rate': 0.03125, 'f_rate': -1.0}):
        s = slip(p, DECELERATING, 0.125, push=12.0, v=0.125, **inputs)
        ended(turn, p, s)
        assert s.mode == ACCELERATING


@both_ways
@pytest.mark.parametrize(('kind', 'mode', 'begin'), [(ACCELERATE, ACCELERATING, 0.25), (DECELERATE, DECELERATING, 0.0)])
def test_coasting_ends_upwards_or_downwards(kind: float, mode: float, begin: float, direction: float) -> None:
    """Friction is F_d + F_e up to there, and the acceleration begins with 0."""
    p = parameters()
    s = slip(p, COASTING, 0.25, direction=direction, push=8.0 if mode == DECELERATING else 16.0, excess=0.25)
    row = ended(leave_coast, p, s, kind)
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
    return ended(cross_breakpoint, p, s, before), s.velocity, breakpoint_speed(p, int(s.segment)), s.acceleration


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
    row = ended(cross_breakpoint, p, s, -6.0)
    assert (row.velocity, row.friction, row.static) == (-0.125, -2.0, 0.375)
