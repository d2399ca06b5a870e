# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of several files: each whole by itself, and all of them one bag for everybody; a disk that is full in one."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from rosbags.rosbag2 import Reader

from stickslip_sim.bags.topics import DRIVE_VELOCITY
from stickslip_sim.cli.main import run as tool
from stickslip_sim.core.errors import RecordingError, RecordingWarning
from stickslip_sim.recording import RECORDED, BagWriter, RunFacts, Split, flat_layout, open_bag, open_run, receipt_file
from stickslip_sim.recording.reader import Recording
from tests.support.recorded_runs import FACTS
from tests.support.repository import ROOT
from tests.support.tool import Capture

STEP = 1_000_000   # ns

FULL_DISK = '''
import os, resource, sys
from stickslip_sim.core.errors import RecordingError
from stickslip_sim.recording import RecorderThread, Split, open_run
from tests.support.recorded_runs import FACTS

def limit(size):    # of the files of this process
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

folder, is_full = sys.argv[1], sys.argv[2] == 'full'
if is_full:
    limit(100)
try:
    recorder = RecorderThread(open_run(folder, FACTS, split=Split(max_duration=1000)))
except RecordingError as error:
    sys.exit(print(error, 0, sep='|'))
limit(100_000)
for step in range(300):
    recorder.put(0, os.urandom(100), 10 * step, step, step)
step = 300
while recorder.failure is None:
    if recorder.waiting < 500:
        recorder.put(0, os.urandom(100), 3000, step, step)
        step += 1
assert not recorder.close()
assert recorder.written + recorder.dropped == step
print(recorder.failure, recorder.written, sep='|')
'''


RECORD_UNTIL_KILLED = '''    # a message a millisecond, and how many were handed over on standard output
import sys, time
from stickslip_sim.recording import RecorderThread, Split, open_run
from tests.support.recorded_runs import FACTS

recorder = RecorderThread(open_run(sys.argv[1], FACTS, split=Split(max_duration=int(sys.argv[2]))))
start, step = time.monotonic(), 0
while True:
    while step < (time.monotonic() - start) * 1000.0:
        step += 1
        recorder.put(0, step.to_bytes(8, 'little') * 12, step * 1_000_000, step * 1_000_000, step)
        if step % 50 == 0:
            print(step, flush=True)
    time.sleep(0.001)
'''


def split_bag(folder: Path, split: Split, count: int = 100, size: int = 0) -> Path:
    """Record messages a step apart, none twice the same."""
    writer = open_run(folder, FACTS, split=split)
    put(writer, count, size)
    writer.close(receipt_file({'a': 1}))
    return folder


def put(writer: BagWriter, count: int, size: int = 0) -> None:
    """Write so many drive velocities, each with so many bytes too many that cannot be compressed."""
    for step in range(count):
        data = flat_layout(DRIVE_VELOCITY.type).pack(step * STEP, 1e-3 * step) + os.urandom(size)
        writer.write(RECORDED.index(DRIVE_VELOCITY), data, step * STEP, step * STEP, step)


def names(folder: Path) -> list[str]:
    """Return the names of the files in a folder."""
    return sorted(path.name for path in folder.iterdir())


def listed(folder: Path) -> dict[str, Any]:
    """Return what metadata.yaml says."""
    text = (folder / 'metadata.yaml').read_text(encoding='utf-8')
    body: dict[str, Any] = yaml.safe_load(text)['rosbag2_bagfile_information']
    return body


def on_a_full_disk(folder: Path, when: str) -> tuple[str, int]:
    """Record where a limit on the size of files stands for a full disk: both make a write fail half-way."""
    done = subprocess.run([sys.executable, '-c', FULL_DISK, folder, when], cwd=ROOT, capture_output=True, text=True,
                          timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, '')
    failure, written = done.stdout.split('|')
    return failure, int(written)


