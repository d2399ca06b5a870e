# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Bags that were damaged, or made to exhaust memory or time: refused in one line, and cheaply."""

import struct
import tracemalloc
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from random import Random

import lz4.frame
import pytest
import zstandard
from mcap.opcode import Opcode
from mcap.writer import CompressionType

from stickslip_sim.bags import bag_files
from stickslip_sim.core.errors import RecordingError, RecordingWarning
from stickslip_sim.recording import RecordedMessage, open_bag, write_bag
from stickslip_sim.recording.reader import Recording
from tests.support.check_files import LIMITS, limits_file
from tests.support.made_up_bags import Record, file_of
from tests.support.recorded_runs import FACTS, events, samples
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture, refused

REPORTED = 'damaged: it was closed properly, but has changed since; fetch it again'


def data_of(bag: Path) -> bytes:
    return next(bag.glob('*.mcap')).read_bytes()


def flipped(data: bytes, place: int, bit: int = 0) -> bytes:
    """Return data with one bit turned."""
    return data[:place] + bytes([data[place] ^ 1 << bit]) + data[place + 1:]


@pytest.fixture
def damaged(fig8_bag: Path, tmp_path: Path) -> Path:
    data = data_of(fig8_bag)
    path = tmp_path / 'damaged.mcap'
    path.write_bytes(flipped(data, int(0.3 * len(data))))
    return path


@pytest.mark.parametrize('command', [
    ['check', 'BAG', '--limits', 'LIMITS', '--json', 'OUT'], ['compare', 'BAG', '--out', 'OUT'],
    ['export', 'BAG', '--csv', 'OUT'], ['export', 'BAG', '--csv', '-'], ['verify', 'BAG'],
])
def test_the_tool_refuses_it(command: list[str], damaged: Path, tmp_path: Path, capsys: Capture) -> None:
    words: dict[str, str | Path] = {'BAG': damaged, 'LIMITS': limits_file(tmp_path, LIMITS), 'OUT': tmp_path / 'out'}
    assert f'{damaged}: {REPORTED}' in refused(capsys, *(words.get(word, word) for word in command))
    assert not [path for path in tmp_path.iterdir() if 'out' in path.name]


@pytest.mark.parametrize('compression', list(CompressionType))
def test_python_refuses_it(compression: CompressionType, fig8_bag: Path, tmp_path: Path) -> None:
    path = rewritten(fig8_bag, tmp_path / 'other', compression=compression) / 'run_0.mcap'
    data = path.read_bytes()
    path.write_bytes(flipped(data, len(data) // 2))
    with pytest.raises(RecordingError, match=REPORTED):
        open_bag(path)


def test_damaged_after_it_was_opened(fig8_bag: Path, damaged: Path, tmp_path: Path) -> None:
    path = tmp_path / 'run.mcap'
    path.write_bytes(data_of(fig8_bag))
    run = open_bag(path)
    damaged.replace(path)
    with pytest.raises(RecordingError, match=REPORTED):
        run.columns('slider_state')


def test_a_damaged_file_without_an_end_is_read_up_to_the_damage(damaged: Path) -> None:
    """It cannot be known: a computer that lost its power leaves such a file, too."""
    damaged.write_bytes(damaged.read_bytes()[:-8])
    with pytest.warns(RecordingWarning, match='has no end: cut off'):
        run = open_bag(damaged)
    assert not run.is_complete
    steps = run.columns('slider_state')['step'].tolist()
    assert steps == list(range(len(steps)))
    assert 0.2 * 3001 < len(steps) < 0.4 * 3001


def read(path: Path) -> list[RecordedMessage]:
    return sorted(open_bag(path).messages())


def played(path: Path) -> list[RecordedMessage]:
    recording = Recording(path)
    return sorted(recording.messages(recording.topics, recording.begin, recording.end))


@pytest.fixture(scope='module')
def small(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A run of a few chunks."""
    folder = tmp_path_factory.mktemp('bags') / 'run'
    write_bag(folder, FACTS, samples(600), events(), {})
    return data_of(folder)


@pytest.mark.parametrize('how', [read, played])
def test_no_bit_of_the_index_changes_what_is_read(how: Callable[[Path], list[RecordedMessage]], small: bytes,
                                                  tmp_path: Path) -> None:
    """It is refused, or the index is not used."""
    data, path, stream = small, tmp_path / 'run.mcap', Random(5)
    path.write_bytes(data)
    whole = how(path)
    (begin,) = struct.unpack_from('<Q', data, len(data) - 28)    # the footer says
    outcomes = []
    for _ in range(40):
        path.write_bytes(flipped(data, stream.randrange(begin, len(data)), stream.randrange(8)))
        outcomes.append(outcome(how, path))
        assert outcomes[-1] in (whole, f'{path}: {REPORTED}')
    assert whole in outcomes
    path.write_bytes(flipped(data, data.rindex(b'/slider_state') + 1))    # no topic is renamed
    assert how(path) == whole


@pytest.mark.parametrize('how', [read, played])
def test_a_short_bag_is_read_as_its_chunks_say(how: Callable[[Path], list[RecordedMessage]], tmp_path: Path) -> None:
    """All of it is looked at together, and the damaged index behind it does not come first."""
    path = tmp_path / 'run'
    write_bag(path, FACTS, samples(20), events(), {})
    (file,) = path.glob('*.mcap')
    whole, data = how(path), file.read_bytes()
    file.write_bytes(flipped(data, data.rindex(b'/slider_state') + 1))
    assert how(path) == whole


def test_no_chunk_is_unpacked_to_open_a_finished_bag(fig8_bag: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = open_bag(fig8_bag).counts
    monkeypatch.setattr(bag_files, 'contents', None)
    assert open_bag(fig8_bag).counts == expected


def outcome(how: Callable[[Path], list[RecordedMessage]], path: Path) -> list[RecordedMessage] | str:
    """Return the messages, or why they are refused; anything else, a warning too, is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        try:
            return how(path)
        except RecordingError as error:
            return str(error)


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


@cache
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


@pytest.mark.parametrize(('reported', 'records'), [
    ('damaged', lambda: [chunk('zstd', bomb('zstd'), 1000)]), ('damaged', lambda: [chunk('lz4', bomb('lz4'), 1000)]),
    ('a chunk of 1073741824 bytes; at most', lambda: [chunk('zstd', bomb('zstd'), HUGE)]),
    *(('damaged', lambda length=length: [Record(Opcode.MESSAGE, MESSAGE, length)])
      for length in (HUGE, 1 << 62, (1 << 64) - 1)),
    ('more than 64 MiB beside its messages', lambda: [attachment(f'{k}', bytes(30 << 20)) for k in range(3)]),
], ids=['zstd', 'lz4', 'chunk', '1 GiB', '4 EiB', '16 EiB', 'attachments'])
def test_what_unpacks_to_far_more_or_says_it_is_huge(reported: str, records: Callable[[], list[Record]], tmp_path: Path
                                                     ) -> None:
    path = written(tmp_path, HEADER, *records())
    with cheaply(), pytest.raises(RecordingError, match=reported):
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
