# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Bags that are nearly whole: taken apart into records, changed, and put together again."""

import struct
from collections.abc import Sequence
from io import BytesIO
from typing import NamedTuple

import lz4.frame
import zstandard
from hypothesis import strategies as st
from hypothesis.strategies import DrawFn
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Chunk
from mcap.stream_reader import get_chunk_data_stream

from .made_up_texts import WORDS

MAGIC = b'\x89MCAP0\r\n'
_KEPT = (Opcode.HEADER, Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE, Opcode.ATTACHMENT, Opcode.METADATA)
_END = [(Opcode.DATA_END, bytes(4)), (Opcode.FOOTER, bytes(20))]
_EXTREMES = [0, 1, 2, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 2**31 - 1, 2**31, 2**32 - 1, 2**62, 2**63, 2**64 - 1]
_PACK = {'zstd': zstandard.compress, 'lz4': lz4.frame.compress, '': bytes}


class Record(NamedTuple):
    """A record of an MCAP file; `length` is what it says of its content, None: the truth."""

    opcode: int
    content: bytes
    length: int | None = None


def records_of(data: bytes) -> list[Record]:
    """Return the records of an MCAP file, those of its chunks in their place, without its index."""
    found: list[Record] = []
    for record in _split(data[len(MAGIC):-len(MAGIC)]):
        if record.opcode == Opcode.CHUNK:
            stream, size = get_chunk_data_stream(Chunk.read(ReadDataStream(BytesIO(record.content))))
            found += _split(stream.read(size))
        elif record.opcode in _KEPT:
            found.append(record)
    index = next(k for k in reversed(range(len(found))) if found[k].opcode == Opcode.MESSAGE)
    return [record for k, record in enumerate(found)
            if k < index or record.opcode not in (Opcode.SCHEMA, Opcode.CHANNEL)]


def file_of(records: Sequence[Record]) -> bytes:
    """Return an MCAP file of records."""
    return MAGIC + _joined([*records, *(Record(*end) for end in _END)]) + MAGIC


@st.composite
def changed(draw: DrawFn, bags: Sequence[bytes]) -> bytes:
    """Return one of some MCAP files with changes: in its records, in chunks around them, or in its bytes."""
    data = draw(st.sampled_from(bags))
    if draw(st.booleans()):
        records = records_of(data)
        for _ in range(draw(st.integers(1, 4))):
            _change(draw, records)
        data = file_of(_in_a_chunk(draw, records) if draw(st.booleans()) else records)
    return _damaged(draw, data) if draw(st.integers(0, 2)) == 0 else data


def _split(data: bytes) -> list[Record]:
    found, at = [], 0
    while at < len(data):
        opcode, length = struct.unpack_from('<BQ', data, at)
        found.append(Record(opcode, data[at + 9:at + 9 + length]))
        at += 9 + length
    return found


def _joined(records: Sequence[Record]) -> bytes:
    return b''.join(struct.pack('<BQ', record.opcode, len(record.content) if record.length is None else record.length)
                    + record.content for record in records)


def _change(draw: DrawFn, records: list[Record]) -> None:
    """Change one record: of any kind with the same chance, for most are messages."""
    if not records:
        return
    kind = draw(st.sampled_from(sorted({record.opcode for record in records})))
    k = draw(st.sampled_from([k for k, record in enumerate(records) if record.opcode == kind]))
    other = draw(st.integers(0, len(records) - 1))
    how = draw(st.integers(0, 9))
    if how == 0:
        del records[k]
    elif how == 1:
        records.insert(other, records[k])
    elif how == 2:
        records[k], records[other] = records[other], records[k]
    elif how == 3:
        records[k] = records[k]._replace(length=draw(st.sampled_from(_EXTREMES)))
    elif how == 4:
        records[k] = records[k]._replace(opcode=draw(st.integers(0, 16)))
    else:
        records[k] = records[k]._replace(content=_other_content(draw, records[k].content))


def _other_content(draw: DrawFn, content: bytes) -> bytes:
    at = draw(st.integers(0, max(len(content) - 1, 0)))
    how = draw(st.integers(0, 4))
    if how == 0:
        return content[:at]
    if how == 1:
        return content + draw(st.binary(max_size=16))
    if how == 2:    # a word of a text
        return content[:at] + draw(WORDS).encode(errors='surrogatepass') + content[at + draw(st.integers(0, 8)):]
    if how == 3:
        return content[:at] + draw(st.binary(min_size=1, max_size=4)) + content[at + 1:]
    code, size = draw(st.sampled_from([('<H', 2), ('<I', 4), ('<Q', 8)]))
    number = draw(st.sampled_from(_EXTREMES)) & (256**size - 1)
    return content[:at] + struct.pack(code, number) + content[at + size:]


def _in_a_chunk(draw: DrawFn, records: list[Record]) -> list[Record]:
    """Put records into a chunk, which may say of itself what is not true."""
    compression = draw(st.sampled_from([*_PACK]))
    inside = _joined(records[1:])
    data = _PACK[compression](inside)
    said = draw(st.sampled_from([compression, compression, 'zstd', 'lz4', '', 'br', '\x00']))
    size = draw(st.sampled_from([len(inside), len(inside), *_EXTREMES]))
    length = draw(st.sampled_from([len(data), len(data), *_EXTREMES]))
    content = struct.pack('<QQQII', 0, 0, size, 0, len(said)) + said.encode() + struct.pack('<Q', length) + data
    return [*records[:1], Record(Opcode.CHUNK, content)]


def _damaged(draw: DrawFn, data: bytes) -> bytes:
    """Return a file with changed bytes, or one that ends too early."""
    if draw(st.booleans()):
        return data[:draw(st.integers(0, len(data)))]
    changed = bytearray(data)
    for _ in range(draw(st.integers(1, 8))):
        changed[draw(st.integers(0, len(changed) - 1))] = draw(st.integers(0, 255))
    return bytes(changed)
