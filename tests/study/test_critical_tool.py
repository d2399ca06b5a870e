# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip critical`: what it prints, and what it refuses in one line."""

import re

import pytest

from stickslip_sim.cli.main import run
from tests.support.tool import Capture

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
