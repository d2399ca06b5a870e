# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction that changes during a run: every solver follows it, its smooth law too, or says why it cannot."""

import json
from typing import Any

import pytest

from stickslip_sim.core.errors import InputError, SolverError
from stickslip_sim.core.types import Event, EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import checkpoint_file
from stickslip_sim.rig import Rig
from stickslip_sim.scene import changed
from tests.support.axes import instant
from tests.support.rigs import inject, run

LAWS = [('stribeck', 1e-6), ('exponential', 1e-6), ('hyperbolic', 1e-5)]
_PER_ERROR = 20.0    # s that a slip may be early or late per error of a table: up to 9 were seen
_STEPPED = 2e-4      # s that these fixed steps add
SOLVERS: dict[str, dict[str, Any]] = {
    'adaptive': {'solver.name': 'adaptive'}, 'fixed_step': {'solver.name': 'fixed_step', 'solver.step': 2e-6},
}


def scaled_from(start: float, factor: float) -> dict[str, Any]:
    """Return what a scene says of friction that is times a factor from a time on."""
    return {'faults.ids': ['a'], 'faults.kinds': ['friction_scale'], 'faults.starts': [start],
            'faults.durations': [100.0], 'faults.values': [factor]}


def slips(events: list[Event]) -> list[Event]:
    """Return where slips begin and end."""
    return [event for event in events if event.kind in (EventKind.BREAKAWAY, EventKind.STICK)]


def assert_same_slips(found: list[Event], expected: list[Event], seconds: float) -> None:
    assert [event.kind for event in slips(found)] == [event.kind for event in slips(expected)]
    for event, other in zip(slips(found), slips(expected)):
        assert event.time == pytest.approx(other.time, abs=seconds)
        assert event.position == pytest.approx(other.position, abs=0.1 * seconds)


@pytest.mark.parametrize('factor', [0.5, 3.0])
@pytest.mark.parametrize(('law', 'tolerance'), LAWS)
@pytest.mark.parametrize('solver', SOLVERS)
def test_a_fault_scales_the_law_as_it_scales_the_table(solver: str, law: str, tolerance: float, factor: float) -> None:
    given = {'friction.kinetic.law': law, 'friction.kinetic.tolerance': tolerance, **scaled_from(2.0, factor)}
    expected, found = (load_scene('stribeck', {**given, **other}).make_rig().advance(instant(4.5))
                       for other in ({}, SOLVERS[solver]))
    assert sum(event.time > 2.0 for event in slips(expected)) >= 2
    assert_same_slips(found, expected, _PER_ERROR * tolerance + (_STEPPED if solver == 'fixed_step' else 0.0))


def driven(rig: Rig, steps: int) -> list[Event]:
    return [event for result in run(rig, steps) for event in result.events]


SLOW = {'time.rate': 50.0, 'friction.kinetic.tolerance': 1e-6}
OTHER_LAW = {'friction.kinetic.initial': 0.11, 'friction.kinetic.limit': 0.03, 'friction.kinetic.viscous': 0.05,
             'friction.kinetic.stribeck_velocity': 0.008}


@pytest.mark.parametrize('start_anew', [False, True])
def test_a_live_parameter_changes_the_law(start_anew: bool) -> None:
    runs = []
    for solver in ({}, SOLVERS['adaptive']):
        scene = load_scene('stribeck', {**SLOW, **solver})
        rig = scene.make_rig()
        driven(rig, 90)
        rig.change_axis(changed(scene, OTHER_LAW).axis)
        if start_anew:
            rig.make_step()
            rig.reset()
        runs.append(driven(rig, 120))
    expected, found = runs
    assert len(slips(expected)) > 2
    assert_same_slips(found, expected, _PER_ERROR * SLOW['friction.kinetic.tolerance'])


def test_a_checkpoint_is_continued_with_the_law_of_its_time() -> None:
    scene = load_scene('stribeck', {**SLOW, **SOLVERS['adaptive'], **scaled_from(1.0, 3.0)})
    rig, again = scene.make_rig(), scene.make_rig()
    other = changed(scene, OTHER_LAW).axis
    rig.change_axis(other)
    driven(rig, 100)
    (data,) = checkpoint_file(rig.checkpoint()).values()
    again.change_axis(other)
    again.restore(json.loads(data))
    expected = driven(rig, 150)
    assert len(slips(expected)) >= 2
    assert driven(again, 150) == expected


STEEP = {'solver.name': 'fixed_step', 'solver.step': 1e-3, 'drive.velocity': 0.2, 'friction.kinetic.end_slope': 5.0}


def test_steps_too_long_for_the_scaled_friction_end_the_run() -> None:
    """Where friction rises with the speed a scaled one damps harder, and fixed steps of 1 ms would diverge."""
    rig = load_scene('paper_fig7', STEEP).make_rig()
    with pytest.raises(SolverError, match=r'faults in force scale friction by 100: solver\.step = 0\.001 is refused'):
        run(rig, 600, {500: [inject('friction_scale', value=100.0)]})
    rig.reset()
    assert driven(rig, 800)


def test_friction_beyond_all_numbers_ends_the_run() -> None:
    rig = load_scene('stribeck').make_rig()
    with pytest.raises(SolverError, match='faults in force scale friction by inf: friction'):
        run(rig, 2, {1: [inject('friction_scale', value=100.0)] * 200})


def test_what_the_faults_of_a_scene_make_of_friction_is_checked_with_the_scene() -> None:
    with pytest.raises(InputError, match=r'with friction times 100 by faults: solver\.step = 0\.001 is refused'):
        load_scene('paper_fig7', {**STEEP, **scaled_from(0.5, 100.0)})
    one_after_the_other = {'faults.ids': ['a', 'b'], 'faults.kinds': ['friction_scale'] * 2,
                           'faults.starts': [0.5, 0.7], 'faults.values': [10.0, 10.0]}
    load_scene('paper_fig7', {**STEEP, **one_after_the_other, 'faults.durations': [0.2, 0.2]})
    with pytest.raises(InputError, match=r'with friction times 100 by faults: solver\.step'):
        load_scene('paper_fig7', {**STEEP, **one_after_the_other, 'faults.durations': [0.3, 0.2]})
