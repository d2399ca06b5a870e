# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Properties of the exact engine that hold for every axis; the suite of extremes measures the harder ones."""

import math
import random
from dataclasses import replace
from itertools import pairwise

import pytest

from stickslip_sim.axis import InitialState
from stickslip_sim.core.errors import SolverError
from stickslip_sim.core.input_profile import InputProfile, ramp, steps
from stickslip_sim.core.types import Event, EventKind, Instant, Mode
from tests.support.axes import COMPLIANT, RIGID, instant, make, of_kind, paper_axis, run_events


def test_smooth_sliding_ends_in_steady_coasting() -> None:
    """A decaying oscillation ends where it drowns in rounding: at the speed of the drive, without more events."""
    for contact in (RIGID, COMPLIANT):
        simulator = make(paper_axis(contact), 0.08)
        simulator.advance(instant(20.0))
        assert (simulator.sample().mode, simulator.sample().velocity) == (Mode.COASTING, 0.08)
        assert simulator.advance(instant(1e6)) == []


def test_a_command_that_repeats_the_present_value_changes_no_bit() -> None:
    axis = paper_axis(COMPLIANT)
    quiet, busy = make(axis, 0.002), make(axis, 0.002)
    a: list[Event] = []
    b: list[Event] = []
    for k in range(1, 3001):
        to = Instant(k // 1000, (k % 1000) / 1000)
        a += quiet.advance(to)
        busy.command_drive(0.002)
        b += busy.advance(to)
        assert quiet.sample() == busy.sample()
    assert a == b


def test_an_event_has_happened_at_its_very_time() -> None:
    (event,) = run_events(paper_axis(RIGID), 0.002, 0.69)
    simulator = make(paper_axis(RIGID), 0.002)
    assert simulator.advance(Instant(event.second, math.nextafter(event.fraction, 0.0))) == []
    assert simulator.advance(event.instant) == [event]


def test_reverses_at_once_where_a_rigid_contact_cannot_hold() -> None:
    """A frictionless slider swings for ever; a lightly braked one reverses until it stays."""
    free = replace(paper_axis(RIGID), normal_force=0.0, drive_damping=0.0)
    events = run_events(free, 0.0, 2.0, initial=InitialState(velocity=0.1))
    turns = of_kind(events, EventKind.REVERSE)
    half_period = math.pi / math.sqrt(6e5 / 350.0)
    assert len(turns) == 26
    assert turns[-1].time == pytest.approx((len(turns) - 0.5) * half_period, rel=1e-13)
    light = replace(paper_axis(RIGID), normal_force=300.0, drive_damping=0.0)
    events = run_events(light, 0.0, 5.0, initial=InitialState(velocity=0.05))
    assert len(of_kind(events, EventKind.REVERSE)) > 2
    assert events[-1].kind == EventKind.STICK
    amplitudes = [abs(e.position) for e in of_kind(events, EventKind.REVERSE)]
    assert all(b < a for a, b in pairwise(amplitudes))


def test_grazing_the_limit_is_neither_missed_nor_invented() -> None:
    """A drive that slows down and turns back: the force peaks at the limit but for a relative 1e-4 to 1e-12."""
    rng = random.Random(11)
    axis = paper_axis(RIGID)
    c, h = axis.drive_stiffness, axis.drive_damping
    for margin in (1e-4, 1e-6, 1e-9, 1e-12, -1e-12, -1e-9, -1e-4):
        for _ in range(100):
            v, rate = rng.uniform(0.5e-3, 5e-3), -(10 ** rng.uniform(-4, -2))
            delay = rng.uniform(0.0, 1.0)
            t = -(v + h * rate / c) / rate
            peak = c * (v + 0.5 * rate * t) * t + h * (v + rate * t)
            held = replace(axis, normal_force=peak / 0.24 / (1.0 + margin))
            drive = InputProfile((0.0, delay), (0.0, v), (0.0, rate))
            events = run_events(held, drive, delay + 1.9 * t)
            broke = bool(events) and events[0].time < delay + 1.1 * t
            assert broke == (margin > 0.0), (margin, v, rate)


def test_parameters_may_change_on_the_way() -> None:
    """Position, velocity and spring stay; a load that goes lets the slider go; back and forth changes nothing."""
    for contact in (RIGID, COMPLIANT):
        axis = paper_axis(contact)
        simulator, twin = make(axis, 0.002), make(axis, 0.002)
        to = Instant(0.0, 0.6)
        assert simulator.advance(to) == twin.advance(to) == []
        before = simulator.sample()
        simulator.change_axis(replace(axis, normal_force=0.5 * axis.normal_force))
        after = simulator.sample()
        assert (after.position, after.drive_force) == (before.position, before.drive_force)
        events = simulator.advance(to)
        assert [(e.kind, e.time) for e in events] == [(EventKind.BREAKAWAY, 0.6)]
        for events, sim in ((simulator.advance(instant(3.0)), simulator), (twin.advance(instant(3.0)), twin)):
            assert events
            assert sim.sample().time == 3.0
    simulator = make(paper_axis(RIGID), 0.002)
    simulator.advance(Instant(0.0, 0.5))
    simulator.change_axis(paper_axis(COMPLIANT))
    deflection = simulator.sample().contact_deflection
    assert deflection == pytest.approx(simulator.sample().drive_force / 5e6, rel=1e-14)
    simulator.change_axis(paper_axis(RIGID))
    assert run_events(paper_axis(RIGID), 0.002, 2.0)[1:] != []
    for event, other in zip(simulator.advance(instant(2.0)), run_events(paper_axis(RIGID), 0.002, 2.0), strict=True):
        assert (event.kind, event.direction) == (other.kind, other.direction)
        assert event.time == pytest.approx(other.time, abs=1e-14)


def test_a_state_that_is_not_finite_is_an_error() -> None:
    simulator = make(replace(paper_axis(RIGID), mass=1e-300), 0.002)
    simulator.advance(instant(0.7))
    with pytest.raises(SolverError, match='the state overflows'):
        simulator.sample()


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_without_friction_the_drive_takes_the_slider_along_either_way(sign: float) -> None:
    for contact in (RIGID, COMPLIANT):
        free = replace(paper_axis(contact), normal_force=0.0)
        events = run_events(free, ramp(0.0, sign * 0.01, 1.0), 1.0)
        assert (events[0].kind, events[0].direction) == (EventKind.BREAKAWAY, sign)


def test_changing_to_the_same_axis_changes_no_force() -> None:
    axis = paper_axis(COMPLIANT)
    simulator = make(axis, 0.0, steps('force', [0.0, 0.1], [0.0, 400.0]))
    simulator.advance(instant(0.105))
    before = simulator.sample().friction_force
    simulator.change_axis(axis)
    assert simulator.sample().friction_force == pytest.approx(before, rel=1e-14)
