# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every shipped scene shows what its first comment says."""

import itertools

import pytest

from stickslip_sim.core.types import Event, EventKind, Mode, Sample
from stickslip_sim.inputs import load_scene
from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import instant


def play(name: str, duration: float) -> tuple[list[Event], Sample]:
    """Return all events but those of kind knot, and the state at the end."""
    scene = load_scene(name)
    simulator = Simulator(scene.axis, scene.initial, scene.drive, scene.force)
    events = simulator.advance(instant(duration))
    return [event for event in events if event.kind != EventKind.KNOT], simulator.sample()


def of(events: list[Event], kind: EventKind) -> list[Event]:
    return [event for event in events if event.kind == kind]


def last_cycle(events: list[Event]) -> tuple[float, float]:
    """Return period (s) and jump (m) between the last two stops."""
    before, after = of(events, EventKind.STICK)[-2:]
    return after.time - before.time, after.position - before.position


@pytest.mark.parametrize(('name', 'period', 'coasts'), [
    ('paper_fig4_constant', 0.58993, False), ('paper_fig4_falling', 0.88826, False), ('paper_fig7', 0.619075168, True),
    ('paper_fig8', 0.659065697, True),
])
def test_scenes_of_the_paper_reach_their_limit_cycle(name: str, period: float, coasts: bool) -> None:
    events, _ = play(name, 20.0)
    assert last_cycle(events) == pytest.approx((period, 0.002 * period), rel=1e-4)
    assert bool(of(events, EventKind.COAST)) == coasts
    assert all(event.direction == 1 for event in events)


def test_paper_fig4_falling_passes_the_drive_and_v_gr() -> None:
    events, _ = play('paper_fig4_falling', 3.0)
    assert all(stop.drive_force < 0.0 for stop in of(events, EventKind.STICK))
    assert events[0].time == pytest.approx(0.67979883333333, abs=1e-13)
    assert events[2].time == pytest.approx(0.75893741627714234, abs=1e-13)
    assert events[1].velocity > 0.035


def test_stribeck_reaches_its_limit_cycle_below_the_speed_where_the_branches_meet() -> None:
    events, _ = play('stribeck', 20.0)
    assert last_cycle(events) == pytest.approx((0.8268, 0.002 * 0.8268), rel=1e-3)
    assert max(event.velocity for event in of(events, EventKind.COAST)) < 0.0322
    fine = load_scene('stribeck', {'friction.kinetic.tolerance': 1e-7})
    simulator = Simulator(fine.axis, fine.initial, fine.drive, fine.force)
    exact = last_cycle(simulator.advance(instant(20.0)))
    assert last_cycle(events) == pytest.approx(exact, rel=1e-3)


def test_positioning_starts_runs_stops_and_reverses() -> None:
    events, end = play('positioning', 4.0)
    starts = of(events, EventKind.BREAKAWAY)
    forward = [event for event in starts if event.direction == 1]
    back = [event for event in starts if event.direction == -1]
    assert max(event.time for event in forward) < 1.125 < 2.0 < min(event.time for event in back)
    assert forward[0].static_coefficient > forward[1].static_coefficient
    assert back[0].static_coefficient > back[1].static_coefficient
    assert end.mode == Mode.STICK
    assert end.drive_position == pytest.approx(0.0, abs=1e-15)
    assert 5e-5 < end.position < 5e-4
    there = [event for event in events if event.kind == EventKind.STICK and event.time < 2.0][-1]
    assert there.drive_position < 0.01
    assert 9e-3 < there.position < 1e-2


def test_micro_feed_jumps_and_coasts_slowly() -> None:
    events, _ = play('micro_feed', 60.0)
    period, jump = last_cycle(events)
    assert events[0].time == pytest.approx(15.37, abs=0.01)
    assert 9.0 < period < 9.3
    assert 0.9e-3 < jump < 1e-3
    assert all(event.velocity < 7e-4 for event in events)


def test_fast_feed_settles_to_smooth_sliding() -> None:
    events, end = play('fast_feed', 10.0)
    assert len(of(events, EventKind.BREAKAWAY)) == 1
    assert not of(events, EventKind.STICK)
    assert end.velocity == pytest.approx(0.1, rel=1e-9)
    _, soon = play('fast_feed', 2.0)
    assert soon.velocity == pytest.approx(0.1, rel=1e-3)


def test_cutting_force_ties_the_stick_slip_to_the_cut() -> None:
    events, _ = play('cutting_force', 20.0)
    stops = of(events, EventKind.STICK)[-40:]
    assert [b.time - a.time for a, b in itertools.pairwise(stops)] == pytest.approx([0.0625] * 39, rel=1e-9)
    assert last_cycle(events)[1] == pytest.approx(1.25e-4, rel=1e-9)
    released = of(events, EventKind.BREAKAWAY)[-1].time % 0.0625
    assert 0.03125 < released < 0.0625
