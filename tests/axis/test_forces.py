# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The forces of docs/model.md, by hand: F_d = c (s − x) + h (v − ẋ), F_c = c_c δ + h_c ẋ, and N (mu_k + e)."""

import math
import sys
from dataclasses import replace

import pytest

from stickslip_sim.axis import forces
from stickslip_sim.axis.codes import ACCELERATING, COASTING, DECELERATING, STICK
from stickslip_sim.axis.forces import (
    breakpoint_speed,
    friction_line,
    has_branches,
    kinetic_at_rest,
    limit_backwards,
    lower_limit,
    segment_above,
    segment_below,
    segment_end,
    slip_friction,
    static_at_once,
    static_limit,
)
from stickslip_sim.friction import ExcessTable
from tests.support.plain_axes import AXIS, COMPLIANT, CONVENTIONAL, FRICTION, SIDED, STATIC, parameters, slip, state


def test_the_drive_pushes_by_its_spring_and_its_damper() -> None:
    assert forces.drive_force(parameters(), 0.03125, 0.5, 0.25) == 1024.0 * 0.03125 + 32.0 * (0.5 - 0.25)
    assert forces.applied_force(parameters(), state(spring=0.03125, v=0.5, velocity=0.25, f=-3.0)) == 40.0 - 3.0


def test_a_damper_on_the_slideway_is_no_part_of_the_drives_force() -> None:
    """−h ẋ stands beside F_d = c (s − x) in the balance."""
    p = parameters(damper_on_slideway=True)
    balance = forces.drive_force(p, 0.03125, 0.5, 0.25)
    assert balance == 32.0 - 32.0 * 0.25
    assert forces.stated_drive_force(p, balance, 0.25) == 32.0
    assert forces.stated_drive_force(parameters(), 40.0, 0.25) == 40.0


@pytest.mark.parametrize(('on_slideway', 'feed', 'ground'), [(False, 32.0, 0.0), (True, 0.0, 32.0)])
def test_the_damper_acts_on_the_drive_or_on_the_slideway(on_slideway: bool, feed: float, ground: float) -> None:
    p = parameters(damper_on_slideway=on_slideway)
    assert (forces.feed_damping(p), forces.ground_damping(p)) == (feed, ground)


def test_the_contact_pushes_by_its_spring_and_its_damper() -> None:
    assert forces.contact_force(parameters(contact=COMPLIANT), 0.0078125, -0.25) == 4096.0 * 0.0078125 - 64.0 * 0.25


@pytest.mark.parametrize(('contact', 'mode', 'expected'), [
    (AXIS.contact, STICK, True), (COMPLIANT, STICK, False), (AXIS.contact, COASTING, False),
    (AXIS.contact, ACCELERATING, False)])
def test_only_a_rigid_contact_stands_still(contact: object, mode: float, expected: bool) -> None:
    assert forces.is_rigid_stick(parameters(contact=contact), state(mode=mode)) is expected


@pytest.mark.parametrize('direction', [1.0, -1.0])
@pytest.mark.parametrize(('mode', 'expected'), [
    (DECELERATING, 64.0 * 0.1875),                # N mu_k, half-way between 0.25 and 0.125
    (ACCELERATING, 64.0 * (0.1875 + 0.5 * 0.75)),  # N (mu_k + E psi), psi = 1 − 0.125 / 0.5
    (COASTING, 21.0)])                            # as much as is applied
def test_friction_opposes_a_slip(mode: float, expected: float, direction: float) -> None:
    p = parameters()
    s = slip(p, mode, 0.125, direction=direction, excess=0.5)
    assert forces.friction_force(p, s, 0.0, direction * 0.125, direction * 21.0) == direction * expected


def test_each_direction_has_its_own_friction() -> None:
    p = parameters(friction=SIDED)
    s = slip(p, ACCELERATING, 0.0625, direction=-1.0, excess=0.5)
    assert forces.friction_force(p, s, 0.0, -0.0625, 0.0) == -64.0 * (0.078125 + 0.5 * 0.5)


def test_in_stick_friction_is_what_is_applied_or_what_the_contact_gives() -> None:
    stick = state(mode=STICK)
    assert forces.friction_force(parameters(), stick, 0.0, 0.0, -7.0) == -7.0
    assert forces.friction_force(parameters(contact=COMPLIANT), stick, 0.0078125, -0.25, -7.0) == 16.0


@pytest.mark.parametrize(('contact', 'expected'), [
    (AXIS.contact, 1024.0 * 0.015625 + 32.0 * 0.25 + 5.0),
    (COMPLIANT, 4096.0 * 0.0078125),
    (replace(COMPLIANT, ends_by_drive=True), 1024.0 * 0.015625 + 32.0 * 0.25 + 5.0)])
