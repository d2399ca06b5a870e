# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `health`, asked about real nodes."""

import signal
import subprocess
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticStatus

from stickslip_sim.core.errors import StickslipError
from tests.support.forked_programs import ended_at_once
from tests.support.node_processes import executable, recording_into, running, with_small_files
from tests.support.ros_nodes import client

from stickslip_sim.ros.health_node import health_of  # isort: skip  # after ros_nodes, which skips without ROS

pytestmark = [pytest.mark.ros, pytest.mark.slow]

SLOW = ('-p', 'time.rate:=200.0')    # how an axis is does not depend on it


def health(*ros_args: str) -> tuple[int, str, str]:
    """Return the exit code, standard output and standard error."""
    done = subprocess.run([executable('health'), '--ros-args', *ros_args], capture_output=True, text=True, timeout=60,
                          check=False)
    return done.returncode, done.stdout, done.stderr


class TestAxis:
    def test_one_that_runs_is_well(self) -> None:
        with running(*SLOW, '-r', '__ns:=/press'):
            code, out, errors = health('-r', '__ns:=/press', '-p', 'patience:=20.0')
        assert (code, errors) == (0, '')
        assert out.startswith('/press/feed_axis is well')

    def test_one_that_hangs_says_nothing(self) -> None:
        with running(*SLOW) as process:
            with client() as axis:
                axis.connect()
            process.send(signal.SIGSTOP)
            code, out, errors = health('-p', 'patience:=3.0')
        assert (code, out) == (1, '')
        assert errors.startswith('health: /feed_axis said nothing on /diagnostics within 3 s')

    def test_one_of_another_namespace_is_not_meant(self) -> None:
        with running(*SLOW, '-r', '__ns:=/press') as process:
            with client('/press') as axis:
                axis.connect()
            code, _, errors = health('-p', 'patience:=3.0')
            process.end()
        assert code == 1
        assert 'in this namespace' in errors

    def test_one_whose_recording_failed_is_not_well(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        with running(*recording_into(folder), prepare=with_small_files) as process:
            with client() as axis:
                axis.status('recorder', lambda values: int(values['dropped']) > 0)
            code, out, errors = health('-p', 'patience:=20.0')
            process.end()
        assert (code, out) == (1, '')
        assert errors.startswith('health: /feed_axis is not well: recorder: ')
        assert len(errors.splitlines()) == 1


@pytest.mark.parametrize(('words', 'reported'), [
    (['-p', 'patience:=0.0'], 'patience = 0.0'),
    (['-p', 'patence:=3.0'], 'did you mean patience?'),
    (['--', 'now'], "argument = 'now'"),
])
def test_refused(words: list[str], reported: str) -> None:
    code, errors = ended_at_once('health', '--ros-args', *words)
    assert code == 2
    assert reported in errors
    assert len(errors.splitlines()) == 1


class TestVerdict:
    def test_by_the_worst(self) -> None:
        fine, slow, full = (DiagnosticStatus(name=name, level=level, message=f'{name} reported')
                            for name, level in (('loop', b'\0'), ('command', b'\1'), ('recorder', b'\2')))
        assert health_of('/a', [fine]) == '/a is well: loop: loop reported'
        assert health_of('/a', [fine, slow]) == '/a is well, with warnings: command: command reported'
        with pytest.raises(StickslipError, match=r'not well: recorder: recorder reported$'):
            health_of('/a', [slow, full, fine])
