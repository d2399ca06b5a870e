# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The start of the programs: what is refused, in one line; what parameter files give, which are read as rclcpp does."""

import array
import os
import re
import subprocess
import sys
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node

from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.ros.node.parameters import scene_at_start
from stickslip_sim.ros.programs import GivenParameters, NodeParameters
from stickslip_sim.scene import scene_from_values, scene_names
from stickslip_sim.scene.ros_yaml import plain_value
from tests.support.axis_here import axis_here
from tests.support.node_processes import executable, refusal_of, ros_args
from tests.support.scene_files import HEAD, write

pytestmark = [pytest.mark.ros, pytest.mark.slow]


def refused(*command: str, **options: Any) -> str:
    """Return the one line in which an installed program refuses to start."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, **options)
    line: str = done.stderr
    assert (done.returncode, done.stdout, line.count('\n')) == (2, '', 1), line
    return line


class TestRefusedStart:
    @pytest.mark.parametrize('text', [
        *(f'/**:\n  ros__parameters:\n    scene: mine\n    {content}\n' for content in (
            'axis: {mass: -1.0}', 'axis: {weight: 1.0}', 'axis: {mass: heavy}', 'axis: [',
            'friction: {kinetic: {velocities: [0.0, 1], coefficients: [0.1, 0.1]}}')),
        '', '/**:\n  ros__parameters:\n', '/**:\n  ros__parameters:\n    seed: 3\n',
        '/**:\n  ros__parameters:\n    scene: a\n---\n/**:\n  ros__parameters:\n    scene: b\n',
        '/**:\n  ros__parameters:\n    scene: mine.yaml\n', '/**:\n  ros__parameters:\n    axis: {mass: 0.0}\n',
    ])
    def test_in_the_words_of_the_tool(self, tmp_path: Path, text: str) -> None:
        file = tmp_path / 'scene.yaml'
        file.write_text(text)
        with pytest.raises(InputError) as of_the_tool:
            load_scene(str(file))
        with pytest.raises(InputError) as of_the_node, axis_here('--params-file', file):
            pass
        assert str(of_the_node.value) == str(of_the_tool.value)

    @pytest.mark.parametrize(('name', 'value', 'reported'), [
        ('ROS_DOMAIN_ID', '9999', '0 to 232'), ('ROS_DOMAIN_ID', '-1', '0 to 232'), ('ROS_DOMAIN_ID', 'x', '0 to 232'),
        ('ROS_STATIC_PEERS', 'no address', 'Unable to resolve peer'), ('ROS_LOG_DIR', '/proc/x', '/proc/x'),
        ('AMENT_PREFIX_PATH', '', 'setup.bash'), ('RMW_IMPLEMENTATION', 'rmw_smoke_signals', 'rmw_fastrtps_cpp'),
    ])
    def test_by_the_environment(self, monkeypatch: pytest.MonkeyPatch, name: str, value: str, reported: str) -> None:
        program = executable('sim_node')
        monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')    # that has peers
        monkeypatch.setenv(name, value)
        is_read_at_import = name in ('AMENT_PREFIX_PATH', 'RMW_IMPLEMENTATION')
        line = refused(program) if is_read_at_import else refusal_of('sim_node')
        assert value in line
        assert reported in line

    @pytest.mark.parametrize(('settings', 'reported'), [
        ({'ENABLE': 'True'}, "ENABLE = 'True' is refused: must be true or false"),
        ({'ENABLE': 'true', 'STRATEGY': 'enforce'}, "STRATEGY = 'enforce' is refused: must be Enforce or Permissive"),
        ({'ENABLE': 'true', 'STRATEGY': 'Enforce'}, "KEYSTORE = '' is refused: must be the folder of the keys"),
        ({'ENABLE': 'true', 'STRATEGY': 'Enforce', 'KEYSTORE': '.'}, "ENABLE = 'true' is refused"),
    ])
    def test_security_names_its_variables(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
                                          settings: dict[str, str], reported: str) -> None:
        monkeypatch.chdir(tmp_path)
        for name, value in settings.items():
            monkeypatch.setenv(f'ROS_SECURITY_{name}', value)
        line = refusal_of('sim_node', '--enclave', '/stickslip/feed_axis')
        assert line.startswith(f'sim_node: ROS_SECURITY_{reported}'), line

    @pytest.mark.parametrize(('program', 'words', 'reported'), [
        ('sim_node', 'axis.mas:=1.0', ['axis.mas = 1.0', 'did you mean axis.mass?']),
        ('sim_node', 'scene:=paper_fig9', ['paper_fig9', 'paper_fig8']), ('sim_node', '--nonsense', ['--nonsense']),
        ('sim_node', '--params-file nowhere.yaml', ['nowhere.yaml', 'No such file']),
        ('sim_node', 'record.enabled:=true axis.mass:=-1.0', ['axis.mass = -1.0']),
        ('sim_node', 'solver.name:=adaptive', ['solver.name', 'exact or fixed_step in the node']),
        ('sim_node', 'drive.velocity:=5.0', ['drive.velocity = 5.0 is refused',
                                             "if 5 m/s is intended, add -p 'meant:=["]),
        ('sim_node', 'meant:=drive.velocity', ["meant = 'drive.velocity'", 'a list']),
        ('sim_node', 'time.mode:=lockstep use_sim_time:=true', ['must be false on this node', 'lockstep']),
        ('sim_node', 'time.mode:=free_run use_sim_time:=true', ['must be false on this node', 'free_run']),
        ('sim_node', 'use_sim_time:=3', ["'use_sim_time' to '3'"]),
        ('sim_node', 'thread_priority:=100', ['thread_priority = 100 is refused: must be a whole number, >= 0 and <=']),
        ('sim_node', 'thread_priority:=50 time.mode:=lockstep',
         ['thread_priority = 50 is refused: must be 0 with time.mode: lockstep']),
        ('cascade_controller', 'moves.feed:=-0.001', ['moves.feed = -0.001', '>= 1e-12']),
        ('cascade_controller', 'moves.fed:=0.001', ['moves.fed = 0.001', 'did you mean moves.feed?']),
        ('cascade_controller', 'position_gain:=.nan', ['position_gain = nan']),
        ('cascade_controller', 'integral_time:=0.0', ['integral_time = 0.0', 'or .inf']),
        ('cascade_controller', 'compensation.share:=0.5', ['compensation.share = 0.5', 'one of moves.travel']),
        ('compensating_controller', 'compensation.model:=paper_fig9', ['compensation.model', 'paper_fig8?']),
        ('health', 'patience:=0.0', ['patience = 0.0']), ('health', 'patence:=3.0', ['did you mean patience?']),
        ('health', '-- now', ["argument = 'now'"]),
    ])
    def test_by_words(self, program: str, words: str, reported: list[str]) -> None:
        line = refusal_of(program, *words.split())
        assert all(words in line for words in reported), line

    def test_a_parameter_without_p_is_no_name_to_be_replaced(self) -> None:
        line = refused(executable('sim_node'), 'scene:=positioning')
        assert line.startswith("sim_node: argument = 'scene:=positioning' is refused: must be behind --ros-args -p; "
                               'sim_node --ros-args -p scene:=positioning')

    @pytest.mark.parametrize('program', ['sim_node', 'stickslip'])
    def test_a_terminal_that_does_not_know_the_workspace(self, program: str) -> None:
        plain = {name: os.environ[name] for name in ('PATH', 'HOME')}
        path = executable(program)
        line = refused(path, '--help', env=plain)
        setup = re.fullmatch(rf'{program}: this terminal does not know the workspace: source (/.*/setup.bash), in each '
                             r'terminal\n', line)
        assert setup, line
        subprocess.run(['bash', '-c', f'source {setup[1]} && {path} --help'], timeout=60, check=True, env=plain)


class TestFiles:
    @pytest.mark.parametrize(('texts', 'words', 'scene', 'mass'), [
        (['scene: mine'], [], 'mine', 350.0),
        (['scene: paper_fig7'], ['axis.mass:=300.0'], 'paper_fig7', 300.0),
        (['record: {enabled: false}'], ['scene:=positioning'], 'positioning', 350.0),
        (['{scene: mine, axis: {mass: 200.0}, contact: {stiffness: null}}', 'seed: 5'], ['scene:=yours'],
         'yours', 200.0),
        (['use_sim_time: false'], [], 'paper_fig8', 350.0),
        (['{scene: paper_fig7, meant: null, contact: {stiffness: null}}'], [], 'paper_fig7', 350.0),    # as dumped
    ])
    def test_are_a_scene_by_the_rules_of_the_tool(self, tmp_path: Path, texts: list[str], words: list[str],
                                                  scene: str, mass: float) -> None:
        for number, text in reversed([*enumerate(texts)]):    # what comes later on the command line wins
            file = tmp_path / f'{number}.yaml'
            file.write_text(f'/**:\n  ros__parameters: {text}\n' if text[0] == '{'
                            else f'/**:\n  ros__parameters:\n    {text}\n')
            words = ['--params-file', str(file), *words]
        with axis_here(*words) as axis:
            of_the_node = axis.values('scene', 'axis.mass', 'contact.model', 'friction.static.law')
            assert [value.string_value or value.double_value for value in of_the_node[:2]] == [scene, mass]
            if texts[0].startswith('scene'):
                same = load_scene(str(tmp_path / '0.yaml')).values
                assert [value.string_value for value in of_the_node[2:]] == [
                    same['contact.model'], same['friction.static.law']]

    def test_one_without_friction_and_one_for_other_nodes_are_warned_of(self, tmp_path: Path,
                                                                       capfd: pytest.CaptureFixture[str]) -> None:
        """And an unusual number that is meant is taken."""
        mine, other = tmp_path / 'mine.yaml', tmp_path / 'other.yaml'
        mine.write_text('/**:\n  ros__parameters:\n    scene: position\n')
        other.write_text('/press/feed_axis:\n  ros__parameters:\n    axis: {mass: 1.0}\n')
        files = ('--params-file', str(mine), '--params-file', str(other))
        with axis_here(*files, 'drive.velocity:=5.0', 'meant:=[drive.velocity]') as axis:
            assert axis.values('drive.velocity')[0].double_value == 5.0
        warned = capfd.readouterr().err
        assert 'the scene position leaves out the friction: the axis has none; did you mean positioning?' in warned
        assert f'{other} has no section for /feed_axis' in warned
        assert f'{mine} has no section' not in warned


def test_nothing_is_imported_before_signals_are_taken() -> None:
    program = ('import os, signal, sys, collections.abc; before = set(sys.modules);'
               'import stickslip_sim.ros.executables; print(*sorted(set(sys.modules) - before))')
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.split() == [
        'stickslip_sim', 'stickslip_sim.core', 'stickslip_sim.core.version', 'stickslip_sim.ros',
        'stickslip_sim.ros.executables', 'stickslip_sim.ros.stop_signals']


# Parameter files as rclcpp reads them, with scenes as this package does.

TWO_AXES = """\
/x/feed_axis: {ros__parameters: {scene: positioning, axis: {normal_force: 2500.0}}}
/y/feed_axis: {ros__parameters: {scene: paper_fig7, seed: 4}}
/controller_manager: {ros__parameters: {update_rate: 500, cascade: {type: cascade_controller/Cascade}}}
"""


def given(folder: Path, node: str, *texts: str, single: tuple[str, ...] = ()) -> NodeParameters:
    words = [*single]
    for number, text in enumerate(texts):
        path = folder / f'parameters_{number}.yaml'
        path.write_text(text)
        words += ['--params-file', str(path)]
    return GivenParameters.read(ros_args(*words)).of(node)


@pytest.mark.parametrize(('pattern', 'node', 'fits'), [
    ('/**', '/feed_axis', True), ('/**', '/x/y/feed_axis', True), ('/*', '/feed_axis', True),
    ('/*', '/x/feed_axis', False), ('/*/feed_axis', '/x/feed_axis', True), ('/*/feed_axis', '/feed_axis', False),
    ('/**/feed_axis', '/feed_axis', True),
    ('/**/feed_axis', '/x/y/feed_axis', True), ('/x/**', '/x/y/feed_axis', True), ('/x/**', '/xy/feed_axis', False),
    ('/x/*', '/x/axis', True), ('feed_axis', '/feed_axis', True), ('feed_axis', '/x/feed_axis', False),
    ('/feed_axi', '/feed_axis', False), ('/**/y/*', '/x/y/axis', True),
])
def test_a_section_fits_by_the_full_name(pattern: str, node: str, fits: bool, tmp_path: Path) -> None:
    found = given(tmp_path, node, f'{pattern}: {{ros__parameters: {{seed: 3}}}}\n')
    assert found.in_files == ({'seed': 3} if fits else {})
    assert bool(found.passed_over) is not fits


@pytest.mark.parametrize(('general', 'specific'), [
    ('/**', '/x/**'), ('/**', '/**/feed_axis'), ('/x/**', '/x/*'), ('/**/feed_axis', '/*/feed_axis'),
    ('/*/feed_axis', '/x/feed_axis'), ('/x/**', '/x/feed_axis'),
])
def test_the_specific_holds_over_the_general_in_any_order(general: str, specific: str, tmp_path: Path) -> None:
    texts = [f'{general}: {{ros__parameters: {{seed: 1, scene: mine}}}}\n',
             f'{specific}: {{ros__parameters: {{seed: 2}}}}\n']
    for order in (texts, texts[::-1]):
        for found in (given(tmp_path, '/x/feed_axis', ''.join(order)), given(tmp_path, '/x/feed_axis', *order)):
            assert found.values == {'seed': 2, 'scene': 'mine'}


def test_of_two_alike_the_later_holds_and_single_parameters_over_files(tmp_path: Path) -> None:
    texts = ['/x/**: {ros__parameters: {seed: 1}}\n', '/**/feed_axis: {ros__parameters: {seed: 2}}\n']
    assert given(tmp_path, '/x/feed_axis', *texts).values == {'seed': 2}
    assert given(tmp_path, '/x/feed_axis', *texts[::-1]).values == {'seed': 1}
    found = given(tmp_path, '/feed_axis', '/feed_axis: {ros__parameters: {seed: 1, axis: {mass: 5.0}}}\n',
                  single=('seed:=2', 'feed_axis:time.rate:=500', 'other:seed:=3'))
    assert found.values == {'seed': 2, 'axis.mass': 5.0, 'time.rate': 500}
    assert (found.in_files['seed'], found.single['seed']) == (1, 2)


def test_one_scene_with_one_change_is_the_same_however_it_is_given(tmp_path: Path) -> None:
    text = '/**: {ros__parameters: {scene: positioning, axis: {normal_force: 2500.0}}}\n'
    single = ('scene:=positioning', 'axis.normal_force:=2500.0')
    in_a_file = scene_at_start(given(tmp_path, '/feed_axis', text))
    assert in_a_file == scene_at_start(given(tmp_path, '/feed_axis', single=single))
    halves = text.replace('scene: positioning, ', ''), text.replace(', axis: {normal_force: 2500.0}', '')
    assert in_a_file == scene_at_start(given(tmp_path, '/feed_axis', *halves))
    assert in_a_file == scene_at_start(given(tmp_path, '/feed_axis', halves[0], single=single[:1]))
    assert in_a_file == scene_at_start(given(tmp_path, '/feed_axis', text.replace('positioning', 'paper_fig7'),
                                             single=single[:1]))
    assert (in_a_file.axis.normal_force, in_a_file.name) == (2500.0, 'positioning')


@pytest.mark.parametrize('text', [
    'seed: 3', 'axis: {mass: 3.0}', 'record: {enabled: true}', 'friction: {static: {limit: 0.3}}',
])
def test_a_file_without_a_scene_that_leaves_out_the_friction_is_refused(text: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match='scene is missing'):
        scene_at_start(given(tmp_path, '/feed_axis', f'/**: {{ros__parameters: {{{text}}}}}\n'))


def test_two_axes_and_a_controller_share_a_file(tmp_path: Path) -> None:
    path = tmp_path / 'cell.yaml'
    path.write_text(TWO_AXES)
    for namespace, *expected in (('/x', 'positioning', 0, 2500.0), ('/y', 'paper_fig7', 4, 350 * 9.80665)):
        with axis_here('--params-file', path, '-r', f'__ns:={namespace}') as axis:
            scene, seed, force = axis.values('scene', 'seed', 'axis.normal_force')
            assert [scene.string_value, seed.integer_value, force.double_value] == expected


TEXTS = {
    'nested more than 16 deep': '[' * 100_000,
    'more than 200000 numbers in a list': '[' + '0.1,' * 210_000 + '0.2]\n',
    'at most 1048576 letters': '"' + 'a' * 1_100_000 + '"\n',
}


@pytest.mark.parametrize(('program', 'reported'), [
    *(('sim_node', reported) for reported in TEXTS),
    *((program, 'nested more than 16 deep') for program in (
        'cascade_controller', 'compensating_controller', 'replay_node', 'health'))])
def test_too_deep_or_too_long_for_the_parser_of_ros(program: str, reported: str, tmp_path: Path) -> None:
    path = tmp_path / 'parameters.yaml'
    path.write_text(f'/**:\n  ros__parameters:\n    numbers: {TEXTS[reported]}')
    line = refusal_of(program, '--params-file', path)
    assert line.startswith(f'{program}: {path}: ')
    assert reported in line


def test_one_for_a_controller_takes_effect(tmp_path: Path) -> None:
    path = tmp_path / 'parameters.yaml'
    path.write_text('cascade_controller:\n  ros__parameters:\n    moves: {feed: -1.0}\n')
    assert 'moves.feed = -1.0' in refusal_of('cascade_controller', '--params-file', path)


WORDS = ('350', '350.', '.5', '6e5', '-1E-3', '.inf', '-.inf', 'inf', '0x10', '010', '08', '1_000', '1:30', 'null', '~',
         '2020-01-01', '1e400', '1e-320', 'yes', 'Off', 'y', '1.0f', '9223372036854775808', 'rigid', '+5', '-0', '00',
         '+.INF')
OF_ROS = ('use_sim_time', 'start_type_description_service')


def parameters(path: str) -> dict[str, object]:
    """Return the parameters that a node gets from a file."""
    context = Context()
    rclpy.init(args=['--ros-args', '--params-file', path], context=context)
    node = Node('feed_axis', context=context, automatically_declare_parameters_from_overrides=True,
                start_parameter_services=False, enable_rosout=False)
    values = {name: parameter.value for name, parameter in node.get_parameters_by_prefix('').items()}
    node.destroy_node()
    rclpy.shutdown(context=context)
    return {name: tuple(value) if isinstance(value, (list, array.array)) else value
            for name, value in values.items() if name not in OF_ROS}


@pytest.mark.parametrize('name', scene_names())
def test_a_node_gets_the_same_scene(name: str, tmp_path: Path) -> None:
    scene = load_scene(name)
    assert scene_from_values(parameters(str(files('stickslip_sim') / 'scenes' / f'{name}.yaml'))) == scene
    assert parameters(write(tmp_path, scene.text, '')) == scene.values


def test_plain_words_have_the_same_types(tmp_path: Path) -> None:
    read = parameters(write(tmp_path, ''.join(f'    a{i}: {word}\n' for i, word in enumerate(WORDS)), HEAD))
    expected = {f'a{i}': plain_value(word) for i, word in enumerate(WORDS)}
    assert read == expected
    assert [type(read[name]) for name in expected] == [type(value) for value in expected.values()]


def test_extreme_values_survive(tmp_path: Path) -> None:
    scene = load_scene('paper_fig8', {'scene': 'a "q" \\ é 😀 #: y', 'axis.mass': 1e-9, 'seed': 2**63 - 1,
                                      'axis.drive_stiffness': 1e18, 'axis.drive_damping': 2.3e-308})
    assert parameters(write(tmp_path, scene.text, '')) == scene.values
