# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The error estimate against the true error of runs that are known to 25 digits, and on runs that nobody can know."""

import dataclasses
import json
import math
import statistics
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache
from typing import Any

import pytest

from benchmarks.smooth_tables import SmoothRun
from stickslip_sim.axis import InitialState
from stickslip_sim.core.input_profile import steps
from stickslip_sim.core.types import Event, EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.reference import simulate
from stickslip_sim.runs import simulate_events
from stickslip_sim.runs.error_estimate import ROUNDING_UNIT, error_estimate, perturbed
from stickslip_sim.scene import Scene, SolverSettings
from tests.support.stored_objects import axis_of, profile_of
from tests.support.stored_runs import stored


def scene_of(values: dict[str, Any]) -> Scene:
    return dataclasses.replace(load_scene('paper_fig7'), axis=axis_of(values), drive=profile_of(values['drive']),
                               force=profile_of(values['force']), initial=InitialState(**values['initial']))


def test_the_true_error_is_within_the_estimate_and_not_far_below() -> None:
    times, positions = [], []
    for run in stored().values():
        done = simulate_events(scene_of(run['parameters']), run['duration'])
        estimate, want = error_estimate(done), run['events']
        assert estimate.until_s == run['duration']
        times.append(_worst([event.instant for event in done.events], want['time']) / estimate.event_time_s)
        positions.append(_worst([(event.position, 0.0) for event in done.events], want['position'])
                         / estimate.position_m)
    for ratios in (times, positions):
        assert sum(ratio <= 1.0 for ratio in ratios) >= 0.99 * len(ratios)
        assert statistics.median(ratios) >= 0.01


WITH_STEPS = 1.5   # s


@cache
def true_events(name: str) -> Sequence[Event]:
    scene = load_scene(name)
    return simulate(scene.axis, scene.initial, scene.drive, scene.force, WITH_STEPS, 30).events


@pytest.mark.parametrize('name', ['paper_fig4_falling', 'paper_fig7', 'cutting_force'])
@pytest.mark.parametrize('settings', [
    SolverSettings('adaptive', 'DOP853', rtol=1e-3, atol=1e-5),
    SolverSettings('adaptive', 'DOP853', rtol=1e-6, atol=1e-8),
    SolverSettings('adaptive', 'RK45', rtol=1e-9, atol=1e-11),
    *(SolverSettings('fixed_step', 'euler', step) for step in (3e-3, 1e-3, 5e-4, 1e-4)),
    *(SolverSettings('fixed_step', 'rk4', step) for step in (3e-3, 1e-3, 5e-4))],
    ids=lambda settings: '-'.join(map(str, settings.settings.values())))
def test_the_error_of_steps_is_within_the_estimate_too(name: str, settings: SolverSettings) -> None:
    """Where the calls bound the steps of an adaptive solver, a tenth of the tolerance takes the same steps again."""
    run = simulate_events(dataclasses.replace(load_scene(name), solver=settings), WITH_STEPS)
    estimate = error_estimate(run)
    want = [event for event in true_events(name) if settings.name == 'adaptive' or event.kind != EventKind.KNOT]
    pairs = [(a, b) for a, b in zip(run.events, want) if a.time < estimate.until_s]
    assert pairs
    assert all((a.kind, a.direction) == (b.kind, b.direction) for a, b in pairs)
    error = max(abs(a.time - b.time) for a, b in pairs)
    assert 0.5 * estimate.event_time_s <= error <= estimate.event_time_s
    assert max(abs(a.position - b.position) for a, b in pairs) <= estimate.position_m


def test_steps_that_pass_over_an_event_say_from_when_on() -> None:
    """The first peak coasts for 11 µs, which a grid of 1 ms passes over."""
    estimate = error_estimate(simulate_events(load_scene('positioning', {'solver.name': 'fixed_step'}), 1.0))
    assert estimate.until_s == pytest.approx(0.5481986133899266, abs=1e-12)
    assert 'missed, invented' in estimate.how


def test_a_coast_of_nanoseconds_does_not_end_what_is_known() -> None:
    """The second break-away coasts for 4 ns before it accelerates, which every grid passes over."""
    scene = load_scene('paper_fig8', {'solver.name': 'fixed_step', 'solver.method': 'rk4'})
    run = simulate_events(scene, 3.0)
    want = simulate(scene.axis, scene.initial, scene.drive, scene.force, 3.0, 30).events
    assert (len(run.events), len(want)) == (16, 17)
    lasting = [event for event in want if not 1.446303213 < event.time < 1.446303214]
    estimate = error_estimate(run)
    assert 'coasts of less than 1e-06 s' in estimate.how
    assert estimate.until_s == 3.0
    assert [event.kind for event in run.events] == [event.kind for event in lasting]
    assert max(abs(a.time - b.time) for a, b in zip(run.events, lasting)) <= estimate.event_time_s


