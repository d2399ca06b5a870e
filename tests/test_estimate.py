# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The error estimate against the true error of runs that are known to 25 digits, and on runs that nobody can know."""

import dataclasses
import json
import math
import statistics
from fractions import Fraction
from typing import Any

import pytest

from stickslip_sim.axis import InitialState
from stickslip_sim.courses import steps
from stickslip_sim.estimate import error_estimate
from stickslip_sim.offline import run_offline
from stickslip_sim.perturbation import ROUNDING_UNIT, perturbed
from stickslip_sim.scene import Scene, load_scene
from tests.reference.objects import axis_of, course_of
from tests.test_against_reference import RUNS


def scene_of(values: dict[str, Any]) -> Scene:
    return dataclasses.replace(load_scene('paper_fig7'), axis=axis_of(values), drive=course_of(values['drive']),
                               force=course_of(values['force']), initial=InitialState(**values['initial']))


def test_the_true_error_is_within_the_estimate_and_not_far_below() -> None:
    times, positions = [], []
    for run in RUNS.values():
        done = run_offline(scene_of(run['parameters']), run['duration'])
        estimate, want = error_estimate(done), run['events']
        assert estimate.until_s == run['duration']
        times.append(_worst([event.instant for event in done.events], want['time']) / estimate.event_time_s)
        positions.append(_worst([(event.position, 0.0) for event in done.events], want['position'])
                         / estimate.position_m)
    for ratios in (times, positions):
        assert sum(ratio <= 1.0 for ratio in ratios) >= 0.99 * len(ratios)
        assert statistics.median(ratios) >= 0.01


def test_a_run_without_events_has_an_estimate_too() -> None:
    scene = load_scene('paper_fig7', {'drive.velocity': 0.0})
    estimate = error_estimate(run_offline(scene, 10.0))
    assert 0.0 < estimate.event_time_s <= 1e-16
    assert estimate.position_m == 0.0
    assert estimate.until_s == 10.0


def test_a_run_that_nobody_can_know_says_from_when_on() -> None:
    """The drive stops within rounding of the instant at which the force reaches the limit."""
    scene = load_scene('paper_fig4_constant')
    (first, *_) = run_offline(scene, 1.0).events
    grazing = dataclasses.replace(scene, drive=steps('drive', (0.0, first.time), (scene.drive.values[0], 0.0)))
    estimate = error_estimate(run_offline(grazing, 1.0))
    assert estimate.until_s == pytest.approx(first.time, abs=1e-12)
    assert 'the events differ' in estimate.how


def test_the_estimate_is_the_same_every_time() -> None:
    run = run_offline(load_scene('paper_fig8'), 3.0)
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
    """Return the numbers of axis, start and courses."""
    text = json.dumps([dataclasses.asdict(part) for part in (scene.axis, scene.initial, scene.drive, scene.force)])
    found: list[float] = []
    json.loads(text, parse_float=lambda number: found.append(float(number)),
               parse_constant=lambda number: found.append(math.inf))
    return found


def _worst(got: list[Any], want: list[str]) -> float:
    """Return the largest error of numbers in two parts against decimal ones."""
    return max(abs(float(Fraction(a) + Fraction(b) - Fraction(text))) for (a, b), text in zip(got, want))


