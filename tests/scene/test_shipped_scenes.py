# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every shipped scene shows what its first comment says."""

import itertools
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.advise.parts import friction_parts
from stickslip_sim.compare.characteristics import characteristics_beside
from stickslip_sim.core.types import Event, EventKind, Mode, Sample
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import SimulatedRun, simulate, simulate_events
from stickslip_sim.scene import changed, scene_names
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.study import EvenGrid, Study, variation
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


def test_ball_screw_comes_to_its_targets_from_both_sides_a_micrometre_off() -> None:
    run = simulate(load_scene('ball_screw'), 15.0)
    time, drive = run.samples['time'], run.samples['drive_position']
    off = 1e6 * (run.samples['position'] - drive)
    rests = [(0.8, 0.02), (2.3, 0.11), (3.85, 0.205), (5.3, 0.29), (6.85, 0.385), (7.5, 0.39), (8.15, 0.385),
             (9.7, 0.29), (11.15, 0.205), (12.7, 0.11), (14.2, 0.02), (15.0, 0.0)]
    for end, target in rests:
        row = int(np.searchsorted(time, end))
        assert drive[row] == pytest.approx(target, abs=1e-12)
        assert off[row] == pytest.approx(-0.35 if end < 8.0 else 0.35, abs=0.1)
    sliding = (time > 1.2) & (time < 1.6)
    assert off[sliding] == pytest.approx(-120.0 / 170.0, abs=0.01)


def test_cutting_force_ties_the_stick_slip_to_the_cut() -> None:
    events, _ = play('cutting_force', 20.0)
    stops = of(events, EventKind.STICK)[-40:]
    assert [b.time - a.time for a, b in itertools.pairwise(stops)] == pytest.approx([0.0625] * 39, rel=1e-9)
    assert last_cycle(events)[1] == pytest.approx(1.25e-4, rel=1e-9)
    released = of(events, EventKind.BREAKAWAY)[-1].time % 0.0625
    assert 0.03125 < released < 0.0625


# A part that a scene leaves out changes nothing: the motion is that of the part at its neutral value, to the bit.

DURATION, PERIOD = 3.0, 0.01   # s
CONSTANT = {'friction.static.law': 'constant', 'friction.static.initial': 0.2}


def with_values(name: str, changes: dict[str, object]) -> SimulatedRun:
    return simulate(load_scene(name, changes), DURATION, PERIOD)


def assert_same(a: SimulatedRun, b: SimulatedRun) -> None:
    assert len(a.events) > 5
    assert a.events == b.events
    assert all((a.samples[name] == b.samples[name]).all() for name in a.samples)


@pytest.mark.parametrize('neutral', [
    {'force.course': 'constant', 'force.constant': 0.0},
    {'force.course': 'sine', 'force.amplitude': 0.0, 'force.frequency': 16.0},
    {'drive.amplitudes': [0.0, 0.0], 'drive.frequencies': [3.0, 700.0]},
    {'force.amplitudes': [0.0], 'force.frequencies': [20.0]},
    {'friction.kinetic.end_slope': 0.0},
    {'friction.scale': 1.0},
    {'encoder.resolution': 0.0},
    {'command.timeout': 0.0},
    {'record.enabled': False},
    {'seed': 7},
    {'time.rate': 250.0},
])
@pytest.mark.parametrize('name', ['paper_fig7', 'paper_fig8'])
def test_a_neutral_value_is_as_good_as_none(name: str, neutral: dict[str, object]) -> None:
    assert_same(with_values(name, neutral), with_values(name, {}))


def test_dampers_of_nothing_are_none(tmp_path: Path) -> None:
    given = changed(load_scene('paper_fig8'), {'contact.damping': 0.0, 'scene': 'mine'})
    path = tmp_path / 'scene.yaml'
    path.write_text('\n'.join(line for line in given.text.splitlines() if 'damping: 0.0' not in line))
    left_out = load_scene(str(path))
    assert_same(simulate(given, DURATION, PERIOD), simulate(left_out, DURATION, PERIOD))


@pytest.mark.parametrize('law', ['exponential', 'kato', 'hyperbolic', 'logarithmic'])
@pytest.mark.parametrize('name', ['paper_fig7', 'paper_fig8', 'paper_fig4_falling'])
def test_growth_to_where_it_begins_is_the_constant_law_for_any_time(name: str, law: str) -> None:
    constant = with_values(name, {**CONSTANT, 'initial.rest_time': 1.0})
    for time_constant in (1e-3, 50.0):
        growing = {'friction.static.law': law, 'friction.static.initial': 0.2, 'friction.static.limit': 0.2,
                   'friction.static.time_constant': time_constant, 'initial.rest_time': 1.0}
        exponent = {'friction.static.exponent': 0.7} if law == 'kato' else {}
        assert_same(with_values(name, {**growing, **exponent}), constant)