class TestFullDisk:
    def test_from_the_start(self, tmp_path: Path) -> None:
        failure, _ = on_a_full_disk(tmp_path / 'run', 'full')
        assert failure == f'{tmp_path / "run" / "run_0.mcap"}: File too large; the recording ends here'
        assert not (tmp_path / 'run').exists()

    def test_in_a_later_part(self, tmp_path: Path) -> None:
        """The whole parts stay listed; what is whole of the last one can be read, too."""
        failure, written = on_a_full_disk(tmp_path / 'run', 'later')
        assert failure == f'{tmp_path / "run" / "run_3.mcap"}: File too large; the recording ends here'
        assert listed(tmp_path / 'run')['relative_file_paths'] == ['run_0.mcap', 'run_1.mcap', 'run_2.mcap']
        with Reader(tmp_path / 'run') as reader:
            assert len(list(reader.messages())) == 300
        with pytest.warns(RecordingWarning, match='no end'):
            bag = open_bag(tmp_path / 'run')
        steps = [message.sequence for message in bag.messages()]
        assert not bag.is_complete
        assert steps == list(range(len(steps)))
        assert 300 <= written <= len(steps)


class TestSplits:
    def test_by_duration(self, tmp_path: Path) -> None:
        folder = split_bag(tmp_path / 'run', Split(max_duration=40 * STEP))
        assert names(folder) == ['metadata.yaml', 'run_0.mcap', 'run_1.mcap', 'run_2.mcap']
        body = listed(folder)
        assert body['relative_file_paths'] == ['run_0.mcap', 'run_1.mcap', 'run_2.mcap']
        assert [(part['path'], part['starting_time']['nanoseconds_since_epoch'], part['duration']['nanoseconds'],
                 part['message_count']) for part in body['files']] == [
            ('run_0.mcap', 0, 39 * STEP, 40), ('run_1.mcap', 40 * STEP, 39 * STEP, 40),
            ('run_2.mcap', 80 * STEP, 19 * STEP, 20)]
        assert (body['message_count'], body['duration']['nanoseconds']) == (100, 99 * STEP)
        with Reader(folder) as reader:    # one bag
            assert [time for _, time, _ in reader.messages()] == [step * STEP for step in range(100)]

    def test_by_size(self, tmp_path: Path) -> None:
        """The file has that size when the next message comes; the chunk under way may be added to it."""
        folder = split_bag(tmp_path / 'run', Split(max_size=200_000), 5000, 200)
        sizes = [(folder / name).stat().st_size for name in names(folder)[1:]]
        assert len(sizes) > 3
        assert all(200_000 <= size < 300_000 for size in sizes[:-1])

    def test_a_part_that_cannot_be_begun(self, tmp_path: Path) -> None:
        """The recording ends with its last whole part, and touches nothing of others."""
        writer = open_run(tmp_path / 'run', FACTS, split=Split(max_duration=40 * STEP))
        (tmp_path / 'run' / 'run_1.mcap').write_text('of somebody else')
        with pytest.raises(RecordingError, match=r'run_1\.mcap: File exists; the recording ends here'):
            put(writer, 100)
        writer.abandon()
        assert writer.on_disk == 40
        assert (tmp_path / 'run' / 'run_1.mcap').read_text() == 'of somebody else'
        with pytest.warns(RecordingWarning, match='goes on in run_1.mcap, beside it'):
            bag = open_bag(tmp_path / 'run' / 'run_0.mcap')
        assert sum(bag.counts.values()) == 40

    def test_kill_in_the_middle_of_splits(self, tmp_path: Path) -> None:
        program = subprocess.Popen([sys.executable, '-c', RECORD_UNTIL_KILLED, str(tmp_path / 'run'), str(20 * STEP)],
                                   cwd=ROOT, stdout=subprocess.PIPE, text=True)
        assert program.stdout is not None
        while int(program.stdout.readline()) < 700:
            pass
        program.send_signal(signal.SIGKILL)
        rest = program.communicate()[0].split()
        with pytest.warns(RecordingWarning):
            bag = open_bag(tmp_path / 'run')
        steps = [message.sequence for message in bag.messages()]
        assert steps == list(range(1, len(steps) + 1))
        assert int(rest[-1] if rest else 700) - len(steps) < 1000
        whole = listed(tmp_path / 'run')['relative_file_paths']
        assert len(whole) > 10
        with Reader(tmp_path / 'run') as reader:
            found = list(reader.messages())
        assert 20 * len(whole) <= len(found) <= len(steps)


