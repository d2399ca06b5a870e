# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scene files with something wrong: one line that names the file, the thing, its value, the range and the fix."""

import math
import os
import pathlib

import pytest

from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import PARAMETERS, Parameter, ros_yaml, scene_from_values
from stickslip_sim.scene.ros_yaml import SIZE_LIMIT, plain_value, read_yaml
from tests.support.scene_files import refusal, write

EXPONENTIAL = 'law: exponential, initial: 0.1, limit: 0.05, stribeck_velocity: 0.01'


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
    ('    axis: {mass: -1.0}\n', 'axis.mass', '>= 1e-09 and <= 1e+12 kg'),
    ('    axis: {mass: .nan}\n', 'axis.mass', '<= 1e+12 kg'),
    ('    axis: {mass: .inf}\n', 'axis.mass', '<= 1e+12 kg'),
    ('    axis: {mass: "350"}\n', 'axis.mass', 'without quotes'),
    ('    axis: {mass: true}\n', 'axis.mass', 'a number'),
    ('    axis: {mass: [1.0]}\n', 'axis.mass', 'a number'),
    ('    axis: {mas: 1.0}\n', 'axis.mas', 'did you mean axis.mass?'),
    ('    axis: 5.0\n', 'axis', 'it is a section'),
    ('    axes: {mass: 1.0}\n', 'axes.mass', 'did you mean axis.mass?'),
    ('    encoder: {resolution: 2.0}\n', 'encoder.resolution', '<= 1'),
    ('    joint_interface: {prefix: "x y_"}\n', 'joint_interface.prefix', 'then letters, digits, _, - and /'),
    ('    joint_interface: {prefix: y}\n', 'joint_interface.prefix', 'put it in quotes'),
    ('    encoder: {gain: 1.0}\n', 'encoder.gain', 'resolution'),
    ('    command: {timeout: -0.5}\n', 'command.timeout', '>= 0'),
    ('    drive: {course: square}\n', 'drive.course', 'constant, ramp, steps, sine, table'),
    ('    drive: {course: sine, frequency: 1.0}\n', 'drive.amplitude', 'add it'),
    ('    drive: {course: sine, amplitude: 1.0, frequency: 0.0}\n', 'drive.frequency', '>= 1e-09'),
    ('    drive: {amplitude: 1.0}\n', 'drive.amplitude', 'course: sine'),
    ('    force: {amplitudes: [1.0, 2.0], frequencies: [1.0]}\n', 'force.frequencies', 'as many as'),
    ('    force: {amplitudes: [1.0], frequencies: [1.0], phases: [0.0, 0.0]}\n', 'force.phases', 'as many as'),
    ('    force: {amplitudes: [1.0]}\n', 'force.amplitudes', 'both'),
    ('    force: {phases: [1.0]}\n', 'force.phases', 'both'),
    (f'    force: {{amplitudes: [{"1.0, " * 100}1.0], frequencies: [{"1.0, " * 100}1.0]}}\n', 'force.amplitudes',
     'at most 100'),
    ('    solver: {name: newton}\n', 'solver.name', 'exact, fixed_step, adaptive'),
    ('    solver: {name: fixed_step, method: RK45}\n', 'solver.method', 'euler, rk4'),
    ('    solver: {name: adaptive, method: rk4}\n', 'solver.method', 'DOP853'),
    ('    solver: {name: fixed_step, step: 0.0}\n', 'solver.step', '>= 1e-09 and <= 1 s'),
    ('    solver: {name: fixed_step, step: 0.5}\n', 'solver.step', 'exact, which has none'),
    ('    solver: {name: adaptive, rtol: 1.0e-15}\n', 'solver.rtol', '>= 2.3e-14'),
    ('    solver: {name: adaptive, step: 0.001}\n', 'solver.step', 'solver.name: fixed_step'),
    ('    solver: {method: rk4}\n', 'solver.method', 'omitted with solver.name: exact'),
    ('    time: {mode: lock_step}\n', 'time.mode', 'realtime, lockstep, free_run'),
    ('    time: {factor: .inf}\n', 'time.factor', 'free_run'),
    ('    time: {mode: lockstep, rate: 100.0}\n    clock: {rate: 101.0}\n', 'clock.rate', 'time.rate'),
    ('    clock: {rate: 101.0}\n', 'clock.rate', 'lockstep or free_run'),
    ('    command: {timeout_deceleration: 2.0}\n', 'command.timeout_deceleration', 'ramp_to_zero or fault'),
    ('    encoder: {delay: 0.0015}\n', 'encoder.delay', 'whole steps'),
    ('    faults: {ids: [a]}\n', 'faults.kinds', 'as many'),
    ('    faults: {ids: [a, a], kinds: [drive_freeze, drive_freeze], starts: [0.0, 1.0], durations: [.inf, 1.0]}\n',
     'faults (a): id', 'not in use'),
    ('    faults: {ids: [a], kinds: [flood], starts: [0.0], durations: [1.0]}\n', 'faults (a): kind', 'drive_freeze'),
    ('    faults: {ids: [a], kinds: [force_pulse], starts: [0.0], durations: [1.0e-4]}\n', 'faults (a): duration',
     'from a step'),
    ('    faults: {ids: [""], kinds: [force_pulse], starts: [0.0], durations: [1.0]}\n', 'faults.ids', 'text'),
    ('    time: {rate: 0.5}\n', 'time.rate', '>= 1 and <= 20000 Hz'),
    ('    time: {factor: 0.0}\n', 'time.factor', '>= 0.001'),
    ('    seed: 1.5\n', 'seed', 'a whole number'),
    ('    seed: -1\n', 'seed', '>= 0'),
    ('    record: {enabled: 1}\n', 'record.enabled', 'true or false'),
    ('    scene: 5\n', 'scene', 'quotes'),
    ('    scene: "a\\nb"\n', 'scene', 'printable'),
    ('    command: {max_force: 0.0}\n', 'command.max_force', '> 0'),
    ('    contact: {stiffness: 1.0e6}\n', 'contact.stiffness', 'contact.model: rigid'),
    ('    contact: {model: compliant}\n', 'contact.stiffness', 'contact.model: compliant'),
    ('    friction: {static: {limit: 0.2}}\n', 'friction.static.limit', 'law: constant'),
    ('    friction: {static: {law: exponential, limit: 0.2, time_constant: 0.1, exponent: 2.0}}\n',
     'friction.static.exponent', 'kato'),
    ('    friction: {static: {law: kato, limit: 0.2, time_constant: 0.1}}\n', 'friction.static.exponent', 'add it'),
    ('    friction: {kinetic: {law: viscous}}\n', 'friction.kinetic.law', 'table, stribeck, exponential, hyperbolic'),
    ('    friction: {kinetic: {law: stribeck}}\n', 'friction.kinetic.initial', 'add it'),
    ('    friction: {kinetic: {law: stribeck, velocities: [0.0]}}\n', 'friction.kinetic.velocities', 'law: table'),
    ('    friction: {kinetic: {initial: 0.1}}\n', 'friction.kinetic.initial', 'law: stribeck or exponential or hyp'),
    (f'    friction: {{kinetic: {{{EXPONENTIAL}, exponent: 1.0}}}}\n', 'friction.kinetic.exponent', 'stribeck'),
    (f'    friction: {{kinetic: {{{EXPONENTIAL}, tolerance: 0.0}}}}\n', 'friction.kinetic.tolerance', '>= 1e-12'),
    (f'    friction: {{kinetic: {{{EXPONENTIAL}}}}}\n', 'friction.kinetic.initial', 'static.initial'),
    (f'    friction: {{static: {{initial: 0.1}}, kinetic: {{{EXPONENTIAL}, tolerance: 1.0e-9}}}}\n',
     'friction.kinetic.tolerance', 'fits'),
    ('    friction: {excess: {law: cosine}}\n', 'friction.excess.law', 'acceleration_dependence: false'),
    ('    friction: {acceleration_dependence: true, excess: {law: cosine}}\n', 'friction.excess',
     'one breakpoint only'),
    ('    friction: {acceleration_dependence: true, excess: {law: power, limit_velocity: 0.1}}\n',
     'friction.excess.exponent', 'add it'),
    ('    friction: {acceleration_dependence: true, excess: {law: cosine, fractions: [1.0]}}\n',
     'friction.excess.fractions', 'law: table'),
    ('    friction: {acceleration_dependence: true, excess: {limit_velocity: 0.1}}\n',
     'friction.excess.limit_velocity', 'cosine or power'),
    ('    friction: {excess: {velocities: [0.0, 1.0], fractions: [1.0, 0.0]}}\n', 'friction.excess.velocities',
     'acceleration_dependence: false'),
    ('    friction: {kinetic: {velocities: [0, 0.035]}}\n', 'friction.kinetic.velocities', 'one type'),
    ('    friction: {kinetic: {coefficients: [0.16, abc]}}\n', 'friction.kinetic.coefficients',
     "'abc' is no number, and others are"),
    ('    friction: {kinetic: {velocities: [0.0, -0.1]}}\n', 'friction.kinetic.velocities', '>= 0'),
    ('    friction: {kinetic: {velocities: []}}\n', 'friction.kinetic.velocities', 'at least one'),
    ('    friction: {kinetic: {velocities: 0.0}}\n', 'friction.kinetic.velocities', 'a list'),
    ('    friction: {kinetic: {velocities: [0.0, 0.0], coefficients: [0.0, 0.0]}}\n', 'friction.kinetic.velocities',
     'increasing'),
    ('    friction: {kinetic: {velocities: [0.0, 0.5, 0.500000001], coefficients: [0.2, 0.1, 0.0]}}\n',
     'friction.kinetic.velocities', 'at least 5e-09 m/s apart, 1e-08 of the speed; they are 1e-09 m/s apart'),
    ('    friction: {kinetic: {coefficients: [0.1]}}\n', 'friction.kinetic.coefficients[0]', 'static.initial'),
    ('    friction: {static: {law: logarithmic, initial: 0.1, limit: 0.2, time_constant: 1.0}}\n', 'initial.rest_time',
     'finite'),
    ('    drive: {velocity: 1.0, course: table, times: [0.0], velocities: [1.0]}\n', 'drive.velocity', 'course: table'),
    ('    drive: {times: [0.0]}\n', 'drive.times', 'drive.course: steps or table'),
    ('    drive: {course: steps, times: [0.0]}\n', 'drive.velocities', 'add it'),
    ('    drive: {course: steps, times: [0.0, 2.0], velocities: [0.0, 1.0], period: 1.0}\n', 'drive.times', 'period'),
    ('    drive: {course: steps, times: [0.0], velocities: [0.0], period: 1.0e-9}\n', 'drive.period', '>= 1e-06 and'),
    ('    force: {course: table, times: [0.0, 1.0e-300], forces: [0.0, 1.0e15]}\n', 'force.times',
     'at least 1e-11 s apart in a table; they are 1e-300 s apart'),
    ('    normal_load: {course: table, times: [0.0, 1.0], forces: [0.0, 1.0], period: 1.000000000001}\n',
     'normal_load.times', '[1.0, 1.000000000001] is refused: must be at least 1e-11 s apart'),
    ('    drive: {course: position, times: [0.0]}\n', 'drive.positions', 'add it'),
    ('    drive: {course: position, times: [0.0, 1.0, 1.0, 2.0], positions: [0.0, 0.0, 1.0, 1.0]}\n',
     'drive.positions', 'jumps'),
    ('    drive: {course: position, times: [0.0, 1.0, 1.0], positions: [0.0, 1.0, 1.0]}\n',
     'drive.times', 'increasing'),
    ('    drive: {course: position, times: [0.0, 1.0], positions: [0.0]}\n', 'drive.times', 'as many'),
    ('    drive: {course: position, times: [0.0, 1.0], positions: [0.0, 1.0], slopes: [0.0]}\n',
     'drive.slopes', 'as many'),
    ('    drive: {course: position, times: [0.0], positions: [0.001]}\n',
     'drive.positions[0]', 'initial.position: 0.001'),
    ('    drive: {course: position, times: [0.0, 1.0e-9], positions: [0.0, 1.0]}\n',
     'drive.positions', 'at most 1e+06 m/s'),
    ('    drive: {course: position, times: [0.0, 1.0e-3], positions: [0.0, 1.0e3], slopes: [0.0, 0.0]}\n',
     'drive.positions', 'at most 1e+09 m/s²'),
    ('    drive: {course: position, times: [0.0], positions: [0.0], velocities: [0.0]}\n',
     'drive.velocities', 'position'),
    ('    force: {course: position}\n', 'force.course', 'constant, ramp, steps, sine, table'),
    ('    force: {velocity: 1.0}\n', 'force.velocity', 'constant, rate'),
])
def test_a_wrong_file_is_refused_by_name_in_one_line(body: str, name: str, hint: str, tmp_path: pathlib.Path) -> None:
    path = write(tmp_path, body)
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
