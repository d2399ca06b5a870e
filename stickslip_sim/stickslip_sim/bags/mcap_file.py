# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An MCAP file as it is written: the records are those of the library, messages come one by one or in blocks.

The file is to the last byte what the library writes with chunks of zstd, all indexes and checksums.  Its writer
takes messages only one by one, and holds an object for each chunk until the end.
"""

import struct
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import accumulate
from typing import Any, NamedTuple, Protocol
from zlib import crc32

import numpy as np
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from mcap.writer import MCAP0_MAGIC
from numpy.typing import NDArray

from .message_layout import CHANNEL_AT, FRAME_KIND, FRAME_SIZE, frame_at, record_of

# A chunk of an MCAP file while it fills, and where its messages stand in it.

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


# Where the messages stand in the content of a chunk, and those of a channel as rows of an array.

_HEAD = struct.Struct('<BQ')       # of a record: what it is, and its length without this
_LONGEST = 8                       # messages of a step whose sizes may repeat
_WORTH_IT, _AT_ONCE = 4, 256       # steps, at least and at most


class Messages(NamedTuple):
    """The messages in the content of a chunk: where the record of each begins, its size, its channel.

    `others` are where the records that are no messages begin and end.
    """

    data: bytes
    starts: NDArray[np.int64]
    sizes: NDArray[np.int64]
    channels: NDArray[np.int64]
    others: list[tuple[int, int]]

    @property
    def log_times(self) -> NDArray[np.uint64]:
        """When they were logged, ns."""
        return self.rows(np.arange(len(self.starts)), FRAME_KIND)['log_time']

    def on(self, channels: Sequence[int]) -> NDArray[np.intp]:
        """Return the places of the messages on some channels."""
        return np.flatnonzero(np.isin(self.channels, channels))

    def each(self, chosen: NDArray[np.intp]) -> Iterator[tuple[int, tuple[int, int, int], bytes]]:
        """Yield the channel of chosen messages; sequence, log and publish time (ns); and their bytes."""
        for begin, size in zip(self.starts[chosen].tolist(), self.sizes[chosen].tolist()):
            frame = frame_at(self.data, begin)
            yield frame[0], frame[1:], self.data[begin + FRAME_SIZE:begin + size]

    def rows(self, chosen: NDArray[Any], kind: np.dtype[Any]) -> NDArray[Any]:
        """Return the records of chosen messages, all of the size of a row, as an array."""
        bytes_each = np.dtype((np.void, kind.itemsize))
        count = max(len(self.data) - kind.itemsize + 1, 0)
        every: NDArray[Any] = np.ndarray(count, bytes_each, self.data, strides=(1,))
        rows: NDArray[Any] = every[self.starts[chosen]].view(kind)
        return rows


def messages_in(data: bytes) -> Messages:
    """Return the messages in the content of a chunk; raises McapError where its records do not fit into it.

    Their sizes repeat from step to step, as a rule: where they do, many are looked at at once.
    """
    at, end = 0, len(data)
    others: list[tuple[int, int]] = []
    starts: list[NDArray[np.int64]] = []   # in turn some by themselves, and some at once
    ends: list[NDArray[np.int64]] = []
    alone: list[tuple[int, int]] = []      # begins and ends since then
    unpack, size = _HEAD.unpack_from, _HEAD.size
    while at + size <= end:
        kind, length = unpack(data, at)
        begin, at = at, at + size + length
        if at > end:
            break
        if kind != Opcode.MESSAGE:
            others.append((begin, at))
            continue
        alone.append((begin, at))
        period = _period(alone)
        if period and len(again := _repeated(data, at, tuple(stop - start for start, stop in alone[-period:]))):
            for found, places in ((starts, [start for start, _ in alone]), (ends, [stop for _, stop in alone])):
                found.append(np.array(places, np.int64))
            starts.append(again[:-1])
            ends.append(again[1:])
            alone, at = [], int(again[-1])
    whole = np.concatenate([*starts, np.array([start for start, _ in alone], np.int64)])
    sizes = np.concatenate([*ends, np.array([stop for _, stop in alone], np.int64)]) - whole
    if at != end or sizes.min(initial=FRAME_SIZE) < FRAME_SIZE:
        raise McapError('a record that does not fit into its chunk')
    raw = np.frombuffer(data, np.uint8)
    channels = raw[whole + CHANNEL_AT] + 256 * raw[whole + CHANNEL_AT + 1].astype(np.int64)
    return Messages(data, whole, sizes, channels, others)


def _period(places: list[tuple[int, int]]) -> int:
    """Return after how many messages, one behind the other, their sizes came again; 0 where they did not."""
    sizes = [stop - start for start, stop in places[-2 * _LONGEST:]]
    if places[-len(sizes)][0] + sum(sizes) != places[-1][1]:   # other records are between them
        return 0
    return next((k for k in range(1, len(sizes) // 2 + 1) if sizes[-k:] == sizes[-2 * k:-k]), 0)


def _repeated(data: bytes, at: int, sizes: tuple[int, ...]) -> NDArray[np.int64]:
    """Return where messages begin that come behind a place with these sizes, again and again, and where they end."""
    step, heads = sum(sizes), _heads(sizes)
    count = min((len(data) - at) // step, _AT_ONCE)
    if count < _WORTH_IT:
        return np.empty(0, np.int64)
    rows = np.frombuffer(data, heads, count, at)
    differ = np.zeros(count, np.bool_)
    for k, size in enumerate(sizes):
        differ |= (rows[f'kind{k}'] != Opcode.MESSAGE) | (rows[f'length{k}'] != size - _HEAD.size)
    same = int(differ.argmax()) if differ.any() else count
    begins = (at + step * np.arange(same)[:, None] + np.array([0, *accumulate(sizes[:-1])])).ravel()
    return np.append(begins, at + step * same) if same else np.empty(0, np.int64)


@lru_cache
def _heads(sizes: tuple[int, ...]) -> np.dtype[Any]:
    """Return what stands at the heads of messages of these sizes, one behind the other."""
    begins = [0, *accumulate(sizes[:-1])]
    return np.dtype({'names': [f'{name}{k}' for k in range(len(sizes)) for name in ('kind', 'length')],
                     'formats': ['u1', '<u8'] * len(sizes),
                     'offsets': [begin + place for begin in begins for place in (0, 1)], 'itemsize': sum(sizes)})


_COMPRESSION = 'zstd'
_CHECKSUM_SIZE = 4   # bytes, at the end of a footer


class Output(Protocol):
    """Where the bytes go."""

    @property
    def size(self) -> int:
        """Bytes so far."""

    def write(self, data: bytes) -> int:
        """Write all of it; raises OSError."""


class McapFile:
    """Writes an MCAP file into `output`; every method raises OSError when that refuses."""

    def __init__(self, output: Output, chunk_size: int, library: str, level: int) -> None:
        self.on_disk = 0                                     # messages in chunks that were written
        self._output, self._chunk_size = output, chunk_size
        self._crc = 0
        self._chunk = ChunkUnderWay()
        self._compressor = zstandard.ZstdCompressor(level)
        self._summary: dict[Opcode, RecordBuilder] = {
            kind: RecordBuilder() for kind in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.CHUNK_INDEX,
                                               Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX)}
        self._counts: Counter[str] = Counter()               # of records
        self._messages: Counter[int] = Counter()             # in those chunks, by channel
        self._begin = self._end = 0                          # of them, log times, ns
        self._write(MCAP0_MAGIC)
        self._write(bytes_of(Header('ros2', library)))

    def add_schema(self, name: str, encoding: str, data: bytes) -> int:
        """Add the definition of a type; return its number."""
        self._counts['schema'] += 1
        schema = Schema(id=self._counts['schema'], data=data, encoding=encoding, name=name)
        schema.write(self._chunk.records)
        schema.write(self._summary[Opcode.SCHEMA])
        self._end_full_chunk()
        return schema.id

    def add_channel(self, topic: str, encoding: str, schema: int, metadata: Mapping[str, str]) -> int:
        """Add a topic; return the number of its channel."""
        self._counts['channel'] += 1
        channel = Channel(id=self._counts['channel'], topic=topic, message_encoding=encoding, schema_id=schema,
                          metadata=dict(metadata))
        channel.write(self._chunk.records)
        channel.write(self._summary[Opcode.CHANNEL])
        self._end_full_chunk()
        return channel.id

    def add_metadata(self, name: str, data: Mapping[str, str]) -> None:
        """Add a record of names and texts."""
        self._counts['metadata'] += 1
        offset, record = self._output.size, bytes_of(Metadata(name=name, metadata=dict(data)))
        MetadataIndex(offset=offset, length=len(record), name=name).write(self._summary[Opcode.METADATA_INDEX])
        self._write(record)

    def add_attachment(self, log_time: int, name: str, media_type: str, data: bytes) -> None:
        """Add a file."""
        self._counts['attachment'] += 1
        offset = self._output.size
        record = bytes_of(Attachment(create_time=0, log_time=log_time, name=name, media_type=media_type, data=data))
        AttachmentIndex(offset=offset, length=len(record), create_time=0, log_time=log_time, data_size=len(data),
                        name=name, media_type=media_type).write(self._summary[Opcode.ATTACHMENT_INDEX])
        self._write(record)

    def add_message(self, channel: int, log_time: int, data: bytes, publish_time: int, sequence: int) -> None:
        """Add a message; times are ns."""
        self._chunk.add(channel, log_time, data, publish_time, sequence)
        self._end_full_chunk()

    def add_block(self, block: MessageBlock) -> None:
        """Add messages; chunks end where they do when these come one by one."""
        ends = np.append(block.starts[1:], len(block.data))
        first = 0
        while first < len(ends):
            room = self._chunk_size - self._chunk.records.count
            last = min(int(np.searchsorted(ends, block.starts[first] + room, 'right')) + 1, len(ends))
            self._chunk.add_part(block, first, last, int(ends[last - 1]))
            self._end_full_chunk()
            first = last

    def flush(self) -> None:
        """Write the chunk under way, if there is a message in it."""
        if self._chunk.count:
            self._end_chunk()

    def finish(self) -> None:
        """Write what is waiting, and all that stands at the end of such a file."""
        self.flush()
        self._write(bytes_of(DataEnd(self._crc)))
        begin = self._output.size
        summary, offsets = RecordBuilder(), RecordBuilder()
        for kind, records in self._groups():
            start = summary.count
            summary.write(records)
            SummaryOffset(group_opcode=kind, group_start=begin + start, group_length=len(records)).write(offsets)
        offset_start = begin + summary.count
        summary.write(taken(offsets))
        data = taken(summary)
        without = bytes_of(Footer(begin, offset_start, 0))[:-_CHECKSUM_SIZE]
        self._output.write(data)
        self._output.write(bytes_of(Footer(begin, offset_start, crc32(without, crc32(data)))))
        self._output.write(MCAP0_MAGIC)

    def _groups(self) -> list[tuple[Opcode, bytes]]:
        """Return the records of the summary by their kinds, in the order in which they stand there."""
        found = {kind: taken(records) for kind, records in self._summary.items()}
        kinds = 'schema', 'channel', 'attachment', 'metadata', 'chunk'
        counts = {f'{kind}_count': self._counts[kind] for kind in kinds}
        of_statistics = bytes_of(Statistics(
            message_count=self._messages.total(), message_start_time=self._begin, message_end_time=self._end,
            channel_message_counts=dict(self._messages), **counts))
        return [(Opcode.SCHEMA, found[Opcode.SCHEMA]), (Opcode.CHANNEL, found[Opcode.CHANNEL]),
                (Opcode.STATISTICS, of_statistics), (Opcode.CHUNK_INDEX, found[Opcode.CHUNK_INDEX]),
                (Opcode.ATTACHMENT_INDEX, found[Opcode.ATTACHMENT_INDEX]),
                (Opcode.METADATA_INDEX, found[Opcode.METADATA_INDEX])]

    def _end_full_chunk(self) -> None:
        if self._chunk.records.count > self._chunk_size and self._chunk.count:
            self._end_chunk()

    def _end_chunk(self) -> None:
        chunk, data = self._chunk, taken(self._chunk.records)
        packed = self._compressor.compress(data)
        record = bytes_of(Chunk(
            compression=_COMPRESSION, data=packed, message_start_time=chunk.begin, message_end_time=chunk.end,
            uncompressed_crc=crc32(data), uncompressed_size=len(data)))
        index = chunk.indexes()
        offset = self._output.size
        ChunkIndex(
            message_start_time=chunk.begin, message_end_time=chunk.end, chunk_start_offset=offset,
            chunk_length=len(record),
            message_index_offsets={channel: offset + len(record) + at for channel, at in index.offsets.items()},
            message_index_length=len(index.records), compression=_COMPRESSION, compressed_size=len(packed),
            uncompressed_size=len(data)).write(self._summary[Opcode.CHUNK_INDEX])
        self._write(record)
        self._counts['chunk'] += 1
        self._begin = min(self._begin, chunk.begin) if self.on_disk else chunk.begin
        self._end = max(self._end, chunk.end)
        self._messages.update(chunk.counts())
        self.on_disk += chunk.count
        self._chunk = ChunkUnderWay()
        self._write(index.records)

    def _write(self, data: bytes) -> None:
        self._crc = crc32(data, self._crc)
        self._output.write(data)
