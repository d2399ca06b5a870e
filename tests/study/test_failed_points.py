# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Points of a study whose run went wrong, or whose motion cannot be decided: a class of their own everywhere."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.core.types import EventKind
from stickslip_sim.extremes.shared_axes import instant, of_kind
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs.batch import BatchFigures, Rounds, run_rounds
from stickslip_sim.study import EvenGrid, Motion, Study, settling, variation
from stickslip_sim.study.folder import POINTS_TABLE
from stickslip_sim.study.point_figures import FIGURES
from tests.support.tool import Capture

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

    monkeypatch.setattr(settling, 'run_rounds', broken)


def test_a_sweep_has_the_word_failed_and_no_figures(flood: str, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / 'out'
    assert run(['sweep', flood, '--over', 'axis.mass=1e-9:1.0:2:log', '--over', 'axis.drive_stiffness=5e5:6e5:2',
                '--duration', '4', '--out', str(out)]) == 0
    said = capsys.readouterr().out
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

    monkeypatch.setattr(settling, 'run_rounds', broken)
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
    assert run(['uncertainty', 'paper_fig7', '--with', str(tmp_path / 'known.yaml'), '--samples', '16', '--out',
                str(tmp_path / 'out')]) == 0
    said = capsys.readouterr().out
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