def test_what_ends_a_stick_is_the_force_of_the_contact_or_of_the_drive(contact: object, expected: float) -> None:
    p = parameters(contact=contact)
    s = state(mode=STICK, spring=0.015625, v=0.25, f=5.0, deflection=0.0078125)
    assert forces.stick_force(p, s) == expected


def test_the_band_of_coasting_is_the_excess() -> None:
    """B = N E psi: psi falls from 1 to 0 at 0.5 m/s, and stays there."""
    p = parameters()
    assert [forces.band_of(p, slip(p, ACCELERATING, speed, direction=-1.0, excess=0.25))
            for speed in (0.0, 0.125, 0.25, 0.5, 0.75)] == [16.0, 12.0, 8.0, 0.0, 0.0]


@pytest.mark.parametrize(('on_slideway', 'rate'), [(False, 1024.0 * (0.5 - 0.25) + 32.0 * 2.0 - 3.0),
                                                   (True, 1024.0 * (0.5 - 0.25) - 3.0)])
def test_the_force_rises_with_the_stretch_and_with_the_inputs(on_slideway: bool, rate: float) -> None:
    """At constant velocity (F_d + F_e)′ = c (v − ẋ) + h v′ + F_e′, and its rate is c v′."""
    s = state(mode=COASTING, v=0.5, v_rate=2.0, velocity=0.25, f_rate=-3.0)
    assert forces.force_rate(parameters(damper_on_slideway=on_slideway), s) == (rate, 1024.0 * 2.0)


def test_a_rate_within_rounding_is_none() -> None:
    """Steady sliding at the drive's velocity, but for a rounding; not where a millionth part is left."""
    v = 0.1
    assert forces.force_rate(parameters(), state(v=v, velocity=v * (1.0 + 2.0 ** -52))) == (0.0, 0.0)
    assert forces.force_rate(parameters(), state(v=0.25, f_rate=-256.0 * (1.0 + 2.0 ** -50))) == (0.0, 0.0)
    rate, _ = forces.force_rate(parameters(), state(v=v, velocity=v * (1.0 + 1e-12)))
    assert rate == pytest.approx(-1024.0 * v * 1e-12, rel=1e-3)


@pytest.mark.parametrize(('numbers', 'friction', 'terms'), [
    ({'spring': -0.5}, 0.0, 512.0), ({'v': -0.25}, 0.0, 8.0), ({'velocity': -0.125}, 0.0, 4.0), ({'f': -9.0}, 0.0, 9.0),
    ({}, 0.5, 32.0), ({'spring': 0.5, 'v': 0.25, 'velocity': 0.125, 'f': -9.0}, 0.5, 565.0)])
def test_rounding_is_of_the_terms_of_the_sum(numbers: dict[str, float], friction: float, terms: float) -> None:
    """Of each alike, of either sign: a few units in the last place of c w, h v, h ẋ, F_e and N mu."""
    units = forces.force_rounding(parameters(), state(**numbers), friction) / (terms * sys.float_info.epsilon)
    assert units == forces.force_rounding(parameters(), state(), 1.0) / (64.0 * sys.float_info.epsilon)
    assert 1.0 <= units <= 32.0


# mu_k and psi are linear between breakpoints, mu_k goes on with its last slope, and each direction has its tables.

# speed in m/s, mu_k, psi: by hand from the tables of `plain_axes`
FORWARDS = [(0.0, 0.25, 1.0), (0.125, 0.1875, 0.75), (0.25, 0.125, 0.5), (0.375, 0.09375, 0.25), (0.5, 0.0625, 0.0),
            (0.75, 0.0625 + 0.5 * 0.25, 0.0)]
BACKWARDS = [(0.0, 0.125, 1.0), (0.0625, 0.078125, 0.5), (0.125, 0.03125, 0.0), (1.0, 0.03125, 0.0)]


@pytest.mark.parametrize(('direction', 'speed', 'coefficient', 'psi'),
                         [*((1.0, *row) for row in FORWARDS), *((-1.0, *row) for row in BACKWARDS)])
def test_the_line_through_a_speed_is_that_of_the_tables(direction: float, speed: float, coefficient: float, psi: float
                                                        ) -> None:
    """Of the segment above and of the one below alike: both meet at a breakpoint."""
    p = parameters(friction=SIDED)
    for segment in (segment_above(p, direction, speed), segment_below(p, direction, speed)):
        found, _, share, _ = friction_line(p, segment, speed)
        assert (found, share) == (coefficient, psi)
        assert breakpoint_speed(p, segment) <= speed <= segment_end(p, segment)


def test_a_breakpoint_parts_the_segments() -> None:
    p = parameters()
    above, below = segment_above(p, 1.0, 0.25), segment_below(p, 1.0, 0.25)
    assert (breakpoint_speed(p, above), segment_end(p, below)) == (0.25, 0.25)
    assert [friction_line(p, segment, 0.25)[1::2] for segment in (below, above)] == [(-0.5, -2.0), (-0.25, -2.0)]
    assert segment_below(p, 1.0, 0.0) == segment_above(p, 1.0, 0.0)
    assert segment_below(p, 1.0, 0.3) == segment_above(p, 1.0, 0.3) == above


