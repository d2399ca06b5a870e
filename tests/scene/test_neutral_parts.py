# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A part that a scene leaves out changes nothing: the motion is that of the part at its neutral value, to the bit."""

from pathlib import Path

import pytest

from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import SimulatedRun, simulate
from stickslip_sim.scene import changed

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
