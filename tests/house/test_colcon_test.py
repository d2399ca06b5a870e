# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`colcon test` in the built workspace runs the tests of the packages."""

import re
import subprocess
from pathlib import Path

import pytest

from tests.support.repository import ROOT

pytest.importorskip('rclpy')


@pytest.mark.ros
@pytest.mark.slow
def test_colcon_test_runs_the_tests_of_the_packages(tmp_path: Path) -> None:
    def colcon(*words: str | Path) -> str:
        done = subprocess.run(['colcon', '--log-base', tmp_path / 'log', *words], cwd=ROOT / 'ros2_ws',
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=240, check=False)
        assert done.returncode == 0, done.stdout
        return done.stdout

    colcon('test', '--test-result-base', tmp_path, '--return-code-on-test-failure', '--event-handlers',
           'console_cohesion+')
    summary = colcon('test-result', '--test-result-base', tmp_path, '--all')
    counts = re.search(r'^Summary: (\d+) tests, 0 errors, 0 failures, 0 skipped$', summary, re.MULTILINE)
    assert counts is not None, summary
    assert int(counts[1]) >= 10