class TestReading:
    def test_a_last_part_that_is_empty_is_the_end_of_a_process_that_was_killed(self, tmp_path: Path) -> None:
        """Or of one that is just about to write it."""
        writer = open_run(tmp_path / 'run', FACTS, split=Split(max_duration=40 * STEP))
        put(writer, 100)
        writer.abandon()
        *_, last = sorted((tmp_path / 'run').glob('*.mcap'))
        last.write_bytes(b'')
        for place in (tmp_path / 'run', last.with_name('run_1.mcap')):
            with pytest.warns(RecordingWarning, match='no end'):
                bag = open_bag(place)
            assert (bag.next_file, bag.is_complete) == ('', False)
            assert [message.sequence for message in bag.messages()][-1] == 79
            assert not Recording(place).is_complete
        with pytest.raises(RecordingError, match='it is empty'):
            open_bag(last)

    def test_all_parts_are_one_bag(self, tmp_path: Path) -> None:
        whole = open_bag(split_bag(tmp_path / 'whole', Split()))
        bag = open_bag(split_bag(tmp_path / 'run', Split(max_duration=7 * STEP)))
        assert len(bag.files) == 15
        assert bag.is_complete
        assert bag.receipt == {'a': 1}
        assert (bag.counts, bag.topics, bag.metadata['stickslip']) == (
            whole.counts, whole.topics, whole.metadata['stickslip'])
        assert list(bag.messages()) == list(whole.messages())
        topic = '/drive_velocity'
        assert {name: column.tolist() for name, column in bag.columns(topic).items()} == {
            name: column.tolist() for name, column in whole.columns(topic).items()}

    @pytest.mark.parametrize(('lost', 'opened', 'warning', 'steps'), [
        ('', 'run_1.mcap', r'run_1\.mcap goes on in run_2\.mcap, beside it; give the folder', range(40, 80)),
        ('run_2.mcap', '', r'goes on in run_2\.mcap, which is not there', range(80)),
    ])
    def test_some_of_the_parts(self, tmp_path: Path, lost: str, opened: str, warning: str, steps: range) -> None:
        folder = split_bag(tmp_path / 'run', Split(max_duration=40 * STEP))
        assert open_bag(folder / 'run_2.mcap').is_complete
        if lost:
            (folder / lost).unlink()
        with pytest.warns(RecordingWarning, match=warning):
            bag = open_bag(folder / opened)
        assert not bag.is_complete
        assert [message.sequence for message in bag.messages()] == [*steps]

    def test_a_part_in_between_is_lost(self, tmp_path: Path) -> None:
        folder = split_bag(tmp_path / 'run', Split(max_duration=40 * STEP))
        (folder / 'run_1.mcap').unlink()
        with pytest.raises(RecordingError, match=r'run_1\.mcap is missing'):
            open_bag(folder)

    def test_played_across_parts(self, tmp_path: Path) -> None:
        recording = Recording(split_bag(tmp_path / 'run', Split(max_duration=40 * STEP)))
        assert (recording.begin, recording.end, recording.is_complete) == (0, 99 * STEP, True)
        steps = [message.sequence for message in recording.messages(['/drive_velocity'], 35 * STEP, 85 * STEP)]
        assert steps == list(range(35, 86))


def test_verify_across_parts(tmp_path: Path, capsys: Capture) -> None:
    """The run of all parts is the same; a later part cannot be run again by itself, the first as far as it goes."""
    assert tool(['simulate', 'paper_fig8', '--duration', '2', '--bag', str(tmp_path / 'whole')]) == 0
    whole = open_bag(tmp_path / 'whole')
    scene = whole.scene
    writer = open_run(tmp_path / 'run', RunFacts.of(scene, 2.0, scene.time.step), split=Split(max_duration=600 * STEP))
    topics = list(whole.topics)
    for message in whole.messages():
        writer.write(topics.index(message.topic), message.data, message.log_time, message.publish_time,
                     message.sequence)
    writer.close(receipt_file(whole.receipt))
    capsys.readouterr()
    assert tool(['verify', str(tmp_path / 'run')]) == 0
    assert capsys.readouterr().out.startswith('identical, 2001 steps,')
    assert tool(['verify', str(tmp_path / 'run' / 'run_0.mcap')]) == 0
    out = capsys.readouterr().out
    assert 'goes on in run_1.mcap, beside it; give the folder of the bag' in out
    assert 'identical as far as it goes' in out
    assert tool(['verify', str(tmp_path / 'run' / 'run_2.mcap')]) == 2
    assert 'part 2 of a recording that was split' in capsys.readouterr().err
