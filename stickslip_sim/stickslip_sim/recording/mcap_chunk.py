# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A chunk of an MCAP file while it fills, and where its messages stand in it."""

import struct
from typing import NamedTuple

import numpy as np
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import McapRecord
from numpy.typing import NDArray

from .message_record import record_of

_ENTRY = struct.Struct('<QQ')   # of an index: log time, place in the chunk


class MessageBlock(NamedTuple):
    """Records of messages one behind the other: where each begins, its channel and its log time (ns)."""

    data: bytes
    starts: NDArray[np.int64]
    channels: NDArray[np.int64]
    times: NDArray[np.int64]


class ChunkIndexes(NamedTuple):
    """The indexes of the messages in a chunk, one of each channel, and where each begins."""

    records: bytes
    offsets: dict[int, int]


class ChunkUnderWay:
    """Collects records; `count` messages with log times (ns) from `begin` to `end`."""

    def __init__(self) -> None:
        self.records = RecordBuilder()
        self.count = self.begin = self.end = 0
        self._entries: dict[int, bytearray] = {}   # by channel, in the order of their first messages

    def add(self, channel: int, log_time: int, data: bytes, publish_time: int, sequence: int) -> None:
        """Add a message."""
        entries = self._entries.get(channel)
        if entries is None:
            entries = self._entries[channel] = bytearray()
        entries += _ENTRY.pack(log_time, self.records.count)
        self._note(1, log_time, log_time)
        self.records.write(record_of(channel, sequence, log_time, publish_time, data))

    def add_part(self, block: MessageBlock, first: int, last: int, end: int) -> None:
        """Add the messages of a block from one place up to another, where the data end."""
        begin = int(block.starts[first])
        channels, times = block.channels[first:last], block.times[first:last]
        places = block.starts[first:last] - begin + self.records.count
        entries = np.stack([times, places], axis=1).astype('<u8')
        _, at = np.unique(channels, return_index=True)
        for channel in channels[np.sort(at)].tolist():
            self._entries.setdefault(channel, bytearray()).extend(entries[channels == channel].tobytes())
        self._note(last - first, int(times.min()), int(times.max()))
        self.records.write(memoryview(block.data)[begin:end])

    def counts(self) -> dict[int, int]:
        """Return how many messages there are, by channel."""
        return {channel: len(entries) // _ENTRY.size for channel, entries in self._entries.items()}

    def indexes(self) -> ChunkIndexes:
        """Return the indexes of its messages."""
        builder, offsets = RecordBuilder(), {}
        for channel, entries in self._entries.items():
            offsets[channel] = builder.count
            builder.start_record(Opcode.MESSAGE_INDEX)
            builder.write2(channel)
            builder.write4(len(entries))
            builder.write(entries)
            builder.finish_record()   # type: ignore[no-untyped-call]
        return ChunkIndexes(taken(builder), offsets)

    def _note(self, count: int, begin: int, end: int) -> None:
        self.begin = min(self.begin, begin) if self.count else begin
        self.end = max(self.end, end)
        self.count += count


def bytes_of(record: McapRecord) -> bytes:
    """Return a record as the library writes it."""
    builder = RecordBuilder()
    record.write(builder)
    return taken(builder)


def taken(builder: RecordBuilder) -> bytes:
    """Return what a builder has collected; it is empty then."""
    data: bytes = builder.end()   # type: ignore[no-untyped-call]
    return data
