# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Bags made to exhaust memory or time, or to lead out of their folder: refused in one line, and cheaply."""

import struct
import tracemalloc
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import lz4.frame
import pytest
import zstandard
from mcap.opcode import Opcode

from stickslip_sim.core.errors import RecordingError
from stickslip_sim.recording import open_bag
from tests.support.made_up_bags import Record, file_of

HUGE = 1 << 30          # bytes
MOST = 200 << 20        # that reading may take
HEADER = Record(Opcode.HEADER, struct.pack('<II', 0, 0))
MESSAGE = struct.pack('<HIQQ', 1, 0, 0, 0)


def text(word: str) -> bytes:
    return struct.pack('<I', len(word)) + word.encode()


def chunk(compression: str, data: bytes, says: int) -> Record:
    return Record(Opcode.CHUNK, struct.pack('<QQQI', 0, 0, says, 0) + text(compression) + struct.pack('<Q', len(data))
                  + data)


def attachment(name: str, data: bytes) -> Record:
    return Record(Opcode.ATTACHMENT, struct.pack('<QQ', 0, 0) + text(name) + text('') + struct.pack('<Q', len(data))
                  + data + bytes(4))


def defined(definition: str) -> list[Record]:
    """Return the records of a topic with a message of a type."""
    schema = struct.pack('<H', 1) + text('a/msg/B') + text('ros2msg') + text(definition)
    channel = struct.pack('<HH', 1, 1) + text('/b') + text('cdr') + struct.pack('<I', 0)
    return [HEADER, Record(Opcode.SCHEMA, schema), Record(Opcode.CHANNEL, channel),
            Record(Opcode.MESSAGE, MESSAGE + b'\0\1\0\0' + bytes(8))]


def bomb(compression: str) -> bytes:
    """Return a GiB of zeros, compressed."""
    zeros = bytes(1 << 24)
    count = HUGE // len(zeros)
    if compression == 'zstd':
        packer = zstandard.ZstdCompressor().compressobj(size=HUGE)
        return b''.join(packer.compress(zeros) for _ in range(count)) + packer.flush()
    with lz4.frame.LZ4FrameCompressor() as frame:
        return b''.join([frame.begin(), *(frame.compress(zeros) for _ in range(count)), frame.flush()])


def written(folder: Path, *records: Record) -> Path:
    path = folder / 'run_0.mcap'
    path.write_bytes(file_of(records))
    return path


@contextmanager
def cheaply() -> Iterator[None]:
    """Fail when what is done takes more memory than reading may."""
    tracemalloc.start()
    try:
        yield
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < MOST, f'{peak >> 20} MiB'


@pytest.mark.parametrize('compression', ['zstd', 'lz4'])
def test_a_chunk_that_unpacks_to_far_more_than_it_says(compression: str, tmp_path: Path) -> None:
    path = written(tmp_path, HEADER, chunk(compression, bomb(compression), 1000))
    with cheaply(), pytest.raises(RecordingError, match='damaged'):
        open_bag(path)


def test_a_chunk_that_says_it_is_huge(tmp_path: Path) -> None:
    path = written(tmp_path, HEADER, chunk('zstd', bomb('zstd'), HUGE))
    with cheaply(), pytest.raises(RecordingError, match='a chunk of 1073741824 bytes; at most'):
        open_bag(path)


@pytest.mark.parametrize('length', [HUGE, 1 << 62, (1 << 64) - 1])
def test_a_record_that_says_it_is_huge(length: int, tmp_path: Path) -> None:
    path = written(tmp_path, HEADER, Record(Opcode.MESSAGE, MESSAGE, length))
    with cheaply(), pytest.raises(RecordingError, match='damaged'):
        open_bag(path)


def test_attachments_without_end(tmp_path: Path) -> None:
    path = written(tmp_path, HEADER, *(attachment(f'{k}', bytes(30 << 20)) for k in range(3)))
    with cheaply(), pytest.raises(RecordingError, match='more than 64 MiB beside its messages'):
        open_bag(path)


@pytest.mark.parametrize('definition', [
    'string[100000000] x\n', 'C[100000000] x\n' + '=' * 80 + '\nMSG: a/C\nfloat64 x\n', 'float64 x\n' * 20_000,
])
def test_a_definition_that_becomes_endless_code(definition: str, tmp_path: Path) -> None:
    run = open_bag(written(tmp_path, *defined(definition)))
    with cheaply(), pytest.raises(RecordingError, match='are read'):
        run.columns('/b')


@pytest.mark.parametrize('definition', [
    'B x\n', 'float64 x\nfloat64 x\n', 'Nowhere x\n', 'float32 INF=1e999\n', 'string def\nbool class\n', 'int8 x = \n',
])
def test_definitions_that_rosbags_stumbles_over(definition: str, tmp_path: Path) -> None:
    run = open_bag(written(tmp_path, *defined(definition)))
    (message,) = run.messages()
    with pytest.raises(RecordingError, match=r'run_0\.mcap: '):
        run.decode(message)


def test_no_code_in_a_definition_runs(tmp_path: Path) -> None:
    """rosbags makes Python of definitions: names and values in them must stay names and values."""
    trap = f'__import__("pathlib").Path({str(tmp_path / "trap")!r}).touch()'
    for definition in (f'string X={trap}\n', f'float64 x {trap}\n', f'string A="\'\'\'\\n{trap}"\nfloat64 x\n',
                       f'{trap} x\n', f'float64 x\n{"=" * 80}\nMSG: a/C:\n {trap}\nfloat64 y\n'):
        run = open_bag(written(tmp_path, *defined(definition)))
        with suppress(RecordingError):
            run.columns('/b')
    assert not (tmp_path / 'trap').exists()


def test_names_lead_nowhere(tmp_path: Path) -> None:
    """Attachments are named as their maker likes, and nothing is written; metadata.yaml is not asked for files."""
    inside = tmp_path / 'bag'
    inside.mkdir()
    written(inside, HEADER, attachment('../../up', b'x'), attachment('/dev/shm/up', b'x'))
    (inside / 'metadata.yaml').write_text('rosbag2_bagfile_information: {relative_file_paths: [../other_0.mcap]}\n')
    (tmp_path / 'other_0.mcap').write_bytes(file_of([*defined('float64 x\n')]))
    before = sorted(tmp_path.rglob('*'))
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        run = open_bag(inside)
    assert (run.path, run.topics) == (inside / 'run_0.mcap', {})
    assert sorted(tmp_path.rglob('*')) == before
