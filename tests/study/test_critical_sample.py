# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The critical value where parameters are known only roughly: point by point that of `critical`, and its spread."""

import csv
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import changed
from stickslip_sim.study import Saltelli, Study, Variation
from stickslip_sim.study.answer_changes import ALL_OVER, NO, NOWHERE, OPEN, YES, Answers, Places, highest_changes
from stickslip_sim.study.critical import (
    ACCURACY,
    CriticalStudy,
    critical_of,
    critical_values,
    feed_of_theory,
    spreads_of,
)
from stickslip_sim.study.sample import Distribution
from stickslip_sim.study.sweep import processes
from tests.support.repository import ROOT
from tests.support.tool import Capture, answered, refused

FEED = Variation('drive.velocity', 2e-3, 0.2, 0, True)
COULOMB = {'friction.static.law': 'constant', 'friction.static.initial': 0.24, 'friction.kinetic.velocities': (0.0,),
           'friction.kinetic.coefficients': (0.12,)}


def study_of(changes: dict[str, object], *laws: Distribution, name: str = 'paper_fig4_constant') -> CriticalStudy:
    scene = changed(load_scene(name), changes)
    return CriticalStudy(Study(scene.values, Saltelli(laws, 16), None), FEED)


def uniform(name: str, low: float, high: float) -> Distribution:
    return Distribution(name, 'uniform', (low, high), low, high)


def test_each_point_has_the_critical_feed_of_the_closed_form() -> None:
    study = study_of(COULOMB, uniform('axis.drive_damping', 1e3, 5e3), uniform('friction.scale', 0.9, 1.1))
    found = critical_values(study)
    exact = [feed_of_theory(study.study.scene_at(point).axis) for point in study.study.points(0, study.study.count)]
    assert found[:, 0] == pytest.approx(exact, rel=ACCURACY)
    assert (found[:, 1] == NOWHERE).all()    # friction that does not fall loses no sliding


def test_each_point_has_the_values_of_critical() -> None:
    laws = uniform('axis.normal_force', 2500.0, 3500.0), uniform('friction.kinetic.coefficients[1]', 0.04, 0.07)
    study = study_of({}, *laws, name='paper_fig7')
    found = study.values(0, 3)
    for k in range(3):
        alone = critical_of(study.study.scene_at(study.study.points(k, k + 1)[0]), FEED, 1e-6)
        assert found[k, 0] == pytest.approx(alone.from_rest.transitions[-1].value, rel=2 * ACCURACY)
        assert found[k, 1] == pytest.approx(alone.from_sliding.transitions[-1].value, rel=2 * ACCURACY)


def test_workers_find_the_same() -> None:
    study = study_of(COULOMB, uniform('axis.drive_damping', 1e3, 5e3), uniform('axis.mass', 300.0, 400.0))
    with processes(2) as workers:
        assert np.array_equal(critical_values(study, workers), critical_values(study))


def test_the_spread_counts_what_has_no_value() -> None:
    sample = Saltelli((uniform('axis.mass', 300.0, 400.0),), 16)
    values = np.linspace(1.0, 2.0, sample.count)
    values[[0, 1, 3]] = ALL_OVER, NOWHERE, np.nan    # A and B of the first sample, A of the second
    spread = spreads_of(sample, np.column_stack([values, values]))['from_rest']
    assert (spread.points, spread.all_over, spread.nowhere, spread.unknown, len(spread.values)) == (32, 1, 1, 1, 29)
    assert spread.indices is None
    assert spread.percentiles is not None
    assert spread.percentiles[2] == pytest.approx(np.median(spread.values))


def asked_about(changes: list[float], unknown: tuple[float, float] = (math.inf, math.inf)) -> Numbers:
    def question(rows: Places, numbers: Numbers) -> Answers:
        answers = np.where(numbers < np.array(changes)[rows], YES, NO)
        return np.where((unknown[0] < numbers) & (numbers < unknown[1]), OPEN, answers)

    return highest_changes(question, len(changes), Variation('drive.velocity', 1.0, 100.0, 0, True), 1e-6)


def test_changes_are_found_side_by_side() -> None:
    assert asked_about([2.0, 50.0, 0.5, 200.0, 99.9]) == pytest.approx([2.0, 50.0, NOWHERE, ALL_OVER, 99.9], rel=1e-6)


def test_what_is_open_is_known_as_far_as_it_is() -> None:
    assert asked_about([10.0], (9.99, 10.01)) == pytest.approx([10.0], rel=2e-3)
    assert np.isnan(asked_about([10.0], (8.0, 12.0)))
    assert np.isnan(asked_about([200.0], (50.0, 60.0)))   # in there it might have changed twice