def test_both_directions_have_one_table_unless_they_differ() -> None:
    p = parameters()
    assert [segment_above(p, -1.0, speed) for speed, *_ in FORWARDS] == [segment_above(p, 1.0, speed)
                                                                         for speed, *_ in FORWARDS]
    assert (kinetic_at_rest(p, 1.0), kinetic_at_rest(p, -1.0)) == (0.25, 0.25)
    p = parameters(friction=SIDED)
    assert [kinetic_at_rest(p, direction) for direction in (1.0, 0.0, -1.0)] == [0.25, 0.25, 0.125]


@pytest.mark.parametrize(('mode', 'at_rest', 'slope'), [(DECELERATING, 0.25, -0.5),
                                                        (ACCELERATING, 0.25 + 0.125, -0.5 - 0.125 * 2.0)])
def test_the_branch_of_a_slip_is_a_line(mode: float, at_rest: float, slope: float) -> None:
    """mu_k on the lower branch, mu_k + E psi on the upper one."""
    p = parameters()
    assert slip_friction(p, slip(p, mode, 0.125, excess=0.125)) == (at_rest, slope)


def test_the_excess_has_breakpoints_of_its_own() -> None:
    """psi falls to a quarter at 0.25 m/s, so that its line from there begins at 0.5; mu_k + E psi, E = 0.5."""
    p = parameters(friction=replace(FRICTION, excess=ExcessTable((0.0, 0.25, 0.5), (1.0, 0.25, 0.0))))
    assert slip_friction(p, slip(p, ACCELERATING, 0.375, excess=0.5)) == (0.1875 + 0.5 * 0.5, -0.25 - 0.5 * 1.0)


def test_the_conventional_friction_has_one_branch() -> None:
    assert has_branches(parameters())
    assert not has_branches(parameters(friction=CONVENTIONAL))


# mu_s(t⁻) = mu_inf − (mu_inf − mu_0) exp(−t⁻/tau) of docs/model.md, from a delay on, in either direction.

FORWARD_LIMITS = [(0.0, 0.25), (2.0, 0.5 - 0.25 / math.e), (4.0, 0.5 - 0.25 / math.e ** 2), (math.inf, 0.5)]
BACKWARD_LIMITS = [(0.0, 0.375), (1.0, 0.75 - 0.375 / math.e), (4.0, 0.75 - 0.375 / math.e ** 4), (math.inf, 0.75)]


@pytest.mark.parametrize(('rest', 'expected'), FORWARD_LIMITS)
def test_the_limit_rises_with_the_rest_time(rest: float, expected: float) -> None:
    p = parameters()
    assert static_limit(p, rest, 1.0) == pytest.approx(expected, rel=1e-15)
    forwards = static_limit(p, rest, 1.0)
    assert static_limit(p, rest, -1.0) == limit_backwards(p, rest, forwards) == lower_limit(p, rest) == forwards


@pytest.mark.parametrize(('side', 'rest', 'expected'), [*((1.0, *row) for row in FORWARD_LIMITS),
                                                        *((-1.0, *row) for row in BACKWARD_LIMITS)])
def test_the_sign_of_the_force_chooses_the_law(side: float, rest: float, expected: float) -> None:
    assert static_limit(parameters(friction=SIDED), rest, side) == pytest.approx(expected, rel=1e-15)


def test_both_limits_and_the_lower_one() -> None:
    """Backwards it is the higher one here; turned round it is the lower one."""
    for friction in (SIDED, SIDED.mirrored):
        p = parameters(friction=friction)
        both = static_limit(p, 1.0, 1.0), static_limit(p, 1.0, -1.0)
        assert limit_backwards(p, 1.0, both[0]) == both[1] != both[0]
        assert lower_limit(p, 1.0) == min(both)


def test_the_limit_rises_from_the_delay_on() -> None:
    late = parameters(friction=replace(CONVENTIONAL, static=replace(STATIC, delay=3.0)))
    assert [static_limit(late, rest, 1.0) for rest in (0.0, 1.0, 3.0)] == [0.25] * 3
    assert static_limit(late, 5.0, -1.0) == static_limit(parameters(), 2.0, -1.0)
    assert static_limit(late, math.inf, 1.0) == 0.5


@pytest.mark.parametrize(('side', 'expected'), [(1.0, 0.25), (-1.0, 0.375), (0.0, 0.25)])
def test_at_once_it_is_that_of_no_rest(side: float, expected: float) -> None:
    """Without a force as forwards, with a rest time too."""
    assert static_limit(parameters(friction=SIDED), 0.0, side) == expected
    assert static_at_once(parameters(friction=SIDED), side) == expected
    assert static_at_once(parameters(), side) == 0.25
