# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes from files, values and overrides, and the schema behind them."""

import array
import math
import pathlib

import pytest

from stickslip_sim.axis import CompliantContact, RigidContact
from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import PARAMETERS, parse_override, scene_from_values, scene_names
from stickslip_sim.scene.load import read_scene
from stickslip_sim.scene.schema import BY_NAME
from tests.support.scene_files import refusal, write


def test_names_of_the_shipped_scenes() -> None:
    assert scene_names() == ['ball_screw', 'cutting_force', 'fast_feed', 'micro_feed', 'paper_fig4_constant',
                             'paper_fig4_falling', 'paper_fig7', 'paper_fig8', 'positioning', 'stribeck']


@pytest.mark.parametrize('name', scene_names())
def test_a_shipped_scene_is_named_described_and_loads_from_its_text(name: str, tmp_path: pathlib.Path) -> None:
    scene = load_scene(name)
    assert scene.name == name
    assert 20 < len(scene.summary) < 110
    path = tmp_path / 'text.yaml'
    path.write_text(scene.text, encoding='utf-8')
    assert load_scene(str(path)) == scene
    assert scene_from_values(scene.values) == scene
    assert len(scene.hash) == 64


def test_paper_data_arrive_in_the_axis() -> None:
    axis = load_scene('paper_fig8').axis
    assert (axis.mass, axis.drive_stiffness, axis.drive_damping) == (350.0, 6e5, 4000.0)
    assert axis.normal_force == 350 * 9.80665
    assert axis.contact == CompliantContact(5e6, 15000.0)
    assert axis.friction.excess is not None
    assert axis.friction.static.coefficient(math.inf) == 0.24
    assert load_scene('paper_fig7').axis.contact == RigidContact()
    assert load_scene('paper_fig4_falling').axis.friction.excess is None


def test_what_is_read_of_a_shipped_scene_belongs_to_its_reader() -> None:
    values = read_scene('paper_fig8').values
    coefficients = values['friction.kinetic.coefficients']
    assert isinstance(coefficients, list)
    coefficients.clear()
    values.clear()
    assert load_scene('paper_fig8').values['friction.kinetic.coefficients'] == (0.12, 0.05)


def test_what_is_left_out_is_not_modelled(tmp_path: pathlib.Path) -> None:
    scene = load_scene(write(tmp_path, '    axis: {mass: 350}\n'))
    assert scene == scene_from_values({'axis.mass': 350.0})
    assert scene.axis.contact == RigidContact()
    assert scene.axis.friction.static.coefficient(math.inf) == 0.0
    assert scene.axis.friction.kinetic.coefficient(1.0) == 0.0
    assert scene.axis.friction.excess is None
    assert scene.drive.value_at(5.0) == scene.force.value_at(5.0) == 0.0
    assert 'contact.stiffness' not in scene.values
    assert scene.name == 'unnamed'


def test_values_as_a_node_has_them_make_the_same_scene() -> None:
    scene = load_scene('positioning')
    node: dict[str, object] = dict.fromkeys(BY_NAME)
    node.update({name: array.array('d', value) if isinstance(value, tuple) else value
                 for name, value in scene.values.items()})
    assert scene_from_values(node) == scene


@pytest.mark.parametrize('head', ['feed_axis:\n  ros__parameters:\n', '/feed_axis:\n  ros__parameters:\n',
                                  '/hall/feed_axis:\n  ros__parameters:\n', '/**/feed_axis:\n  ros__parameters:\n'])
def test_sections_for_the_node(head: str, tmp_path: pathlib.Path) -> None:
    assert load_scene(write(tmp_path, '    scene: light\n    axis.mass: 1.0\n', head)).axis.mass == 1.0


def test_a_namespace_may_be_nested(tmp_path: pathlib.Path) -> None:
    text = 'hall:\n  feed_axis:\n    ros__parameters: {scene: light, axis: {mass: 1.0}}\n'
    assert load_scene(write(tmp_path, '', text)).axis.mass == 1.0


def test_sections_are_merged_unless_they_repeat_a_parameter(tmp_path: pathlib.Path) -> None:
    text = '/**: {ros__parameters: {scene: light, axis: {mass: 2.0}}}\nfeed_axis: {ros__parameters: {seed: 3}}\n'
    scene = load_scene(write(tmp_path, '', text))
    assert (scene.axis.mass, scene.seed) == (2.0, 3)
    text = '/**: {ros__parameters: {seed: 4}}\nfeed_axis: {ros__parameters: {seed: 3}}\n'
    assert refusal(load_scene, write(tmp_path, '', text)).name == 'seed'


