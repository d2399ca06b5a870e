# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene with a normal load that changes in time and friction that differs backwards: in a real node, and offline."""

import math
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.check.verification import verify
from stickslip_sim.core.types import Event, EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import RecordedRun, read_run
from stickslip_sim.runs import simulate
from stickslip_sim.runs.run import LOAD_COLUMN
from stickslip_sim.scene import changed
from tests.support.node_processes import recording_into
from tests.support.ros_nodes import node_and_client

from stickslip_msgs.srv import Step  # isort: skip

pytestmark = pytest.mark.ros

CHANGES: dict[str, Any] = {
    'time.mode': 'lockstep',
    'friction.static.backward.initial': 0.1, 'friction.static.backward.limit': 0.15,
    'friction.kinetic.backward.coefficients': [0.1, 0.03],
    'normal_load.course': 'steps', 'normal_load.times': [0.0, 0.7, 1.6], 'normal_load.forces': [0.0, 500.0, -800.0],
}
SPEEDS, STEPS, RATE = (0.004, -0.01, 0.006), 800, 1000.0
FORWARDS, BACKWARDS = (0.12, 0.24), (0.1, 0.15)    # the range of the static coefficient


@pytest.fixture(scope='module')
def recorded(tmp_path_factory: pytest.TempPathFactory) -> RecordedRun:
    """The run of a node that was ordered by messages to go forwards, backwards, and forwards again."""
    folder = tmp_path_factory.mktemp('node')
    (folder / 'scene.yaml').write_text(load_scene('paper_fig8', CHANGES).text, encoding='utf-8')
    with node_and_client(folder, 'lockstep', '--params-file', str(folder / 'scene.yaml'),
                         *recording_into(folder / 'runs')) as (_, axis):
        bag = Path(axis.latest('run_info').bag_path)
        for speed in SPEEDS:
            assert axis.call(Step, 'step', steps=STEPS, velocity=speed, force=math.nan).success
    return read_run(bag)


def test_it_has_the_load_and_the_friction_of_the_direction(recorded: RecordedRun) -> None:
    weight = 3432.3275
    assert recorded.samples[LOAD_COLUMN][[699, 700, 1600]].tolist() == [weight, weight + 500.0, weight - 800.0]
    away = [event for event in recorded.events if event.kind == EventKind.BREAKAWAY]
    assert {event.direction for event in away} == {1, -1}
    for event in away:
        low, high = FORWARDS if event.direction > 0 else BACKWARDS
        assert low <= event.static_coefficient <= high


def test_it_verifies(recorded: RecordedRun) -> None:
    verdict = verify(recorded)
    assert verdict.difference is None, verdict
    assert (verdict.steps, verdict.events, verdict.missing) == (1 + len(SPEEDS) * STEPS, len(recorded.events), 0)


def test_it_is_the_run_of_a_scene_whose_drive_goes_so(recorded: RecordedRun) -> None:
    duration = STEPS / RATE
    drive = {'drive.course': 'steps', 'drive.times': [k * duration for k in range(len(SPEEDS))],
             'drive.velocities': list(SPEEDS)}
    offline = simulate(changed(load_scene('paper_fig8', CHANGES), drive), len(SPEEDS) * duration, 1.0 / RATE)
    published = [event for event in offline.events if event.kind != EventKind.KNOT]
    assert [kind_of(event) for event in recorded.events] == [kind_of(event) for event in published]
    assert [event.time for event in recorded.events] == pytest.approx([event.time for event in published], rel=1e-12)
    assert recorded.samples['position'] == pytest.approx(offline.samples['position'], rel=1e-12, abs=1e-15)


def kind_of(event: Event) -> tuple[int, int, int]:
    return event.kind, event.mode, event.direction
