# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The launch files run by launch itself, where it is installed, which the wheels of ROS lack."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from stickslip_sim.recording import open_bag
from tests.support.launch_files import FILES
from tests.support.ros_nodes import client
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE

pytest.importorskip('launch_ros')
pytestmark = pytest.mark.ros

# What `ros2 launch` does with a file and name:=value; without a terminal, so that launch passes the signal on.
PROGRAM = '''
import sys
from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
file, *words = sys.argv[1:]
service = LaunchService(noninteractive=True)
service.include_launch_description(LaunchDescription([IncludeLaunchDescription(
    PythonLaunchDescriptionSource(file), launch_arguments=[tuple(word.split(':=', 1)) for word in words])]))
sys.exit(service.run())
'''


@contextmanager
def launching(name: str, *words: str, folder: Path) -> Iterator[subprocess.Popen[str]]:
    """Run a launch file, which leaves no process behind; what it records and logs is in the folder."""
    process = subprocess.Popen([sys.executable, '-c', PROGRAM, str(FILES[name]), *words], cwd=folder, text=True,
                               env={**os.environ, 'ROS_LOG_DIR': str(folder / 'log')}, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, start_new_session=True, preexec_fn=restore_interrupt)
    try:
        yield process
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)


def test_two_axes_record_until_interrupted(tmp_path: Path) -> None:
    with launching('axes', 'axes:=x:positioning y:cutting_force', 'rate:=500', 'record:=true',
                   folder=tmp_path) as process:
        for namespace in ('/x', '/y'):
            with client(namespace) as axis:
                axis.connect()
                assert axis.values('time.rate')[0].double_value == 500.0
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0, output
    assert output.count('process has finished cleanly') == 2, output
    scenes = [open_bag(folder).metadata['stickslip']['scene'] for folder in sorted((tmp_path / 'runs').iterdir())]
    assert scenes == ['positioning', 'cutting_force']


@pytest.mark.parametrize(('name', 'word', 'told'), [
    ('sim', 'parameters:=seed', 'NAME:=VALUE'),
    ('controlled', 'controller:=cascade', 'Valid options are'),
    ('axes', 'axes:=x', 'NAMESPACE:SCENE'),
])
def test_wrong_words_start_nothing(name: str, word: str, told: str, tmp_path: Path) -> None:
    with launching(name, word, folder=tmp_path) as process:
        output, _ = process.communicate(timeout=DEADLINE)
    assert process.returncode == 1
    assert told in output
    assert 'process started' not in output
