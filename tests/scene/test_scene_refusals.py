# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scene files with something wrong: one line that names the file, the thing, its value, the range and the fix."""

import math
import os
import pathlib
from pathlib import Path

import pytest
import yaml

from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import PARAMETERS, Parameter, ros_yaml, scene_from_values
from stickslip_sim.scene.ros_yaml import SIZE_LIMIT, plain_value, read_yaml
from tests.support.scene_files import refusal, write


@pytest.mark.parametrize(('word', 'value'), [
    ('350', 350), ('350.', 350.0), ('.5', 0.5), ('6e5', 6e5), ('6.0e+05', 6e5), ('-1E-3', -1e-3), ('.inf', math.inf),
    ('-.inf', -math.inf), ('inf', math.inf), ('0x10', 16), ('010', 8), ('08', 8.0), ('1_000', '1_000'),
    ('1:30', '1:30'), ('null', 'null'), ('~', '~'), ('2020-01-01', '2020-01-01'), ('1e400', '1e400'),
    ('1e-320', '1e-320'), ('yes', True), ('Off', False), ('1.0f', '1.0f'), ('9223372036854775808', 2.0**63),
    ('9' * 400, '9' * 400), ('rigid', 'rigid'),
])
def test_plain_words_have_the_types_of_ros(word: str, value: object) -> None:
    assert (plain_value(word), type(plain_value(word))) == (value, type(value))


def test_not_a_number_is_read_as_one_and_refused_as_a_value() -> None:
    assert math.isnan(plain_value('.nan'))   # type: ignore[arg-type]
    assert refusal(scene_from_values, {'axis.mass': math.nan}).name == 'axis.mass'
    assert refusal(scene_from_values, {'initial.rest_time': math.nan}).name == 'initial.rest_time'


@pytest.mark.parametrize(('text', 'hint'), [
    ('a: &x 1.0\nb: *x\n', 'aliases'), ('a: 1\na: 2\n', 'twice'), ('a: !!python/object:os.system 1\n', 'tags'),
    ('a: [1, 2\n', 'line 2'), ('a:\n', 'missing'), ('a: 1\n---\nb: 2\n', 'document'), ('a: b: c\n', 'line 1'),
    ('[' * 400, 'deep'), ('#' * (SIZE_LIMIT + 1), 'at most'),
    ('? [' + '1.0, ' * 100 + '1.0]\n: 2\n', 'word'), ('[' + '1.0, ' * 100 + '1.0] x\n', 'line 1'),
    ('#' * SIZE_LIMIT + '\n[' + '1.0, ' * 100 + '1.0]', 'at most'), ('a: "\\U00110000"\n', 'Unicode'),
    ('[' + '1.0, ' * 200_000 + '1.0]', 'more than 200000 numbers'),
    ('? [1]\n: 2\n', 'word'), ('a: \x00\n', 'printable'), ('a: !x 1\n', 'tags'),
])
def test_yaml_that_ros_refuses_or_passes_over(text: str, hint: str) -> None:
    assert hint in str(refusal(read_yaml, text))


def test_a_document_has_so_many_names_and_values(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many as docs/security.md says, which takes seconds; here of fewer."""
    monkeypatch.setattr(ros_yaml, 'MOST_NODES', 1000)
    assert read_yaml('[' + '1,' * 999 + ']') == [1] * 999    # with the list itself
    assert 'more than 1000 names' in str(refusal(read_yaml, '[' + '1,' * 1000 + ']'))


@pytest.mark.parametrize(('body', 'name', 'hint'), [
    *yaml.safe_load(Path(__file__).with_name('refused.yaml').read_text(encoding='utf-8')),
    (f'force: {{amplitudes: [{"1.0, " * 101}], frequencies: [{"1.0, " * 101}]}}', 'force.amplitudes', 'at most 100'),
])
def test_a_wrong_file_is_refused_by_name_in_one_line(body: str, name: str, hint: str, tmp_path: pathlib.Path) -> None:
    path = write(tmp_path, f'    {body}\n')
    error = refusal(load_scene, path)
    assert error.name == name
    assert str(error).startswith((f'{path}: {name} = ', f'{path}: {name} is missing: '))
    assert hint in str(error)


@pytest.mark.parametrize(('text', 'hint'), [
    ('', '/**'), ('5\n', '/**'), ('- 1\n', '/**'), ('/**: 5\n', '/**'), ('/**:\n  ros__parameters: {}\n', 'shipped'),
    ('ros__parameters: {seed: 1}\n', '/**'), ('axis: {mass: 1.0}\n', 'ros__parameters'),
    ('/other: {ros__parameters: {seed: 1}}\n', 'one axis only'), ('/**: {ros__parameters: 5}\n', 'mapping'),
    ('/**: {ros__parameters: {axis: {mass: 1.0}, axis.mass: 2.0}}\n', 'twice'),
    ('/**: {ros__parameters: {seed: 1}, extra: 2}\n', 'ros__parameters'),
])
def test_a_file_that_is_no_scene(text: str, hint: str, tmp_path: pathlib.Path) -> None:
    path = write(tmp_path, '', text)
    error = refusal(load_scene, path)
    assert str(error).startswith(path)
    assert hint in str(error)


def test_files_that_cannot_be_read(tmp_path: pathlib.Path) -> None:
    binary = tmp_path / 'binary.yaml'
    binary.write_bytes(b'\x89\xff\x00')
    assert 'UTF-8' in str(refusal(load_scene, str(binary)))
    huge = tmp_path / 'huge.yaml'
    huge.write_bytes(b'#' * (SIZE_LIMIT + 1))
    assert 'at most' in str(refusal(load_scene, str(huge)))
    assert 'No such file' in str(refusal(load_scene, str(tmp_path / 'none.yaml')))
    assert 'directory' in str(refusal(load_scene, str(tmp_path) + os.sep))


def test_an_unknown_name_lists_the_scenes() -> None:
    error = refusal(load_scene, 'paper_fig9')
    assert 'positioning' in str(error)
    assert 'did you mean paper_fig' in str(error)
    assert refusal(load_scene, '').name == 'scene'


def test_a_table_longer_than_a_step_can_walk_is_refused() -> None:
    values = {'friction.kinetic.velocities': [float(i) for i in range(1001)],
              'friction.kinetic.coefficients': [0.0] * 1001}
    assert 'at most 1000 breakpoints' in str(refusal(scene_from_values, values))


@pytest.mark.parametrize('entry', [entry for entry in PARAMETERS if entry.type.startswith('double')],
                         ids=lambda entry: entry.name)
def test_every_number_has_bounds_far_within_the_doubles(entry: Parameter) -> None:
    assert entry.low is not None
    assert entry.high is not None
    assert -1e18 <= entry.low <= entry.high <= 1e18
    beyond = [1.7e308, -1.7e308, math.nextafter(entry.high, math.inf), math.nextafter(entry.low, -math.inf)]
    for number in [*beyond, *([] if entry.infinite else [math.inf])]:
        error = refusal(entry.checked, number if entry.type == 'double' else [number])
        assert error.name == entry.name
        assert entry.range in str(error)
