# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`normal_load` of a scene: neutral where left out, refused by name where it has no meaning, shown where it varies."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stickslip_sim.advise.advice import advise
from stickslip_sim.compare.look import look_at
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, table
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import read_run
from stickslip_sim.runs import simulate
from stickslip_sim.runs.run import LOAD_COLUMN
from stickslip_sim.scene import Scene, parse_scene
from stickslip_sim.study.critical import critical_of, default_range
from stickslip_sim.study.points import works_in_batches
from tests.support.scene_files import write
from tests.support.tool import answered

STEPS = {'normal_load.course': 'steps', 'normal_load.times': [0.0, 0.5, 0.75], 'normal_load.forces': [0.0, 500.0, -1e3]}
SINE = {'normal_load.course': 'sine', 'normal_load.amplitude': 100.0, 'normal_load.frequency': 3.0}


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


@pytest.mark.parametrize(('changes', 'name', 'hint'), [
    ({**SINE, 'friction.static.law': 'kato', 'friction.static.exponent': 0.5}, 'friction.static.law',
     'normal_load.course: steps, or solver.name: adaptive'),
    ({**SINE, 'solver.name': 'fixed_step'}, 'normal_load', 'constant or steps with solver.name: fixed_step'),
    ({**STEPS, 'normal_load.course': 'table', 'solver.name': 'fixed_step'}, 'normal_load',
     'normal_load.course: steps, or solver.name: exact'),
    ({**STEPS, 'normal_load.amplitudes': [1.0], 'normal_load.frequencies': [1.0], 'solver.name': 'fixed_step'},
     'normal_load', 'solver.name: exact'),
    ({**STEPS, 'normal_load.forces': [0.0, 1.0, -3433.0]}, 'axis.normal_force + normal_load', '>= 0 N at all times'),
    ({**SINE, 'normal_load.amplitude': 3433.0, 'solver.name': 'adaptive'}, 'axis.normal_force + normal_load',
     'whole amplitudes'),
    ({'normal_load.course': 'ramp', 'normal_load.rate': -1.0, 'solver.name': 'adaptive'},
     'axis.normal_force + normal_load', '-inf'),
    ({**STEPS, 'normal_load.forces': [0.0, 1e6, 0.0], 'friction.kinetic.end_slope': 10.0, 'solver.name': 'fixed_step'},
     'solver.step', '<= 6.97e-05 s for slip'),
    ({'normal_load.times': [0.0]}, 'normal_load.times', 'normal_load.course: steps or table'),
    ({'normal_load.amplitudes': [1.0]}, 'normal_load.amplitudes', 'normal_load.course'),
    ({**STEPS, 'axis.normal_force': 999.0}, 'axis.normal_force + normal_load', '= -1.0 '),
    ({'normal_load.course': 'steps', 'normal_load.times': [0.0, 1.0], 'normal_load.forces': [0.0]}, 'normal_load.times',
     'as many'),
])
def test_what_has_no_meaning_is_refused(changes: dict[str, Any], name: str, hint: str) -> None:
    with pytest.raises(InputError) as caught:
        scene_with(changes)
    assert name in caught.value.name
    assert hint in str(caught.value)


def test_statements_on_constant_inputs_say_nothing_of_it() -> None:
    """They run the axis anew, without its load."""
    assert look_at(simulate(load_scene('paper_fig8'), 0.5)).steady is not None
    assert look_at(simulate(scene_with(STEPS), 0.4)).steady is None


def test_studies_of_constant_inputs_refuse_it() -> None:
    scene = scene_with(STEPS)
    assert not works_in_batches(scene)
    with pytest.raises(InputError, match='without faults or a normal load'):
        critical_of(scene, default_range(scene, 'drive.velocity'), 1e-3)
    with pytest.raises(InputError, match=r'normal_load\.course = .steps. is refused: must be left out for advice'):
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
