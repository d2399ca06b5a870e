# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A rig goes on from a checkpoint as if nothing had been: to the last bit, with any orders afterwards."""

import json
from random import Random
from typing import Any

import pytest

from stickslip_sim.axis.fields import places_of
from stickslip_sim.axis.state_record import State
from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import checkpoint_file
from stickslip_sim.rig import Fault, Rig, StepResult
from stickslip_sim.scene import Scene, changed

LIMITS = {'command.acceleration_limit': 0.5, 'command.on_timeout': 'ramp_to_zero'}
SINES = {'force.course': 'sine', 'force.amplitude': 200.0, 'force.frequency': 7.0, 'drive.course': 'table',
         'drive.times': [0.0, 0.3], 'drive.velocities': [0.001, 0.004], 'drive.period': 0.5}
LOADS = {'normal_load.course': 'steps', 'normal_load.times': [0.0, 0.15, 0.2503], 'normal_load.period': 0.4,
         'normal_load.forces': [0.0, -3000.0, 900.0]}
SCENES = [('paper_fig8', LIMITS), ('paper_fig7', SINES), ('cutting_force', {}), ('paper_fig8', LOADS),
          ('paper_fig8', {'solver.name': 'fixed_step', 'solver.step': 1e-4})]


def go(rig: Rig, scene: Scene, first: int, count: int) -> list[StepResult]:
    """Make steps with orders of every kind, chosen by the number of the step."""
    results = []
    for n in range(first, first + count):
        stream = Random(n)
        velocity = stream.uniform(-0.01, 0.01) if n % 7 == 0 else None
        force = stream.uniform(-900.0, 900.0) if n % 97 == 0 else None
        if n % 100 == 50:
            kind = stream.choice(['friction_scale', 'force_pulse', 'command_loss', 'command_delay', 'drive_freeze'])
            rig.inject(Fault('', kind, 0.01, 0.1, 0.0 if kind == 'drive_freeze' else stream.random()))
        if n % 444 == 3:
            rig.time_out(0.2)
        if n % 333 == 3:
            rig.change_axis(changed(scene, {'axis.mass': stream.uniform(200.0, 400.0)}).axis)
        results.append(rig.make_step(velocity, force))
    return results


def continued(scene: Scene, rig: Rig) -> Rig:
    """Return another rig that goes on from the checkpoint as a file has it."""
    (data,) = checkpoint_file(rig.checkpoint()).values()
    again = scene.make_rig()
    again.restore(json.loads(data))
    return again


@pytest.mark.parametrize(('name', 'overrides'), SCENES)
@pytest.mark.parametrize('steps', [1, 455, 1257])
def test_to_the_last_bit(name: str, overrides: dict[str, object], steps: int) -> None:
    scene = load_scene(name, overrides)
    rig = scene.make_rig()
    go(rig, scene, 0, steps)
    rig.change_axis(scene.axis)
    again = continued(scene, rig)
    expected, found = go(rig, scene, steps, 1500), go(again, scene, steps, 1500)
    assert [result.sample for result in found] == [result.sample for result in expected]
    assert [result.events for result in found] == [result.events for result in expected]
    assert sum(len(result.events) for result in expected) > 5


def test_the_order_of_faults_and_parameters_between_two_steps_does_not_matter() -> None:
    scene = load_scene('paper_fig8')
    heavier = changed(scene, {'axis.normal_force': 9000.0}).axis
    found = []
    for is_cleared_first in (True, False):
        rig = scene.make_rig()
        rig.inject(Fault('slippery', 'friction_scale', 0.0, 100.0, 0.1))
        go(rig, scene, 0, 700)
        if is_cleared_first:
            rig.clear_fault('slippery')
        rig.change_axis(heavier)
        if not is_cleared_first:
            rig.clear_fault('slippery')
        found.append([result.sample for result in go(rig, scene, 700, 500)])
    assert found[0] == found[1]


@pytest.mark.parametrize(('place', 'value'), [
    ('state', [0.0] * 7), ('state', 'none'), ('mode', 5.0), ('mode', 0.5), ('segment', -1.0), ('segment', 1e300),
    ('sinusoid_count', 3.0), ('until', 'soon'), ('time', [1.0]), ('waiting', [[1.0]]),
])
def test_a_state_that_no_solver_may_see(place: str, value: Any) -> None:
    scene = load_scene('paper_fig8')
    rig = scene.make_rig()
    saved = rig.checkpoint()
    if place in places_of(State):
        saved['simulator']['state'][places_of(State).index(place)] = value
    else:
        saved['simulator'][place] = value
    with pytest.raises((TypeError, ValueError)):
        scene.make_rig().restore(saved)


@pytest.mark.parametrize(('place', 'value'), [
    ('wire', [[], [[1, 2, 3], 0]]), ('wire', [[], [[0] * 624, 625]]),
    ('drive', [[[], [], [], 'inf', []], None, 'inf', False]),
    ('force', [[0.0], ['x'], [0.0], 'inf', []]), ('faults', {'active': [], 'planned': [[1, 2, ['a']]], 'chosen': 0}),
    ('faults', {'active': [[['a', 'rust', 0.0, 1.0, 0.0], 2.0]], 'planned': [], 'chosen': 0}),
])
def test_a_rig_that_never_was(place: str, value: Any) -> None:
    scene = load_scene('paper_fig8')
    rig = scene.make_rig()
    with pytest.raises((TypeError, ValueError, InputError)):
        rig.restore({**rig.checkpoint(), place: value})
