# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Commands are read from the bytes as they come, with any header."""

import math
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.bags import topics
from stickslip_sim.core.errors import InputError
from stickslip_sim.recording import flat_layout
from tests.support.node_processes import running
from tests.support.ros_nodes import Client, client, rclpy
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros


@pytest.fixture
def node() -> Iterator[Any]:
    """A node with an executor."""
    from rclpy.context import Context
    from rclpy.executors import SingleThreadedExecutor
    context = Context()
    rclpy.init(context=context)
    executor, it = SingleThreadedExecutor(context=context), rclpy.create_node('commands_test', context=context)
    executor.add_node(it)
    yield it
    executor.shutdown()
    it.destroy_node()
    context.try_shutdown()


@pytest.mark.parametrize('frame_id', ['', 'a', 'abc', 'axis', 'axis_drive'])
@pytest.mark.parametrize(('topic', 'field'), [(topics.DRIVE_VELOCITY, 'velocity'), (topics.EXTERNAL_FORCE, 'force')])
def test_numbers_of_a_message_of_rclpy(topic: topics.Topic, field: str, frame_id: str) -> None:
    from rclpy.serialization import serialize_message
    data = serialize_message(command(topic, field, frame_id, -0.25))
    numbers = flat_layout(topic.type).numbers(data)
    assert numbers == (None if frame_id else [-0.25])


@pytest.mark.parametrize('data', [b'', b'\0\1\0\0', b'\0\0' + bytes(26), bytes(28)])
def test_other_bytes_have_no_numbers(data: bytes) -> None:
    assert flat_layout(topics.DRIVE_VELOCITY.type).numbers(data) is None


@pytest.mark.parametrize(('topic', 'field'), [(topics.DRIVE_VELOCITY, 'velocity'), (topics.EXTERNAL_FORCE, 'force')])
def test_heard_as_sent(node: Any, topic: topics.Topic, field: str) -> None:
    from stickslip_sim.ros.node.endpoints import command_reader, publisher, raw_subscription
    heard: list[float] = []
    read = command_reader(topic)
    raw_subscription(node, topic, lambda data: heard.append(read(data)))
    out = publisher(node, topic)
    wait_for(out.get_subscription_count, 'the subscription')
    for frame_id, value in (('', 0.002), ('abc', -1e300), ('axis_drive', math.inf), ('', 5e-324)):
        out.publish(command(topic, field, frame_id, value))
        wait_for(lambda: node.executor.spin_once(timeout_sec=0.01) or heard, 'the command')
        assert heard.pop() == value


@pytest.mark.parametrize('topic', [topics.DRIVE_VELOCITY, topics.EXTERNAL_FORCE])
@pytest.mark.parametrize(('data', 'reported'), [
    (b'', '0 bytes'), (b'\0\1\0\0', 'its sender is broken'), (b'\0\1\0\0' + b'\xff' * 100, 'its sender is broken'),
    (bytes(5000), 'at most 4096 bytes'),
])
def test_bytes_that_are_no_command(topic: topics.Topic, data: bytes, reported: str) -> None:
    from stickslip_sim.ros.node.endpoints import command_reader
    with pytest.raises(InputError, match=topic.name) as refusal:
        command_reader(topic)(data)
    assert reported in str(refusal.value)


def test_a_node_outlives_senders_that_mean_no_good(tmp_path: Path) -> None:
    """Each publishes what is no message of its type, or far too much; one that is meant well is heard after each."""
    from sensor_msgs.msg import JointState

    from stickslip_sim.ros.node.endpoints import publisher
    bad = [b'', b'\0\1\0\0', b'\0\1\0\0' + b'\xff' * 100, b'\0\1\0\0' + bytes(8) + b'\xff\xff\xff\x7f',
           JointState(name=['axis_drive'] * 100_000, velocity=[1.0] * 100_000)]
    with client() as axis, running('-p', 'joint_interface.enabled:=true', folder=tmp_path):
        axis.connect()
        for topic in (topics.DRIVE_VELOCITY, topics.EXTERNAL_FORCE, topics.JOINT_COMMANDS):
            sender = publisher(axis.node, topic)
            wait_for(sender.get_subscription_count, 'the axis')
            for count, message in enumerate(bad[:None if topic == topics.JOINT_COMMANDS else -1], 1):
                sender.publish(message)
                wait_for(partial(obeys, axis, 1e-3 * count), 'an axis that goes on listening')
        axis.next('timing', lambda timing: timing.total_refused > len(bad))


def obeys(axis: Client, velocity: float) -> bool:
    """Send a velocity, as often as asked: one message may get lost on best-effort topics."""
    axis.send_velocity(velocity)
    return bool(axis.latest('slider_state').drive_velocity == velocity)


def command(topic: topics.Topic, field: str, frame_id: str, value: float) -> Any:
    from stickslip_sim.ros.node.endpoints import message_type
    message = message_type(topic)(**{field: value})
    message.header.frame_id = frame_id
    return message
