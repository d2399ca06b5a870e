# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The records of an MCAP file as far as they are whole; what it says of its own sizes is not believed."""

import os
import struct
from collections.abc import Iterable, Iterator
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import BinaryIO
from zlib import crc32

import lz4.frame
import zstandard
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Chunk, DataEnd, McapRecord, Message
from mcap.stream_reader import CRCValidationError, StreamReader, breakup_chunk
from mcap.writer import MCAP0_MAGIC

from ..core.errors import RecordingError
from .mcap_file import Messages, bytes_of, messages_in

RECORD_LIMIT = 32 << 20   # bytes of a record, and of what a chunk unpacks to; rosbag2 makes chunks of 1 to 4 MiB
COMPRESSIONS = ('', 'zstd', 'lz4')
_FOOTER = struct.Struct('<QQI')   # where the summary begins, and its part of offsets; checksum of all that but itself
_DATA_END = struct.Struct('<BQI')   # the whole record: what it is, its length, checksum of all before it
_CHECKSUM_SIZE = 4
_BLOCK = 1 << 20
GATHERED_BYTES = 1 << 19   # bytes of chunks that are looked at together

# What a file that ends or is damaged anywhere makes the libraries stumble over (RuntimeError: lz4).
CUT_OFF = (McapError, CRCValidationError, struct.error, zstandard.ZstdError, RuntimeError, UnicodeDecodeError,
            OverflowError)


def contents(path: Path) -> Iterator[McapRecord | Messages]:
    """Yield the records that are whole, and the messages of some chunks at once, behind their other records.

    A file that is cut off just ends earlier.  Raises RecordingError when it is no MCAP file, cannot be read, or was
    finished and is damaged.
    """
    gathered = _GatheredChunks(path)
    try:
        with path.open('rb') as file:
            begin = True
            try:
                for record in _Records(_Careful(file), validate_crcs=True,  # type: ignore[arg-type]
                                       emit_chunks=True).records:
                    begin = False
                    yield from gathered.take(record)
                yield from gathered.rest()
            except CUT_OFF:
                if begin:
                    raise RecordingError(f'{path} is not an MCAP file: it is empty or has another format') from None
                if _is_finished(file):
                    raise RecordingError(f'{path}: damaged: it was closed properly, but has changed since; fetch it '
                                         'again') from None
                with suppress(*CUT_OFF):
                    yield from gathered.rest()
    except OSError as error:
        raise RecordingError(f'{path}: {error.strerror}') from None


def summary_of(file: BinaryIO, whose_bytes_are_checked: bool) -> Iterator[McapRecord]:
    """Yield the records at the end of a file; none where they are not to be trusted, as in one that was cut off.

    With `whose_bytes_are_checked` they are trusted only where the file has checksums of all its bytes, which are right.
    Raises one of CUT_OFF, or OSError where it is shorter than such an end.
    """
    end = file.seek(0, os.SEEK_END) - len(MCAP0_MAGIC) - _FOOTER.size
    if end < 0 or not _is_finished(file):
        return
    file.seek(end)
    begin, _, written = _FOOTER.unpack(file.read(_FOOTER.size))
    is_right = written == _checksum(file, begin, end + _FOOTER.size - _CHECKSUM_SIZE)
    if begin and (is_right and _data_are_whole(file, begin) if whose_bytes_are_checked else is_right or not written):
        yield from _records_from(file, begin)


def _data_are_whole(file: BinaryIO, end: int) -> bool:
    """Return whether all before a place, where the summary begins, is what was written; false without a checksum."""
    at = end - _DATA_END.size
    file.seek(max(at, 0))
    opcode, length, written = _DATA_END.unpack(file.read(_DATA_END.size))
    return (opcode, length) == (Opcode.DATA_END, _CHECKSUM_SIZE) and 0 != written == _checksum(file, 0, at)


def _checksum(file: BinaryIO, begin: int, end: int) -> int:
    checksum = 0
    for at in range(file.seek(begin), end, _BLOCK):
        checksum = crc32(file.read(min(_BLOCK, end - at)), checksum)
    return checksum


def record_at(file: BinaryIO, offset: int) -> McapRecord:
    """Return the record at a place; raises one of CUT_OFF."""
    return next(_records_from(file, offset))