def test_the_tool_prints_draws_and_writes_it(tmp_path: Path, capsys: Capture) -> None:
    known = tmp_path / 'known.yaml'
    known.write_text('parameters:\n  axis.normal_force: {distribution: uniform, low: 3000.0, high: 3600.0}\n')
    code, out, err = answered(capsys, 'uncertainty', 'paper_fig7', '--with', known, '--of', 'drive.velocity',
                              '--between', '0.01:0.1', '--samples', '16', '--out', tmp_path / 'spread',
                              '--plot', tmp_path / 'u.png')
    assert (code, err) == (0, '')
    assert 'critical drive.velocity from 0.01 to 0.1 m/s, the highest one, to 0.0001 of the value' in out
    found = json.loads((tmp_path / 'spread/uncertainty.json').read_text())
    low, high = (found['from_rest']['percentiles'][percent] for percent in ('5', '95'))
    assert 0.02 < low < high < 0.04
    assert found['from_rest']['indices']['axis.normal_force']['total'] == pytest.approx(1.0, abs=0.2)
    with (tmp_path / 'spread/critical.csv').open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 16 * 3
    assert 3000.0 <= float(rows[0]['axis.normal_force']) <= 3600.0
    assert 0.02 < float(rows[0]['critical_from_rest']) < 0.04
    assert (tmp_path / 'u.png').stat().st_size > 10_000


@pytest.mark.parametrize(('options', 'said'), [
    (('--between', '0.01:0.1'), '--between needs --of'),
    (('--of', 'drive.velocity', '--resume'), '--of does not take --duration or --resume'),
    (('--of', 'drive.velocity', '--duration', '10'), '--of does not take --duration or --resume'),
    (('--of', 'axis.normal_force'), '--of = .axis.normal_force. is refused: must be another parameter'),
    (('--of', 'drive.velocity', '--between', '1:100'), 'add --allow-implausible drive.velocity'),
    (('--of', 'drive.speed'), 'did you mean'),
])
def test_wrong_use_is_refused(options: tuple[str, ...], said: str, tmp_path: Path, capsys: Capture) -> None:
    given = ('uncertainty', 'paper_fig7', '--with', ROOT / 'examples/friction.yaml', '--out', tmp_path / 'spread')
    assert said.replace('.axis.normal_force.', "'axis.normal_force'") in refused(capsys, *given, *options)
    assert list(tmp_path.iterdir()) == []


def test_a_parameter_that_is_drawn_is_refused() -> None:
    with pytest.raises(InputError, match='another parameter than those that are drawn'):
        study_of({}, uniform('drive.velocity', 1e-3, 1e-2))


# `stickslip critical`: what it prints, and what it refuses in one line.

pytestmark = pytest.mark.slow


def test_the_tool_prints_both_values(capsys: Capture) -> None:
    assert run(['critical', 'paper_fig4_falling', '--of', 'axis.normal_force', '--between', '500:5000']) == 0
    out = capsys.readouterr().out
    assert 'from rest' in out
    assert 'bistable' in out
    assert 'to 2000 N both go on' in out


def test_the_tool_names_breakpoint_and_segment(capsys: Capture) -> None:
    given = ('critical', 'paper_fig7', '--accuracy', '1e-4')
    assert run([*given, '--of', 'drive.velocity', '--between', '0.034:0.036']) == 0
    assert 'the feed is a breakpoint, friction.kinetic.velocities[1]' in capsys.readouterr().out
    assert run([*given, '--of', 'axis.normal_force', '--between', '1990:2010']) == 0
    assert 'the straight segment of mu_k from 0 to 0.035 m/s decides' in capsys.readouterr().out


def test_the_tool_says_that_there_is_no_transition(capsys: Capture) -> None:
    assert run(['critical', 'paper_fig7', '--of', 'drive.velocity', '--between', '1e-4:1e-3']) == 0
    out = capsys.readouterr().out
    assert out.count('no transition') == 2
    assert 'stick-slip all over the range' in out


def test_the_tool_prints_what_is_undecided(capsys: Capture) -> None:
    """With no more digits than the stretch has a use for, rounded outwards."""
    assert run(['critical', 'paper_fig8', '--set', 'drive.velocity=0.02', '--of', 'axis.normal_force', '--between',
                '1900:2300']) == 0
    out = capsys.readouterr().out
    line = r'^from rest      between [\d.]+ and [\d.]+ N, undecided: no stick-slip below, stick-slip above$'
    assert re.search(line, out, re.MULTILINE), out
    low, high = re.findall(r'between ([\d.]+) and ([\d.]+) N', out)[0]
    assert float(low) < 2098.9463 < 2098.9472 < float(high)
    assert max(len(low), len(high)) <= 10    # the stretch is 0.001 N wide


@pytest.mark.parametrize(('arguments', 'said'), [
    (['--of', 'axis.mas'], 'axis.mass'), (['--of', 'contact.model'], 'a number'),
    (['--of', 'axis.mass', '--between', '1'], 'LOW:HIGH'), (['--of', 'axis.mass', '--between', '5:1'], 'swap'),
    (['--of', 'axis.mass', '--between', 'a:1'], 'finite number'), (['--of', 'axis.mass', '--between', '-1:1'], '1e-09'),
    (['--of', 'axis.mass', '--accuracy', '0'], '--accuracy'),
    (['--of', 'axis.mass', '--accuracy', 'nan'], '--accuracy'),
    (['--of', 'force.constant'], '--between'), (['--of', 'contact.stiffness'], '--between'),
    (['--of', 'contact.stiffness', '--between', '1:2'], 'contact.model'),
    (['--of', 'friction.kinetic.coefficients[7]', '--between', '0.1:0.2'], 'has 2')])
def test_wrong_use_gets_one_line(arguments: list[str], said: str, capsys: Capture) -> None:
    assert run(['critical', 'paper_fig7', *arguments]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count('\n')) == ('', 1)
    assert said in err
