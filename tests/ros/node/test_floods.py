# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Floods of commands, controllers that die, commands that are refused: counted and reported; the budget of a step."""

import json
import math
import resource
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from stickslip_msgs.msg import DriveVelocity, RigEvent
from stickslip_msgs.srv import Step
from stickslip_sim.bags.topics import DRIVE_VELOCITY
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import open_bag
from stickslip_sim.ros.node.endpoints import publisher
from stickslip_sim.simulation import RigEventKind
from tests.support.node_processes import assert_clean, recording_into
from tests.support.rigs import assert_same_states, made_again, rig_events_in
from tests.support.ros_nodes import Client, bare_nodes, live_axis
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE, wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

class Controller:
    """Sends a velocity at a rate, Hz, and then falls silent as one that is killed: the middleware is not told."""

    def __init__(self, node: Any, rate: float, value: float) -> None:
        self.sent = 0
        self._out = publisher(node, DRIVE_VELOCITY)
        self._rate, self._message = rate, DriveVelocity(velocity=value)
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._send)

    def _send(self) -> None:
        begin = time.monotonic()
        while not self._is_over.wait(max(begin + self.sent / self._rate - time.monotonic(), 0.0)):
            self._out.publish(self._message)
            self.sent += 1

    def __enter__(self) -> 'Controller':
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._is_over.set()
        self._thread.join()


@pytest.fixture
def nodes() -> Iterator[list[Any]]:
    """Two for controllers."""
    with bare_nodes('first', 'second') as both:
        yield both


def memory_of(pid: int) -> float:
    """Return the resident memory of a process, MB."""
    pages = int(Path(f'/proc/{pid}/statm').read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


def test_a_flood_of_commands_is_counted_reported_once_a_second_and_costs_no_memory(nodes: list[Any]) -> None:
    with live_axis('drive.velocity:=0.001', prepare=restore_interrupt) as (process, axis):
        begin = time.monotonic()
        with Controller(nodes[0], 2000.0, math.nan) as of_none:
            timing = axis.next('timing', lambda timing: timing.total_refused > 2000)
        assert axis.next('slider_state').drive_velocity == 0.001
        refused, received = timing.total_refused, timing.total_received
        assert refused == received <= of_none.sent
        with Controller(nodes[1], 10_000.0, 0.003) as controller:
            first = axis.next('timing', lambda timing: timing.total_received > received + 1000)
            before = memory_of(process.pid)
            timing = axis.next('timing', lambda timing: timing.total_received > first.total_received + 8000)
            assert timing.step - first.step > 200
            assert axis.next('slider_state').drive_velocity == 0.003
            assert memory_of(process.pid) - before < 5.0
        assert timing.total_refused <= of_none.sent
        assert timing.total_received <= of_none.sent + controller.sent
    lasted = time.monotonic() - begin    # what was on its way was refused after the flood, too
    assert 1 <= process.errors.count('velocity = nan is refused: must be finite and within') <= lasted + 1


def test_a_controller_that_dies_is_noticed_and_one_that_restarts_is_obeyed(tmp_path: Path, nodes: list[Any]) -> None:
    wanted = {'command.timeout': 2.0, 'command.on_timeout': 'ramp_to_zero', 'command.timeout_deceleration': 0.1,
              'time.rate': 200.0}
    words = [f'{name}:={value}' for name, value in wanted.items()]
    with live_axis(*words, *recording_into(tmp_path / 'run')) as (_, axis):
        for count, (node, velocity) in enumerate(zip(nodes, (0.004, 0.006)), 1):
            with Controller(node, 200.0, velocity):
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
        with live_axis('time.rate:=200.0', *recording_into(tmp_path / 'run')) as (process, axis):
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
        with live_axis(*wanted, *recording_into(tmp_path / 'run')) as (_, axis):
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
    subprocess.run([sys.executable, '-m', 'benchmarks.budget', '--rate', '200', '--seconds', '0.3', '--out', str(path)],
                   check=True, timeout=DEADLINE)
    found = {row['part']: row['p50'] for row in json.loads(path.read_text())['rows']}
    parts = ('hear', 'take', 'simulate', 'rig events', 'pack', 'publish', 'record', 'statistics')
    assert all(found[part] > 0.0 for part in parts)
    assert sum(found[part] for part in parts) < 2.0 * found['the whole step']
