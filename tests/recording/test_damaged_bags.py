# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A bit turned in a bag that was finished: refused in one line by all that read it."""

import struct
import warnings
from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest
from mcap.writer import CompressionType

from stickslip_sim.core.errors import RecordingError, RecordingWarning
from stickslip_sim.recording import RecordedMessage, open_bag
from stickslip_sim.recording.playback import Recording
from tests.support.check_files import LIMITS, limits_file
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture, refused

REPORTED = 'damaged: it was finished, but is no longer what was written; fetch the file again'


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


@pytest.mark.parametrize('how', [read, played])
def test_no_bit_of_the_index_changes_what_is_read(how: Callable[[Path], list[RecordedMessage]], fig8_bag: Path,
                                                  tmp_path: Path) -> None:
    """It is refused, or the index is not used."""
    data, path, stream = data_of(fig8_bag), tmp_path / 'run.mcap', Random(5)
    path.write_bytes(data)
    whole = how(path)
    (begin,) = struct.unpack_from('<Q', data, len(data) - 28)    # the footer says
    outcomes = []
    for _ in range(40):
        path.write_bytes(flipped(data, stream.randrange(begin, len(data)), stream.randrange(8)))
        outcomes.append(outcome(how, path))
        assert outcomes[-1] in (whole, f'{path}: {REPORTED}')
    assert whole in outcomes


@pytest.mark.parametrize('how', [read, played])
def test_the_index_does_not_rename_a_topic(how: Callable[[Path], list[RecordedMessage]], fig8_bag: Path, tmp_path: Path
                                           ) -> None:
    data, path = data_of(fig8_bag), tmp_path / 'run.mcap'
    path.write_bytes(flipped(data, data.rindex(b'/slider_state') + 1))
    assert how(path) == how(fig8_bag)


def outcome(how: Callable[[Path], list[RecordedMessage]], path: Path) -> list[RecordedMessage] | str:
    """Return the messages, or why they are refused; anything else, a warning too, is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        try:
            return how(path)
        except RecordingError as error:
            return str(error)
