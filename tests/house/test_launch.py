# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The launch files: what they declare, and what the nodes do that they would start.

The wheels of ROS lack launch; a double of it, tests/support/launch_files.py, takes its place.
"""

import json
import os
import re
import shlex
import signal
import subprocess
import sys
from contextlib import suppress
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
import yaml

from stickslip_sim.core.errors import InputError
from stickslip_sim.recording import open_bag
from stickslip_sim.ros.controllers.controller_node import COMMON, COMPENSATION
from stickslip_sim.scene.schema import BY_NAME
from tests.support import say_words
from tests.support.launch_files import FILES, LAUNCH, Started, launched
from tests.support.node_processes import assert_clean, executable, running
from tests.support.ros_nodes import client
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE

from stickslip_sim.ros.replay.span import REPLAY_PARAMETERS  # isort: skip
from tests.support.robot_descriptions import expanded  # isort: skip
from tests.support.ros2_control_client import Description  # isort: skip

pytestmark = [pytest.mark.ros, pytest.mark.slow]

CONTROLLER = {entry.name for entry in (*COMMON, *COMPENSATION)}
REPLAY = {entry.name: entry.default for entry in REPLAY_PARAMETERS}
KNOWN = {'sim_node': set(BY_NAME), 'replay_node': set(REPLAY), 'cascade_controller': CONTROLLER,
         'compensating_controller': CONTROLLER}
NEEDED = {'replay': {'bag': 'runs/a'}}    # what has no default
OF_SIM = {'scene', 'namespace', 'mode', 'rate', 'record'}
CASES = yaml.safe_load(Path(__file__).with_name('launched.yaml').read_text(encoding='utf-8'))


def given(name: str, **words: str) -> list[Started]:
    """Return what a launch file starts when these arguments are given beside those that it needs."""
    return launched(name, **{**NEEDED.get(name, {}), **words}).processes


def xacro_of(process: Started) -> tuple[Path, list[str]]:
    """Return the file that xacro expands for a node, and the words that it is given."""
    command = re.search(r'\$\(xacro (.*)\)', ' '.join(process.words))
    assert command is not None
    file, *words = shlex.split(command[1])
    return Path(file), words


@pytest.mark.parametrize('name', FILES)
class TestEach:
    def test_arguments_are_reported(self, name: str) -> None:
        declared = launched(name, **NEEDED.get(name, {})).arguments
        assert all(len(argument.description) > 10 for argument in declared)
        assert name == 'replay' or {argument.name for argument in declared} >= OF_SIM

    def test_names_exist(self, name: str) -> None:
        for process in launched(name, **NEEDED.get(name, {})).ours:
            assert executable(process.executable)
            parameters = {word.partition(':=')[0] for flag, word in pairwise(process.words) if flag == '-p'}
            assert parameters <= KNOWN[process.executable]

    def test_its_head_shows_how_to_start_it(self, name: str) -> None:
        assert f'ros2 launch stickslip_sim {name}.launch.py' in FILES[name].read_text(encoding='utf-8').split('"""')[1]


class TestWords:
    """What the nodes of a launch file are started with."""

    @pytest.mark.parametrize('case', CASES, ids=lambda case: f'{case["file"]}: {case["case"]}')
    def test_are_those_of_the_case(self, case: Any) -> None:
        started = ['  '.join([process.executable, *process.words]) for process in given(case['file'], **case['given'])]
        assert [line.replace(str(LAUNCH.parent), 'SHARE') for line in started] == case['starts'].splitlines()
        for shipped in re.findall(r'SHARE/([\w/.]+)', case['starts']):
            assert (LAUNCH.parent / shipped).is_file()

    def test_controlled_ends_with_the_first_that_ends(self) -> None:
        assert launched('controlled').ends == ['shutdown']

    def test_display_gives_the_description_its_prefix(self) -> None:
        file, words = xacro_of(given('display', prefix='x_')[0])
        assert '"x_axis_slider"' in expanded(file, *words)

    @pytest.mark.parametrize(('namespace', 'prefix'), [('mill', '/mill'), ('/mill/', '/mill'), ('', '')])
    def test_ros2_control_gives_the_hardware_the_topics_of_the_axis(self, namespace: str, prefix: str) -> None:
        _, words = xacro_of(given('ros2_control', namespace=namespace)[0])
        for name in ('joint_states', 'joint_commands'):
            assert Description(*words).parameters[f'{name}_topic'] == f'{prefix}/{name}'

    def test_replay_has_the_defaults_of_the_node(self) -> None:
        for argument in launched('replay', **NEEDED['replay']).arguments:
            if argument.default_value:    # empty is left out
                assert yaml.safe_load(argument.default_value) == REPLAY[argument.name]


