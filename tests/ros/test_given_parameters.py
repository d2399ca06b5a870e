# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Parameter files for several nodes: what fits a node reaches it, as rclcpp reads them, and the rest is passed over."""

from pathlib import Path

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.ros.node.parameters import scene_at_start
from stickslip_sim.ros.programs import GivenParameters, NodeParameters
from tests.support.node_processes import running
from tests.support.ros_nodes import client

pytestmark = pytest.mark.ros

TWO_AXES = """\
/x/feed_axis: {ros__parameters: {scene: positioning, axis: {normal_force: 2500.0}}}
/y/feed_axis: {ros__parameters: {scene: paper_fig7, seed: 4}}
/controller_manager: {ros__parameters: {update_rate: 500, cascade: {type: cascade_controller/Cascade}}}
"""


def given(folder: Path, node: str, *texts: str, single: tuple[str, ...] = ()) -> NodeParameters:
    words = [word for each in single for word in ('-p', each)]
    for number, text in enumerate(texts):
        path = folder / f'parameters_{number}.yaml'
        path.write_text(text)
        words += ['--params-file', str(path)]
    return GivenParameters.read(['--ros-args', *words]).of(node)


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


def test_of_two_alike_the_later_holds(tmp_path: Path) -> None:
    texts = ['/x/**: {ros__parameters: {seed: 1}}\n', '/**/feed_axis: {ros__parameters: {seed: 2}}\n']
    assert given(tmp_path, '/x/feed_axis', *texts).values == {'seed': 2}
    assert given(tmp_path, '/x/feed_axis', *texts[::-1]).values == {'seed': 1}


def test_single_parameters_hold_over_files(tmp_path: Path) -> None:
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
    for namespace, scene, seed in (('/x', 'positioning', 0), ('/y', 'paper_fig7', 4)):
        with running('--params-file', str(path), '-r', f'__ns:={namespace}'), client(namespace) as axis:
            name, number, force = axis.values('scene', 'seed', 'axis.normal_force')
            assert (name.string_value, number.integer_value) == (scene, seed)
            assert force.double_value == (2500.0 if namespace == '/x' else 350 * 9.80665)
