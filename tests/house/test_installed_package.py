# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What colcon and the build farm of ROS install: programs, and the files of a ROS package; pip: test_wheel.py."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.copied_package import copy_package
from tests.support.repository import ROOT

PROGRAMS = {'cascade_controller', 'compensating_controller', 'health', 'replay_node', 'sim_node', 'stickslip'}
COLCON = ['colcon', 'build', '--base-paths', '.', '--build-base', '../build', '--install-base', '../install']
INSTALLATIONS = {
    'colcon': COLCON,
    'colcon, with links': [*COLCON, '--symlink-install'],
    'build farm': [sys.executable, 'setup.py', '-q', 'egg_info', '--egg-base', '..', 'build', '--build-base',
                   '../build', 'install', '--root', '../install', '--prefix', '/stickslip_sim'],
}

pytest.importorskip('rclpy')


@pytest.mark.slow
@pytest.mark.parametrize('command', INSTALLATIONS.values(), ids=INSTALLATIONS)
def test_an_installation_has_programs_and_files(command: list[str], tmp_path: Path) -> None:
    environment = {**os.environ, 'STICKSLIP_COMPILED': '0', 'COLCON_LOG_PATH': str(tmp_path / 'log')}
    done = subprocess.run(command, cwd=copy_package(tmp_path), capture_output=True, text=True, timeout=240, check=False,
                          env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    prefix = tmp_path / 'install/stickslip_sim'
    programs = [*(prefix / 'lib/stickslip_sim').iterdir()]
    assert {path.name for path in programs} == PROGRAMS
    assert [path.name for path in (prefix / 'bin').iterdir()] == ['stickslip']
    assert (prefix / 'share/ament_index/resource_index/packages/stickslip_sim').is_file()
    share = prefix / 'share/stickslip_sim'
    for name in ('launch', 'layouts', 'ros2_control', 'security', 'stickslip_sim/scenes'):
        wanted = {path.name for path in (ROOT / 'stickslip_sim' / name).iterdir() if path.is_file()}
        assert {path.name for path in (share / Path(name).name).iterdir()} == wanted, name
    for program in programs:
        done = subprocess.run([program], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False, env={})
        assert (done.returncode, done.stderr.count('\n')) == (2, 1), done.stderr
        assert f'{program.name}: this terminal does not know the workspace: source ' in done.stderr
