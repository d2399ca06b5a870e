# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What is installed: programs, the files of a ROS package, and the compiled hot path."""

import os
import subprocess
import sys
from pathlib import Path

import pytest


def test_the_programs_are_where_ros2_run_looks(prefix: Path) -> None:
    programs = (prefix / 'lib/stickslip_sim').iterdir()
    assert {path.name for path in programs if os.access(path, os.X_OK)} == {
        'cascade_controller', 'compensating_controller', 'health', 'replay_node', 'sim_node', 'stickslip'}


def test_the_files_of_the_package(prefix: Path) -> None:
    share = prefix / 'share/stickslip_sim'
    assert (share / 'package.xml').is_file()
    assert (share / 'launch/sim.launch.py').is_file()
    assert (share / 'scenes/paper_fig8.yaml').is_file()


@pytest.mark.skipif(os.environ.get('STICKSLIP_COMPILED') == '0', reason='plain Python was asked for')
def test_the_hot_path_is_compiled(tmp_path: Path) -> None:
    program = 'from stickslip_sim.core.hot_path import hot_path; print(hot_path())'
    done = subprocess.run([sys.executable, '-c', program], cwd=tmp_path, capture_output=True, text=True, timeout=60,
                          check=True)
    assert (done.stdout, done.stderr) == ('compiled\n', '')
