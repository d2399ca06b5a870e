# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The recorder: it never waits, never overwrites, and what is cut off can be read."""

import threading
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.core.errors import RecordingError, RecordingWarning
from stickslip_sim.recording import RecorderThread, open_bag, open_run, receipt_file, write_bag
from tests.support.recorded_runs import FACTS, events, samples
from tests.support.waiting import wait_for


class TestRefusals:
    @pytest.mark.parametrize(('made', 'asked', 'reported'), [
        ('here/', 'here', '/here exists and is not overwritten; choose another name'),
        ('here/metadata.yaml', 'here', '/here exists and is not overwritten; choose another name'),
        ('here', 'here', 'here.*; choose a'), ('here', 'here/below', 'here.*; choose a'),
        ('here', 'here/far/below', 'here.*; choose a'),
        ('here', '/proc/run', '^/proc/run cannot be created: .*; choose a writable place$'),
    ])
    def test_to_write(self, tmp_path: Path, made: str, asked: str, reported: str) -> None:
        mine = tmp_path / made
        (mine if made.endswith('/') else mine.parent).mkdir(exist_ok=True)
        if not made.endswith('/'):
            mine.write_text('mine')
        before = sorted(tmp_path.rglob('*'))
        with pytest.raises(RecordingError, match=reported):
            open_run(tmp_path / asked, FACTS)
        assert sorted(tmp_path.rglob('*')) == before
        assert mine.is_dir() or mine.read_text() == 'mine'

    @pytest.mark.parametrize('name', ['nowhere', 'empty', 'text.mcap'])
    def test_to_read(self, tmp_path: Path, name: str) -> None:
        (tmp_path / 'empty').mkdir()
        (tmp_path / 'text.mcap').write_text('not a bag, but long enough to be one')
        with pytest.raises(RecordingError, match=name):
            open_bag(tmp_path / name)

class TestThread:
    def test_all_that_was_put_is_there(self, tmp_path: Path) -> None:
        recorder = RecorderThread(open_run(tmp_path / 'run', FACTS))
        for step in range(5000):
            recorder.put(step % 2, step.to_bytes(4, 'little'), step, step, step)
        assert recorder.close(receipt_file({'steps': 5000}))
        recorder.put(0, b'', 0, 0, 0)    # too late
        assert (recorder.written, recorder.dropped, recorder.failure) == (5000, 1, None)
        run = open_bag(tmp_path / 'run')
        assert [int.from_bytes(message.data, 'little') for message in run.messages()] == list(range(5000))
        assert run.receipt == {'steps': 5000}

    def test_a_full_queue_drops_and_counts(self, tmp_path: Path) -> None:
        writer = open_run(tmp_path / 'run', FACTS)
        gate = threading.Event()
        write = writer.write

        def slow(*item: Any) -> None:
            gate.wait()
            write(*item)

        writer.write = slow  # type: ignore[assignment, method-assign]
        recorder = RecorderThread(writer, capacity=10)
        for step in range(100):
            recorder.put(0, b'', step, step, step)
        gate.set()
        assert recorder.close()
        assert (recorder.written, recorder.dropped) == (10, 90)
        assert [message.sequence for message in open_bag(tmp_path / 'run').messages()] == list(range(10))

    @pytest.mark.filterwarnings('ignore::stickslip_sim.core.errors.RecordingWarning')   # it is still being written
    def test_few_messages_reach_the_disk_within_a_second(self, tmp_path: Path) -> None:
        recorder = RecorderThread(open_run(tmp_path / 'run', FACTS))
        recorder.put(0, b'only one', 0, 0, 0)
        (first,) = wait_for(lambda: list(open_bag(tmp_path / 'run').messages()), 'the message in the file')
        assert first.data == b'only one'
        recorder.close()

    def test_any_failure_is_reported_and_stops_nobody(self, tmp_path: Path) -> None:
        recorder = RecorderThread(open_run(tmp_path / 'run', FACTS))
        recorder.put(99, b'', 0, 0, 0)  # no such topic
        recorder.put(0, b'', 0, 0, 0)
        assert wait_for(lambda: recorder.failure, 'the failure')
        recorder.put(0, b'', 0, 0, 0)
        assert not recorder.close()
        assert recorder.dropped == 3

def test_a_file_cut_anywhere_gives_what_is_whole(tmp_path: Path) -> None:
    bag = tmp_path / 'first'
    write_bag(bag, FACTS, samples(120), events(), {})
    whole = (bag / 'first_0.mcap').read_bytes()
    steps = [message.sequence for message in open_bag(bag).messages()]
    file = tmp_path / 'cut.mcap'
    for size in range(60, len(whole), 293):
        file.write_bytes(whole[:size])
        with pytest.warns(RecordingWarning, match='no end'):
            run = open_bag(file)
        found = [message.sequence for message in run.messages()]
        assert not run.is_complete
        assert found == steps[:len(found)]