def test_without_a_comment_the_summary_is_made_of_values(tmp_path: pathlib.Path) -> None:
    scene = load_scene(write(tmp_path, '    drive: {velocity: 0.005}\n'))
    assert scene.summary == 'rigid contact, constant static friction, without acceleration dependence, drive 5 mm/s'


@pytest.mark.parametrize(('text', 'name', 'value'), [
    ('axis.mass=400', 'axis.mass', 400), ('axis.drive_stiffness=6e5', 'axis.drive_stiffness', 6e5),
    ('initial.rest_time=.inf', 'initial.rest_time', math.inf), ('contact.model=rigid', 'contact.model', 'rigid'),
    ('friction.acceleration_dependence=false', 'friction.acceleration_dependence', False),
    ('friction.kinetic.velocities=[0, 0.01]', 'friction.kinetic.velocities', [0, 0.01]),
    (' seed = 3 ', 'seed', 3), ('record.folder="a=b"', 'record.folder', 'a=b'),
])
def test_overrides_are_yaml(text: str, name: str, value: object) -> None:
    assert parse_override(text) == (name, value)


@pytest.mark.parametrize('text', ['axis.mass', '=5', 'axis.mass=', 'a={b: 1}', 'a=[1', 'a=# c', 'a=*x'])
def test_what_is_no_override(text: str) -> None:
    refusal(parse_override, text)


def test_an_override_changes_one_value() -> None:
    scene = load_scene('paper_fig8', {'axis.mass': 400, 'friction.kinetic.velocities': [0, 0.01]})
    assert scene.axis.mass == 400.0
    assert scene.axis.friction.kinetic.velocities == (0.0, 0.01)
    assert scene.axis.friction.excess is not None
    assert scene.axis.friction.excess.velocities == (0.0, 0.01)
    assert scene.hash != load_scene('paper_fig8').hash


def test_an_override_of_a_choice_drops_what_belonged_to_the_old_one() -> None:
    rigid = load_scene('paper_fig8', {'contact.model': 'rigid', 'scene': 'paper_fig7'})
    assert rigid == load_scene('paper_fig7')
    assert load_scene('paper_fig8', {'friction.static.law': 'constant'}).axis.friction.static.bounded
    assert load_scene('positioning', {'drive.course': 'constant', 'drive.velocity': 0.1}).drive.value_at(9.0) == 0.1
    hyperbolic = load_scene('paper_fig8', {'friction.static.law': 'hyperbolic'})
    assert hyperbolic.axis.friction.static.time_constant == 0.2


def test_an_override_is_refused_like_a_file() -> None:
    error = refusal(load_scene, 'paper_fig8', {'axis.mass': -1.0})
    assert str(error).startswith('paper_fig8: axis.mass = -1.0 is refused')
    assert refusal(load_scene, 'paper_fig7', {'contact.stiffness': 1e6}).name == 'contact.stiffness'
    both = {'contact.model': 'rigid', 'contact.damping': 1.0}
    assert refusal(load_scene, 'paper_fig8', both).name == 'contact.damping'
    assert refusal(load_scene, 'paper_fig8', {'contact.model': 'soft'}).name == 'contact.model'
    assert refusal(load_scene, 'paper_fig8', {'contact.model': ['rigid']}).name == 'contact.model'


def test_every_default_is_allowed_and_every_choice_stands_before_what_depends_on_it() -> None:
    names = [entry.name for entry in PARAMETERS]
    assert len(set(names)) == len(names)
    for entry in PARAMETERS:
        assert entry.default is None or entry.checked(entry.default) == entry.default
        assert entry.description
        if entry.when is not None:
            choice = BY_NAME[entry.when.name]
            assert names.index(choice.name) < names.index(entry.name)
            assert all(choice.checked(value) == value for value in entry.when.values)
        else:
            assert not entry.required


def test_only_numbers_of_the_axis_and_commands_and_the_next_folder_are_live() -> None:
    live = {entry.name for entry in PARAMETERS if entry.live} - {'record.folder'}
    assert BY_NAME['record.folder'].live
    assert {name.partition('.')[0] for name in live} == {'axis', 'contact', 'friction', 'command'}
    assert {BY_NAME[name].type for name in live} == {'double', 'double_array'}