def test_branches_that_begin_together_are_one_curve() -> None:
    """With mu_s = mu_k at rest a rigid contact breaks away without an excess."""
    equal = {'friction.static.law': 'constant', 'friction.static.initial': 0.12, 'drive.course': 'sine',
             'drive.amplitude': 0.01, 'drive.frequency': 1.0}
    assert_same(with_values('paper_fig7', equal),
                with_values('paper_fig7', {**equal, 'friction.acceleration_dependence': False}))


def test_a_breakpoint_on_the_line_between_its_neighbours_is_an_event_and_no_more() -> None:
    plain = with_values('paper_fig4_falling', {})
    knotted = with_values('paper_fig4_falling', {'friction.kinetic.velocities': [0.0, 0.0175, 0.035],
                                                 'friction.kinetic.coefficients': [0.12, 0.085, 0.05]})
    moves = [e for e in plain.events if e.kind != EventKind.KNOT]
    again = [e for e in knotted.events if e.kind != EventKind.KNOT]
    assert [(e.kind, e.mode, e.direction) for e in again] == [(e.kind, e.mode, e.direction) for e in moves]
    assert max(abs(a.time - b.time) for a, b in zip(again, moves)) < 1e-13
    slips = plain.summary.events[EventKind.BREAKAWAY]
    extra = knotted.summary.events[EventKind.KNOT] - plain.summary.events[EventKind.KNOT]
    assert extra == 2 * slips   # on the way up and on the way down


# One factor on all of friction: in a scene, in a study, and in the scenes that advise and compare derive.

SCALED = {'friction.scale': 1.25}


def test_a_scene_without_it_says_nothing_of_it() -> None:
    assert all('friction.scale' not in load_scene(name).values for name in scene_names())


@pytest.mark.parametrize('name', ['paper_fig7', 'paper_fig8', 'stribeck'])
def test_all_coefficients_are_scaled_as_by_the_fault(name: str) -> None:
    fault = {'faults.ids': ['dry'], 'faults.kinds': ['friction_scale'], 'faults.starts': [0.0],
             'faults.durations': [1e6], 'faults.values': [1.25]}
    scaled, faulty = (simulate_events(load_scene(name, changes), 3.0) for changes in (SCALED, fault))
    assert len(scaled.events) > 5
    assert [event.kind for event in scaled.events] == [event.kind for event in faulty.events]
    assert [event.time for event in scaled.events] == pytest.approx([event.time for event in faulty.events], rel=1e-9)


def test_more_friction_is_as_a_heavier_load() -> None:
    """Both times a power of two, so that the products are the same doubles."""
    scaled, loaded = (simulate_events(load_scene('paper_fig8', change), 3.0).events for change in (
        {'friction.scale': 2.0}, {'axis.normal_force': 2.0 * 3432.3275}))
    assert [event.time for event in scaled] == pytest.approx([event.time for event in loaded], rel=1e-12)


def test_a_study_varies_it_beside_static_friction() -> None:
    study = Study(load_scene('paper_fig8').values, EvenGrid((variation('friction.scale=0.8:1.2:3'),
                                                          variation('friction.static.limit=0.2:0.28:3'))))
    found = study.figures(0, study.count).break_away_force
    alone = [simulate_events(study.scene_at(point), 20.0).summary.last for point in study.points(0, study.count)]
    assert found == pytest.approx([cycle.break_away_force for cycle in alone if cycle], rel=1e-6)
    assert len(np.unique(found)) == study.count


def test_scenes_made_from_a_scaled_one_are_scaled_once() -> None:
    scene = changed(load_scene('paper_fig8'), SCALED)
    at_rest = scene.axis.friction.kinetic.coefficients[0]
    assert characteristics_beside(scene)['constant kinetic friction'].axis.friction.kinetic.coefficients == (at_rest,)
    part = next(part for part in friction_parts(scene) if part.name == 'speed dependence of mu_k')
    flat = changed(scene, part.variants[0].changes(dict(scene.values)))
    assert set(flat.axis.friction.kinetic.coefficients) == {at_rest}
