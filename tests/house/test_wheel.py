# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What `pip install ./stickslip_sim` gives to those without ROS: the tool, recording too, and no other program."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.support.copied_package import copy_package
from tests.support.repository import ROOT

SOURCES = ROOT / 'stickslip_sim'


@pytest.fixture(scope='module')
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The unpacked wheel, made offline and without compiled code, which other tests are for."""
    folder = tmp_path_factory.mktemp('wheel')
    done = subprocess.run(
        [sys.executable, '-m', 'pip', 'wheel', '-q', '--no-deps', '--no-build-isolation', '--no-index',
         '--disable-pip-version-check', '-w', folder, copy_package(folder)],
        capture_output=True, text=True, timeout=120, check=False, env={**os.environ, 'STICKSLIP_COMPILED': '0'})
    assert done.returncode == 0, done.stderr
    [file] = folder.glob('*.whl')
    zipfile.ZipFile(file).extractall(folder / 'unpacked')
    return folder / 'unpacked'


def alone(wheel: Path, folder: Path, *arguments: str) -> str:
    """Return what the tool of the wheel prints in an environment that knows no ROS."""
    environment = {'PYTHONPATH': str(wheel), 'STICKSLIP_COMPILED': '0', '_ROS_WHEELS_BOOTSTRAP_COMPLETE': '1'}
    done = subprocess.run([sys.executable, '-m', 'stickslip_sim', *arguments], cwd=folder, capture_output=True,
                          text=True, timeout=120, check=False, env=environment)
    assert (done.returncode, done.stderr) == (0, '')
    return done.stdout


def test_the_tool_is_its_only_program(wheel: Path) -> None:
    [info] = wheel.glob('*.dist-info')
    programs = (info / 'entry_points.txt').read_text().split()
    assert programs == ['[console_scripts]', 'stickslip', '=', 'stickslip_sim.__main__:main']
    assert {path.name for path in wheel.iterdir()} == {info.name, 'stickslip_sim'}


def test_a_run_is_recorded_and_verified_without_ros(wheel: Path, tmp_path: Path) -> None:
    alone(wheel, tmp_path, 'simulate', 'paper_fig8', '--duration', '0.2', '--bag', 'eight')
    assert alone(wheel, tmp_path, 'verify', 'eight').startswith('identical, 201 steps')
    alone(wheel, tmp_path, 'export', 'eight', '--csv', 'states.csv')
    assert (tmp_path / 'states.csv').stat().st_size > 10_000


def test_the_copies_of_the_messages_are_the_messages() -> None:
    """After a change: cp stickslip_msgs/msg/*.msg stickslip_sim/stickslip_sim/recording/stickslip_msgs/."""
    copies, originals = SOURCES / 'stickslip_sim/recording/stickslip_msgs', ROOT / 'stickslip_msgs/msg'
    assert {file.name: file.read_text() for file in copies.iterdir()} \
        == {file.name: file.read_text() for file in originals.glob('*.msg')}
