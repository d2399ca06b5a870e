# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded messages are those of ROS itself, and files those of the library's own writer: to the byte."""

import itertools
import json
import math
import os
import struct
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Message
from mcap.writer import CompressionType, Writer

from stickslip_sim.bags import topics
from stickslip_sim.bags.mcap_file import McapFile, MessageBlock, bytes_of, messages_in
from stickslip_sim.bags.message_layout import FRAME_SIZE as FRAME
from stickslip_sim.bags.schemas import store_of
from stickslip_sim.core.errors import RecordingError
from stickslip_sim.core.types import Event, Sample
from stickslip_sim.recording import RECORDED, MessageCodec, flat_layout, schema
from stickslip_sim.recording.messages import Packer, header
from tests.support.recorded_runs import friction_force, mode_event, slider_state
from tests.support.repository import ROOT
from tests.support.waiting import wait_for

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
    def test_type_hash_is_the_installed_one_also_without_ros(self, topic: topics.Topic, monkeypatch: pytest.MonkeyPatch
                                                             ) -> None:
        package, kind, name = topic.type.split('/')
        files = [Path(prefix, 'share', package, kind, f'{name}.json') for prefix in
                 os.environ['AMENT_PREFIX_PATH'].split(':')]
        known = json.loads(next(file for file in files if file.is_file()).read_text())['type_hashes']
        installed = {entry['type_name']: entry['hash_string'] for entry in known}[topic.type]
        assert schema(topic.type).hash == installed
        monkeypatch.delenv('AMENT_PREFIX_PATH')
        alone = schema.__wrapped__(topic.type)
        assert (alone.type, alone.hash) == (topic.type, installed)

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


CHUNK = 700
RANDOM = np.random.default_rng(3)
MESSAGES = [Message(channel_id=1 + k % 2 if k % 7 else 3, log_time=5 * k - 3 * (k % 4), publish_time=k, sequence=k,
                    data=bytes(RANDOM.integers(0, 256, 40 + 13 * (k % 5), np.uint8))) for k in range(1, 200)]


class Memory:
    """A file in memory."""

    def __init__(self) -> None:
        self.data = b''

    @property
    def size(self) -> int:
        """Bytes so far."""
        return len(self.data)

    def write(self, data: bytes) -> int:
        """Take bytes."""
        self.data += data
        return len(data)


def of_library() -> bytes:
    """Return what the library's writer makes, flushed in the middle."""
    stream = BytesIO()
    writer = Writer(stream, CHUNK, CompressionType.ZSTD, enable_data_crcs=True)
    writer.start('ros2', 'us')
    writer.add_metadata('first', {'a': 'b'})
    writer.add_attachment(0, 0, 'scene.yaml', 'application/yaml', b'scene')
    for topic in 'abc':
        schema = writer.register_schema(topic, 'ros2msg', b'float64 x')
        writer.register_channel(topic, 'cdr', schema, {'qos': topic})
    for message in MESSAGES:
        if message.sequence == 100:
            writer.flush()   # type: ignore[no-untyped-call]
            writer.add_attachment(0, 9, 'more.json', 'application/json', b'{}')
        writer.add_message(message.channel_id, message.log_time, message.data, message.publish_time, message.sequence)
    writer.add_metadata('last', {})
    writer.finish()   # type: ignore[no-untyped-call]
    return stream.getvalue()


@pytest.mark.parametrize('size', [0, 1, 2, 3, 50, 99])
def test_blocks_and_single_messages_make_the_bytes_of_the_library(size: int) -> None:
    """Chunks end at the same message, wherever a block ends; 0: one by one."""
    output = Memory()
    file = McapFile(output, CHUNK, 'us', 3)
    file.add_metadata('first', {'a': 'b'})
    file.add_attachment(0, 'scene.yaml', 'application/yaml', b'scene')
    for topic in 'abc':
        file.add_channel(topic, 'cdr', file.add_schema(topic, 'ros2msg', b'float64 x'), {'qos': topic})
    for part in (MESSAGES[:99], MESSAGES[99:]):
        for begin in range(0, len(part), size or 1):
            if size:
                file.add_block(block_of(part[begin:begin + size]))
            else:
                message = part[begin]
                file.add_message(message.channel_id, message.log_time, message.data, message.publish_time,
                                 message.sequence)
        if part[0] is MESSAGES[0]:
            file.flush()
            file.add_attachment(9, 'more.json', 'application/json', b'{}')
    assert 0 < file.on_disk < len(MESSAGES)
    file.add_metadata('last', {})
    file.finish()
    assert file.on_disk == len(MESSAGES)
    assert output.data == of_library()


def block_of(messages: list[Message]) -> MessageBlock:
    """Return messages as a block."""
    records = [bytes_of(message) for message in messages]
    return MessageBlock(b''.join(records), np.array([0, *itertools.accumulate(map(len, records[:-1]))]),
                        np.array([message.channel_id for message in messages]),
                        np.array([message.log_time for message in messages]))


_HEAD = struct.Struct('<BQ')
_CHANNEL = struct.Struct('<H')


def message(size: int, channel: int) -> bytes:
    body = _CHANNEL.pack(channel) + bytes(size - _HEAD.size - _CHANNEL.size)
    return _HEAD.pack(Opcode.MESSAGE, len(body)) + body


def other(size: int) -> bytes:
    return _HEAD.pack(Opcode.CHANNEL, size) + bytes(size)


RUNS = st.lists(st.tuples(st.lists(st.integers(FRAME, FRAME + 60), min_size=1, max_size=10),   # sizes of a step
                           st.integers(1, 300),                                                # so many steps
                           st.sampled_from([None, 0, 40])), max_size=5)                        # another record behind


@settings(max_examples=60, deadline=None)
@given(steps=RUNS)
def test_messages_are_where_they_were_put(steps: list[tuple[list[int], int, int | None]]) -> None:
    records, end, places, channels, others = [], 0, [], [], []
    for sizes, count, behind in steps:
        for number in range(count):
            for k, size in enumerate(sizes):
                places.append((end, size))
                channels.append((k + 300 * number) % 65536)
                records.append(message(size, channels[-1]))
                end += size
        if behind is not None:
            records.append(other(behind))
            others.append((end, end + len(records[-1])))
            end = others[-1][1]
    found = messages_in(b''.join(records))
    assert list(zip(found.starts.tolist(), found.sizes.tolist())) == places
    assert found.channels.tolist() == channels
    assert found.others == others


@pytest.mark.parametrize('damage', [
    lambda data: data[:-1], lambda data: data + b'\x05', lambda data: data + _HEAD.pack(Opcode.MESSAGE, 3) + bytes(3),
    lambda data: data + _HEAD.pack(Opcode.MESSAGE, 2 ** 63)])
def test_what_does_not_fit_is_refused(damage: object) -> None:
    whole = b''.join(message(size, 1) for _ in range(50) for size in (93, 125))
    assert len(messages_in(whole).starts) == 100
    with pytest.raises(McapError):
        messages_in(damage(whole))  # type: ignore[operator]
