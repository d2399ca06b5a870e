# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Parameter files on which the parser of ROS would sit for minutes: each program refuses them first, in one line."""

import subprocess
from pathlib import Path

import pytest

from tests.support.forked_programs import ended_at_once
from tests.support.node_processes import executable
from tests.support.waiting import DEADLINE

pytestmark = pytest.mark.ros

PROGRAMS = ['sim_node', 'cascade_controller', 'compensating_controller', 'replay_node', 'health']
HEAD = '/**:\n  ros__parameters:\n    numbers: '


def refusal(program: str, path: Path) -> str:
    code, errors = ended_at_once(program, '--ros-args', '--params-file', path)
    assert code == 2, errors
    (line,) = errors.splitlines()
    assert line.startswith(f'{program}: {path}: ')
    return line


@pytest.mark.parametrize('program', PROGRAMS)
@pytest.mark.parametrize(('text', 'reported'), [
    (HEAD + '[' * 100_000, 'nested more than 16 deep'),
    (HEAD + '[' + '0.1,' * 210_000 + '0.2]\n', 'more than 200000 numbers in a list'),
    (HEAD + '"' + 'a' * 1_100_000 + '"\n', 'at most 1048576 letters'),
])
def test_too_deep_or_too_long(program: str, text: str, reported: str, tmp_path: Path) -> None:
    path = tmp_path / 'parameters.yaml'
    path.write_text(text)
    assert reported in refusal(program, path)


def test_one_that_is_fit_to_read_takes_effect(tmp_path: Path) -> None:
    path = tmp_path / 'parameters.yaml'
    path.write_text('cascade_controller:\n  ros__parameters:\n    moves: {feed: -1.0}\n')
    done = subprocess.run([executable('cascade_controller'), '--ros-args', '--params-file', path], capture_output=True,
                          text=True, timeout=DEADLINE, check=False)
    assert done.returncode == 2
    assert 'moves.feed = -1.0' in done.stderr
