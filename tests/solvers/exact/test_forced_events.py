# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""No event under sines is missed, none is invented, and none depends on how a run is split."""

import math
import random
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stickslip_sim.axis import Axis, CompliantContact, InitialState
from stickslip_sim.core.input_profile import InputProfile, constant, steps
from stickslip_sim.core.types import Event, EventKind, Instant, Mode
from stickslip_sim.friction import StaticLaw, StaticLawKind
from stickslip_sim.proof.axes import GRAZING_FREQUENCIES, PHASES, grazing_drive
from stickslip_sim.reference import simulate
from tests.conftest import Program
from tests.support.axes import COMPLIANT, RIGID, instant, make, paper_axis, random_axis, run_events
from tests.support.forced_profiles import random_profiles, with_sinusoids

LIMIT = 0.24 * 350 * 9.80665


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
@pytest.mark.parametrize('overshoot', [1e-4, 1e-6, 1e-12, -1e-12])
def test_a_grazing_peak_is_found_and_a_peak_below_the_limit_holds(contact: Any, overshoot: float) -> None:
    rng = random.Random(f'{overshoot}')
    axis = paper_axis(contact)
    for _ in range(500):
        frequency, phase = rng.uniform(*GRAZING_FREQUENCIES), rng.uniform(*PHASES)
        drive = grazing_drive(axis, overshoot, frequency, phase)
        events = run_events(axis, drive, 0.95 / frequency)
        assert bool(events) == (overshoot > 0.0)
        if events:
            assert events[0].kind is EventKind.BREAKAWAY
            peak = (math.pi - phase) / (2.0 * math.pi * frequency)
            assert events[0].time == pytest.approx(peak, abs=math.sqrt(8.0 * overshoot) / frequency + 0.02)


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


@pytest.mark.parametrize('seed', range(6))
def test_one_call_or_many_give_the_same_bits(seed: int) -> None:
    rng = random.Random(seed)
    axis = random_axis(rng)
    drive, force = random_profiles(rng, axis)
    whole = make(axis, drive, force)
    expected = whole.advance(instant(2.0))
    for ticks in (True, False):
        parts, events, t, k = make(axis, drive, force), [], 0.0, 0
        while t < 2.0:
            k += 1
            t = k / 1000 if ticks else min(t + rng.choice((1e-9, 1e-6, 1e-3, 0.3)) * rng.random(), 2.0)
            events += parts.advance(instant(t))
        assert events == expected
        assert parts.sample() == whole.sample()


@pytest.mark.parametrize('seed', range(10))
def test_mirror_and_units_of_a_power_of_two_are_bit_identical(seed: int) -> None:
    rng = random.Random(seed)
    axis = random_axis(rng)
    drive, force = random_profiles(rng, axis)
    events = run_events(axis, drive, 2.0, force)
    mirrored = run_events(axis, _scaled(drive, -1.0), 2.0, _scaled(force, -1.0))
    for e, image in zip(events, mirrored, strict=True):
        assert image == _mirrored(e)
    contact = axis.contact
    if isinstance(contact, CompliantContact):
        contact = CompliantContact(contact.stiffness * 0.5, contact.damping * 0.5)
    half = replace(axis, mass=axis.mass * 0.5, drive_stiffness=axis.drive_stiffness * 0.5, contact=contact,
                   drive_damping=axis.drive_damping * 0.5, normal_force=axis.normal_force * 0.5)
    for e, other in zip(events, run_events(half, drive, 2.0, _scaled(force, 0.5)), strict=True):
        assert other == e._replace(drive_force=0.5 * e.drive_force, friction_force=0.5 * e.friction_force)


@pytest.mark.parametrize('speed', [0.0046, 0.00464, 0.00476, 0.00494, 0.0076])
def test_a_leap_to_either_limit_is_as_long(speed: float) -> None:
    """The room between envelope and limit, rounded alike on both sides, or the first root differs by an ULP."""
    axis = paper_axis(RIGID)
    axis = replace(axis, friction=replace(axis.friction, static=StaticLaw(StaticLawKind.CONSTANT, 0.24, 0.24)))
    up, down = (run_events(axis, way * speed, 2.0, with_sinusoids(constant(0.0), (-way * 100.0, 5.0, 1.0)))
                for way in (1.0, -1.0))
    assert [_mirrored(event) for event in up] == down
    assert len(up) > 10


