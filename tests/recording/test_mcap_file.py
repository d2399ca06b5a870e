# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The file as it is written: the same bytes as the library's own writer makes, one by one or in blocks."""

import itertools
from io import BytesIO

import numpy as np
import pytest
from mcap.records import Message
from mcap.writer import CompressionType, Writer

from stickslip_sim.recording.mcap_chunk import MessageBlock, bytes_of
from stickslip_sim.recording.mcap_file import McapFile

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
    file = McapFile(output, CHUNK, 'us')
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
