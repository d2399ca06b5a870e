# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The faults of a scene act offline as they do step by step."""

import pytest

from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate, simulate_events

FAULTS = {'faults.ids': ['dry', 'knock', 'stop'], 'faults.kinds': ['friction_scale', 'force_pulse', 'drive_freeze'],
          'faults.starts': [0.3, 0.7004, 1.2],
          'faults.durations': [0.5, 0.0125, 0.25], 'faults.values': [1.5, 900.0, 0.0]}


@pytest.mark.parametrize('name', ['paper_fig7', 'positioning', 'cutting_force'])
def test_a_run_from_event_to_event_is_that_of_the_steps(name: str) -> None:
    scene = load_scene(name, {**FAULTS, 'time.rate': 200.0})
    run = simulate(scene, 2.0, 0.005)
    rig = scene.make_rig()
    results = [rig.make_step() for _ in range(401)]
    assert run.events == [event for result in results for event in result.events]
    assert list(run.sample_rows()) == [result.sample for result in results]
    assert run.events != simulate_events(load_scene(name, {'time.rate': 200.0}), 2.0).events
