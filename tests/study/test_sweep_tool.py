# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip sweep` as a user meets it: interrupted, killed, resumed, on a full disk, misused."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.figures.point_figures import FIGURES
from stickslip_sim.study import folder as study_folder
from stickslip_sim.study import sweep
from stickslip_sim.study.folder import PARQUET, PARTIAL, POINTS_TABLE, SIDECAR, Folder
from stickslip_sim.study.study import study_of
from stickslip_sim.study.table import read_columns, title_line
from tests.support.tool import Capture, answered, refused, restore_interrupt

pytestmark = pytest.mark.slow

SMALL = ['paper_fig7', '--over', 'drive.velocity=1e-3:0.06:6:log', '--over', 'axis.drive_stiffness=1e5:1e6:4:log']
LONG = ['paper_fig7', '--over', 'drive.velocity=1e-3:0.03:8000:log', '--duration', '8']   # four chunks
FULL = 'import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (600_000, 600_000)); '


def started(*arguments: str | Path) -> 'subprocess.Popen[str]':
    return subprocess.Popen([sys.executable, '-m', 'stickslip_sim', 'sweep', *map(str, arguments)], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
                            preexec_fn=restore_interrupt)


def wait_until(process: 'subprocess.Popen[str]', holds: Callable[[], bool]) -> None:
    """Wait for something while a sweep still runs."""
    end = time.monotonic() + 60.0
    while not holds():
        assert time.monotonic() < end
        assert process.poll() is None, process.communicate()
        time.sleep(0.005)


def out_lines(path: Path) -> int:
    """Return how many lines of points a sweep has written, and the line above them."""
    return path.read_bytes().count(b'\n') if path.exists() else 0


def wait_for_lines(path: Path, process: 'subprocess.Popen[str]') -> None:
    """Wait until there is a whole chunk, and the sweep still runs."""
    wait_until(process, lambda: out_lines(path) > 2000)


