# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The launch files run by launch itself, where it is installed, which the wheels of ROS lack.

Here the double of `tests/support/launch_files.py`, which takes its place elsewhere, is held to what launch does.
"""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from stickslip_sim.recording import open_bag
from tests.support import say_words
from tests.support.launch_files import FILES, launched
from tests.support.ros_nodes import client
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE

pytest.importorskip('launch_ros')
pytestmark = pytest.mark.ros

LAUNCHED = [
    ('sim', {}),
    ('sim', {'scene': 'cutting_force', 'namespace': 'press', 'mode': 'free_run', 'rate': '500', 'record': 'true',
             'folder': 'runs/a', 'clock': 'clock', 'parameters': "seed:=3 friction.kinetic.velocities:='[0.0, 0.1]'"}),
    ('controlled', {}),
    ('controlled', {'namespace': 'mill', 'rate': '2000', 'controller': 'compensating_controller', 'feed': '0.01',
                    'parameters': 'seed:=3'}),
    ('axes', {}),
    ('axes', {'axes': 'x:positioning y:/a/scene.yaml', 'rate': '500', 'record': 'true'}),
    ('axes', {'axes': 'x:positioning y:positioning', 'joints': '/joint_states', 'parameters': 'seed:=3'}),
    ('replay', {'bag': 'runs/a', 'loop': 'true'}),
    ('replay', {'bag': 'runs/a', 'mode': 'commands', 'topics': '[drive_velocity]', 'axis': '/mill/feed_axis'}),
]

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

# What a launch file itself declares, as `ros2 launch --show-args` sees it.
ARGUMENTS = '''
import json, sys
from launch import LaunchContext
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.utilities import perform_substitutions
context = LaunchContext()
description = PythonLaunchDescriptionSource(sys.argv[1]).get_launch_description(context)
print(json.dumps({argument.name: [
    argument.default_value and perform_substitutions(context, argument.default_value),
    argument.description, argument.choices] for argument in description.get_launch_arguments()}))
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


def test_an_axis_ends_with_its_controller(tmp_path: Path) -> None:
    with launching('controlled', 'feed:=-1.0', 'record:=false', folder=tmp_path) as process:
        output, _ = process.communicate(timeout=DEADLINE)
    assert 'moves.feed = -1.0 is refused' in output
    assert 'process[cascade_controller-2] was required: shutting down launched system' in output
    assert '[sim_node-1]: process has finished cleanly' in output


@pytest.mark.parametrize(('name', 'given'), LAUNCHED)
def test_the_double_starts_what_launch_starts(name: str, given: dict[str, str], tmp_path: Path) -> None:
    """Launch puts a program in front of each command, which writes its words and does not run it."""
    written = tmp_path / 'written'
    prefix = f'launch-prefix:={sys.executable} {say_words.__file__} {written}'
    with launching(name, prefix, *(f'{key}:={value}' for key, value in given.items()), folder=tmp_path) as process:
        output, _ = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0, output
    commands = [json.loads(line) for line in written.read_text(encoding='utf-8').splitlines()]
    assert sorted([Path(program).name, *words] for program, *words in commands) == sorted(
        [started.executable, *started.words] for started in launched(name, **given).processes)


@pytest.mark.parametrize('name', FILES)
def test_the_double_knows_the_arguments_that_launch_knows(name: str) -> None:
    done = subprocess.run([sys.executable, '-c', ARGUMENTS, str(FILES[name])], capture_output=True, text=True,
                          timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    needed = {'bag': 'runs/a'} if name == 'replay' else {}
    ours = {argument.name: argument for argument in reversed(launched(name, **needed).arguments)}    # the first counts
    for argument, (default, description, choices) in json.loads(done.stdout).items():
        assert (ours[argument].default_value, ours[argument].choices) == (default, choices)
        assert description.startswith(ours[argument].description)    # launch adds the choices


@pytest.mark.parametrize(('name', 'word', 'reported'), [
    ('sim', 'parameters:=seed', 'NAME:=VALUE'),
    ('controlled', 'controller:=cascade', 'Valid options are'),
    ('axes', 'axes:=x', 'NAMESPACE:SCENE'),
    ('sim', 'scen:=paper_fig7', 'did you mean scene?'),
    ('controlled', 'flder:=a', 'did you mean folder?'),
])
def test_wrong_words_start_nothing(name: str, word: str, reported: str, tmp_path: Path) -> None:
    with launching(name, word, folder=tmp_path) as process:
        output, _ = process.communicate(timeout=DEADLINE)
    assert process.returncode == 1
    assert reported in output
    assert 'process started' not in output
