# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the node reports of commands that it refuses, over DDS and in the bag: of which kind, how many, and why."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.recording import open_bag
from stickslip_sim.simulation import RigEventKind
from tests.support.node_processes import recording_into
from tests.support.replays import rig_events_in
from tests.support.ros_nodes import Client, node_and_client
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros

FORCE = 'force = nan is refused: must be finite and within ±100000.0 N; the previous command stays'
VELOCITY = 'velocity = 5.0 is refused: must be finite and within ±1.0 m/s; the previous command stays'
FAILED = 'fault after a time-out: the drive takes no command until ~/clear_faults or ~/reset'


@contextmanager
def reported(folder: Path, *ros_args: str) -> Iterator[tuple[Client, Callable[[str], Any]]]:
    """Run a node; yield its client, and what waits for a refusal with a text and returns its name, count and text."""
    from stickslip_msgs.msg import RigEvent
    with node_and_client(folder, 'realtime', '-p', 'time.rate:=200.0', *ros_args) as (_, axis):
        heard: list[Any] = []
        axis.node.create_subscription(RigEvent, 'rig_event', heard.append, 100)
        axis.greet()

        def refusal(text: str) -> tuple[str, int, str]:
            def find() -> Any:
                return next((event for event in heard
                             if event.kind == RigEvent.KIND_COMMAND_REFUSED and event.text == text), None)

            event = wait_for(find, text)
            heard.clear()
            return event.id, event.count, event.text

        yield axis, refusal


def test_each_kind_is_reported_with_its_own_reason_once(tmp_path: Path) -> None:
    """A velocity that is refused now is not reported with the reason of a force that was refused long ago."""
    with reported(tmp_path, *recording_into(tmp_path / 'run')) as (axis, refusal):
        axis.send_force(math.nan)
        assert refusal(FORCE) == ('force', 1, FORCE)
        axis.send_velocity(5.0)
        assert refusal(VELOCITY) == ('velocity', 1, VELOCITY)
        assert axis.status('command', lambda values: values['velocity refused'] == '1')
        assert [text for text in diagnosed(axis) if 'refused' in text] == [f'1 refused: {FORCE}',
                                                                           f'1 refused: {VELOCITY}']
    assert [(event.id, event.count, event.text) for event in recorded(tmp_path / 'run')] \
        == [('force', 1, FORCE), ('velocity', 1, VELOCITY)]


def test_a_reset_forgets_what_was_refused(tmp_path: Path) -> None:
    with reported(tmp_path) as (axis, refusal):
        axis.send_force(math.nan)
        refusal(FORCE)
        assert axis.status('command')[1]['force last refusal'] == FORCE
        assert axis.trigger('reset').success
        axis.status('command', lambda values: values['force last refusal'] == 'none')


def test_the_drive_says_why_it_takes_none_after_a_time_out(tmp_path: Path) -> None:
    """They are good commands, refused by the drive: until the fault is cleared."""
    with reported(tmp_path, '-p', 'command.timeout:=0.5', '-p', 'command.on_timeout:=fault', '-p',
              'command.timeout_deceleration:=1.0', *recording_into(tmp_path / 'run')) as (axis, refusal):
        axis.send_velocity(0.004)
        axis.next('slider_state', lambda state: state.drive_velocity == 0.004)
        axis.next('slider_state', lambda state: state.drive_velocity == 0.0)
        axis.send_velocity(0.004)
        assert refusal(FAILED) == ('velocity', 1, FAILED)
        assert axis.status('command')[0].message == FAILED
        assert axis.trigger('clear_faults').success
        axis.send_velocity(0.003)
        axis.next('slider_state', lambda state: state.drive_velocity == 0.003)
    (event,) = recorded(tmp_path / 'run')
    assert (event.id, event.count, event.text) == ('velocity', 1, FAILED)


def diagnosed(axis: Client) -> list[str]:
    """Return what /diagnostics said of the commands, second after second."""
    return [status.message for message in axis.heard['/diagnostics'] for status in message.status
            if status.name == '/feed_axis: command']


def recorded(folder: Path) -> list[Any]:
    """Return the events of refused commands in a bag."""
    return rig_events_in(open_bag(folder), RigEventKind.COMMAND_REFUSED)
