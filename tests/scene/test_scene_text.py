# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The canonical text of a scene."""

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import changed, scene_from_values, scene_names
from stickslip_sim.scene.load import parse_scene, values_in_file, values_of
from stickslip_sim.scene.plausible import PLAUSIBLE, check_plausible
from stickslip_sim.scene.ros_yaml import plain_value, read_yaml
from stickslip_sim.scene.schema import BY_NAME, PARAMETERS
from stickslip_sim.scene.values import scene_text, stated, yaml_value
from tests.support.scene_files import refusal
from tests.support.tool import Capture, answered, refused

masses = st.floats(1e-9, 1e12)
positive = st.floats(1e-300, 1e15)
signed = st.floats(-1e6, 1e6).filter(lambda x: x == 0.0 or abs(x) > 1e-300)
words = st.text(st.characters(categories=['L', 'N', 'P', 'S', 'Zs']), max_size=40).filter(str.isprintable)
breakpoints = st.lists(st.floats(1e-9, 1e6), max_size=4, unique_by=lambda speed: round(1e6 * math.log(speed))).map(
    lambda speeds: [0.0, *sorted(speeds)]).filter(   # nearer ones are refused
        lambda speeds: all(after - before > 1e-7 * after for before, after in pairwise(speeds)))


@st.composite
def overrides(draw: st.DrawFn) -> dict[str, object]:
    speeds = draw(breakpoints)
    times = draw(breakpoints)
    profiles: list[dict[str, object]] = [
        {'drive.course': 'constant', 'drive.velocity': draw(signed)},
        {'drive.course': 'ramp', 'drive.acceleration': draw(st.floats(-1e9, 1e9).filter(lambda x: abs(x) > 1e-9))},
        {'drive.course': 'steps', 'drive.times': times, 'drive.velocities': [0.1] * len(times), 'drive.period': 1e10},
        {'force.course': 'table', 'force.times': times, 'force.period': 1e10, 'force.forces': draw(
            st.lists(st.floats(-1e5, 1e5, allow_subnormal=False), min_size=len(times), max_size=len(times)))},
    ]
    return {
        'scene': draw(words), 'axis.mass': draw(masses), 'axis.drive_damping': draw(positive),
        'friction.kinetic.velocities': speeds, 'friction.kinetic.coefficients': [0.1] * len(speeds),
        'friction.acceleration_dependence': len(speeds) > 1, 'initial.position': draw(signed),
        'initial.rest_time': draw(st.one_of(positive, st.just(math.inf))), 'record.folder': draw(words),
        'record.enabled': draw(st.booleans()), 'seed': draw(st.integers(0, 2**63 - 1)),
        **draw(st.sampled_from(profiles)),
    }


@settings(max_examples=30)
@given(overrides(), st.sampled_from(['paper_fig7', 'paper_fig8', 'cutting_force']))
def test_the_text_of_a_scene_loads_as_the_same_scene(changes: dict[str, object], name: str) -> None:
    scene = load_scene(name, changes)
    again = scene_from_values(values_of(read_yaml(scene.text)))
    assert again == scene
    assert again.text == scene.text


@pytest.mark.parametrize('name', scene_names())
def test_what_param_dump_writes_is_the_same_scene(name: str) -> None:
    """`null` for each parameter without a value."""
    scene = load_scene(name)
    values = {entry.name: scene.values.get(entry.name, 'null') for entry in PARAMETERS}
    assert 'null' in values.values()
    again = scene_from_values(stated(values))
    assert again == replace(scene, summary=again.summary)


def test_null_is_as_if_left_out() -> None:
    text = '/**:\n  ros__parameters: {scene: mine, contact: {model: null}, axis: {mas%s: null}}\n'
    assert parse_scene(text % 's').values == scene_from_values({'scene': 'mine'}).values
    with pytest.raises(InputError, match=r"axis\.mas = 'null' is refused"):
        parse_scene(text % '')


@pytest.mark.parametrize('name', scene_names())
@pytest.mark.parametrize('changes', [
    {},
    {'contact.model': 'rigid', 'friction.acceleration_dependence': False},
    {'friction.kinetic.law': 'table', 'friction.kinetic.velocities': [0.0, 0.02], 'record.folder': None, 'seed': 4,
     'friction.kinetic.coefficients': [0.004, 0.003], 'force.course': 'constant', 'force.constant': 3.0,
     'drive.course': 'constant', 'drive.velocity': 0.002},
])
def test_a_file_with_the_values_of_a_changed_scene_is_that_scene(name: str, changes: dict[str, object], tmp_path: Path
                                                                  ) -> None:
    scene = changed(load_scene(name), changes)
    path = tmp_path / 'scene.yaml'
    path.write_text(scene_text(values_in_file(scene)))
    assert load_scene(path) == scene
    for left_out in [entry for entry in scene.values if entry.startswith('friction.excess')]:
        less = changed(scene, {left_out: None})
        path.write_text(scene_text(values_in_file(less)))
        assert load_scene(path) == less


def test_null_takes_a_part_of_a_shipped_scene_away(tmp_path: Path) -> None:
    path = tmp_path / 'scene.yaml'
    path.write_text('/**:\n  ros__parameters: {scene: paper_fig8, contact: {damping: null}, axis: {mass: 300.0}}\n')
    assert load_scene(path) == changed(load_scene('paper_fig8'), {'contact.damping': None, 'axis.mass': 300.0})


