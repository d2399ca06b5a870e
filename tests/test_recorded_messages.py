"""Recorded messages are those of ROS itself: bytes, type hashes, quality of service."""

import json
import math
import os
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.errors import RecordingError
from stickslip_sim.recording import (
    RECORDED,
    MessageCodec,
    schema,
    topics,
)
from tests.recorded_runs import wait_for

# lark, which rosidl's Python brings in, imports modules that Python wants to rename.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

ROOT = Path(__file__).parent.parent
Values = dict[str, Any]


@pytest.fixture(scope='module')
def codec() -> MessageCodec:
    return MessageCodec(topic.type for topic in RECORDED)


class TestMessages:
    """CDR bytes and type hashes are those of ROS itself."""

    @pytest.mark.parametrize('frame_id', ['', 'a', 'odd', 'even', 'axis_slider'])
    @pytest.mark.parametrize('topic', [t for t in RECORDED if t.type.startswith('stickslip_')], ids=lambda t: t.name)
    def test_bytes_of_rclpy(self, codec: MessageCodec, topic: topics.Topic, frame_id: str) -> None:
        from rclpy.serialization import deserialize_message, serialize_message
        message = distinct(ros_class(topic.type), frame_id)
        values = values_of(message)
        ours, theirs = codec.encode(topic.type, values), serialize_message(message)
        padding = padding_of(codec, topic.type, values)
        assert len(ours) == len(theirs)
        assert [b for b, pad in zip(ours, padding) if not pad] == [b for b, pad in zip(theirs, padding) if not pad]
        assert deserialize_message(ours, type(message)) == message
        assert values_of(codec.decode(topic.type, theirs), like=message) == values

    @pytest.mark.parametrize('topic', RECORDED, ids=lambda t: t.name)
    def test_type_hash_is_the_installed_one(self, topic: topics.Topic) -> None:
        package, kind, name = topic.type.split('/')
        files = [Path(prefix, 'share', package, kind, f'{name}.json') for prefix in
                 os.environ['AMENT_PREFIX_PATH'].split(':')]
        known = json.loads(next(file for file in files if file.is_file()).read_text())['type_hashes']
        assert {entry['type_name']: entry['hash_string'] for entry in known}[topic.type] == schema(topic.type).hash

    @pytest.mark.ros
    def test_qos_and_type_hash_are_those_of_the_graph(self) -> None:
        import rclpy
        from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
        rclpy.init(args=[])
        try:
            node = rclpy.create_node('recording_test')
            for topic in RECORDED:
                node.create_publisher(ros_class(topic.type), topic.name, QoSProfile(
                    depth=topic.qos.depth, reliability=QoSReliabilityPolicy[topic.qos.reliability.upper()],
                    durability=QoSDurabilityPolicy[topic.qos.durability.upper()]))
            for topic in topics.recorded(node.get_namespace()):
                infos = wait_for(lambda name=topic.name: node.get_publishers_info_by_topic(name))
                info = next(info for info in infos if info.topic_type == topic.type)
                assert str(info.topic_type_hash) == schema(topic.type).hash
                found, wanted = info.qos_profile, topic.qos.as_yaml()
                assert found.reliability.name.lower() == wanted['reliability']
                assert found.durability.name.lower() == wanted['durability']
                assert found.liveliness.name.lower() == wanted['liveliness']
                for name in ('deadline', 'lifespan', 'liveliness_lease_duration'):
                    part: Any = wanted[name]
                    assert getattr(found, name).nanoseconds == part['sec'] * 10**9 + part['nsec']
            node.destroy_node()
        finally:
            rclpy.shutdown()

    def test_a_definition_is_its_file_and_all_it_needs(self) -> None:
        first, *rest = schema('stickslip_msgs/msg/RunInfo').text.split('\n' + '=' * 80 + '\nMSG: ')
        assert first == (ROOT / 'stickslip_msgs/msg/RunInfo.msg').read_text()
        assert [part.split('\n')[0] for part in rest] == ['builtin_interfaces/Time', 'std_msgs/Header']

    def test_unknown_type(self) -> None:
        with pytest.raises(RecordingError, match='no definition of stickslip_msgs/msg/Nothing in AMENT_PREFIX_PATH; '):
            schema('stickslip_msgs/msg/Nothing')


def ros_class(type_name: str) -> Any:
    package, kind, name = type_name.split('/')
    return getattr(__import__(f'{package}.{kind}', fromlist=[name]), name)


def distinct(cls: Any, frame_id: str) -> Any:
    """Return a message with another value in every field, some of them not finite."""
    message = cls()
    message.header.stamp.sec, message.header.stamp.nanosec = 1_700_000_000, 123_456_789
    message.header.frame_id = frame_id
    for i, (name, kind) in enumerate(cls.get_fields_and_field_types().items()):
        if kind == 'string':
            setattr(message, name, 'é' + 'x' * i)
        elif kind == 'double':
            setattr(message, name, math.inf if name == 'rest_time' else -1.1 * i)
        elif kind.startswith(('uint', 'int')):
            setattr(message, name, -1 if kind[0] == 'i' else {'uint8': 200, 'uint64': 2**60}[kind] + i)
    return message


def values_of(message: Any, like: Any = None) -> Values:
    """Return a message as plain mappings; the fields are those of the ROS message `like`."""
    like = message if like is None else like
    return {
        name: values_of(getattr(message, name), getattr(like, name)) if '/' in kind else getattr(message, name)
        for name, kind in like.get_fields_and_field_types().items()
    }


def padding_of(codec: MessageCodec, type_name: str, values: Values) -> list[bool]:
    """Tell which bytes are padding: those that encoding leaves alone (rclpy leaves in them what was there before)."""
    message = codec._message(type_name, values)
    store = codec._store
    definition = store.get_msgdef(type_name)
    size = definition.getsize_cdr(0, message, store)
    buffers = [bytearray([fill]) * size for fill in (0, 255)]
    for buffer in buffers:
        definition.serialize_cdr_le(memoryview(buffer), 0, message, store)
    return [False] * 4 + [a != b for a, b in zip(*buffers)]
