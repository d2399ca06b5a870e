# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Which mode begins: the table of sub-modes of docs/model.md, its ties, the excess of a break-away, and stick.

With sigma the direction, R = sigma (F_d + F_e) − N mu_k and B = N e: accelerating for R > B with m ẍ = R − B, coasting
for 0 <= R <= B, decelerating for R < 0 with m ẍ = R.  A tie is decided by where the force moves next.
"""

import pytest

from stickslip_sim.axis.codes import ACCELERATING, COASTING, DECELERATING, STICK
from stickslip_sim.axis.friction_segments import breakpoint_speed
from stickslip_sim.axis.mode_entry import break_away, choose_slip, enter_branch, rest
from tests.support.plain_axes import COMPLIANT, CONVENTIONAL, SIDED, parameters, slip, state

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