@pytest.mark.parametrize(('law', 'more'), [
    ('constant', {}),
    ('exponential', {'limit': 0.3, 'time_constant': 0.5}),
    ('hyperbolic', {'limit': 0.3, 'time_constant': 0.5}),
    ('logarithmic', {'limit': 0.3, 'time_constant': 0.5}),
    ('kato', {'limit': 0.3, 'time_constant': 0.5, 'exponent': 0.7}),
])
def test_all_static_laws(law: str, more: dict[str, float]) -> None:
    scene = scene_from_values({'friction.static.law': law, 'friction.static.initial': 0.2, 'initial.rest_time': 1.0,
                               **{f'friction.static.{name}': value for name, value in more.items()}})
    static = scene.axis.friction.static
    assert static.kind.name.lower() == law
    assert static.coefficient(0.0) == 0.2
    assert (static.coefficient(1.0) > 0.2) == (law != 'constant')


def test_input_profiles() -> None:
    ramp = scene_from_values({'drive.course': 'ramp', 'drive.velocity': 0.01, 'drive.acceleration': -0.02,
                              'drive.duration': 1.0})
    assert (ramp.drive.value_at(0.5), ramp.drive.value_at(3.0)) == (0.0, -0.01)
    endless = scene_from_values({'force.course': 'ramp', 'force.rate': 5.0})
    assert endless.force.value_at(100.0) == 500.0
    steps = scene_from_values({'force.course': 'steps', 'force.times': [0.0, 1.0], 'force.forces': [1, 2],
                               'force.period': 2})
    assert [steps.force.value_at(time) for time in (0.5, 1.5, 2.5)] == [1.0, 2.0, 1.0]


def test_the_position_of_the_drive_over_time() -> None:
    given = {'drive.course': 'position', 'drive.times': [0.0, 1.0, 3.0], 'drive.positions': [0.5, 0.75, 0.25],
             'initial.position': 0.375, 'initial.stretch': 0.125}
    linear = scene_from_values(given)
    assert [linear.drive.value_at(time) for time in (0.5, 1.0, 2.9, 3.0, 9.0)] == [0.25, -0.25, -0.25, 0.0, 0.0]
    periodic = scene_from_values({**given, 'drive.period': 4.0})
    assert [periodic.drive.value_at(time) for time in (3.5, 4.5)] == [0.25, 0.25]
    bent = scene_from_values({**given, 'drive.slopes': [0.0, 0.5, -1.0]})
    assert [bent.drive.value_at(time) for time in (0.0, 0.5, 1.0, 2.0, 3.0, 9.0)] == [0.0, 0.25, 0.5, -0.25, -1.0, -1.0]
    table = {'drive.course': 'table', 'drive.times': [0.0, 1.0, 3.0], 'drive.velocities': [0.0, 0.5, -1.0]}
    assert bent.drive == scene_from_values(table).drive
    assert scene_from_values(bent.values).hash == bent.hash


def test_sines_alone_and_on_top_of_any_profile() -> None:
    scene = scene_from_values({
        'drive.course': 'sine', 'drive.velocity': 0.5, 'drive.amplitude': 2.0, 'drive.frequency': 3.0,
        'drive.phase': 0.25, 'drive.amplitudes': [1.0], 'drive.frequencies': [5.0],
        'force.course': 'ramp', 'force.rate': 4.0,
        'force.amplitudes': [10.0, -7.0], 'force.frequencies': [1.0, 20.0], 'force.phases': [0.0, 1.0]})
    for t in (0.0, 0.1, 0.77):
        assert scene.drive.value_at(t) == pytest.approx(
            0.5 + 2.0 * math.sin(6.0 * math.pi * t + 0.25) + math.sin(10.0 * math.pi * t))
        assert scene.force.value_at(t) == pytest.approx(
            4.0 * t + 10.0 * math.sin(2.0 * math.pi * t) - 7.0 * math.sin(40.0 * math.pi * t + 1.0))
    again = scene_from_values(scene.values)
    assert (again.drive, again.force, again.hash) == (scene.drive, scene.force, scene.hash)
    plain = scene_from_values({**scene.values, 'drive.frequency': 2.0})
    assert plain.hash != scene.hash
