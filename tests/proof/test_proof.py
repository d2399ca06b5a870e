# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The extremes in their reduced size; and that the suite calls a wrong engine wrong."""

import json
from pathlib import Path

import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.proof.judges import Setup, Tally
from stickslip_sim.proof.suite import EXTREMES, chosen, results
from stickslip_sim.solvers import fixed_step

pytestmark = pytest.mark.slow

STEPPED = Setup(full=False, solver=fixed_step.solver('rk4', 1e-3))


@pytest.mark.parametrize('number', [extreme.number for extreme in EXTREMES])
def test_every_mark_is_met(number: str) -> None:
    (outcome,) = results(chosen([number]), Setup(full=False))
    assert outcome.passed, (outcome.finding.figure, outcome.finding.examples)
    assert outcome.finding.cases > 0


@pytest.mark.parametrize('number', ['X1', 'X4', 'X6', 'X16', 'X25'])
def test_a_solver_that_steps_misses_the_mark(number: str) -> None:
    (outcome,) = results(chosen([number]), STEPPED)
    assert not outcome.passed
    assert outcome.finding.misses > 0
    assert outcome.finding.examples


def test_the_extremes_are_in_their_order() -> None:
    numbers = [int(extreme.number.removeprefix('X')) for extreme in EXTREMES]
    assert numbers == list(range(1, len(numbers) + 1))


def test_a_tally_calls_wrong_what_is_wrong() -> None:
    def gives(error: float) -> float:
        return error

    def fails() -> float:
        raise ZeroDivisionError('division')

    assert not Tally(1e-12).finding().passed, 'no case is no success'
    for wrong in (gives, fails):
        tally = Tally(1e-12)
        tally.measure(gives, 1e-13)
        assert tally.finding().passed
        tally.measure(wrong, *([float('nan')] if wrong is gives else []))
        finding = tally.finding()
        assert (finding.passed, finding.misses, finding.cases) == (False, 1, 2)
    too_much = Tally(1e-12)
    too_much.measure(gives, 2e-12)
    assert too_much.finding().misses == 1


def test_the_tool_prints_a_table_and_writes_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ('table.json', 'table.md'):
        assert run(['extremes', '--quick', '--only', 'x10,X13', '--out', str(tmp_path / name)]) == 0
    assert capsys.readouterr().out.count('met ') == 4
    document = json.loads((tmp_path / 'table.json').read_text())
    assert [row['number'] for row in document['extremes']] == ['X10', 'X13']
    assert (document['size'], document['passed']) == ('reduced', True)
    lines = (tmp_path / 'table.md').read_text().splitlines()
    assert [line.split(' | ')[0] for line in lines if line.startswith('| X')] == ['| X10', '| X13']


def test_a_missed_mark_is_exit_code_3(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(Setup.__init__, '__defaults__', (True, STEPPED.solver))
    assert run(['extremes', '--quick', '--only', 'X2']) == 3
    assert 'missed: X2' in capsys.readouterr().err


@pytest.mark.parametrize('arguments', [['--only', 'X99'], ['--only', ''], ['--out', 'table.txt']])
def test_wrong_use_is_refused_by_name(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert run(['extremes', '--quick', *arguments]) == 2
    assert arguments[0] in capsys.readouterr().err
