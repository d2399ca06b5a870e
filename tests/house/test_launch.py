# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The launch files: what they declare, and what the nodes do that they would start."""

import re
import shlex
from pathlib import Path

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.recording import open_bag
from stickslip_sim.scene.schema import BY_NAME
from tests.support.launch_files import FILES, LAUNCH, Started, launched
from tests.support.node_processes import assert_clean, executable, running
from tests.support.ros_nodes import client

from stickslip_sim.ros.controllers.controller_parameters import (  # isort: skip  # after ros_nodes, which skips
    COMMON, COMPENSATION,
)
from stickslip_sim.ros.replay.replay_settings import REPLAY_PARAMETERS  # isort: skip
from tests.support.robot_descriptions import expanded  # isort: skip
from tests.support.ros2_control_client import Description  # isort: skip

pytestmark = [pytest.mark.ros, pytest.mark.slow]

CONTROLLER = {entry.name for entry in (*COMMON, *COMPENSATION)}
KNOWN = {'sim_node': set(BY_NAME), 'replay_node': {entry.name for entry in REPLAY_PARAMETERS},
         'cascade_controller': CONTROLLER, 'compensating_controller': CONTROLLER}
NEEDED = {'replay': {'bag': 'runs/a'}}    # what has no default
OF_SIM = {'scene', 'namespace', 'mode', 'rate', 'record'}


def parameters_of(process: Started) -> list[str]:
    return [word.partition(':=')[0] for flag, word in zip(process.words, process.words[1:]) if flag == '-p']


def words_of(process: Started) -> str:
    return ' '.join(process.words)


def test_all_of_them_are_looked_at() -> None:
    assert set(FILES) >= {'sim', 'controlled', 'axes', 'display', 'ros2_control'}


@pytest.mark.parametrize('name', FILES)
class TestEach:
    def test_arguments_are_reported(self, name: str) -> None:
        declared = launched(name, **NEEDED.get(name, {})).arguments
        assert all(len(argument.description) > 10 for argument in declared)
        assert name == 'replay' or {argument.name for argument in declared} >= OF_SIM

    def test_names_exist(self, name: str) -> None:
        for process in launched(name, **NEEDED.get(name, {})).ours:
            assert executable(process.executable)
            assert set(parameters_of(process)) <= KNOWN[process.executable]

    def test_its_head_shows_how_to_start_it(self, name: str) -> None:
        head = FILES[name].read_text(encoding='utf-8').split('"""')[1]
        assert f'ros2 launch stickslip_sim {name}.launch.py' in head


