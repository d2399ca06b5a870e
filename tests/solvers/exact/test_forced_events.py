# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""No event under sines is missed, none is invented, and none depends on how a run is split."""

import math
import random
from dataclasses import replace
from typing import Any

import pytest

from stickslip_sim.axis import InitialState
from stickslip_sim.core.input_profile import constant, steps
from stickslip_sim.core.types import EventKind, Instant, Mode
from stickslip_sim.friction import StaticLaw, StaticLawKind
from stickslip_sim.proof.axes import Parts, with_static
from stickslip_sim.reference import simulate
from tests.hostile.case import run
from tests.hostile.judges import JUDGES
from tests.support.axes import COMPLIANT, RIGID, instant, make, paper_axis, run_events
from tests.support.forced_profiles import with_sinusoids

LIMIT = 0.24 * 350 * 9.80665


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_a_blow_on_top_of_a_sine_is_not_missed(contact: Any) -> None:
    rng = random.Random(3)
    for _ in range(100):
        t = rng.uniform(0.0, 5.0)
        blow = with_sinusoids(steps('force', [0.0, t, t + 0.002], [0.0, 33e3, 0.0]),
                              (100.0, 10 ** rng.uniform(-1, 2), t))
        events = run_events(paper_axis(contact), 0.0, 6.0, blow)
        assert events[0].kind is EventKind.BREAKAWAY
        assert t <= events[0].time <= t + 0.002


@pytest.mark.parametrize(('amplitude', 'frequency', 'phase'), [(900.0, 0.7, 0.3), (850.0, 1.1, 2.0)])
def test_a_slip_that_begins_where_friction_is_continuous_goes_the_way_the_force_moves_then(
        amplitude: float, frequency: float, phase: float) -> None:
    """At such a break-away nothing but the force's rate at that very instant says that the slider slips."""
    pytest.importorskip('mpmath')
    axis, push = paper_axis(RIGID), with_sinusoids(constant(0.0), (amplitude, frequency, phase))
    events, expected = run_events(axis, 0.0, 4.0, push), simulate(axis, InitialState(), constant(0.0), push, 4.0).events
    assert [(e.kind, e.mode, e.direction) for e in events] == [(e.kind, e.mode, e.direction) for e in expected]
    assert all(abs(a.time - b.time) <= 1e-12 for a, b in zip(events, expected))
    assert len(events) > 15


def test_a_short_sinusoid_on_a_slow_one_is_found_where_their_peaks_meet() -> None:
    """Incommensurate sinusoids that pass the limit together only: the first time is that of a fine scan."""
    rng = random.Random(8)
    for _ in range(20):
        profile = with_sinusoids(constant(0.0), (LIMIT * 0.49, rng.uniform(0.2, 1.0), rng.uniform(-1, 1)),
                            (LIMIT * 0.525, rng.uniform(5, 9), rng.uniform(-0.2, 0.2)))
        scan = next((k / 2000 for k in range(40000) if abs(profile.value_at(k / 2000)) > LIMIT), math.inf)
        events = run_events(paper_axis(RIGID), 0.0, 20.0, profile)
        first = events[0].time if events else math.inf
        assert scan - 1.0 / 2000 <= first <= scan or (scan == math.inf and first > 0.0)
        if events:
            assert abs(profile.value_at(first)) == pytest.approx(LIMIT, rel=1e-12)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_a_year_under_a_sine_below_the_limit(contact: Any) -> None:
    """Nothing happens for a year; then the sine still has its phase, and a ramp breaks away where it must."""
    simulator = make(paper_axis(contact), 0.0, with_sinusoids(constant(100.0), (500.0, 50.0, 0.5), (100.0, 7.0, 0.0)))
    year = Instant(365.0 * 86400.0, 0.0)
    assert simulator.advance(year) == []
    assert simulator.root_iterations < 50
    sample = simulator.sample()
    assert sample.external_force == pytest.approx(100.0 + 500.0 * math.sin(0.5), rel=1e-13)
    simulator.command_drive(0.001)
    broken = simulator.advance(Instant(year.second + 2.0, 0.0))
    assert broken[0].kind is EventKind.BREAKAWAY
    if contact is RIGID:
        t = (broken[0].second - year.second) + broken[0].fraction
        force = 6e5 * 0.001 * t + 4000 * 0.001 + 100.0 + 500.0 * math.sin(100 * math.pi * t + 0.5) + 100.0 * math.sin(
            14 * math.pi * t)
        assert force == pytest.approx(LIMIT, rel=1e-11)


def test_a_force_whose_peak_is_the_limit_holds() -> None:
    for amplitude in (0.25 * LIMIT, 0.5 * LIMIT):
        force = with_sinusoids(constant(LIMIT - amplitude), (amplitude, 3.0, 0.1))
        assert run_events(paper_axis(RIGID), 0.0, 100.0, force) == []


@pytest.mark.parametrize('speed', [0.0046, 0.00464, 0.00476, 0.00494, 0.0076])
def test_a_leap_to_either_limit_is_as_long(speed: float) -> None:
    """The room between envelope and limit, rounded alike on both sides, or the first root differs by an ULP."""
    axis = with_static(paper_axis(RIGID), StaticLaw(StaticLawKind.CONSTANT, 0.24, 0.24))
    force = with_sinusoids(constant(0.0), (-100.0, 5.0, 1.0))
    found = run(Parts(axis, InitialState(), constant(speed), force, 2.0))
    JUDGES['images'](found, random.Random(0))
    assert len(found.events) > 10


def test_sinusoids_without_amplitude_change_no_bit() -> None:
    axis = paper_axis(COMPLIANT)
    plain, idle = make(axis, 0.002), make(axis, with_sinusoids(constant(0.002), (0.0, 5.0, 1.0)))
    assert plain.advance(instant(3.0)) == idle.advance(instant(3.0))
    assert plain.sample() == idle.sample()


def test_a_command_ends_the_sinusoids_of_its_profile_only() -> None:
    simulator = make(paper_axis(RIGID), with_sinusoids(constant(0.002), (0.001, 3.0, 0.0)),
                     with_sinusoids(constant(0.0), (50.0, 2.0, 0.3)))
    simulator.advance(instant(0.4))
    before = simulator.sample()
    simulator.command_drive(0.001)
    after = simulator.sample()
    assert (after.drive_velocity, after.external_force) == (0.001, before.external_force)
    assert after.drive_position == before.drive_position
    for _ in range(3):
        simulator.command_drive(0.001)   # the same again: no bit changes
        assert simulator.sample() == after


def test_sinusoids_without_friction_follow_the_linear_axis() -> None:
    """N = 0, no damper: resonance from rest, x = A/(2 ω²m) (sin ωt − ωt cos ωt)."""
    axis = replace(paper_axis(RIGID), normal_force=0.0, drive_damping=0.0)
    omega = math.sqrt(6e5 / 350.0)
    simulator = make(axis, 0.0, with_sinusoids(constant(0.0), (10.0, omega / (2.0 * math.pi), 0.0)))
    for t in (0.01, 0.1, 1.0, 5.0):
        simulator.advance(instant(t))
        expected = 10.0 / (2.0 * omega * omega * 350.0) * (math.sin(omega * t) - omega * t * math.cos(omega * t))
        assert simulator.sample().position == pytest.approx(expected, rel=1e-9, abs=1e-12)
    assert simulator.sample().mode in (Mode.ACCELERATING, Mode.DECELERATING)