def _records_from(file: BinaryIO, offset: int) -> Iterator[McapRecord]:
    file.seek(offset)
    return StreamReader(_Careful(file), skip_magic=True, emit_chunks=True).records  # type: ignore[arg-type]


def messages_at(path: Path, file: BinaryIO, offset: int) -> Messages:
    """Return the messages of the chunk at a place; raises one of CUT_OFF or RecordingError."""
    chunk = record_at(file, offset)
    if not isinstance(chunk, Chunk):
        raise McapError('no chunk')
    return messages_in(_content(path, chunk))


class _Records(StreamReader):
    """The records of a file without the indexes of its messages, which take longer to read than the messages."""

    def _read_record(self, opcode: int, length: int) -> McapRecord | None:
        if opcode == Opcode.MESSAGE_INDEX and length <= RECORD_LIMIT:
            self._stream.read(length)
            return None
        return super()._read_record(opcode, length)


class _Careful:
    """A file that is never asked for more at once than a record may hold: it would make room for it first."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file

    def read(self, size: int) -> bytes:
        if not 0 <= size <= RECORD_LIMIT:
            raise McapError(f'a part of {size} bytes')
        return self._file.read(size)


def _is_finished(file: BinaryIO) -> bool:
    """Return whether a file has its last bytes, which are written when all others are."""
    file.seek(-len(MCAP0_MAGIC), os.SEEK_END)
    return file.read() == MCAP0_MAGIC


class _GatheredChunks:
    """Takes the records of a file, and gives the messages of several chunks at once: then arrays are worth it."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._held: list[bytes] = []   # contents of chunks, messages by themselves
        self._size = 0

    def take(self, record: McapRecord) -> Iterator[McapRecord | Messages]:
        """Take a record; yield those that are no messages, and the messages that were held when they are enough."""
        if not isinstance(record, (Chunk, Message)):
            if isinstance(record, DataEnd):    # the summary repeats what chunks say: they come first
                yield from self.rest()
            yield record
            return
        data = bytes_of(record) if isinstance(record, Message) else _content(self._path, record)
        self._held.append(data)
        self._size += len(data)
        if self._size >= GATHERED_BYTES:
            yield from self.rest()

    def rest(self) -> Iterator[McapRecord | Messages]:
        """Yield what is held: the messages behind other records."""
        held, self._held, self._size = self._held, [], 0
        together: Iterable[Messages]
        try:
            together = [messages_in(b''.join(held))] if held else []
        except McapError:    # those before the one that is damaged are whole
            together = map(messages_in, held)
        for messages in together:
            for begin, end in messages.others:
                yield from breakup_chunk(_chunk_of(messages.data[begin:end]))
            yield messages


def _chunk_of(data: bytes) -> Chunk:
    return Chunk(compression='', data=data, message_start_time=0, message_end_time=0, uncompressed_crc=0,
                 uncompressed_size=len(data))


def _content(path: Path, record: Chunk) -> bytes:
    """Return the records in a chunk, as they were written."""
    if record.compression not in COMPRESSIONS:
        raise RecordingError(f'{path}: its chunks are compressed with {record.compression!r}; zstd, lz4 and none are '
                             'read: convert it first (mcap compress)')
    if record.uncompressed_size > RECORD_LIMIT:
        raise RecordingError(f'{path}: a chunk of {record.uncompressed_size} bytes; at most {RECORD_LIMIT} are read: '
                             'rewrite it with smaller chunks (mcap compress --chunk-size)')
    data = _decompressed(record)
    if len(data) != record.uncompressed_size:
        raise McapError('a chunk of another size than it says')
    if record.uncompressed_crc and (found := crc32(data)) != record.uncompressed_crc:
        raise CRCValidationError(record.uncompressed_crc, found, record)
    return data


def _decompressed(chunk: Chunk) -> bytes:
    """Return the content of a chunk, at most a byte more than it says."""
    most = chunk.uncompressed_size + 1
    if chunk.compression == 'zstd':
        return zstandard.ZstdDecompressor().stream_reader(BytesIO(chunk.data)).read(most)
    if chunk.compression == 'lz4':
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=most))
    return chunk.data