def _mirrored(event: Event) -> Event:
    return event._replace(direction=-event.direction, position=-event.position, velocity=-event.velocity,
                          drive_position=-event.drive_position, drive_force=-event.drive_force,
                          friction_force=-event.friction_force)


def _scaled(profile: InputProfile, factor: float) -> InputProfile:
    return InputProfile(profile.starts, tuple(factor * x for x in profile.values),
                        tuple(factor * x for x in profile.rates),
                  profile.period, tuple(one._replace(amplitude=factor * one.amplitude) for one in profile.sinusoids))


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


PROGRAM = '''
import random
from tests.support.axes import make, instant, random_axis
from tests.support.forced_profiles import random_profiles
for seed in range(6):
    rng = random.Random(seed)
    axis = random_axis(rng)
    simulator = make(axis, *random_profiles(rng, axis))
    for event in simulator.advance(instant(1.0)):
        print(event.kind.name, [float(x).hex() for x in event[:2] + event[5:]])
    print([float(x).hex() for x in simulator.sample()[4:]])
'''


def test_plain_python_gives_the_same_bits(in_a_process: Program) -> None:
    assert in_a_process(PROGRAM, compiled=True) == in_a_process(PROGRAM, compiled=False)


# Runs under sines, piece by piece against an integrator: the motion, every guard on the way, the event at its end.

pytestmark = pytest.mark.slow


class Piece:
    """The motion from one event to the next as the model states it."""

    def __init__(self, axis: Axis, drive: InputProfile, force: InputProfile, event: Event, excess: float,
                 deflection: float) -> None:
        self.axis, self.drive, self.force, self.event, self.excess = axis, drive, force, event, excess
        self.deflection = deflection
        self.compliant = axis.contact if isinstance(axis.contact, CompliantContact) else None
        self.rest0 = event.rest_time if event.kind is EventKind.BREAKAWAY else 0.0

    def residual(self, t: float, x: float, u: float, s: float) -> float:
        """Return F_d + F_e."""
        a = self.axis
        return (a.drive_stiffness * (s - x) + a.drive_damping * (self.drive.value_at(t) - u) + self.force.value_at(t))

    def friction(self, u: float, *, upper: bool) -> float:
        kinetic, excess = self.axis.friction.kinetic, self.axis.friction.excess
        w = abs(u)
        mu = float(np.interp(w, kinetic.velocities, kinetic.coefficients))
        mu += kinetic.end_slope * max(w - kinetic.velocities[-1], 0.0)
        if upper and excess is not None:
            mu += self.excess * float(np.interp(w, excess.velocities, excess.fractions))
        return self.axis.normal_force * mu

    def contact(self, x: float, u: float) -> float:
        assert self.compliant is not None
        return self.compliant.stiffness * (self.deflection + x) + self.compliant.damping * u

    def acceleration(self, t: float, x: float, u: float, s: float) -> float:
        mode, direction = self.event.mode, self.event.direction
        if mode is Mode.COASTING or (mode is Mode.STICK and self.compliant is None):
            return 0.0
        if mode is Mode.STICK:
            return (self.residual(t, x, u, s) - self.contact(x, u)) / self.axis.mass
        friction = self.friction(u, upper=mode is Mode.ACCELERATING)
        return (self.residual(t, x, u, s) - direction * friction) / self.axis.mass

    def motion(self, end: float, s0: float, u0: float) -> Any:
        def rates(t: float, y: Any) -> list[float]:
            t = float(t)   # scipy hands over its own numbers
            return [y[1], self.acceleration(t, *map(float, y)), self.drive.value_at(t)]
        start = self.event.time
        breaks = [c + k * (profile.period if profile.period < math.inf else 0.0)
                  for profile in (self.drive, self.force) for c in profile.starts for k in range(4)]
        y, parts = [0.0, u0, s0], []
        for a, b in pairwise(sorted({start, end, *(t for t in breaks if start < t < end)})):
            part = solve_ivp(rates, (a, np.nextafter(b, 0.0)), y, method='DOP853', rtol=1e-12, atol=1e-15,
                             max_step=0.01, dense_output=True)
            y = part.y[:, -1]
            parts.append(part)
        return parts

    def check_guards(self, t: float, y: Any, slack: float) -> None:
        """Assert that no guard was passed; `slack` N."""
        mode, direction = self.event.mode, self.event.direction
        x, u, s = y
        force = self.residual(t, x, u, s)
        if mode is Mode.STICK:
            held = self.contact(x, u) if self.compliant else force
            limit = self.axis.normal_force * self.axis.friction.static.coefficient(self.rest0 + t - self.event.time)
            assert abs(held) <= limit + slack
            return
        assert direction * u >= -1e-9
        if mode is Mode.COASTING:
            assert direction * force >= self.friction(u, upper=False) - slack
            assert direction * force <= self.friction(u, upper=True) + slack
        else:
            sense = 1.0 if mode is Mode.ACCELERATING else -1.0
            assert sense * direction * self.axis.mass * self.acceleration(t, x, u, s) >= -slack


