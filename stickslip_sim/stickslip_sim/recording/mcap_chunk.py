# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A chunk of an MCAP file while it fills, and where its messages stand in it."""

import struct
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import McapRecord, Message
from numpy.typing import NDArray

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


class Span(NamedTuple):
    """Messages of a channel: how many, and their first and last log time (ns)."""

    channel: int
    messages: int
    begin: int
    end: int


class ChunkUnderWay:
    """Collects records; `count` messages with log times (ns) from `begin` to `end`."""

    def __init__(self) -> None:
        self.records = RecordBuilder()
        self.count = self.begin = self.end = 0
        self._entries: dict[int, bytearray] = {}   # by channel, in the order of their first messages

    def add(self, message: Message) -> None:
        """Add a message."""
        time = message.log_time
        self._entries.setdefault(message.channel_id, bytearray()).extend(_ENTRY.pack(time, self.records.count))
        self._note(1, time, time)
        message.write(self.records)

    def add_part(self, block: MessageBlock, first: int, last: int, end: int) -> Iterator[Span]:
        """Add the messages of a block from one place up to another, where the data end; yield what there is of each."""
        begin = int(block.starts[first])
        channels, times = block.channels[first:last], block.times[first:last]
        places = block.starts[first:last] - begin + self.records.count
        entries = np.stack([times, places], axis=1).astype('<u8')
        _, at = np.unique(channels, return_index=True)
        for channel in channels[np.sort(at)].tolist():
            chosen = channels == channel
            self._entries.setdefault(channel, bytearray()).extend(entries[chosen].tobytes())
            of = times[chosen]
            yield Span(channel, len(of), int(of.min()), int(of.max()))
        self._note(last - first, int(times.min()), int(times.max()))
        self.records.write(memoryview(block.data)[begin:end])

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
