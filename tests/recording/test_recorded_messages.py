# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded messages are those of ROS itself: bytes, type hashes, quality of service."""

import json
import math
import os
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stickslip_sim.core.errors import RecordingError
from stickslip_sim.core.types import Event, Sample
from stickslip_sim.recording import (
    RECORDED,
    MessageCodec,
    flat_layout,
    schema,
    topics,
)
from stickslip_sim.recording.messages import Packer, header
from stickslip_sim.recording.schemas import store_of
from tests.support.recorded_runs import friction_force, mode_event, slider_state
from tests.support.repository import ROOT
from tests.support.waiting import wait_for

# lark, which rosidl's Python brings in, imports modules that Python wants to rename.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

Values = dict[str, Any]

STAMPS = st.integers(0, 2**31 * 10**9 - 1)
STEPS = st.integers(0, 2**64 - 1)
DIRECTIONS = st.integers(-1, 1)
SAMPLES = st.builds(Sample, direction=DIRECTIONS)   # any float: NaN, infinity, -0, denormal
EVENTS = st.builds(Event, direction=DIRECTIONS)


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
        ours = codec.encode(topic.type, values)
        same_as_rclpy(codec, topic, ours, values)
        assert deserialize_message(ours, type(message)) == message
        assert values_of(codec.decode(topic.type, serialize_message(message)), like=message) == values

    @given(STAMPS, STEPS, SAMPLES)
    @pytest.mark.parametrize(('topic', 'fields'), [(topics.SLIDER_STATE, slider_state),
                                                   (topics.FRICTION_FORCE, friction_force)])
    def test_samples_become_the_bytes_of_rclpy(self, codec: MessageCodec, topic: topics.Topic, fields: Any,
                                               stamp_ns: int, step: int, sample: Sample) -> None:
        same_as_rclpy(codec, topic, Packer(topic).pack(stamp_ns, step, sample), fields(step, sample, stamp_ns))

    @given(STAMPS, STEPS, EVENTS)
    def test_events_become_the_bytes_of_rclpy(self, codec: MessageCodec, stamp_ns: int, step: int,
                                              event: Event) -> None:
        topic = topics.MODE_EVENT
        same_as_rclpy(codec, topic, Packer(topic).pack(stamp_ns, step, event), mode_event(step, event, stamp_ns))

    @given(STAMPS, st.floats())
    @pytest.mark.parametrize(('topic', 'field'), [(topics.DRIVE_VELOCITY, 'velocity'),
                                                  (topics.EXTERNAL_FORCE, 'force')])
    def test_commands_become_the_bytes_of_rclpy(self, codec: MessageCodec, topic: topics.Topic, field: str,
                                                stamp_ns: int, value: float) -> None:
        data = flat_layout(topic.type).pack(stamp_ns, value)
        same_as_rclpy(codec, topic, data, {'header': header(stamp_ns), field: value})

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
            for topic in topics.recorded_topics(node.get_namespace()):
                infos = wait_for(partial(node.get_publishers_info_by_topic, topic.name), 'its publisher')
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

    @pytest.mark.parametrize('topic', RECORDED, ids=lambda t: t.name)
    def test_without_ros_types_are_the_same(self, topic: topics.Topic, monkeypatch: pytest.MonkeyPatch) -> None:
        installed = schema(topic.type)
        monkeypatch.delenv('AMENT_PREFIX_PATH')
        alone = schema.__wrapped__(topic.type)
        assert (alone.type, alone.hash) == (installed.type, installed.hash)

    def test_unknown_type(self) -> None:
        with pytest.raises(RecordingError, match='no definition of stickslip_msgs/msg/Nothing in AMENT_PREFIX_PATH; '):
            schema('stickslip_msgs/msg/Nothing')


def same_as_rclpy(codec: MessageCodec, topic: topics.Topic, data: bytes, values: Values) -> None:
    """Assert that these are the bytes of a message with these fields, as rclpy makes them."""
    from rclpy.serialization import serialize_message
    theirs = serialize_message(filled(ros_class(topic.type)(), values))
    padding = padding_of(codec, topic.type, values)
    assert len(data) == len(theirs)
    assert [b for b, pad in zip(data, padding) if not pad] == [b for b, pad in zip(theirs, padding) if not pad]


def filled(message: Any, values: Values) -> Any:
    """Return a ROS message with these fields."""
    for name, value in values.items():
        setattr(message, name, filled(getattr(message, name), value) if isinstance(value, dict) else value)
    return message


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
    """Find which bytes are padding: those that encoding leaves alone (rclpy leaves in them what was there before)."""
    message = codec.decode(type_name, codec.encode(type_name, values))
    store = store_of({type_name: schema(type_name).text})
    definition = store.get_msgdef(type_name)
    size = definition.getsize_cdr(0, message, store)
    buffers = [bytearray([fill]) * size for fill in (0, 255)]
    for buffer in buffers:
        definition.serialize_cdr_le(memoryview(buffer), 0, message, store)
    return [False] * 4 + [a != b for a, b in zip(*buffers)]
