# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Floods of commands, controllers that die, commands that are refused: counted and reported; the budget of a step."""

import json
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

from stickslip_msgs.msg import RigEvent
from stickslip_msgs.srv import Step
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import open_bag
from stickslip_sim.simulation import RigEventKind
from tests.support.node_processes import assert_clean, attentive, recording_into
from tests.support.rigs import assert_same_states, made_again, rig_events_in
from tests.support.ros_nodes import Client, live_axis
from tests.support.waiting import DEADLINE, wait_for

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
        with live_axis(folder=tmp_path) as (process, axis):
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
        with live_axis('drive.velocity:=0.001') as (process, axis):
            begin = time.monotonic()
            with Controller(2000.0, math.nan, tmp_path / 'sent') as controller:
                timing = axis.next('timing', lambda timing: timing.total_refused > 2000)
            assert timing.total_refused == timing.total_received <= controller.sent
            assert axis.next('slider_state').drive_velocity == 0.001
            lasted = time.monotonic() - begin
        assert 1 <= process.errors.count('velocity = nan is refused: must be finite and within') <= lasted + 1


class TestController:
    def test_that_dies_is_noticed_and_one_that_restarts_is_obeyed(self, tmp_path: Path) -> None:
        wanted = {'command.timeout': 2.0, 'command.on_timeout': 'ramp_to_zero', 'command.timeout_deceleration': 0.1,
                  'time.rate': 200.0}
        words = [f'{name}:={value}' for name, value in wanted.items()]
        with live_axis(*words, *recording_into(tmp_path / 'run')) as (_, axis):
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
        assert_same_states(recorded, made_again(recorded, load_scene('paper_fig8', wanted)))


def runs_at(velocity: float) -> Callable[[Any], bool]:
    return lambda state: state.drive_velocity == velocity


def has_timed_out(count: int) -> Callable[[Any], bool]:
    return lambda timing: timing.total_timed_out >= count


def test_an_interrupt_amid_many_steps_ends_them_and_closes_the_bag(tmp_path: Path) -> None:
    folder = tmp_path / 'run'
    with live_axis('time.mode:=lockstep', *recording_into(folder)) as (process, axis):
        service = axis.node.create_client(Step, 'feed_axis/step')
        assert service.wait_for_service(10.0)
        service.call_async(Step.Request(steps=100_000, velocity=0.003, force=math.nan))
        wait_for(lambda: axis.heard['slider_state'] and axis.latest('slider_state').step > 500, 'steps')
        assert_clean(*process.end(signal.SIGINT))
    recorded = open_bag(folder)
    last = recorded.columns('/slider_state')['step'][-1]
    assert recorded.is_complete
    assert 500 < last < 100_000
    assert recorded.receipt['timing']['steps'] == last + 1
    assert recorded.receipt['dropped_messages'] == 0


class Refusals:
    """What a node says on rig_event of commands that it refuses."""

    def __init__(self, axis: Client) -> None:
        self._heard: list[RigEvent] = []
        axis.node.create_subscription(RigEvent, 'rig_event', self._heard.append, 100)
        axis.greet()

    def named(self, text: str) -> tuple[str, int]:
        """Return name and count of the refusal with a text."""
        event = wait_for(lambda: [event for event in self._heard
                                  if event.kind == RigEvent.KIND_COMMAND_REFUSED and event.text == text], text)[0]
        self._heard.clear()
        return event.id, event.count


def recorded_refusals(folder: Path) -> list[tuple[str, int, str]]:
    return [(event.id, event.count, event.text)
            for event in rig_events_in(open_bag(folder), RigEventKind.COMMAND_REFUSED)]


class TestRefusals:
    FORCE = 'force = nan is refused: must be finite and within ±100000.0 N; the previous command stays'
    VELOCITY = 'velocity = 5.0 is refused: must be finite and within ±1.0 m/s; the previous command stays'
    FAILED = 'fault after a time-out: the drive takes no command until ~/clear_faults or ~/reset'

    def test_each_kind_is_reported_with_its_own_reason_once_until_a_reset(self, tmp_path: Path) -> None:
        """A velocity that is refused now is not reported with the reason of a force that was refused long ago."""
        with live_axis('time.rate:=200.0', *recording_into(tmp_path / 'run'), prepare=attentive) as (process, axis):
            refusals = Refusals(axis)
            axis.send_force(math.nan)
            assert refusals.named(self.FORCE) == ('force', 1)
            before = len(axis.heard['/diagnostics'])
            axis.send_velocity(5.0)
            assert refusals.named(self.VELOCITY) == ('velocity', 1)
            _, values = axis.status('command', lambda values: values['velocity refused'] == '1', b'\1', before)
            assert values['force last refusal'] == self.FORCE
            said = [status.message for message in axis.heard['/diagnostics'] for status in message.status
                    if status.name == '/feed_axis: command' and 'refused' in status.message]
            assert said == [f'1 refused: {self.FORCE}', f'1 refused: {self.VELOCITY}']
            assert axis.switch('record', False).success
            assert axis.trigger('reset').success
            axis.status('command', lambda values: values['force last refusal'] == 'none')
        assert recorded_refusals(tmp_path / 'run') == [('force', 1, self.FORCE), ('velocity', 1, self.VELOCITY)]
        assert all(text in process.errors for text in (self.FORCE, self.VELOCITY))    # none hushes up the other

    def test_the_drive_says_why_it_takes_none_after_a_time_out(self, tmp_path: Path) -> None:
        """They are good commands, refused by the drive: until the fault is cleared."""
        wanted = ('time.rate:=200.0', 'command.timeout:=0.5', 'command.on_timeout:=fault',
                  'command.timeout_deceleration:=1.0')
        with live_axis(*wanted, *recording_into(tmp_path / 'run'), prepare=attentive) as (_, axis):
            refusals = Refusals(axis)
            axis.send_velocity(0.004)
            axis.next('slider_state', runs_at(0.004))
            axis.next('slider_state', runs_at(0.0))
            axis.send_velocity(0.004)
            assert refusals.named(self.FAILED) == ('velocity', 1)
            assert axis.status('command')[0].message == self.FAILED
            assert axis.trigger('clear_faults').success
            axis.send_velocity(0.003)
            axis.next('slider_state', runs_at(0.003))
        assert recorded_refusals(tmp_path / 'run') == [('velocity', 1, self.FAILED)]


def test_each_part_of_a_step_is_found(tmp_path: Path) -> None:
    path = tmp_path / 'budget.json'
    subprocess.run([sys.executable, '-m', 'benchmarks.budget', '--seconds', '1', '--out', str(path)], timeout=DEADLINE,
                   check=True)
    found = {row['part']: row['p50'] for row in json.loads(path.read_text())['rows']}
    parts = ('hear', 'take', 'simulate', 'rig events', 'pack', 'publish', 'record', 'statistics')
    assert all(found[part] > 0.0 for part in parts)
    assert sum(found[part] for part in parts) < 2.0 * found['the whole step']