def test_doubles_in_the_text_have_a_dot_for_every_yaml_reader() -> None:
    text = scene_from_values({'axis.mass': 1e-5, 'axis.drive_stiffness': 1e17, 'initial.position': -0.0}).text
    assert 'mass: 1.0e-05\n' in text
    assert 'drive_stiffness: 1.0e+17\n' in text
    assert 'position: 0.0\n' in text
    assert 'rest_time: .inf\n' in text


def test_equal_values_give_equal_hashes_in_any_order() -> None:
    values = load_scene('paper_fig8').values
    assert scene_from_values(dict(reversed(values.items()))).hash == load_scene('paper_fig8').hash


@pytest.mark.parametrize('numbers', [
    [0.1 * k - 7.0 for k in range(60_000)],                  # more letters and more values than any other document has
    [*map(float, range(100)), -0.0, 1e-5, -1.5e-300, 1e22, math.inf, -math.inf],
    [5e-324, *map(float, range(100))],
])
def test_a_long_list_is_read_as_a_short_one(numbers: list[float]) -> None:
    entry = BY_NAME['drive.times']
    text = yaml_value(entry, tuple(numbers))
    expected = [plain_value(word) for word in text[1:-1].split(', ')]
    assert repr(read_yaml(f'a: {{b: {text}, c: 1}}\nd: {text}\n')) == repr({'a': {'b': expected, 'c': 1},
                                                                              'd': expected})
    assert repr(read_yaml(text.replace(', ', ' ,'))) == repr(expected)


def test_a_long_list_of_a_scene_is_checked_as_a_short_one() -> None:
    times = [0.001 * k for k in range(50_000)]
    values: dict[str, object] = {'drive.course': 'steps', 'drive.times': times, 'drive.velocities': [-0.0] * 50_000}
    scene = scene_from_values(values)
    assert math.copysign(1.0, scene.drive.values[-1]) == 1.0
    assert parse_scene(scene.text) == scene
    for bad in (math.nan, math.inf, 2e6, 1e-310):
        with pytest.raises(InputError, match=r'drive\.velocities'):
            scene_from_values({**values, 'drive.velocities': [0.1] * 49_999 + [bad]})


# joint_interface.prefix: what may stand before the names of joints and frames.

PREFIX = 'joint_interface.prefix'


@pytest.mark.parametrize('prefix', ['', 'x_', 'y', 'left/', 'Press-2/axis_1_', 'x' * 200])
def test_taken(prefix: str) -> None:
    scene = scene_from_values({PREFIX: prefix})
    assert scene.joint_prefix == prefix


@pytest.mark.parametrize('prefix', ['/x_', '_x', '1_', '-x', 'x.', 'x y_', 'x\n', 'ä_', 'x[', '<x>', '"', 'x:',
                                    'x' * 201, 7, True, ['x_']])
def test_refused(prefix: object) -> None:
    """TF takes no name that begins with a slash, ros2_control has dots in the names of its parameters."""
    found = refusal(scene_from_values, {PREFIX: prefix})
    assert found.name == PREFIX
    assert 'empty, or a letter' in found.allowed


def test_left_out_there_is_none_and_the_scene_is_what_it_was() -> None:
    scene = load_scene('paper_fig8')
    assert scene.joint_prefix == ''
    assert PREFIX not in scene.values    # it would change the hash of each scene that was ever recorded


# Numbers that no feed axis has are asked back by the tool, once, with the unit in which they were read.

FAST = ('--set', 'drive.velocity=5')


@pytest.mark.parametrize('name', scene_names())
def test_the_shipped_scenes_are_plausible(name: str) -> None:
    check_plausible(load_scene(name).values, ())


def test_only_numbers_of_a_scene_are_asked_about_in_their_unit() -> None:
    assert {name: BY_NAME[name].unit for name in PLAUSIBLE} == {name: limit.unit for name, limit in PLAUSIBLE.items()}


@pytest.mark.parametrize(('changes', 'name', 'read'), [
    ({'drive.velocity': -5.0}, 'drive.velocity', '-5 m/s'),
    ({'friction.kinetic.velocities': (0.0, 100.0)}, 'friction.kinetic.velocities', '100 m/s'),
    ({'friction.kinetic.coefficients': (192.0, 84.0)}, 'friction.kinetic.coefficients', '192'),
])
def test_a_question_names_value_unit_and_answer(changes: dict[str, object], name: str, read: str) -> None:
    with pytest.raises(InputError, match=rf'{name} = .* it was read as {read}, .* if {read} is intended, '
                                         rf'add --allow-implausible {name}$'):
        check_plausible(changes, ())
    check_plausible(changes, (name,))


def test_a_name_that_is_never_asked_about_is_refused() -> None:
    with pytest.raises(InputError,
                       match=r'--allow-implausible = .drive.velocit. is refused: .* did you mean drive.velocity\?'):
        check_plausible({}, ('drive.velocit',))


def test_a_file_is_named_and_what_is_meant_runs(tmp_path: Path, capsys: Capture) -> None:
    scene = tmp_path / 'fast.yaml'
    scene.write_text('/**: {ros__parameters: {scene: fast, drive: {velocity: 5.0}}}\n')
    assert f'{scene}: drive.velocity = 5.0 is refused' in refused(capsys, 'simulate', scene, '--duration', '0.1')
    assert answered(capsys, 'simulate', scene, '--duration', '0.1', '--meant', 'drive.velocity')[0] == 0


def test_what_if_asks_about_what_it_changes(fig8_bag: Path, capsys: Capture) -> None:
    assert 'add --allow-implausible drive.velocity' in refused(capsys, 'verify', fig8_bag, *FAST)
