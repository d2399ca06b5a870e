# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The processes that work on a study: they die, their parent dies, and what they start from."""

import json
import math
import os
import re
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.core.types import EventKind
from stickslip_sim.figures.point_figures import FIGURES
from stickslip_sim.inputs import load_scene
from stickslip_sim.proof.axes import instant, of_kind
from stickslip_sim.runs.batch import BatchFigures, Rounds, run_rounds
from stickslip_sim.study import EvenGrid, Motion, Study, points, variation
from stickslip_sim.study.folder import POINTS_TABLE, free_memory
from stickslip_sim.study.sweep import processes
from tests.support.tool import Capture, done

pytestmark = pytest.mark.slow

DYING = """
from signal import SIGKILL, raise_signal
from stickslip_sim.study.sweep import WorkerError, processes

ended = 0
for _ in range(2):
    try:
        with processes(2) as workers:
            works = [workers.pool.submit(abs, -1), *(workers.pool.submit(raise_signal, SIGKILL) for _ in range(4))]
            for one in works:
                one.result()
    except WorkerError:
        ended += 1
print(ended)
"""
WITHOUT_A_GUARD = """
from stickslip_sim.study.sweep import processes

with processes(2) as workers:
    print(*workers.pool.map(abs, [-1, -2, -3]))
"""


def answer(program: str, folder: Path, **environment: str) -> str:
    """Return what a script prints, and nothing but that."""
    script = folder / 'script.py'
    script.write_text(program)
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=120, check=False,
                          env={**os.environ, **environment})
    assert (done.returncode, done.stderr) == (0, '')
    return done.stdout


def test_workers_that_die_raise_one_error_and_say_nothing(tmp_path: Path) -> None:
    assert answer(DYING, tmp_path) == '2\n'


def test_a_script_needs_no_guard_against_being_read_by_its_workers(tmp_path: Path) -> None:
    assert answer(WITHOUT_A_GUARD, tmp_path) == '1 2 3\n'


def test_what_a_worker_raises_is_raised_here() -> None:
    with processes(1) as workers:
        with pytest.raises(ZeroDivisionError) as raised:
            workers.pool.submit(divmod, 1, 0).result()
        assert 'in _answer' in str(raised.value.__cause__)
        with pytest.raises(TypeError, match='pickle'):
            workers.pool.submit(iter, memoryview(b'')).result()
        assert workers.pool.submit(os.getpid).result() != os.getpid()


def test_work_under_way_is_given_up_at_the_end() -> None:
    children = Path('/proc/thread-self/children')
    before = children.read_text().split()
    with processes(2) as workers:
        works = [workers.pool.submit(signal.pause) for _ in range(2)]
        begun = [pid for pid in children.read_text().split() if pid not in before]
    assert len(begun) == 2
    assert not [pid for pid in begun if Path(f'/proc/{pid}').exists()]
    assert all(one.done() for one in works)


# The memory that can be had within limits of containers, on files laid out as Linux shows them.

MACHINE = {'proc/meminfo': 'MemTotal: 9000 kB\nMemAvailable:    8000 kB\n'}


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    return laid_out(tmp_path, MACHINE)


