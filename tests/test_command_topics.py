"""Commands are read from the bytes as they come, whatever their sender puts into the header."""

import math
from collections.abc import Iterator
from typing import Any

import pytest

from stickslip_sim.recording import flat_layout, topics
from tests.ros_nodes import rclpy, wait_for

pytestmark = pytest.mark.ros


@pytest.fixture
def node() -> Iterator[Any]:
    from rclpy.context import Context
    context = Context()
    rclpy.init(context=context)
    yield rclpy.create_node('commands_test', context=context)
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
    from rclpy.executors import SingleThreadedExecutor

    from stickslip_sim.ros.topics import command_subscription, publisher
    heard: list[float] = []
    command_subscription(node, topic, heard.append)
    out = publisher(node, topic)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    wait_for(out.get_subscription_count, 'the subscription')
    for frame_id, value in (('', 0.002), ('abc', -1e300), ('axis_drive', math.inf), ('', 5e-324)):
        out.publish(command(topic, field, frame_id, value))
        wait_for(lambda: executor.spin_once(timeout_sec=0.01) or heard, 'the command')
        assert heard.pop() == value


def command(topic: topics.Topic, field: str, frame_id: str, value: float) -> Any:
    from stickslip_sim.ros.topics import message_type
    message = message_type(topic)(**{field: value})
    message.header.frame_id = frame_id
    return message
