# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The documented `rosdep install`, by rosdep itself, with the keys of its database that our packages may name."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.repository import ROOT

DATA = ROOT / 'tests/data/rosdep'
INDEX = """\
type: index
version: 4
distributions:
  jazzy:
    distribution: [{data}/distribution.yaml]
    distribution_status: active
    distribution_type: ros2
    python_version: 3
"""

pytest.importorskip('rosdep2')


@pytest.fixture(scope='module')
def environment(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Return that of a rosdep whose database is ours."""
    folder = tmp_path_factory.mktemp('rosdep')
    (folder / 'sources').mkdir()
    (folder / 'sources/20-default.list').write_text(f'yaml file://{DATA}/keys.yaml\n')
    (folder / 'index.yaml').write_text(INDEX.format(data=f'file://{DATA}'))
    outside = {name: value for name, value in os.environ.items() if name != 'AMENT_PREFIX_PATH'}    # of the wheels
    found = {**outside, 'ROSDEP_SOURCE_PATH': str(folder / 'sources'), 'ROS_HOME': str(folder / 'home'),
             'ROSDISTRO_INDEX_URL': f'file://{folder}/index.yaml', 'ROS_DISTRO': 'jazzy'}
    rosdep(found, 'update', '--rosdistro', 'jazzy')
    return found


def rosdep(environment: dict[str, str], *words: str | Path) -> str:
    program = 'import sys; from rosdep2.main import rosdep_main; rosdep_main(sys.argv[1:])'
    done = subprocess.run([sys.executable, '-c', program, *words], env=environment, capture_output=True, text=True,
                          timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_documented_line_finds_a_rule_for_each_dependency(environment: dict[str, str], tmp_path: Path) -> None:
    line = re.search(r'^ +rosdep (install .*)$', (ROOT / 'docs/install.md').read_text(), re.MULTILINE)
    assert line is not None
    (tmp_path / 'src').mkdir()
    for name in ('stickslip_msgs', 'stickslip_sim'):
        (tmp_path / 'src' / name).symlink_to(ROOT / name)
    words = line[1].replace('--from-paths src', f'--from-paths {tmp_path}/src').split()
    asked = rosdep(environment, *words, '--simulate', '--reinstall', '--os', 'ubuntu:noble', '--rosdistro', 'jazzy')
    installed = set(re.findall(r'apt-get install -y (\S+)', asked))
    assert {'ros-jazzy-rclpy', 'ros-jazzy-std-msgs', 'python3-scipy', 'cython3'} <= installed
    assert 'pip' not in asked


def test_the_data_has_no_more_than_is_named(environment: dict[str, str]) -> None:
    named = set(rosdep(environment, 'keys', '--from-paths', ROOT / 'stickslip_msgs', ROOT / 'stickslip_sim').split())
    known = set(re.findall(r'^ *- (\w+)$|^([\w-]+):', (DATA / 'keys.yaml').read_text(), re.MULTILINE)) | set(
        re.findall(r'^ *- (\w+)$', (DATA / 'distribution.yaml').read_text(), re.MULTILINE))
    flat = {word for found in known for word in (found if isinstance(found, tuple) else (found,)) if word}
    assert flat == named - {'stickslip_msgs', 'stickslip_sim'}
