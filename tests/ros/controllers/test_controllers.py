# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The example controllers as processes, against the real node of the axis."""

import math
import queue
import signal
import subprocess
import threading
from contextlib import AbstractContextManager, suppress
from pathlib import Path
from typing import Any

import pytest
from rcl_interfaces.msg import Log
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from benchmarks.controllers import close_loop, controllers
from stickslip_msgs.srv import InjectFault, Step
from stickslip_sim.controllers import Moves
from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.ros import lock_step
from stickslip_sim.ros.controllers.controller_node import measurement
from stickslip_sim.ros.node.joints import JointNames
from stickslip_sim.scene.values import scene_text
from tests.support.node_processes import NodeProcess, assert_clean, executable, refusal_of, running
from tests.support.repository import ROOT
from tests.support.ros_nodes import Client, client, live_axis
from tests.support.tool import Capture, answered
from tests.support.waiting import DEADLINE, wait_for

pytestmark = pytest.mark.ros

NAMES = {'cascade': 'cascade_controller', 'compensated': 'compensating_controller'}
BENCH = ['scene:=positioning', 'drive.course:=constant', 'drive.velocity:=0.0',
         'joint_interface.enabled:=true']
BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
LATCHED = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ATTEMPTS = 40


@pytest.mark.parametrize('program', NAMES.values())
def test_help(program: str) -> None:
    done = subprocess.run([executable(program), '--help'], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, '')
    assert done.stdout.startswith(f'usage: {program} ')


OWN = str(ROOT / 'tests/support/own_controllers.py')


@pytest.mark.parametrize(('words', 'reported'), [
    ((), '--controller is missing: must be FILE.py:NAME'),
    (('--controller',), '--controller is missing: must be followed by its value'),
    (('--ctrl', f'{OWN}:Cascade'), "argument = '--ctrl' is refused"),
    (('--controller', f'{OWN}:Cascada'), 'did you mean Cascade?'),
    (('--controller', f'{OWN}:Cascade', '--gain', 'kp=3'), 'Cascade(kp=3)'),
    (('--controller', f'{OWN}:Cascade', '--rate=fast'), "--rate = 'fast' is refused: must be a number"),
    (('--controller', f'{OWN}:Cascade', '--setpoint', 'move.csv'), '--duration is missing'),
])
def test_a_controller_of_the_user_that_is_refused(words: tuple[str, ...], reported: str) -> None:
    assert reported in refusal_of('controller_node', options=words)


def controlled(folder: Path, text: str, **options: Any) -> AbstractContextManager[NodeProcess]:
    """Run a controller of a text in which it is `mine`."""
    (folder / 'mine.py').write_text(text)
    return running(program='controller_node', options=('--controller', f'{folder}/mine.py:mine'), folder=folder,
                   **options)


def test_one_that_fails_in_real_time_stops_the_drive(tmp_path: Path) -> None:
    """Though no measurement comes any more: it is asked with each step, and says so."""
    text = """lost = 0
def mine(t, measured):
    global lost
    lost = lost + 1 if measured.is_lost else 0
    if lost > 300:    # a busy machine loses some
        raise RuntimeError('lost')
    return 0.002
"""
    with live_axis(*BENCH) as (_, axis), controlled(tmp_path, text) as process:
        axis.next('slider_state', lambda state: state.drive_velocity == 0.002)
        assert axis.call(InjectFault, 'inject_fault', kind='encoder_dropout', duration=10.0, value=1.0).success
        code, errors = process.wait()
        assert code == 2
        assert 'controller_node: mine raised RuntimeError: lost (mine.py, line 6), asked after step ' in errors
        axis.next('slider_state', lambda state: state.drive_velocity == 0.0)


def impatient() -> None:
    """Let a controller in lock-step wait a second for an answer, not ten: for `prepare`."""
    lock_step._PATIENCE = 1.0


def test_a_killed_axis_ends_its_controller_in_lock_step(tmp_path: Path) -> None:
    """It asks on for a while, since a network may lose an answer, then says so and ends."""
    text = "def mine(t, measured):\n    open('asked', 'w').close()\n    return 0.002\n"
    with running(*BENCH, 'time.mode:=lockstep') as axis, controlled(tmp_path, text, prepare=impatient) as process:
        wait_for((tmp_path / 'asked').exists, 'the first step')
        axis.end(signal.SIGKILL)
        code, errors = process.wait()
    assert (code, errors.splitlines()[-1]) == (1, 'controller_node: /feed_axis no longer answers: has it ended?')


