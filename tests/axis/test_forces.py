# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The forces of docs/model.md, by hand: F_d = c (s − x) + h (v − ẋ), F_c = c_c δ + h_c ẋ, and N (mu_k + e)."""

import sys
from dataclasses import replace

import pytest

from stickslip_sim.axis import forces
from stickslip_sim.axis.codes import ACCELERATING, COASTING, DECELERATING, STICK
from tests.support.plain_axes import AXIS, COMPLIANT, SIDED, parameters, slip, state


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
