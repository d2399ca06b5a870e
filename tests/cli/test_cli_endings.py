# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of the tool that end otherwise: wrong use, full disks, readers that leave, signals; one line, nothing left."""

import os
import pty
import shlex
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import click
import pytest

from stickslip_sim.cli import files
from stickslip_sim.cli.files import milestones, progress_bar
from stickslip_sim.cli.main import run
from stickslip_sim.inputs import load_scene
from tests.support.repository import ROOT
from tests.support.tool import Capture, answered, refusals, refused, restore_interrupt
from tests.support.waiting import wait_for


@pytest.mark.parametrize('row', refusals(Path(__file__).with_name('refusals.txt')), ids=lambda row: row[0][:60])
def test_wrong_use_gets_one_line_and_leaves_nothing(row: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                                    capsys: Capture) -> None:
    command, *words = row
    (tmp_path / 'examples').symlink_to(ROOT / 'examples')
    (tmp_path / 'limits.yaml').write_text('limits: {sticks: {max: 1}}')
    (tmp_path / 'my_axis.yaml').touch()
    (tmp_path / 'my_run').mkdir()
    monkeypatch.chdir(tmp_path)
    refused(capsys, *shlex.split(command), words=words)
    assert {path.name for path in tmp_path.iterdir()} == {'examples', 'limits.yaml', 'my_axis.yaml', 'my_run'}


