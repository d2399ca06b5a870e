# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of the friction characteristics: of one direction, or of both where they differ."""

from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.compare.characteristics import characteristics_of
from stickslip_sim.compare.fresh import simulate_densely
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots.characteristics import Characteristics, plot_characteristics
from stickslip_sim.runs import Run

TO_AND_FRO = {'drive.course': 'steps', 'drive.times': [0.0, 1.5], 'drive.velocities': [0.004, -0.006]}
BACKWARD = {'friction.static.backward.initial': 0.08, 'friction.static.backward.limit': 0.15,
            'friction.kinetic.backward.velocities': [0.0, 0.02], 'friction.kinetic.backward.coefficients': [0.08, 0.03]}


@pytest.fixture(scope='module')
def run() -> Run:
    return simulate_densely(load_scene('paper_fig7', {**TO_AND_FRO, **BACKWARD}), 3.0)


def test_friction_that_is_the_same_both_ways_is_drawn_once(tmp_path: Path) -> None:
    run = simulate_densely(load_scene('paper_fig7', TO_AND_FRO), 3.0)
    (alone,) = sides = characteristics_of(run)
    assert len(alone.break_aways.x) + alone.has_prolonged_rest == len(away(run, 1)) + len(away(run, -1))
    assert drawn(sides, tmp_path).isdisjoint({'static, forwards', 'static, backwards'})


def test_each_direction_has_its_own_curves_and_break_aways(run: Run) -> None:
    ahead, back = characteristics_of(run)
    assert (ahead.decelerating.y[0], back.decelerating.y[0]) == (0.12, 0.08)
    assert (ahead.static_limit, back.static_limit) == (0.24, 0.15)
    assert np.array_equal(ahead.static.x, back.static.x)
    assert (ahead.has_prolonged_rest, back.has_prolonged_rest) == (True, False)
    assert ahead.break_aways.y.tolist() == away(run, 1)[1:]     # the first one is that after the prolonged rest
    assert back.break_aways.y.tolist() == away(run, -1)
    assert len(back.break_aways.y) > 1
    for side in (ahead, back):
        assert set(side.accelerating) == {'first slip', 'last slip'}
        assert all(curve.y[0] > side.decelerating.y[0] for curve in side.accelerating.values())


def test_both_are_drawn(run: Run, tmp_path: Path) -> None:
    names = drawn(characteristics_of(run), tmp_path)
    assert {'static, forwards', 'static, backwards', 'break-aways of the run, backwards',
            'after prolonged rest, forwards', 'decelerating'} <= names


def away(run: Run, direction: int) -> list[float]:
    """Return the static coefficients of the break-aways in a direction."""
    return [event.static_coefficient for event in run.events
            if event.kind == EventKind.BREAKAWAY and event.direction == direction]


def drawn(sides: list[Characteristics], folder: Path) -> set[str]:
    """Return the labels in a picture."""
    plot_characteristics(sides, folder / 'friction.svg')
    text = (folder / 'friction.svg').read_text(encoding='utf-8')
    return {line.removeprefix('<!-- ').removesuffix(' -->') for line in map(str.strip, text.split('\n'))
            if line.startswith('<!-- ')}