@pytest.mark.parametrize('missing', [1, 2])
def test_a_missed_cycle_is_no_late_one(missing: int) -> None:
    """The kinds and directions of the events are those of a run in which each cycle after it comes late."""
    run = simulate_events(load_scene('paper_fig4_constant'), 5.0)
    away = [i for i, event in enumerate(run.events) if event.kind == EventKind.BREAKAWAY]
    stepped = dataclasses.replace(run.scene, solver=SolverSettings('fixed_step', 'euler', 1e-3))
    left = run.events[:away[2]] + run.events[away[2 + missing]:]
    estimate = error_estimate(dataclasses.replace(run, scene=stepped, events=left))
    assert estimate.until_s == run.events[away[2]].time
    assert estimate.event_time_s < 1e-12


def test_a_smooth_law_itself_is_not_compared_with_its_table() -> None:
    """The adaptive solver integrates the law: its distance to the table of the scene is no error of its own."""
    scene = load_scene('stribeck', {'solver.name': 'adaptive', 'friction.kinetic.tolerance': 1e-3})
    kinetic = scene.axis.friction.kinetic
    assert kinetic.law is not None
    run = simulate_events(scene, 1.2)
    estimate = error_estimate(run)
    want = SmoothRun(scene.axis, scene.drive.values[0], kinetic.law.coefficient, psi_of(scene)).advance(1.2)
    assert [event.kind for event in run.events] == [event.kind for event in want]
    error = max(abs(a.time - b.time) for a, b in zip(run.events, want))
    assert error <= estimate.event_time_s <= 1e-5
    assert max(abs(a.position - b.position) for a, b in zip(run.events, want)) <= estimate.position_m


def psi_of(scene: Scene) -> Callable[[float], float] | None:
    excess = scene.axis.friction.excess
    return excess.fraction if excess else None


def test_a_run_without_events_has_an_estimate_too() -> None:
    scene = load_scene('paper_fig7', {'drive.velocity': 0.0})
    estimate = error_estimate(simulate_events(scene, 10.0))
    assert 0.0 < estimate.event_time_s <= 1e-16
    assert estimate.position_m == 0.0
    assert estimate.until_s == 10.0


def test_a_run_that_nobody_can_know_says_from_when_on() -> None:
    """The drive stops within rounding of the instant at which the force reaches the limit."""
    scene = load_scene('paper_fig4_constant')
    (first, *_) = simulate_events(scene, 1.0).events
    grazing = dataclasses.replace(scene, drive=steps('drive', (0.0, first.time), (scene.drive.values[0], 0.0)))
    estimate = error_estimate(simulate_events(grazing, 1.0))
    assert estimate.until_s == pytest.approx(first.time, abs=1e-12)
    assert 'the events differ' in estimate.how


def test_the_estimate_is_the_same_every_time() -> None:
    run = simulate_events(load_scene('paper_fig8'), 3.0)
    assert error_estimate(run) == error_estimate(run)


@pytest.mark.parametrize('name', ['paper_fig8', 'cutting_force', 'positioning', 'paper_fig4_falling'])
def test_a_perturbed_scene_is_a_scene_with_every_number_moved(name: str) -> None:
    scene = load_scene(name)
    moved = perturbed(scene, 'a')
    assert moved.axis != scene.axis
    assert perturbed(scene, 'a') == moved != perturbed(scene, 'b')
    before, after = _numbers(scene), _numbers(moved)
    assert len(before) == len(after) > 10
    for a, b in zip(before, after):
        assert a == b if a in (0.0, math.inf) else abs(b - a) <= 2.0 * ROUNDING_UNIT * abs(a)
    assert sum(a != b for a, b in zip(before, after)) > 10
    assert all(len({b for a, b in zip(before, after) if a == number}) == 1
               for number in before if number not in (0.0, 1.0))


def _numbers(scene: Scene) -> list[float]:
    """Return the numbers of axis, start and input profiles."""
    text = json.dumps([dataclasses.asdict(part) for part in (scene.axis, scene.initial, scene.drive, scene.force)])
    found: list[float] = []
    json.loads(text, parse_float=lambda number: found.append(float(number)),
               parse_constant=lambda number: found.append(math.inf))
    return found


def _worst(got: list[Any], want: list[str]) -> float:
    """Return the largest error of numbers in two parts against decimal ones."""
    return max(abs(float(Fraction(a) + Fraction(b) - Fraction(text))) for (a, b), text in zip(got, want))




def test_a_slip_that_ends_without_deceleration_is_known_to_the_root_of_rounding_only() -> None:
    """Undamped, mu_s = mu_k: the slip ends where its deceleration does.  The reference has the double root exactly."""
    scene = load_scene('paper_fig4_constant', {
        'axis.mass': 1.0, 'axis.drive_stiffness': 884.9307126484309, 'axis.drive_damping': 0.0,
        'axis.normal_force': 9.80665, 'friction.static.law': 'constant',
        'friction.static.initial': 0.9102081478452411, 'friction.kinetic.velocities': [0.0, 7.488383618872175e-07],
        'friction.kinetic.coefficients': [0.9102081478452411] * 2, 'drive.velocity': 0.016676163303787093})
    run = simulate_events(scene, 1.2)
    wanted = simulate(scene.axis, scene.initial, scene.drive, scene.force, 1.2, 40).events
    stop, other = (next(e for e in events if e.kind == EventKind.STICK) for events in (run.events, wanted))
    off = abs(stop.fraction - other.fraction)
    assert 1e-10 < off <= error_estimate(run).event_time_s < 1e-8
