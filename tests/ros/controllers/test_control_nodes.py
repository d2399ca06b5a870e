# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The example controllers as processes, against the real node of the axis."""

import math
import queue
import signal
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import pytest

from benchmarks.closed_loop import close_loop
from benchmarks.controllers import AXIS, controllers
from stickslip_sim.controllers import Moves
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import EventKind
from tests.support.busy_machine import judged_by_time
from tests.support.forked_programs import ended_at_once
from tests.support.node_processes import assert_clean, executable, running
from tests.support.ros_nodes import Client, client
from tests.support.tool import Capture, answered
from tests.support.waiting import DEADLINE, wait_for

from rcl_interfaces.msg import Log  # isort: skip  # after tests.support.ros_nodes, which skips without ROS
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy  # isort: skip
from sensor_msgs.msg import JointState  # isort: skip

from stickslip_msgs.srv import Step
from stickslip_sim.ros.controllers.controller_node import measurement
from stickslip_sim.ros.node.joints import JointNames

pytestmark = pytest.mark.ros

NAMES = {'cascade': 'cascade_controller', 'compensated': 'compensating_controller'}
BENCH = ['-p', 'scene:=positioning', '-p', 'drive.course:=constant', '-p', 'drive.velocity:=0.0',
         '-p', 'joint_interface.enabled:=true']
BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
LATCHED = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ATTEMPTS = 40


def refused(program: str, *ros_args: str) -> str:
    """Return the one line with which a program refuses to start."""
    code, errors = ended_at_once(program, '--ros-args', *ros_args)
    assert code == 2, errors
    (line,) = errors.splitlines()
    assert line.startswith(f'{program}: ')
    return line


class TestRefusedStart:
    @pytest.mark.parametrize(('argument', 'reported'), [
        ('moves.feed:=-0.001', ['moves.feed = -0.001', '>= 1e-12']),
        ('moves.fed:=0.001', ['moves.fed = 0.001', 'did you mean moves.feed?']),
        ('position_gain:=.nan', ['position_gain = nan']),
        ('integral_time:=0.0', ['integral_time = 0.0', 'or .inf']),
        ('compensation.share:=0.5', ['compensation.share = 0.5', 'one of moves.travel']),
    ])
    def test_parameters(self, argument: str, reported: list[str]) -> None:
        line = refused('cascade_controller', '-p', argument)
        assert all(word in line for word in reported), line

    def test_a_model_that_is_no_scene(self) -> None:
        line = refused('compensating_controller', '-p', 'compensation.model:=paper_fig9')
        assert 'compensation.model' in line
        assert 'did you mean paper_fig8?' in line

    @pytest.mark.parametrize('program', NAMES.values())
    def test_help(self, program: str) -> None:
        done = subprocess.run([executable(program), '--help'], capture_output=True, text=True, timeout=60, check=False)
        assert (done.returncode, done.stderr) == (0, '')
        assert done.stdout.startswith(f'usage: {program} ')


def log_lines(listener: Client) -> list[str]:
    """Return the log lines of all nodes; those to come are added."""
    lines: list[str] = []
    listener.node.create_subscription(Log, '/rosout', lambda log: lines.append(log.msg), LATCHED)
    return lines


def test_without_an_axis_it_says_what_is_missing() -> None:
    with running(program='cascade_controller') as process, client() as listener:
        logged = log_lines(listener)
        wait_for(lambda: any('no /joint_states' in text for text in logged), 'a warning')
        code, errors = process.end(signal.SIGTERM)
    assert code == 0, errors
    assert 'joint_interface.enabled?' in errors
    assert errors.count('no /joint_states') == 1


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
    steps = 400
    offline = close_loop(AXIS, controllers()[kind], Moves(), 0.001 * (steps + 1))
    arguments = ['-r', 'joint_commands:=answers', '-p', 'use_sim_time:=true']
    with running(*BENCH, '-p', 'time.mode:=lockstep'), client() as axis, \
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
        code, errors = controller.end()
    assert code == 0, errors
    assert errors.count('the moves begin at 0 m') >= 2


@contextmanager
def driven(kind: str) -> Iterator[tuple[Client, Any]]:
    """Run axis and controller at half the speed of real time, so that a busy machine keeps up."""
    with running(*BENCH, '-p', 'time.mode:=free_run', '-p', 'time.factor:=0.5') as bench, client() as axis:
        axis.connect()
        with running(program=NAMES[kind]) as controller:
            axis.next('slider_state', lambda state: state.drive_velocity != 0.0)
            yield axis, controller
        assert_clean(*bench.end())


def sticks_in_slow_feed(kind: str) -> int:
    """Let a controller move the axis by 0.8 mm, end it, and see the drive stop."""
    with driven(kind) as (axis, controller):
        last = axis.next('slider_state', lambda state: state.position > 0.0008)
        code, errors = controller.end()
        assert code == 0, errors
        assert 'Traceback' not in errors
        axis.next('slider_state', lambda state: state.drive_velocity == 0.0)
        return sum(event.kind == EventKind.STICK and event.step <= last.step for event in axis.heard['mode_event'])


@pytest.mark.slow
def test_over_dds_the_compensated_one_sticks_less() -> None:
    with judged_by_time(0.05):
        plain, compensated = (sticks_in_slow_feed(kind) for kind in NAMES)
        assert plain >= 3
        assert compensated <= plain / 2    # none on a machine that keeps up


def test_parameters_and_restart_while_it_runs(capsys: Capture) -> None:
    with driven('compensated') as (axis, controller):
        name, logged = NAMES['compensated'], log_lines(axis)
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
        code, errors = controller.end()
    assert code == 0, errors


@pytest.mark.parametrize(('message', 'reported'), [
    (JointState(), 'axis_slider'),
    (JointState(name=['axis_slider'], position=[0.0], velocity=[0.0]), 'axis_drive'),
    (JointState(name=['axis_slider', 'axis_drive'], position=[0.0, 0.0], velocity=[0.0]), 'as long as name'),
    (JointState(name=['axis_slider', 'axis_drive'], position=[0.0, math.nan], velocity=[0.0, 0.0]), 'encoder lost'),
])
def test_measurements_that_are_none(message: JointState, reported: str) -> None:
    with pytest.raises(InputError, match=reported):
        measurement(message, JointNames())


def test_joints_have_the_prefix_of_the_axis() -> None:
    message = JointState(name=['axis_slider', 'axis_drive', 'x_axis_slider', 'x_axis_drive'],
                         position=[9.0, 9.0, 1.0, 2.0], velocity=[9.0, 9.0, 3.0, 4.0])
    assert measurement(message, JointNames.of('x_')) == (1.0, 3.0, 2.0, 4.0)


def test_joints_come_in_any_order() -> None:
    message = JointState(name=['other', 'axis_drive', 'axis_slider'], position=[9.0, 2.0, 1.0],
                         velocity=[9.0, 4.0, 3.0])
    assert measurement(message, JointNames()) == (1.0, 3.0, 2.0, 4.0)
