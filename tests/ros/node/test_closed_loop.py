# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A controller in process and the same one in lock-step with a real node: the same measurements, states and bag."""

import json
import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import stickslip_sim as stickslip
from stickslip_sim.bags import topics
from stickslip_sim.bags.topics import Topic
from stickslip_sim.check.verification import verify
from stickslip_sim.controllers.own_controller import Measurement
from stickslip_sim.core.time_grid import NANOSECONDS
from stickslip_sim.recording import RecordedRun, read_run
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

from sensor_msgs.msg import JointState  # noqa: E402

from stickslip_msgs.srv import Step  # noqa: E402
from tests.support.ros_nodes import Client, live_axis, nanoseconds  # noqa: E402

Changes = dict[str, Any]
DURATION = 0.4   # s
COMPARED = topics.SLIDER_STATE, topics.FRICTION_FORCE, topics.MODE_EVENT, topics.DRIVE_VELOCITY, topics.EXTERNAL_FORCE


class Cascade:
    """P and PI, and a force now and then; keeps its command where the measurement is lost."""

    def __init__(self, pushes: bool) -> None:
        self._pushes = pushes
        self.reset()

    def reset(self) -> None:
        self._integral = self._latest = 0.0

    def __call__(self, time: float, measured: Measurement) -> float | stickslip.Command:
        if not measured.is_lost:
            wanted = 0.004 + 20.0 * (0.004 * time - measured.slider_position) + 1e-8 * measured.drive_force
            self._integral += 0.05 * (wanted - measured.slider_velocity)
            self._latest = min(max(wanted + 2.0 * (wanted - measured.slider_velocity) + self._integral, -0.05), 0.05)
        return stickslip.Command(self._latest, 50.0 * math.sin(9.0 * time)) if self._pushes else self._latest


class Case(NamedTuple):
    """What is changed in a scene, how often the controller is asked (Hz), and whether it commands a force."""

    scene: str
    changes: Changes
    rate: float = 1000.0
    pushes: bool = False


def faults(*given: tuple[str, float, float, float]) -> Changes:
    kinds, starts, durations, values = zip(*given)
    return {'faults.ids': [f'f{k}' for k in range(len(kinds))], 'faults.kinds': list(kinds),
            'faults.starts': list(starts), 'faults.durations': list(durations), 'faults.values': list(values)}


CASES = {
    'ideal': Case('positioning', {}),
    'counted': Case('paper_fig7', {
        'encoder.resolution': 1e-6, 'encoder.delay': 0.003, 'encoder.noise': 2e-7, 'encoder.velocity_steps': 4,
        **faults(('encoder_dropout', 0.05, 0.2, 0.3), ('encoder_freeze', 0.1, 0.02, 0.0),
                 ('encoder_step', 0.2, 0.1, 1e-5))}),
    'channel': Case('paper_fig8', {
        'command.velocity_limit': 0.03, 'command.acceleration_limit': 2.0,
        **faults(('command_loss', 0.05, 0.2, 0.4), ('command_delay', 0.15, 0.1, 0.004))}),
    'watched': Case('micro_feed', {
        'command.timeout': 0.005, 'command.on_timeout': 'ramp_to_zero', 'encoder.resolution': 1e-8,
        **faults(('command_loss', 0.1, 0.2, 0.5), ('drive_freeze', 0.3, 0.03, 0.0))}, rate=250.0),
    'pushed': Case('paper_fig8', {
        'time.rate': 2000.0, 'solver.name': 'fixed_step', 'solver.method': 'rk4', 'solver.step': 1e-4,
        **faults(('friction_scale', 0.1, 0.1, 0.6), ('force_pulse', 0.15, 0.1, -300.0))}, rate=500.0, pushes=True),
}


class LockStep:
    """Makes the steps of an axis; what its encoders say comes on its own, or is lost."""

    def __init__(self, axis: Client) -> None:
        self._axis, self._force = axis, 0.0
        self.heard: dict[int, JointState] = {}
        axis.hear(JointState, 'joint_states', self._take, 5000)
        wait_for(lambda: axis.node.count_publishers('joint_states'), 'the encoders')
        axis.greet()
        wait_for(self._is_begun, 'the encoders after a reset')

    def _is_begun(self) -> bool:
        assert self._axis.trigger('reset').success
        return 0 in self.heard

    def _take(self, message: JointState) -> None:
        self.heard[nanoseconds(message.header.stamp)] = message

    def run(self, controller: Callable[[float, Measurement], Any], count: int, every: int, lost: list[bool]) -> None:
        """Let a controller make `count` steps; `lost` says which measurements need not be waited for."""
        time, stamp, held = 0.0, 0, (0.0,) * 5
        for step in range(0, count, every):
            if not lost[step]:
                joints = wait_for(partial(self.heard.get, stamp), f'the measurement of step {step}')
                held = (joints.position[0], joints.velocity[0], joints.position[1], joints.velocity[1], 0.0)
            force = self._force if lost[step] else joints.effort[1]
            answer = controller(time, Measurement(*held[:4], force, lost[step], None))
            velocity, push = answer if isinstance(answer, tuple) else (answer, math.nan)
            made = self._axis.call(Step, 'step', steps=every, velocity=velocity, force=push)
            assert made.success, made.message
            time, stamp = made.state.time, nanoseconds(made.state.header.stamp)
            self._force = made.state.drive_force


def recorded(run: RecordedRun, topic: Topic, is_decoded: bool = False) -> list[tuple[int, int, Any]]:
    """Return the messages of a topic with their steps and times: as bytes, or their fields (ROS pads some of them)."""
    return [(message.sequence, message.log_time, str(run.bag.decode(message)) if is_decoded else message.data)
            for message in run.bag.messages([run.bag.name_of(topic)])]


@pytest.mark.parametrize('name', CASES)
def test_is_the_run_of_a_node_in_lock_step_to_the_last_bit(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    scene = stickslip.load_scene(case.scene, case.changes)
    own = stickslip.close_loop(Cascade(case.pushes), scene, DURATION, case.rate)
    own.save(tmp_path / 'own')
    words = [f'{key}:={json.dumps(value)}' for key, value in case.changes.items()]
    count, every = len(own.samples['time']) - 1, round(own.scene.time.rate / case.rate)
    lost = own.measured['is_lost'].tolist()
    with live_axis(f'scene:={case.scene}', 'time.mode:=lockstep', 'joint_interface.enabled:=true', *words,
                   folder=tmp_path) as (_, axis):
        loop = LockStep(axis)
        answer = axis.switch('record', True)
        assert answer.success
        folder = tmp_path / answer.message.removeprefix('recording into ')
        loop.run(Cascade(case.pushes), count, every, lost)
        assert axis.switch('record', False).success
        wait_for(lambda: len(loop.heard) >= lost.count(False), 'the latest measurement')
    assert sorted(loop.heard) == [round(k * NANOSECONDS / own.scene.time.rate) for k in range(count + 1) if not lost[k]]
    mine, theirs = read_run(tmp_path / 'own'), read_run(folder)
    assert theirs.scene == mine.scene == own.scene
    for topic in COMPARED:
        assert recorded(mine, topic) == recorded(theirs, topic), topic.name
    assert recorded(mine, topics.RIG_EVENT, True) == recorded(theirs, topics.RIG_EVENT, True)
    assert [(mark.label, round(mark.begin, 9), mark.number) for mark in own.marks] == [
        (mark.label, round(mark.begin, 9), mark.number) for mark in theirs.marks]
    assert verify(mine).difference is None
    assert verify(mine).steps == count + 1