class TestSim:
    def test_what_is_empty_is_left_to_the_scene(self) -> None:
        axis, = launched('sim').processes
        assert axis.executable == 'sim_node'
        assert words_of(axis) == ('--ros-args -p scene:=paper_fig8 --ros-args -r __node:=feed_axis -r __ns:=/'
                                  ' -r /clock:=/clock -r joint_states:=joint_states')

    def test_further_parameters_may_have_blanks(self) -> None:
        axis, = launched('sim', parameters="seed:=3 friction.kinetic.velocities:='[0.0, 0.1]'").processes
        assert axis.words[3:7] == ['-p', 'seed:=3', '-p', 'friction.kinetic.velocities:=[0.0, 0.1]']

    @pytest.mark.parametrize(('parameters', 'advice'), [
        ('seed 3', 'NAME:=VALUE'), ('seed := 3', 'NAME:=VALUE'), ("seed:='3", 'close each quote')])
    def test_parameters_that_are_none_are_refused(self, parameters: str, advice: str) -> None:
        with pytest.raises(ValueError, match=f'^parameters: .*{advice}'):
            launched('sim', parameters=parameters)

    def test_for_real(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        axis, = launched('sim', scene='cutting_force', namespace='press', mode='free_run', rate='500', record='true',
                         folder=str(folder), parameters='seed:=3 time.factor:=2.0', clock='clock').processes
        with running(*axis.words, afresh=True) as process, client('/press') as press:
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


class TestControlled:
    def test_both_in_one_namespace(self) -> None:
        axis, controller = launched('controlled', namespace='mill', rate='2000', controller='compensating_controller',
                                    parameters='seed:=3').processes
        assert (axis.executable, controller.executable) == ('sim_node', 'compensating_controller')
        assert '-r __ns:=/mill' in words_of(axis)
        assert '-r __ns:=/mill' in words_of(controller)
        assert parameters_of(axis) == ['scene', 'time.rate', 'record.enabled', 'joint_interface.enabled',
                                       'drive.course', 'drive.velocity', 'joint_interface.prefix', 'seed']
        assert parameters_of(controller) == ['moves.feed', 'moves.travel', 'joint_interface.prefix']

    def test_it_ends_with_the_first_that_ends(self) -> None:
        assert launched('controlled').ends == ['shutdown']

    def test_the_controller_moves_the_axis(self, tmp_path: Path) -> None:
        axis, controller = launched('controlled', namespace='mill', folder=str(tmp_path / 'run'),
                                    feed='0.01', prefix='y').processes    # to YAML a truth value
        with running(*axis.words, afresh=True) as bench, client('/mill') as mill:
            mill.connect()
            with running(*controller.words, program=controller.executable, afresh=True) as following:
                mill.next('slider_state', lambda state: state.position > 0.0005)
                assert_clean(*following.end())
            assert_clean(*bench.end())


class TestAxes:
    @pytest.mark.parametrize('axes', ['', 'x', ':positioning', 'x:', 'x:positioning /x:paper_fig8'])
    def test_what_is_no_axis_is_refused(self, axes: str) -> None:
        with pytest.raises(ValueError, match='NAMESPACE:SCENE'):
            launched('axes', axes=axes)

    def test_each_in_its_namespace_with_its_clock(self) -> None:
        x, y = launched('axes', axes='x:positioning y:/a/scene.yaml', rate='500').processes
        assert parameters_of(x) == parameters_of(y) == ['scene', 'time.rate']
        assert 'scene:=positioning' in x.words
        assert 'scene:=/a/scene.yaml' in y.words
        for namespace, axis in (('/x', x), ('/y', y)):
            assert words_of(axis).endswith(f'-r __ns:={namespace} -r /clock:=clock -r joint_states:=joint_states')

    def test_joints_with_prefixes_on_one_topic(self) -> None:
        x, y = launched('axes', axes='x:positioning cell/y:paper_fig8', joints='/joint_states',
                        parameters='seed:=3').processes
        for prefix, axis in (('x_', x), ('cell/y_', y)):
            assert parameters_of(axis) == ['scene', 'joint_interface.enabled', 'joint_interface.prefix', 'seed']
            assert f"joint_interface.prefix:='{prefix}'" in axis.words
            assert words_of(axis).endswith('-r joint_states:=/joint_states')


class TestDisplay:
    def test_axis_description_and_rviz(self) -> None:
        publisher, rviz, axis = launched('display', namespace='mill', prefix='y', parameters='seed:=3').processes
        assert parameters_of(axis) == ['scene', 'joint_interface.enabled', 'joint_interface.prefix', 'seed']
        assert "joint_interface.prefix:='y'" in axis.words
        for node in (publisher, axis):
            assert '-r joint_states:=/joint_states' in words_of(node)
        assert rviz.words[:2] == ['-d', f'{LAUNCH.parent}/rviz/feed_axis.rviz']
        assert Path(rviz.words[1]).is_file()

    def test_xacro_gives_the_description_the_prefix(self) -> None:
        command = re.search(r'\$\((.*)\)', words_of(launched('display', prefix='x_').processes[0]))
        assert command is not None
        xacro, file, *words = shlex.split(command[1])
        assert (xacro, file) == ('xacro', f'{LAUNCH.parent}/urdf/feed_axis.urdf.xacro')
        assert '"x_axis_slider"' in expanded(Path(file), *words)

    def test_of_axes_that_run_already(self) -> None:
        publisher, = launched('display', axis='false', rviz='false', description='cross_table.urdf.xacro').processes
        assert f'{LAUNCH.parent}/urdf/cross_table.urdf.xacro' in words_of(publisher)

    def test_a_path_is_a_file_of_your_own(self) -> None:
        publisher, rviz, _ = launched('display', description='/a b/c.xacro', rviz_config='/a b/c.rviz').processes
        assert "'/a b/c.xacro'" in words_of(publisher)
        assert rviz.words[1] == '/a b/c.rviz'


class TestRos2Control:
    def test_shipped_files_and_topics_of_the_axis(self) -> None:
        publisher, manager, broadcaster, spawner, axis = launched('ros2_control', namespace='mill',
                                                                   parameters='seed:=3').processes
        assert '-r __ns:=/mill' in words_of(axis)
        assert parameters_of(axis) == ['scene', 'joint_interface.enabled', 'seed']
        assert f'{LAUNCH.parent}/ros2_control/feed_axis.ros2_control.xacro' in words_of(publisher)
        shipped = f'{LAUNCH.parent}/ros2_control/controllers.yaml'
        assert all(shipped in process.words for process in (manager, broadcaster, spawner))
        assert [process.words[0] for process in (broadcaster, spawner)] == ['joint_state_broadcaster',
                                                                            'velocity_controller']

    @pytest.mark.parametrize(('namespace', 'prefix'), [('mill', '/mill'), ('/mill/', '/mill'), ('', '')])
    def test_xacro_gives_the_hardware_the_topics_of_the_axis(self, namespace: str, prefix: str) -> None:
        publisher = launched('ros2_control', namespace=namespace).processes[0]
        command = re.search(r'\$\((.*)\)', words_of(publisher))
        assert command is not None
        xacro, file, *arguments = shlex.split(command[1])
        assert (xacro, file) == ('xacro', f'{LAUNCH.parent}/ros2_control/feed_axis.ros2_control.xacro')
        parameters = Description(*arguments).parameters
        for name in ('joint_states', 'joint_commands'):
            assert parameters[f'{name}_topic'] == f'{prefix}/{name}'


@pytest.mark.parametrize(('name', 'argument', 'value'), [
    ('controlled', 'controller', 'cascade'), ('replay', 'mode', 'events'), ('ros2_control', 'controller', 'none'),
    ('display', 'rviz', 'no')])
def test_a_choice_that_is_none_is_refused(name: str, argument: str, value: str) -> None:
    with pytest.raises(RuntimeError, match=f'Argument "{argument}" provided value "{value}" is not valid'):
        launched(name, **{**NEEDED.get(name, {}), argument: value})


class TestReplay:
    def test_needs_a_bag(self) -> None:
        with pytest.raises(RuntimeError, match='"bag" was not provided'):
            launched('replay')

    def test_what_is_empty_is_left_out(self) -> None:
        every, some = (launched('replay', bag='runs/a', **given).processes[0] for given in (
            {}, {'topics': '[slider_state, mode_event]', 'mode': 'commands', 'axis': '/mill/feed_axis'}))
        assert {'topics', 'axis'} & set(parameters_of(every)) == set()
        assert {'topics:=[slider_state, mode_event]', 'axis:=/mill/feed_axis'} <= set(some.words)


@pytest.mark.parametrize(('name', 'word', 'advice'), [
    ('sim', 'scen:=paper_fig7', 'did you mean scene'), ('controlled', 'fed:=0.01', 'did you mean feed'),
    ('controlled', 'flder:=a', 'did you mean folder'), ('axes', 'scene:=paper_fig7', 'drop it'),
    ('replay', 'topic:=a', 'did you mean topics'), ('display', 'prefx:=x_', 'did you mean prefix'),
    ('ros2_control', 'namspace:=a', 'did you mean namespace')])
def test_an_argument_that_is_none_is_refused(monkeypatch: pytest.MonkeyPatch, name: str, word: str,
                                             advice: str) -> None:
    """Launch itself passes over it."""
    monkeypatch.setattr('sys.argv', ['ros2', 'launch', 'stickslip_sim', f'{name}.launch.py', 'launch-prefix:=a', word])
    with pytest.raises(InputError, match=f"^{word.partition(':=')[0]} = .* is refused: .*{advice}"):
        launched(name, **NEEDED.get(name, {}))


def test_a_file_that_includes_one_has_arguments_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('sys.argv', ['ros2', 'launch', 'cell', 'cell.launch.py', 'robot:=arm'])
    assert launched('controlled').ours
