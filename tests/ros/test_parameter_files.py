# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Parameter files as rclcpp reads them, with scenes as this package does: what fits a node, and what is refused."""

import array
from importlib.resources import files
from pathlib import Path

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
from tests.support.node_processes import refusal_of, ros_args
from tests.support.scene_files import HEAD, write

pytestmark = pytest.mark.ros

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
