# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The recorder: it never waits, never overwrites, and what is cut off can be read."""

import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.core.errors import RecordingError, RecordingWarning
from stickslip_sim.recording import (
    RecorderThread,
    open_bag,
    open_run,
    receipt_file,
    write_bag,
)
from tests.support.busy_machine import CoreWaits, judged_by_time
from tests.support.recorded_runs import FACTS, events, samples
from tests.support.repository import ROOT
from tests.support.waiting import wait_for


class TestRefusals:
    @pytest.mark.parametrize('content', [None, 'metadata.yaml'])
    def test_existing_folder(self, tmp_path: Path, content: str | None) -> None:
        folder = tmp_path / 'here'
        folder.mkdir()
        if content:
            (folder / content).write_text('mine')
        with pytest.raises(RecordingError, match=r'/here exists and is never overwritten; choose another name'):
            open_run(folder, FACTS)
        assert [file.name for file in folder.iterdir()] == ([content] if content else [])

    @pytest.mark.parametrize('name', ['here', 'here/below', 'here/far/below'])
    def test_a_file_in_the_way(self, tmp_path: Path, name: str) -> None:
        (tmp_path / 'here').write_text('mine')
        with pytest.raises(RecordingError, match=r'here.*; choose a'):
            open_run(tmp_path / name, FACTS)
        assert (tmp_path / 'here').read_text() == 'mine'

    def test_a_place_that_cannot_be_written(self) -> None:
        with pytest.raises(RecordingError, match=r'^/proc/run cannot be made: .*; choose a place that can be written$'):
            open_run('/proc/run', FACTS)

    @pytest.mark.parametrize('name', ['nowhere', 'empty', 'text.mcap'])
    def test_nothing_to_read(self, tmp_path: Path, name: str) -> None:
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
        assert (recorder.written, recorder.dropped, recorder.failure) == (5000, 0, None)
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

    def test_a_late_message_is_dropped_and_counted(self, tmp_path: Path) -> None:
        recorder = RecorderThread(open_run(tmp_path / 'run', FACTS))
        recorder.close()
        recorder.put(0, b'', 0, 0, 0)
        assert (recorder.written, recorder.dropped) == (0, 1)

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

    def test_full_disk(self, tmp_path: Path) -> None:
        """A limit on the size of files stands for a full disk; both make a write fail half-way."""
        code = f'''
import os, resource, sys
from stickslip_sim.recording import RecorderThread, open_run
from tests.support.recorded_runs import FACTS
recorder = RecorderThread(open_run({str(tmp_path / 'run')!r}, FACTS), capacity=1000)
resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))
step = 0
while recorder.failure is None:
    if recorder.waiting < 500:
        recorder.put(0, os.urandom(100), step, step, step)
        step += 1
put = step + 7
for step in range(7):
    recorder.put(0, b'', step, step, step)
assert not recorder.close()
assert recorder.written + recorder.dropped == put
print(recorder.failure, recorder.written, sep='|')
'''
        done = subprocess.run([sys.executable, '-c', code], cwd=ROOT, capture_output=True, text=True, timeout=60)
        assert (done.returncode, done.stderr) == (0, '')
        failure, written = done.stdout.strip().split('|')
        assert failure == f'{tmp_path / "run" / "run_0.mcap"}: File too large; the recording ends here'
        with pytest.warns(RecordingWarning, match='no end'):
            run = open_bag(tmp_path / 'run')
        steps = [message.sequence for message in run.messages()]
        assert not run.is_complete
        assert steps == list(range(len(steps)))
        assert 0 < int(written) <= len(steps)

    def test_no_room_from_the_start(self, tmp_path: Path) -> None:
        code = f'''
import resource
from stickslip_sim.core.errors import RecordingError
from stickslip_sim.recording import open_run
from tests.support.recorded_runs import FACTS
resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
try:
    open_run({str(tmp_path / 'run')!r}, FACTS)
except RecordingError as error:
    print(error)
'''
        done = subprocess.run([sys.executable, '-c', code], cwd=ROOT, capture_output=True, text=True, timeout=60)
        assert done.stdout == f'{tmp_path / "run" / "run_0.mcap"}: File too large; the recording ends here\n'
        assert not (tmp_path / 'run').exists()

    def test_kill_loses_less_than_a_second(self, tmp_path: Path) -> None:
        program = subprocess.Popen([sys.executable, '-m', 'tests.support.record_until_killed', str(tmp_path / 'run')],
                                   cwd=ROOT, stdout=subprocess.PIPE, text=True)
        assert program.stdout is not None
        waits = CoreWaits(program.pid)
        with program, program.stdout, judged_by_time(0.5, waits):
            put = next(step for step in map(int, program.stdout) if step >= 1700)
            waits.look()
            program.send_signal(signal.SIGKILL)
            put = max([put, *map(int, program.stdout)])
            with pytest.warns(RecordingWarning, match='no end'):
                run = open_bag(tmp_path / 'run')
            steps = [message.sequence for message in run.messages()]
            assert put - len(steps) < 1000  # one a millisecond
        assert not run.is_complete
        assert run.attachments['scene.yaml'].decode() == FACTS.scene_text
        assert steps == list(range(1, len(steps) + 1))


def test_a_file_cut_anywhere_gives_what_is_whole(tmp_path: Path) -> None:
    bag = tmp_path / 'first'
    write_bag(bag, FACTS, samples(120), events(), {})
    whole = (bag / 'first_0.mcap').read_bytes()
    steps = [message.sequence for message in open_bag(bag).messages()]
    file = tmp_path / 'cut.mcap'
    for size in range(60, len(whole), 97):
        file.write_bytes(whole[:size])
        with pytest.warns(RecordingWarning, match='no end'):
            run = open_bag(file)
        found = [message.sequence for message in run.messages()]
        assert not run.is_complete
        assert found == steps[:len(found)]
