# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes from files, values and overrides, and the schema behind them."""

import array
import math
import pathlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from stickslip_sim.advise.advice import advise
from stickslip_sim.axis import CompliantContact, RigidContact
from stickslip_sim.compare.look import look_at
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, table
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import read_run
from stickslip_sim.runs import simulate
from stickslip_sim.runs.run import LOAD_COLUMN
from stickslip_sim.scene import PARAMETERS, Scene, parse_override, parse_scene, scene_from_values, scene_names
from stickslip_sim.scene.load import read_scene
from stickslip_sim.scene.schema import BY_NAME
from stickslip_sim.study.critical import critical_of, default_range
from stickslip_sim.study.points import works_in_batches
from tests.support.scene_files import refusal, write
from tests.support.tool import answered


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


# `normal_load` of a scene: neutral where left out, refused by name where it has no meaning, shown where it varies.

STEPS = {'normal_load.course': 'steps', 'normal_load.times': [0.0, 0.5, 0.75], 'normal_load.forces': [0.0, 500.0, -1e3]}


def scene_with(changes: dict[str, Any], **more: Any) -> Scene:
    return load_scene('paper_fig8', {**changes, **more})


def test_a_scene_without_it_does_not_know_of_it() -> None:
    scene = load_scene('paper_fig8')
    assert scene.normal_load is None
    assert 'normal_load' not in scene.text
    assert works_in_batches(scene)


def test_a_scene_with_it_comes_back_from_its_text() -> None:
    scene = scene_with(STEPS)
    assert parse_scene(scene.text) == scene
    assert [scene.normal_force.value_at(time) for time in (0.0, 0.5, 0.8)] == [3432.3275, 3932.3275, 2432.3275]
    assert scene_with({**STEPS, 'normal_load.period': 1.0}).normal_force.value_at(2.6) == 3932.3275


@pytest.mark.parametrize(('changes', 'name', 'hint'),
                         yaml.safe_load(Path(__file__).with_name('loads_refused.yaml').read_text(encoding='utf-8')))
def test_what_has_no_meaning_is_refused(changes: dict[str, Any], name: str, hint: str) -> None:
    error = refusal(scene_with, changes)
    assert name in error.name
    assert hint in str(error)


def test_statements_on_constant_inputs_say_nothing_of_it() -> None:
    """They run the axis anew, without its load."""
    assert look_at(simulate(load_scene('paper_fig8'), 0.5)).steady is not None
    assert look_at(simulate(scene_with(STEPS), 0.4)).steady is None


def test_studies_of_constant_inputs_refuse_it() -> None:
    scene = scene_with(STEPS)
    assert not works_in_batches(scene)
    with pytest.raises(InputError, match='without faults or a normal load'):
        critical_of(scene, default_range(scene, 'drive.velocity'), 1e-3)
    with pytest.raises(InputError, match=r'normal_load\.course = .steps. is refused: must be omitted for advise'):
        advise(scene, 1e-3, 1.0, 1)


def test_its_points_may_come_from_a_file(tmp_path: Path) -> None:
    (tmp_path / 'clamp.csv').write_text('t,kN\n0,0.0\n2,0.5\n')
    scene = load_scene(write(tmp_path, '    normal_load: {course: steps, file: clamp.csv, file_time: t,'
                                       ' file_column: kN, file_unit: kN}\n'))
    assert scene.normal_load is not None
    assert scene.normal_load.value_at(2.0) == 500.0
    profiles = simulate(scene, 0.1).receipt['profiles']
    assert profiles['normal_load']['forces'] == (0.0, 500.0)


def test_samples_tables_and_pictures_show_it_where_it_varies(tmp_path: Path) -> None:
    run = simulate(scene_with(STEPS), 1.0, 0.25)
    assert run.samples[LOAD_COLUMN].tolist() == [3432.3275, 3432.3275, 3932.3275, 2432.3275, 2432.3275]
    assert list(run.frame())[-1] == LOAD_COLUMN
    run.plot(tmp_path / 'run.svg')
    assert 'normal force' in (tmp_path / 'run.svg').read_text()
    plain = simulate(load_scene('paper_fig8'), 1.0, 0.25)
    assert LOAD_COLUMN not in plain.samples
    plain.plot(tmp_path / 'plain.svg')
    assert 'normal force' not in (tmp_path / 'plain.svg').read_text()


def test_a_bag_has_it_from_its_scene(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sets = [word for name, value in STEPS.items() for word in ('--set', f'{name}={value}')]
    bag, samples, exported = tmp_path / 'run', tmp_path / 'samples.csv', tmp_path / 'friction.csv'
    assert answered(capsys, 'simulate', 'paper_fig7', '--duration', '1', '--bag', str(bag), '--samples', str(samples),
                    *sets)[0] == 0
    lines = samples.read_text().splitlines()
    assert lines[0].endswith(',mode,normal_force')
    assert [float(line.rpartition(',')[2]) for line in (lines[500], lines[501])] == [3432.3275, 3932.3275]
    run = read_run(bag)
    assert run.samples[LOAD_COLUMN][[499, 500, 750]].tolist() == [3432.3275, 3932.3275, 2432.3275]
    assert answered(capsys, 'export', str(bag), '--csv', str(exported), '--topic', 'friction_force')[0] == 0
    lines = exported.read_text().splitlines()
    assert lines[0].endswith(',normal_force')
    assert lines[502].endswith(',3932.3274999999999')
    assert answered(capsys, 'verify', str(bag))[0] == 0


def test_values_at_many_times_are_those_at_each() -> None:
    profile = InputProfile((0.0, 0.1, 0.3), (1.0, -2.0, 5.0), (0.0, 3.0, -1.0), 0.7, (Sinusoid(0.5, 2.0, 0.3),))
    times = np.array([0.0, 0.1, 0.3, 0.7, 0.1 + 0.7, 2.1, 2.1 + 0.3, 7.0, 1e4, *np.linspace(0.0, 3.0, 301)])
    assert profile.values_at(times) == pytest.approx([profile.value_at(time) for time in times.tolist()], rel=1e-12)
    once = table('load', (0.0, 1.0), (0.0, 2.0))
    assert once.values_at(np.array([0.25, 3.0])).tolist() == [0.5, 2.0]