def test_the_watchdog_stops_the_drive_of_a_killed_controller(tmp_path: Path) -> None:
    with live_axis(*BENCH, 'command.timeout:=0.2', 'command.on_timeout:=ramp_to_zero') as (_, axis):
        with controlled(tmp_path, 'def mine(t, measured):\n    return 0.002\n'):
            axis.next('slider_state', lambda state: state.drive_velocity == 0.002)
        axis.next('slider_state', lambda state: state.drive_velocity == 0.0)


def log_lines(listener: Client) -> list[str]:
    """Return the log lines of all nodes; those to come are added."""
    lines: list[str] = []
    listener.node.create_subscription(Log, '/rosout', lambda log: lines.append(log.msg), LATCHED)
    return lines


def test_without_an_axis_it_says_what_is_missing() -> None:
    with running(program='cascade_controller') as process, client() as listener:
        logged = log_lines(listener)
        wait_for(lambda: any('no /joint_states' in text for text in logged), 'a warning')
        assert_clean(*process.end(signal.SIGTERM))
    assert 'joint_interface.enabled?' in process.errors
    assert process.errors.count('no /joint_states') == 1


class LockStep:
    """Hands the answers of a controller to the axis, one for each step."""

    def __init__(self, axis: Client) -> None:
        self._axis = axis
        self._answers: queue.Queue[JointState] = queue.Queue()
        axis.node.create_subscription(JointState, 'answers', self._answers.put, BEST_EFFORT)
        self._step = axis.node.create_client(Step, 'feed_axis/step')
        assert self._step.wait_for_service(DEADLINE)
        axis.greet()
        wait_for(lambda: axis.node.count_publishers('answers'), 'the controller')

    def begin(self) -> float:
        """Reset the axis until the controller hears it; return the answer to its start."""
        for _ in range(ATTEMPTS):
            assert self._axis.trigger('reset').success
            with suppress(queue.Empty):
                return self._answer_to(0, DEADLINE / ATTEMPTS)
        raise AssertionError('the controller does not answer')

    def step(self, number: int, velocity: float) -> tuple[Any, float]:
        """Make a step under a velocity; return its state, and the answer to it."""
        done = threading.Event()
        future = self._step.call_async(Step.Request(steps=1, velocity=velocity, force=math.nan))
        future.add_done_callback(lambda _: done.set())
        assert done.wait(DEADLINE)
        return future.result().state, self._answer_to(number, DEADLINE)

    def _answer_to(self, number: int, patience: float) -> float:
        while True:
            message = self._answers.get(timeout=patience)
            if message.header.stamp.sec * 1000 + message.header.stamp.nanosec // 1_000_000 == number:
                velocity: float = message.velocity[0]
                return velocity


@pytest.mark.parametrize('kind', NAMES)
def test_in_lock_step_it_is_the_loop_of_the_benchmark_to_the_last_bit(kind: str) -> None:
    steps = 150
    offline = close_loop(controllers()[kind], Moves(), 0.001 * (steps + 1))
    arguments = ['-r', 'joint_commands:=answers', 'use_sim_time:=true']
    with running(*BENCH, 'time.mode:=lockstep'), client() as axis, \
            running(*arguments, program=NAMES[kind], afresh=True) as controller:
        bench = LockStep(axis)
        answer = bench.begin()
        for number in range(1, steps + 1):
            assert answer == offline.commands[number - 1]
            state, answer = bench.step(number, answer)
            expected = offline.samples[number]
            assert (state.position, state.velocity, state.drive_position) == (
                expected.position, expected.velocity, expected.drive_position)
        assert bench.begin() == offline.commands[0]    # time goes back: it begins anew
        assert_clean(*controller.end())
    assert controller.errors.count('the moves begin at 0 m') >= 2