def test_wrong_use_where_click_is_older(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    """Ubuntu 24.04 has click 8.1."""
    monkeypatch.delattr(click.exceptions, 'NoArgsIsHelpError', raising=False)
    assert 'sing' in refused(capsys, 'sing')


def test_without_a_verb_the_help_is_the_answer(capsys: Capture) -> None:
    code, out, err = answered(capsys)
    assert (code, out) == (2, '')
    assert err.startswith('Usage: stickslip [OPTIONS] COMMAND [ARGS]...')
    assert 'simulate' in err


def test_an_existing_bag_folder_is_refused_before_the_work(tmp_path: Path, capsys: Capture) -> None:
    assert str(tmp_path) in refused(capsys, 'simulate', 'paper_fig7', '--duration', '1e8', '--bag', tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_unwritable_folder(capsys: Capture) -> None:
    """In /sys not even root can make a file."""
    assert 'writable' in refused(capsys, 'simulate', 'paper_fig7', '--duration', '1', '--events', '/sys/e.csv')


def test_a_full_disk_gets_one_line(capsys: Capture) -> None:
    line = refused(capsys, 'simulate', 'paper_fig7', '--duration', '1', '--events', '/dev/full')
    assert 'No space left' in line


def test_internal_errors_get_one_line(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError('first\nsecond')

    monkeypatch.setattr('stickslip_sim.runs.simulate_events', fail)
    assert 'ZeroDivisionError: first' in refused(capsys, 'simulate', 'paper_fig7', '--duration', '1', code=1)
    monkeypatch.setenv('STICKSLIP_DEBUG', '1')
    with pytest.raises(ZeroDivisionError):
        run(['simulate', 'paper_fig7', '--duration', '1'])


def test_a_reader_that_leaves_early_is_no_error() -> None:
    command = [sys.executable, '-m', 'stickslip_sim', 'simulate', 'paper_fig8', '--duration', '10', '--samples', '-']
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.readline().startswith('time,position,velocity,')
        process.stdout.close()
        assert process.stderr.read() == ''
        assert process.wait(30) == 0


@pytest.mark.parametrize(('number', 'code'), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_run_leaves_nothing(number: signal.Signals, code: int, tmp_path: Path) -> None:
    with started('--duration', '5e5', '--events', tmp_path / 'e.csv') as process:
        time.sleep(0.5)
        process.send_signal(number)
        _, err = process.communicate(timeout=30)
    assert process.returncode == code
    assert err == ('stickslip: interrupted\n' if number == signal.SIGINT else '')
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(('number', 'end'), [
    (signal.SIGINT, 'KeyboardInterrupt()'), (signal.SIGTERM, 'SystemExit(143)'),
])
def test_an_import_does_not_hide_what_ends_the_tool(number: signal.Signals, end: str, tmp_path: Path) -> None:
    """One of numpy makes an ImportError of it."""
    (tmp_path / 'hides.py').write_text(f"""
import os, time
try:
    os.kill(os.getpid(), {number:d})
    time.sleep(0.05)
except BaseException:
    raise ImportError('numpy._core.multiarray failed to import')
""")
    program = """
from stickslip_sim.cli.process import listen
listen()
import hides
try:
    while True:
        pass
except BaseException as found:
    print(repr(found))
"""
    paths = os.pathsep.join([str(tmp_path), *sys.path])
    done = subprocess.run([sys.executable, '-c', program], env={**os.environ, 'PYTHONPATH': paths},
                          preexec_fn=restore_interrupt, capture_output=True, text=True, timeout=60, check=False)
    assert (done.stdout, done.stderr) == (f'{end}\n', '')


@pytest.mark.parametrize(('own', 'times'), [
    ("print('hangs', flush=True)\nwhile True:\n    pass\n", 1),
    ("""import time
def own(t, measured):
    while True:
        try:
            print('hangs', flush=True)
            time.sleep(60)
        except BaseException:
            pass
""", 3)])
def test_a_controller_that_hangs_ends_with_ctrl_c(own: str, times: int, tmp_path: Path) -> None:
    """While its file is read with the first, in a loop that takes it for an error of its own with the third."""
    (tmp_path / 'own.py').write_text(own)
    with started('--duration', '1', '--scene', 'positioning', verb=('close-loop', f'{tmp_path}/own.py:own')) as process:
        assert process.stdout is not None
        for _ in range(times):
            assert process.stdout.readline() == 'hangs\n'
            process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
    assert (process.returncode, err.strip()) == (130, 'stickslip: interrupted')


@pytest.mark.ros
def test_an_interrupted_bag_vanishes(tmp_path: Path) -> None:
    with started('--duration', '500', '--bag', tmp_path / 'bag') as process:
        while process.poll() is None and not (tmp_path / 'bag').exists():
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (130, 'stickslip: interrupted\n')
    assert list(tmp_path.iterdir()) == []


def started(*arguments: str | Path, verb: tuple[str, str] = ('simulate', 'paper_fig8')) -> subprocess.Popen[str]:
    """Start a verb, as a run of paper_fig8; return when the tool is about to parse its arguments."""
    program = 'from stickslip_sim.cli import main; print(flush=True); main()'
    process = subprocess.Popen([sys.executable, '-c', program, *verb, *map(str, arguments)],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=restore_interrupt)
    assert process.stdout is not None
    process.stdout.readline()
    return process


def test_what_a_command_reads_is_not_what_it_writes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene, curve = tmp_path / 'mine.yaml', tmp_path / 'curve.csv'
    scene.write_text(load_scene('paper_fig7').text)
    curve.write_text((ROOT / 'examples' / 'friction_curve.csv').read_text())
    for arguments, read in (
            (['simulate', str(scene), '--duration', '1', '--samples', str(scene)], scene),
            (['friction', str(curve), '--speed-unit', 'mm/s', '--out', str(scene), '--scene', str(scene)], scene)):
        before = read.read_bytes()
        assert run(arguments) == 2
        assert 'must be a different file than' in capsys.readouterr().err
        assert read.read_bytes() == before
    assert run(['simulate', 'paper_fig7', '--duration', '1', '--samples', str(curve)]) == 0   # a file of no other use


# Where results go: all verbs make the same folders for their files, and refuse the same paths.

SCENE = 'paper_fig7', '--duration', '0.5'
CURVE = 'friction', ROOT / 'examples' / 'friction_curve.csv', '--speed-unit', 'mm/s'
WITH = 'uncertainty', 'paper_fig7', '--with', ROOT / 'examples' / 'friction.yaml', '--out', 'spread'
LIMITS = '--limits', ROOT / 'examples' / 'limits.yaml'
COMMANDS = [
    (('plot', *SCENE, '--out'), 'a.png'),
    (('simulate', *SCENE, '--plot'), 'a.png'),
    (('simulate', *SCENE, '--events'), 'a.csv'),
    (('simulate', *SCENE, '--samples'), 'a.csv'),
    (('simulate', *SCENE, '--receipt'), 'a.json'),
    (('check', 'positioning', '--duration', '2', *LIMITS, '--junit'), 'a.xml'),
    ((*CURVE, '--out'), 'a.yaml'),
    ((*CURVE, '--plot'), 'a.png'),
    ((*WITH, '--plot'), 'a.png'),
    (('advise', *SCENE, '--tolerance', '1e-3', '--scene-out'), 'a.yaml'),
    (('extremes', '--only', 'X01', '--out'), 'a.json'),
]


@pytest.mark.parametrize(('command', 'name'), COMMANDS, ids=lambda given: ' '.join(map(str, given))[-24:])
def test_a_path_below_two_folders_that_are_missing_is_refused(
        command: tuple[str, ...], name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.chdir(tmp_path)
    line = refused(capsys, *command, Path('new', 'er', name))
    assert f"must be in a folder, or one level below it; {tmp_path / 'new'} does not exist; create it, or check" in line
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(('command', 'name'), COMMANDS[:8], ids=lambda given: ' '.join(map(str, given))[-24:])
def test_one_new_folder_is_made(
        command: tuple[str, ...], name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.chdir(tmp_path)
    assert answered(capsys, *command, Path('new', name))[0] in (0, 3)    # 3: beyond the limits
    assert (tmp_path / 'new' / name).is_file()


def test_a_new_folder_is_made_with_those_around_it(tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / 'new' / 'er' / 'run'
    assert answered(capsys, 'simulate', *SCENE, '--bag', folder)[0] == 0
    assert (folder / 'metadata.yaml').is_file()


# The progress bar on a terminal, which a pseudo-terminal is.

SOON = {'patience': 0.01, 'every': 0.01}


class Terminal:
    """Standard error of this process, and what was written to it."""

    def __init__(self) -> None:
        self._there, here = pty.openpty()
        self.stream = os.fdopen(here, 'w')
        self.text = ''
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        try:
            while part := os.read(self._there, 4096):
                self.text += part.decode()
        except OSError:   # closed
            pass


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[Terminal]:
    found = Terminal()
    monkeypatch.setattr(files, 'sys', SimpleNamespace(stderr=found.stream))   # pytest sets that of sys once more
    yield found
    found.stream.close()


def test_work_that_says_nothing_shows_how_long_it_takes(terminal: Terminal) -> None:
    with progress_bar('waiting', **SOON):
        wait_for(lambda: 'waiting  0 s' in terminal.text, 'the bar')
    wait_for(lambda: terminal.text.endswith('\x1b[?25h\r\n'), 'its end, with a cursor')


def test_work_shows_its_share(terminal: Terminal) -> None:
    with progress_bar('working', **SOON) as take:
        assert take is not None
        take(0.5)
        wait_for(lambda: '#' * 15 + '-' * 15 in terminal.text, 'half of the bar')


def test_there_is_one_bar_at_a_time(terminal: Terminal) -> None:
    with progress_bar('outer', **SOON):
        with progress_bar('inner', **SOON) as take:
            assert take is None
        wait_for(lambda: 'outer' in terminal.text, 'the bar')
    assert 'inner' not in terminal.text
    with progress_bar('later') as take:
        assert take is not None


def test_short_work_shows_nothing(terminal: Terminal) -> None:
    with progress_bar('short', patience=60.0):
        pass
    assert not terminal.text


def test_nobody_looks_where_there_is_no_terminal() -> None:
    with progress_bar('unseen') as take:
        assert take is None


def test_a_log_gets_a_line_now_and_then(capsys: Capture) -> None:
    milestones('working')('fit', 0.5)
    assert capsys.readouterr().err == ''
    milestones('working', every=0.0)('fit', 0.5)
    assert capsys.readouterr().err == 'working: fit, 50% after 0 s\n'