class TestRefusals:
    @pytest.mark.parametrize(('name', 'words', 'message'), [
        ('sim', {'parameters': 'seed 3'}, '^parameters: .*NAME:=VALUE'),
        ('sim', {'parameters': 'seed := 3'}, '^parameters: .*NAME:=VALUE'),
        ('sim', {'parameters': "seed:='3"}, '^parameters: .*close each quote'),
        *(('axes', {'axes': axes}, 'NAMESPACE:SCENE')
          for axes in ('', 'x', ':positioning', 'x:', 'x:positioning /x:paper_fig8')),
    ])
    def test_of_values(self, name: str, words: dict[str, str], message: str) -> None:
        with pytest.raises(ValueError, match=message):
            given(name, **words)

    @pytest.mark.parametrize(('name', 'argument', 'value'), [
        ('controlled', 'controller', 'cascade'), ('replay', 'mode', 'events'), ('ros2_control', 'controller', 'none'),
        ('display', 'rviz', 'no')])
    def test_of_a_choice_that_is_none(self, name: str, argument: str, value: str) -> None:
        with pytest.raises(RuntimeError, match=f'Argument "{argument}" provided value "{value}" is not valid'):
            given(name, **{argument: value})

    def test_of_a_replay_without_a_bag(self) -> None:
        with pytest.raises(RuntimeError, match='"bag" was not provided'):
            launched('replay')

    @pytest.mark.parametrize(('name', 'word', 'advice'), [
        ('sim', 'scen:=paper_fig7', 'did you mean scene'), ('controlled', 'fed:=0.01', 'did you mean feed'),
        ('controlled', 'flder:=a', 'did you mean folder'), ('axes', 'scene:=paper_fig7', 'drop it'),
        ('replay', 'topic:=a', 'did you mean topics'), ('display', 'prefx:=x_', 'did you mean prefix'),
        ('ros2_control', 'namspace:=a', 'did you mean namespace')])
    def test_of_an_argument_that_is_none(self, monkeypatch: pytest.MonkeyPatch, name: str, word: str,
                                         advice: str) -> None:
        """Launch itself passes over it."""
        monkeypatch.setattr('sys.argv', ['ros2', 'launch', 'stickslip_sim', f'{name}.launch.py', 'launch-prefix:=a',
                                         word])
        with pytest.raises(InputError, match=f"^{word.partition(':=')[0]} = .* is refused: .*{advice}"):
            given(name)

    def test_not_of_arguments_of_a_file_that_includes_it(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr('sys.argv', ['ros2', 'launch', 'cell', 'cell.launch.py', 'robot:=arm'])
        assert launched('controlled').ours


class TestNodes:
    """The nodes that would be started."""

    def test_of_sim(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        axis, = given('sim', scene='cutting_force', namespace='press', mode='free_run', rate='500', record='true',
                      folder=str(folder), parameters='seed:=3 time.factor:=2.0', clock='clock')
        with running(*axis.words) as process, client('/press') as press:
            press.connect()
            press.next('slider_state', lambda state: state.step > 100)
            values = press.values('time.rate', 'seed')
            assert press.node.count_publishers('/press/clock') == 1
            assert press.node.count_publishers('/clock') == 0
            code, errors = process.end()
        assert code == 0, errors
        assert (values[0].double_value, values[1].integer_value) == (500.0, 3)
        facts = open_bag(folder).metadata['stickslip']
        assert (facts['scene'], facts['rate']) == ('cutting_force', '500.0')

    def test_of_controlled(self, tmp_path: Path) -> None:
        axis, controller = given('controlled', namespace='mill', folder=str(tmp_path / 'run'),
                                 feed='0.01', prefix='y')    # to YAML a truth value
        with running(*axis.words) as bench, client('/mill') as mill:
            mill.connect()
            with running(*controller.words, program=controller.executable) as following:
                mill.next('slider_state', lambda state: state.position > 0.0005)
                assert_clean(*following.end())
            assert_clean(*bench.end())


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


def said_by_launch(name: str, *words: str, folder: Path) -> tuple[int, str]:
    """Run a launch file until it ends; return its exit code and what it printed.  It leaves no process behind."""
    process = subprocess.Popen([sys.executable, '-c', PROGRAM, str(FILES[name]), *words], cwd=folder, text=True,
                               env={**os.environ, 'ROS_LOG_DIR': str(folder / 'log')}, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, start_new_session=True, preexec_fn=restore_interrupt)
    try:
        output, _ = process.communicate(timeout=DEADLINE)
        return process.returncode, output
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)


@pytest.mark.skipif(find_spec('launch_ros') is None, reason='launch is not installed')
class TestLaunchItself:
    """Here the double is held to what launch does, too; `.ci/ros2 launch` runs the nodes, and gives wrong words."""

    def test_an_axis_ends_with_its_controller(self, tmp_path: Path) -> None:
        _, output = said_by_launch('controlled', 'feed:=-1.0', 'record:=false', folder=tmp_path)
        assert 'moves.feed = -1.0 is refused' in output
        assert 'process[cascade_controller-2] was required: shutting down launched system' in output
        assert '[sim_node-1]: process has finished cleanly' in output

    @pytest.mark.parametrize('case', [case for case in CASES if case['file'] not in ('display', 'ros2_control')],
                             ids=lambda case: f'{case["file"]}: {case["case"]}')
    def test_the_double_starts_what_launch_starts(self, case: Any, tmp_path: Path) -> None:
        """Launch puts a program in front of each command, which writes its words and does not run it."""
        written = tmp_path / 'written'
        prefix = f'launch-prefix:={sys.executable} {say_words.__file__} {written}'
        given_words = (f'{key}:={value}' for key, value in case['given'].items())
        code, output = said_by_launch(case['file'], prefix, *given_words, folder=tmp_path)
        assert code == 0, output
        commands = [json.loads(line) for line in written.read_text(encoding='utf-8').splitlines()]
        assert sorted([Path(program).name, *words] for program, *words in commands) == sorted(
            [started.executable, *started.words] for started in given(case['file'], **case['given']))

    @pytest.mark.parametrize('name', FILES)
    def test_the_double_knows_the_arguments_that_launch_knows(self, name: str) -> None:
        """Those that `ros2 launch --show-args` shows."""
        from launch import LaunchContext
        from launch.launch_description_sources import PythonLaunchDescriptionSource
        from launch.utilities import perform_substitutions
        context = LaunchContext()
        declared = launched(name, **NEEDED.get(name, {})).arguments
        ours = {argument.name: argument for argument in reversed(declared)}    # the first counts
        description = PythonLaunchDescriptionSource(str(FILES[name])).get_launch_description(context)
        for theirs in description.get_launch_arguments():
            default = theirs.default_value and perform_substitutions(context, theirs.default_value)
            assert (ours[theirs.name].default_value, ours[theirs.name].choices) == (default, theirs.choices)
            assert theirs.description.startswith(ours[theirs.name].description)    # launch adds the choices