def follow(axis: Axis, drive: InputProfile, force: InputProfile, duration: float) -> int:
    """Check every piece of a run; return how many there were."""
    simulator = make(axis, drive, force)
    events = simulator.advance(simulator.time._replace(second=math.floor(duration), fraction=duration % 1.0))
    start = Event(0.0, 0.0, EventKind.STICK, Mode.STICK, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    excess, deflection, pieces = 0.0, 0.0, 0
    scale = axis.normal_force * 0.3
    for event, after in pairwise([start, *events]):
        if event.kind in (EventKind.BREAKAWAY, EventKind.REVERSE):
            table_ = axis.friction.excess
            psi = float(np.interp(abs(event.velocity), table_.velocities, table_.fractions)) if table_ else 0.0
            kinetic = axis.friction.kinetic
            mu = float(np.interp(abs(event.velocity), kinetic.velocities, kinetic.coefficients))
            excess = max(event.static_coefficient - mu, 0.0) / psi if psi > 0.0 else 0.0
        if event.mode is Mode.STICK:
            at_rest = axis.friction.kinetic.coefficients[0] * axis.normal_force * event.direction
            deflection = at_rest / axis.contact.stiffness if isinstance(axis.contact, CompliantContact) else 0.0
        piece = Piece(axis, drive, force, event, excess, deflection)
        if event is start:
            piece.rest0 = math.inf
        if after.time <= event.time:
            continue
        u0 = 0.0 if event.mode is Mode.STICK else event.velocity
        x0 = event.position
        parts = piece.motion(after.time, event.drive_position - x0, u0)
        for part in parts:
            times = np.linspace(part.t[0], part.t[-1], 60)
            for t, y in zip(times.tolist(), part.sol(times).T.tolist()):
                piece.check_guards(t, y, 1e-7 * scale)
        x, u, s = parts[-1].y[:, -1]
        assert x + x0 == pytest.approx(after.position, abs=1e-10)
        assert u == pytest.approx(after.velocity, abs=1e-9)
        assert s + x0 == pytest.approx(after.drive_position, abs=1e-10)
        pieces += 1
    return pieces


@pytest.mark.parametrize('seed', range(1, 6))
def test_random_axes_under_random_sinusoids_follow_the_model(seed: int) -> None:
    rng = random.Random(seed)
    axis = random_axis(rng)
    drive, force = random_profiles(rng, axis)
    follow(axis, drive, force, 1.0)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_paper_axis_under_sinusoids_follows_the_model(contact: Any) -> None:
    drive = with_sinusoids(constant(0.002), (0.001, 3.0, 0.3))
    force = with_sinusoids(constant(0.0), (100.0, 20.0, 0.0), (50.0, 6.5896, 1.0))
    assert follow(paper_axis(contact), drive, force, 2.0) > 25
