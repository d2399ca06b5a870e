# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Floods of commands, controllers that die, an interrupt amid many steps: counted, noticed, and the bag is whole."""

import math
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import open_bag
from stickslip_sim.scene import Scene
from stickslip_sim.scene.ros_yaml import plain_value
from stickslip_sim.simulation import RigEventKind
from tests.support.node_processes import recording_into, running
from tests.support.replays import assert_same_states, made_again, rig_events_in
from tests.support.ros_nodes import client, node_and_client
from tests.support.waiting import wait_for

from stickslip_msgs.srv import Step  # isort: skip

pytestmark = [pytest.mark.ros, pytest.mark.slow]
_SENDER = """
import sys, time, rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from stickslip_msgs.msg import DriveVelocity

rate, value = map(float, sys.argv[1:])
rclpy.init()
node = Node('controller')
quality = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
out = node.create_publisher(DriveVelocity, 'drive_velocity', quality)
begin, count = time.monotonic(), 0
while True:
    out.publish(DriveVelocity(velocity=value))
    count += 1
    print(count, flush=count % 100 == 0)
    time.sleep(max(begin + count / rate - time.monotonic(), 0.0))
"""


class Controller:
    """A process that sends a velocity at a rate, Hz, and is killed at the end; then `sent` is the most that it sent."""

    def __init__(self, rate: float, value: float, out: Path) -> None:
        self.sent = 0
        self._out = out
        with out.open('w') as stream:
            self._process = subprocess.Popen([sys.executable, '-c', _SENDER, str(rate), str(value)], stdout=stream)

    def __enter__(self) -> 'Controller':
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait()
        self.sent = len(self._out.read_text().splitlines()) + 100    # it says so by the hundred


def memory_of(pid: int) -> float:
    """Return the resident memory of a process, MB."""
    pages = int(Path(f'/proc/{pid}/statm').read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


class TestFlood:
    def test_of_commands_is_counted_and_costs_no_memory(self, tmp_path: Path) -> None:
        with node_and_client(tmp_path, 'realtime') as (process, axis):
            with Controller(10_000.0, 0.003, tmp_path / 'sent') as controller:
                first = axis.next('timing', lambda timing: timing.total_received > 1000)
                before = memory_of(process.pid)
                timing = axis.next('timing', lambda timing: timing.total_received > first.total_received + 8000)
                assert timing.step - first.step > 200
                assert axis.next('slider_state').drive_velocity == 0.003
                assert memory_of(process.pid) - before < 5.0
            assert timing.total_refused == 0
            assert timing.total_received <= controller.sent

    def test_of_what_is_no_number_is_refused_counted_and_reported_once_a_second(self, tmp_path: Path) -> None:
        with running('-p', 'drive.velocity:=0.001') as process, client() as axis:
            axis.connect()
            begin = time.monotonic()
            with Controller(2000.0, math.nan, tmp_path / 'sent') as controller:
                timing = axis.next('timing', lambda timing: timing.total_refused > 2000)
            assert timing.total_refused == timing.total_received <= controller.sent
            assert axis.next('slider_state').drive_velocity == 0.001
            lasted = time.monotonic() - begin
            code, errors = process.end()
        assert code == 0
        assert 1 <= errors.count('velocity = nan is refused: must be finite and within') <= lasted + 1


class TestController:
    def test_that_dies_is_noticed_and_one_that_restarts_is_obeyed(self, tmp_path: Path) -> None:
        wanted = ['-p', 'command.timeout:=2.0', '-p', 'command.on_timeout:=ramp_to_zero', '-p',
                  'command.timeout_deceleration:=0.1', '-p', 'time.rate:=200.0']
        with node_and_client(tmp_path, 'realtime', *wanted, *recording_into(tmp_path / 'run')) as (_, axis):
            for count, velocity in enumerate((0.004, 0.006), 1):
                with Controller(200.0, velocity, tmp_path / 'sent'):
                    axis.next('slider_state', runs_at(velocity))
                axis.next('slider_state', runs_at(0.0))
                timing = axis.next('timing', has_timed_out(count))
                assert timing.total_timed_out == count
                assert axis.status('command')[0].message.startswith('timed out: no drive velocity comes')
        recorded = open_bag(tmp_path / 'run')
        of_the_rig = set(RigEventKind) - {RigEventKind.TIME_LOST}    # which says how fast the machine was
        kinds = [event.kind for event in rig_events_in(recorded, *of_the_rig)]
        assert kinds == [RigEventKind.COMMAND_TIMEOUT, RigEventKind.COMMAND_RESUMED, RigEventKind.COMMAND_TIMEOUT]
        assert '2 time-outs' in recorded.receipt['timing']['verdict']
        assert_same_states(recorded, made_again(recorded, scene_with(wanted)))


def runs_at(velocity: float) -> Callable[[Any], bool]:
    return lambda state: state.drive_velocity == velocity


def has_timed_out(count: int) -> Callable[[Any], bool]:
    return lambda timing: timing.total_timed_out >= count


def scene_with(arguments: list[str]) -> Scene:
    """Return the default scene changed by arguments as ROS takes them."""
    pairs = [argument.split(':=') for argument in arguments if ':=' in argument]
    return load_scene('paper_fig8', {name: plain_value(value) for name, value in pairs})


class TestInterrupt:
    def test_amid_many_steps_ends_them_and_closes_the_bag(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        with running('-p', 'time.mode:=lockstep', *recording_into(folder)) as process, client() as axis:
            axis.connect(is_moving=False)
            service = axis.node.create_client(Step, 'feed_axis/step')
            assert service.wait_for_service(10.0)
            service.call_async(Step.Request(steps=100_000, velocity=0.003, force=math.nan))
            wait_for(lambda: axis.heard['slider_state'] and axis.latest('slider_state').step > 500, 'steps')
            code, errors = process.end(signal.SIGINT)
        assert (code, 'Traceback' in errors) == (0, False), errors
        recorded = open_bag(folder)
        assert recorded.is_complete
        last = recorded.columns('/slider_state')['step'][-1]
        assert 500 < last < 100_000
        assert recorded.receipt['timing']['steps'] == last + 1
        assert recorded.receipt['dropped_messages'] == 0