def test_parameters_and_restart_while_it_runs_and_its_end_stops_the_drive(capsys: Capture) -> None:
    """At half the speed of real time, so that a busy machine keeps up."""
    name = NAMES['compensated']
    with live_axis(*BENCH, 'time.mode:=free_run', 'time.factor:=0.5') as (_, axis), running(program=name) as controller:
        axis.next('slider_state', lambda state: state.drive_velocity != 0.0)
        logged = log_lines(axis)
        assert axis.set_parameters(name, velocity_gain=6.0).successful
        assert axis.set_parameters(name, integral_time=math.inf).successful
        assert answered(capsys, 'call', 'set', 'velocity_gain=5', 'integral_time=.inf', '--node', name) == (
            0, 'set: velocity_gain, integral_time\n', '')
        assert 'compensation.share = 1.5' in axis.set_parameters(name, compensation__share=1.5).reason
        assert 'cannot change while the node runs' in axis.set_parameters(name, moves__feed=0.01).reason
        unknown = axis.set_parameters(name, moves__fee=0.01).reason
        assert 'moves.fee = 0.01 is refused: must be one of' in unknown
        assert 'did you mean moves.feed?' in unknown
        assert answered(capsys, 'call', 'restart', '--node', name) == (
            0, 'the moves begin anew with the next measurement\n', '')
        wait_for(lambda: sum('the moves begin at' in line for line in logged) >= 2, 'the moves to begin anew')
        assert_clean(*controller.end())
        axis.next('slider_state', lambda state: state.drive_velocity == 0.0)


@pytest.mark.parametrize(('message', 'reported'), [
    (JointState(), 'axis_slider'),
    (JointState(name=['axis_slider'], position=[0.0], velocity=[0.0]), 'axis_drive'),
    (JointState(name=['axis_slider', 'axis_drive'], position=[0.0, 0.0], velocity=[0.0]), 'as long as name'),
    (JointState(name=['axis_slider', 'axis_drive'], position=[0.0, math.nan], velocity=[0.0, 0.0]), 'encoder lost'),
])
def test_measurements_that_are_none(message: JointState, reported: str) -> None:
    with pytest.raises(InputError, match=reported):
        measurement(message, JointNames())


def test_joints_have_the_prefix_of_the_axis_and_come_in_any_order() -> None:
    message = JointState(name=['axis_slider', 'axis_drive', 'x_axis_drive', 'x_axis_slider'],
                         position=[9.0, 8.0, 2.0, 1.0], velocity=[9.0, 8.0, 4.0, 3.0])
    assert measurement(message, JointNames.of('x_')) == (1.0, 3.0, 2.0, 4.0)
    assert measurement(message, JointNames()) == (9.0, 9.0, 8.0, 8.0)


MODEL, STIFFER = (scene_text(load_scene('positioning', {'axis.drive_stiffness': stiffness}).values)
                  for stiffness in (6e5, 9e5))
MS = 1_000_000


class Measurements:
    """Two of a slide whose spring lets go; the answer to the second crosses part of the gap of friction."""

    def __init__(self, asker: Client) -> None:
        self._heard: dict[int, float] = {}
        self._out = asker.node.create_publisher(JointState, 'joint_states', 10)
        asker.node.create_subscription(JointState, 'joint_commands', self._hear, BEST_EFFORT)

    def answer(self) -> float:
        """Return the velocity, m/s; said until it is answered, for a measurement said again changes nothing."""
        self._answer_to(0, 0.001)
        return self._answer_to(10 * MS, 0.0006)

    def _answer_to(self, nanoseconds: int, spring: float) -> float:
        self._heard.clear()
        message = JointState(name=['axis_slider', 'axis_drive'], position=[0.0, spring], velocity=[1e-4, 1e-4])
        message.header.stamp.nanosec = nanoseconds

        def ask() -> bool:
            self._out.publish(message)
            return nanoseconds in self._heard

        wait_for(ask, 'an answer')
        return self._heard[nanoseconds]

    def _hear(self, message: JointState) -> None:
        self._heard[message.header.stamp.nanosec] = message.velocity[0]


@pytest.mark.parametrize('text', [None, 'no scene', STIFFER])
def test_with_the_file_of_its_model_changed_or_gone(tmp_path: Path, text: str | None) -> None:
    file = tmp_path / 'model.yaml'
    file.write_text(MODEL)
    with running(f'compensation.model:={file}', program=NAMES['compensated']) as controller, client() as asker:
        measurements = Measurements(asker)
        answers = [measurements.answer()]
        file.unlink() if text is None else file.write_text(text)
        for share in (0.5, 0.9):
            assert asker.set_parameters(NAMES['compensated'], compensation__share=share).successful
            answers.append(measurements.answer())
        assert_clean(*controller.end())
    first, other, same = answers
    assert first == same > other
