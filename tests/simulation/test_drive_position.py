# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A drive whose position is prescribed is at each breakpoint where it was sent, and pulls as its position says."""

import math
import random

import pytest

from stickslip_sim.core.position_profile import positions
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.reference import simulate as simulate_reference
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene

PLACES, TIMES = (0.0, 0.0013, 0.0029, 0.0012, -0.0004), (0.0, 0.7, 1.5, 1.9, 3.0)


def scene_of(name: str, slopes: list[float] | None, times: tuple[float, ...] = TIMES,
             places: tuple[float, ...] = PLACES) -> Scene:
    return load_scene(name, {'drive.course': 'position', 'drive.times': list(times), 'drive.positions': list(places),
                             **({} if slopes is None else {'drive.slopes': slopes})})


@pytest.mark.parametrize('slopes', [None, [0.004, 0.0, 0.001, -0.002, 0.0]])
def test_the_drive_is_where_it_was_sent(slopes: list[float] | None) -> None:
    scene = scene_of('paper_fig8', slopes)
    run = simulate(scene, 4.0, sample_period=0.1)
    for time, place in zip(TIMES, PLACES, strict=True):
        assert run.samples['drive_position'][round(time / 0.1)] == pytest.approx(place, abs=1e-18)
    truth = simulate_reference(scene.axis, scene.initial, scene.drive, scene.force, 4.0).events
    assert [event.kind for event in run.events] == [event.kind for event in truth]
    assert max(abs(event.time - other.time) for event, other in zip(run.events, truth, strict=True)) < 1e-13


def test_a_slider_breaks_away_where_the_position_stretches_the_spring_to_the_limit() -> None:
    """Rigid contact, s = a t²: c s + h v = N mu_s."""
    scene = scene_of('paper_fig7', [0.0, 0.004], (0.0, 2.0), (0.0, 0.004))
    stiffness, damping, limit = 6e5, 4000.0, 0.24 * scene.axis.normal_force
    root = (-damping + math.sqrt(damping ** 2 + stiffness * limit / 0.001)) / stiffness   # of c a t² + 2 h a t = limit
    first = simulate(scene, 2.0).events[0]
    assert first.kind == EventKind.BREAKAWAY
    assert first.time == pytest.approx(root, rel=1e-14)


def test_no_digits_are_lost_on_a_long_way() -> None:
    rng, places = random.Random(7), [57.3]
    for _ in range(20_000):
        places.append(places[-1] + rng.uniform(-1e-4, 1.2e-4))
    profile = positions('drive', [k * 1e-3 for k in range(len(places))], places)
    reached = math.fsum(value * (end - start) for value, start, end in
                        zip(profile.values, profile.starts, profile.starts[1:], strict=False))
    assert reached == pytest.approx(places[-1] - places[0], abs=1e-15)