@pytest.fixture(scope='module')
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a sweep that nothing interrupted; not to be changed."""
    folder = tmp_path_factory.mktemp('whole') / 'out'
    assert run(['sweep', *LONG, '--out', str(folder)]) == 0
    return folder


@pytest.fixture
def uninterrupted(finished: Path) -> bytes:
    return (finished / POINTS_TABLE).read_bytes()


def test_a_sweep_says_what_it_is_and_can_be_read_back(tmp_path: Path, capsys: Capture) -> None:
    assert run(['sweep', *SMALL, '--set', 'axis.mass=300.0', '--out', str(tmp_path / 'out')]) == 0
    assert '24 points' in capsys.readouterr().out
    sidecar = json.loads((tmp_path / 'out' / SIDECAR).read_text())
    assert {'stickslip', 'numpy', 'python', 'hot_path'} <= sidecar['versions'].keys()
    assert 'mass: 300.0' in sidecar['scene_text']
    study = study_of(sidecar)
    columns = read_columns(tmp_path / 'out' / POINTS_TABLE, study)
    points, figures = study.points(0, 24), study.figures(0, 24)
    assert np.array_equal(columns['drive.velocity'], points[:, 0])
    for name in FIGURES:
        assert columns[name].tobytes() == getattr(figures, name).tobytes(), name


def test_a_sweep_does_not_read_the_table_that_it_wrote(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def unexpected(*_: object) -> None:
        raise AssertionError('a table was read')

    monkeypatch.setattr(sweep, 'read_columns', unexpected)
    assert run(['sweep', *SMALL, '--out', str(tmp_path / 'out')]) == 0


def test_killed_in_the_middle_and_resumed_it_gives_the_same_file(tmp_path: Path, uninterrupted: bytes,
                                                                 capsys: Capture) -> None:
    """Whose first part two workers made."""
    out = tmp_path / 'out'
    process = started(*LONG, '--workers', '2', '--out', out)
    wait_for_lines(out / PARTIAL, process)
    process.kill()
    process.communicate(timeout=60)   # the workers hold its standard error: it ends when they are gone
    assert not (out / POINTS_TABLE).exists()
    with (out / PARTIAL).open('ab') as file:
        file.write(b'0.001,stick-sl')   # as a power failure would leave it
    code, said, error = answered(capsys, 'sweep', *LONG, '--out', out, '--resume')
    assert code == 0, error
    assert ', 8000 of them run now' not in said
    assert (out / POINTS_TABLE).read_bytes() == uninterrupted
    assert not (out / PARTIAL).exists()


@pytest.mark.parametrize('workers', ['1', '2'])
def test_ctrl_c_keeps_what_is_done(workers: str, tmp_path: Path, uninterrupted: bytes) -> None:
    out = tmp_path / 'out'
    process = started(*LONG, '--workers', workers, '--out', out)
    wait_for_lines(out / PARTIAL, process)
    os.killpg(process.pid, signal.SIGINT)
    said, error = process.communicate(timeout=60)
    assert process.returncode == 130, error
    assert (said, error.count('\n')) == ('', 1)
    assert '--resume' in error
    rows = (out / PARTIAL).read_bytes()
    assert uninterrupted.startswith(rows)
    assert rows.count(b'\n') % 2000 == 1


def test_a_full_disk_gets_one_line_and_keeps_whole_chunks(tmp_path: Path, uninterrupted: bytes) -> None:
    out = tmp_path / 'out'
    arguments = ['sweep', *LONG, '--out', str(out)]
    program = f'{FULL}from stickslip_sim.cli.main import run; raise SystemExit(run({arguments}))'
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr.count('\n')) == (2, '', 1)
    assert 'File too large' in done.stderr
    assert '--resume' in done.stderr
    rows = (out / PARTIAL).read_bytes()
    assert uninterrupted.startswith(rows)
    assert rows.count(b'\n') % 2000 == 1


@pytest.mark.parametrize(('lines', 'which'), [(0, 0), (2001, -1)])
def test_a_worker_that_dies_is_reported(lines: int, which: int, tmp_path: Path, uninterrupted: bytes) -> None:
    out = tmp_path / 'out'
    process = started(*LONG, '--workers', '2', '--out', out)
    children = Path(f'/proc/{process.pid}/task/{process.pid}/children')
    wait_until(process, lambda: len(children.read_text().split()) == 2)
    wait_until(process, lambda: not lines or out_lines(out / PARTIAL) >= lines)
    workers = children.read_text().split()
    os.kill(int(workers[which]), signal.SIGKILL)
    said, error = process.communicate(timeout=60)
    assert (process.returncode, said, error.count('\n')) == (1, '', 1), error
    assert 'a worker process was killed by signal 9; what is done is kept, --resume goes on' in error
    assert not [pid for pid in workers if Path(f'/proc/{pid}').exists()]
    assert not lines or uninterrupted.startswith((out / PARTIAL).read_bytes())


def test_resuming_what_is_complete_does_nothing(tmp_path: Path, capsys: Capture) -> None:
    assert run(['sweep', *SMALL, '--out', str(tmp_path / 'out')]) == 0
    before = (tmp_path / 'out' / POINTS_TABLE).stat().st_mtime_ns
    capsys.readouterr()
    assert run(['sweep', *SMALL, '--out', str(tmp_path / 'out'), '--resume']) == 0
    assert '0 of them run now' in capsys.readouterr().out
    assert (tmp_path / 'out' / POINTS_TABLE).stat().st_mtime_ns == before


def test_resuming_another_study_is_refused(tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / 'out'
    assert run(['sweep', *SMALL, '--out', str(out)]) == 0
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    capsys.readouterr()
    for more, said in ((['--set', 'axis.mass=300.0'], 'scene_hash'), (['--duration', '3'], 'duration'),
                       (['--over', 'axis.mass=300:400:2'], 'points')):
        assert said in refused(capsys, 'sweep', *SMALL, *more, '--out', out, '--resume')
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
    sidecar = json.loads(before[SIDECAR])
    (out / SIDECAR).write_text(json.dumps({**sidecar, 'versions': {**sidecar['versions'], 'stickslip': '0.0.1'}}))
    assert 'versions' in refused(capsys, 'sweep', *SMALL, '--out', out, '--resume')


def test_places_that_cannot_be_are_refused(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / 'there').mkdir()
    (tmp_path / 'there' / 'file').touch()
    assert '--resume' in refused(capsys, 'sweep', *SMALL, '--out', tmp_path / 'there')
    assert 'study.json' in refused(capsys, 'sweep', *SMALL, '--out', tmp_path / 'there', '--resume')
    assert 'study.json' in refused(capsys, 'sweep', *SMALL, '--out', tmp_path / 'nowhere', '--resume')
    assert 'Not a directory' in refused(capsys, 'sweep', *SMALL, '--out', tmp_path / 'there' / 'file' / 'where')
    error = refused(capsys, 'sweep', *SMALL, '--out', '/sys/sweep')
    assert 'a writable place' in error
    assert 'nothing is left behind' in error
    assert sorted(path.name for path in tmp_path.rglob('*')) == ['file', 'there']


def test_a_table_of_something_else_is_not_gone_on_with(tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / 'out'
    assert run(['sweep', *SMALL, '--out', str(out)]) == 0
    (out / POINTS_TABLE).unlink()
    (out / PARTIAL).write_text('a,b\n1,2\n')
    capsys.readouterr()
    assert 'was changed' in refused(capsys, 'sweep', *SMALL, '--out', out, '--resume')
    assert (out / PARTIAL).read_text() == 'a,b\n1,2\n'


@pytest.mark.parametrize('flaw', ['a line is gone', 'no motion', 'zeros', 'no text', 'a number of another point',
                                  'no number', 'a column more'])
def test_a_chunk_that_is_not_whole_is_run_again(flaw: str, tmp_path: Path, finished: Path) -> None:
    out = tmp_path / 'out'
    shutil.copytree(finished, out)
    rows = (finished / POINTS_TABLE).read_bytes().splitlines(keepends=True)
    bad = {'a line is gone': b'', 'no motion': rows[3000].replace(b'stick-slip', b'slick-stip'), 'no text': b'\xff\n',
           'zeros': b'\0' * 100 + b'\n', 'a number of another point': b'1' + rows[3000],
           'no number': rows[3000].replace(b'slip,1.0,', b'slip,inf,'), 'a column more': rows[3000][:-1] + b',1\n'}
    assert bad[flaw] != rows[3000]
    (out / POINTS_TABLE).unlink()
    (out / PARTIAL).write_bytes(b''.join([*rows[:3000], bad[flaw], *rows[3001:]]))
    assert len(Folder(out).whole_chunks(study_of(Folder(out).described()))) == 1
    if flaw == 'a line is gone':
        assert run(['sweep', *LONG, '--out', str(out), '--resume']) == 0
        assert (out / POINTS_TABLE).read_bytes() == (finished / POINTS_TABLE).read_bytes()


def test_two_processes_do_not_share_a_folder(tmp_path: Path, uninterrupted: bytes, capsys: Capture) -> None:
    out = tmp_path / 'out'
    process = started(*LONG, '--out', out)
    wait_for_lines(out / PARTIAL, process)
    process.send_signal(signal.SIGSTOP)   # so that it surely works on the folder all the time
    try:
        assert 'no other process' in refused(capsys, 'sweep', *LONG, '--out', out, '--resume')
    finally:
        process.send_signal(signal.SIGCONT)
    error = process.communicate(timeout=60)[1]
    assert process.returncode == 0, error
    assert (out / POINTS_TABLE).read_bytes() == uninterrupted


def test_more_workers_than_memory_holds_are_refused(tmp_path: Path, capsys: Capture,
                                                    monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study_folder, 'free_memory', lambda: 200_000_000)
    monkeypatch.setattr(os, 'sched_getaffinity', lambda _: range(5))
    for number in ('5', 'all'):
        error = refused(capsys, 'sweep', *SMALL, '--workers', number, '--out', tmp_path / 'out')
        assert 'at most 4: they would take 250 MB of memory, of which 200 MB are free' in error
        assert not (tmp_path / 'out').exists()


def test_parquet_has_the_same_table(tmp_path: Path) -> None:
    pandas = pytest.importorskip('pandas')
    pytest.importorskip('fastparquet')
    assert run(['sweep', *SMALL, '--out', str(tmp_path / 'out')]) == 0
    study = study_of(Folder(tmp_path / 'out').described())
    parquet = pandas.read_parquet(tmp_path / 'out' / PARQUET)
    assert ','.join(parquet.columns) + '\n' == title_line(study).decode()
    columns = read_columns(tmp_path / 'out' / POINTS_TABLE, study)
    for name in (*study.names, *FIGURES[1:]):
        assert np.array_equal(parquet[name].to_numpy(), columns[name], equal_nan=True)
    assert set(parquet['motion']) == {'stick-slip', 'smooth sliding'}


def test_a_broken_pandas_keeps_no_study_from_its_end(tmp_path: Path) -> None:
    for name in ('pandas', 'fastparquet'):
        (tmp_path / f'{name}.py').write_text('raise ImportError("built for another numpy")\n')
    done = subprocess.run([sys.executable, '-m', 'stickslip_sim', 'sweep', *SMALL, '--out', str(tmp_path / 'out')],
                          env={**os.environ, 'PYTHONPATH': os.pathsep.join([str(tmp_path), *filter(None, sys.path)])},
                          capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / 'out' / POINTS_TABLE).exists()
    assert not (tmp_path / 'out' / PARQUET).exists()
