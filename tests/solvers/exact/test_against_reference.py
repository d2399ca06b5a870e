# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The engine against an independent automaton at 40 digits (stickslip_sim.reference), event by event.

`time_sensitivity` of an event is what the reference measured: seconds of shift per relative unit of rounding in the
data; a chaotic or nearly grazing run has a large one, and there no double-precision result can do better.
"""

import math
from itertools import pairwise

import pytest

from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import instant
from tests.support.stored_objects import inputs_of
from tests.support.stored_runs import stored

RUNS = stored()
ROUNDING = 2.220446049250313e-16


@pytest.mark.parametrize('name', RUNS)
def test_events_equal_the_reference(name: str) -> None:
    run = RUNS[name]
    events, want = Simulator(*inputs_of(run['parameters'])).advance(instant(run['duration'])), run['events']
    assert [(e.kind.name.lower(), e.direction) for e in events] == list(zip(want['kind'], want['direction']))
    travel = max([abs(float(x) - run['parameters']['initial']['position']) for x in want['position']] or [0.0])
    size = max(travel, abs(run['parameters']['initial']['position']))
    force = max([abs(float(x)) for x in want['drive_force']] or [0.0])
    speed = max([abs(float(x)) for x in want['velocity']] or [0.0])
    worst = 0.0
    for i, event in enumerate(events):
        slack = max(1.0, 16.0 * want['time_sensitivity'][i] * ROUNDING / (1e-12 * run['duration']))
        worst = max(worst, _error(event.time, want['time'][i], run['duration']) / slack,
                    _error(event.position, want['position'][i], size) / slack,
                    _error(event.velocity, want['velocity'][i], speed) / slack,
                    _error(event.drive_force, want['drive_force'][i], force) / slack)
        if event.kind.name != 'REVERSE':
            assert _error(event.friction_force, want['friction_force'][i], force) <= 1e-11 * slack, i
        if event.kind.name == 'BREAKAWAY':
            coefficient = float(want['static_coefficient'][i])
            assert event.static_coefficient == pytest.approx(coefficient, rel=1e-11 * slack), i
    assert worst <= (1e-11 if name == 'D' else 1e-12)   # D is chaotic: errors grow tenfold every 2 s


@pytest.mark.parametrize('name', RUNS)
def test_states_between_events_equal_the_reference(name: str) -> None:
    run = RUNS[name]
    simulator, want = Simulator(*inputs_of(run['parameters'])), run['samples']
    slack = max([1.0, *(16.0 * s * ROUNDING / (1e-12 * run['duration']) for s in run['events']['time_sensitivity'])])
    force = max([1e-300, *(abs(float(x)) for x in [*want['drive_force'], *want['friction_force']])])
    length = max(abs(float(x)) for x in want['position']) or 1.0
    speed = max(abs(float(x)) for x in want['velocity']) or 1.0
    for i, time in enumerate(want['time']):
        simulator.advance(instant(float(time)))
        sample = simulator.sample()
        for got, column, scale in ((sample.position, 'position', length), (sample.velocity, 'velocity', speed),
                                   (sample.drive_force, 'drive_force', force),
                                   (sample.friction_force, 'friction_force', force)):
            assert _error(got, want[column][i], scale) <= 1e-11 * slack, (column, time)


def test_the_stored_runs_cover_the_model() -> None:
    assert len(RUNS) >= 40
    assert {kind for run in RUNS.values() for kind in run['events']['kind']} == {
        'breakaway', 'coast', 'accelerate', 'decelerate', 'stick', 'reverse', 'knot'}
    laws = {run['parameters']['friction']['static']['law'] for run in RUNS.values()}
    assert {'constant', 'exponential'} <= laws
    for run in RUNS.values():
        assert all(float(a) <= float(b) for a, b in pairwise(run['events']['time']))
        assert all(math.isfinite(s) for s in run['events']['time_sensitivity'])


def _error(got: float, want: str, scale: float) -> float:
    """Return |got − want| / scale, with the difference taken in exact arithmetic."""
    from fractions import Fraction
    return abs(float(Fraction(got) - Fraction(want))) / (scale or 1.0)
