# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An MCAP file as it is written: the records are those of the library, messages come one by one or in blocks.

The file is to the last byte what the library writes with chunks of zstd, all indexes and checksums.  Its writer
takes messages only one by one, and holds an object for each chunk until the end.
"""

from collections import Counter
from collections.abc import Mapping
from typing import Protocol
from zlib import crc32

import numpy as np
import zstandard
from mcap.data_stream import RecordBuilder
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
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from mcap.writer import MCAP0_MAGIC

from .mcap_chunk import ChunkUnderWay, MessageBlock, bytes_of, taken

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

    def __init__(self, output: Output, chunk_size: int, library: str) -> None:
        self.on_disk = 0                                     # messages in chunks that were written
        self._output, self._chunk_size = output, chunk_size
        self._crc = 0
        self._chunk = ChunkUnderWay()
        self._compressor = zstandard.ZstdCompressor()
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