def laid_out(root: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


def first(folder: str, limit: object, usage: int, cached: int) -> dict[str, str]:
    """Return the files of a group of version 1."""
    folder = f'sys/fs/cgroup/memory{folder}'
    return {f'{folder}/memory.limit_in_bytes': f'{limit}\n', f'{folder}/memory.usage_in_bytes': f'{usage}\n',
            f'{folder}/memory.stat': f'cache 7\ninactive_file 1\ntotal_inactive_file {cached}\n'}


def second(folder: str, limit: object, usage: int, cached: int) -> dict[str, str]:
    """Return the files of a group of version 2."""
    folder = f'sys/fs/cgroup{folder}'
    return {f'{folder}/memory.max': f'{limit}\n', f'{folder}/memory.current': f'{usage}\n',
            f'{folder}/memory.stat': f'anon 7\ninactive_file {cached}\n'}


def test_of_this_machine() -> None:
    assert 0 < free_memory() < 1 << 50


def test_without_groups(machine: Path) -> None:
    assert free_memory(machine) == 8_192_000


@pytest.mark.parametrize(('group', 'files', 'free'), [
    ('0::/\n', second('', 1_000_000, 400_000, 50_000), 650_000),
    ('0::/\n', second('', 1_000_000, 1_400_000, 0), 0),
    ('0::/\n', second('', 1 << 40, 0, 0), 8_192_000),
    ('0::/a/b\n', second('/a/b', 'max', 10, 0) | second('/a', 1_000_000, 10, 0), 999_990),
    ('0::/a/b\n', second('/a/b', 500_000, 10, 0) | second('/a', 1_000_000, 10, 0), 499_990),
    ('9:name=systemd:/\n4:memory:/a\n0::/\n', first('/a', 1_000_000, 10, 4), 999_994),
    ('4:cpu,memory:/docker/4f1c\n', first('', 1_000_000, 10, 0), 999_990),     # seen from within the container
    ('4:memory:/a\n', first('/a', 9223372036854771712, 10, 0), 8_192_000),     # none
], ids=['container', 'overdrawn', 'wide', 'above', 'own', 'v1', 'v1 container', 'v1 none'])
def test_in_a_group(machine: Path, group: str, files: dict[str, str], free: int) -> None:
    laid_out(machine, {'proc/self/cgroup': group, **files})
    assert free_memory(machine) == free


# Points of a study whose run went wrong, or whose motion cannot be decided: a class of their own everywhere.

FLOOD = '''
scene: flood
axis: {mass: 1.0, drive_stiffness: 6.0e5, drive_damping: 0.0, normal_force: 0.0}
contact: {model: rigid}
friction:
  static: {law: constant, initial: 0.0}
  kinetic: {velocities: [0.0], coefficients: [0.0]}
  acceleration_dependence: false
drive: {course: constant, velocity: 0.0}
force: {course: table, times: [0.0, 0.5], forces: [0.0, 0.0], period: 1.0}
initial: {position: 0.0, velocity: 0.1, rest_time: .inf}
'''
UNCERTAIN = '''
parameters:
  axis.mass: {distribution: uniform, low: 300.0, high: 400.0}
'''


@pytest.fixture
def flood(tmp_path: Path) -> str:
    """A slider without friction that turns at each half swing: a light one too often for the engine."""
    lines = ''.join(f'    {line}\n' for line in FLOOD.strip().splitlines())
    (tmp_path / 'flood.yaml').write_text(f'/**:\n  ros__parameters:\n{lines}')
    return str(tmp_path / 'flood.yaml')


@pytest.fixture
def heavy_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the engine give up on every slider of more than 350 kg."""
    def broken(*given: Any, mass: Any, **more: Any) -> tuple[BatchFigures, Rounds]:
        figures, rounds = run_rounds(*given, mass=mass, **more)
        return replace(figures, complete=figures.complete & (mass <= 350.0)), rounds

    monkeypatch.setattr(points, 'run_rounds', broken)


def test_a_sweep_has_the_word_failed_and_no_figures(flood: str, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / 'out'
    said = done(capsys, 'sweep', flood, '--over', 'axis.mass=1e-9:1.0:2:log', '--over',
                'axis.drive_stiffness=5e5:6e5:2', '--duration', '4', '--out', out)
    assert '2 smooth sliding, 2 failed' in said or '2 failed, 2 smooth sliding' in said
    assert '2 of 4 points failed: the exact engine gave up; see column motion\n' in said
    rows = [line.split(',')[2:] for line in (out / POINTS_TABLE).read_text().splitlines()[1:]]
    assert rows[:2] == [['failed', *[''] * (len(FIGURES) - 1)]] * 2
    assert [row[0] for row in rows[2:]] == ['smooth sliding'] * 2
    assert run(['map', str(out), '--out', str(tmp_path / 'map.svg')]) == 0
    assert '2 of 4 points failed' in capsys.readouterr().out
    text = (tmp_path / 'map.svg').read_text()
    assert '<!-- failed -->' in text or '>failed<' in text
    assert '<pattern' in text   # hatched


@pytest.mark.usefixtures('heavy_fail')
def test_points_of_the_batch_that_fail_have_no_figures() -> None:
    study = Study(load_scene('paper_fig7').values, EvenGrid((variation('axis.mass=300:400:5'),)))
    figures = study.figures(0, 5)
    assert figures.motion.tolist() == [Motion.STICK_SLIP] * 3 + [Motion.FAILED] * 2
    for name in FIGURES[1:]:
        assert np.isnan(getattr(figures, name)[3:]).all(), name
        assert np.isfinite(getattr(figures, name)[:3]).all(), name


@pytest.mark.parametrize('name', ['round_period', 'round_travel', 'round_force'])
def test_a_figure_that_is_no_number_is_a_failure(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*given: Any, **more: Any) -> tuple[BatchFigures, Rounds]:
        figures, rounds = run_rounds(*given, **more)
        getattr(rounds, name)[0] = math.inf
        return figures, rounds

    monkeypatch.setattr(points, 'run_rounds', broken)
    study = Study(load_scene('paper_fig7').values, EvenGrid((variation('axis.mass=300:400:2'),)), 5.0)
    assert study.figures(0, 2).motion.tolist() == [Motion.FAILED, Motion.STICK_SLIP]


@pytest.mark.usefixtures('heavy_fail')
@pytest.mark.parametrize(('between', 'said'), [
    ('300:400', r'from 349[.0-9]* to 400[.0-9]* kg: not known, the exact engine gave up'),
    ('360:400', r'from 360[.0-9]* to 400[.0-9]* kg: not known, the exact engine gave up')])
def test_critical_says_where_it_does_not_know(between: str, said: str, capsys: Capture) -> None:
    assert run(['critical', 'paper_fig7', '--of', 'axis.mass', '--between', between]) == 0
    from_rest = [line for line in capsys.readouterr().out.splitlines() if line.startswith('from rest')]
    assert any(re.search(said, line) for line in from_rest), from_rest
    assert not any('all over' in line for line in from_rest)


@pytest.mark.usefixtures('heavy_fail')
def test_uncertainty_counts_them_and_averages_over_the_others(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / 'known.yaml').write_text(UNCERTAIN)
    said = done(capsys, 'uncertainty', 'paper_fig7', '--with', tmp_path / 'known.yaml', '--samples', '16', '--out',
                tmp_path / 'out')
    found = json.loads((tmp_path / 'out' / 'uncertainty.json').read_text())
    assert (found['points'], found['known'] + found['failed']) == (32, 32)
    assert 10 < found['failed'] < 22
    assert found['stick_slip'] == 1.0
    assert found['indices']['amplitude'] is None
    assert (f'stick-slip in 100.00% of those {found["known"]} of 32 independent points where it is known, '
            f'{found["failed"]} failed') in said
    assert 'of 48 points failed: the exact engine gave up; see column motion' in said


def sticks_late(study: Study, k: int, duration: float) -> list[float]:
    simulator = study.scene_at(study.points(k, k + 1)[0]).make_rig().simulator
    parts = (simulator.advance(instant(end)) for end in np.linspace(0.0, duration, 21)[1:].tolist())
    return [event.time for part in parts for event in of_kind(part, EventKind.STICK) if event.time > 0.5 * duration]


def test_alternating_sticks_and_reversals_are_stick_slip() -> None:
    study = Study(load_scene('paper_fig7', {'drive.velocity': 0.02}).values, EvenGrid((variation(
        'axis.mass=20000:32000:41'),)))
    figures = study.figures(0, 41)
    assert (figures.motion == Motion.STICK_SLIP).all()
    assert (figures.settled == 1.0).all()
    assert (np.diff(figures.amplitude) > 0.0).all()   # the jump forward, not the step back
    assert (figures.period > 1.0).all()


def test_sticks_that_come_again_after_long_pauses_are_undecided(tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / 'out'
    assert run(['sweep', 'paper_fig8', '--over', 'axis.drive_damping=11380:11490:12', '--out', str(out)]) == 0
    assert 'undecided' in capsys.readouterr().out
    study = Study(load_scene('paper_fig8').values, EvenGrid((variation('axis.drive_damping=11380:11490:12'),)))
    figures = study.figures(0, 12)
    open_ones = np.flatnonzero(figures.motion == Motion.UNDECIDED)
    assert len(open_ones)
    assert not (figures.motion == Motion.SMOOTH_SLIDING).any()
    for name in ('stick_slip', 'amplitude', 'period', 'stick_share', 'settling_time'):
        assert np.isnan(getattr(figures, name)[open_ones]).all()
    assert (figures.settled[open_ones] == 0.0).all()
    for k in (0, int(open_ones[-1])):
        assert sticks_late(study, k, 1e4)
