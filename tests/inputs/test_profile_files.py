# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Profiles from files: their points become those of the scene, and what is wrong with a file is said with its line."""

import math
from pathlib import Path

import numpy as np
import pytest
import yaml

from stickslip_sim.core.errors import InputError, RecordingError
from stickslip_sim.inputs import load_scene
from stickslip_sim.inputs.units import FORCES, SPEEDS, all_in_si, in_si
from stickslip_sim.recording import read_run
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene, parse_scene
from stickslip_sim.scene.schema import MOST_POINTS
from tests.support.tool import answered

SCENE = """\
# A drive from a file
/**:
  ros__parameters:
    scene: from_file
    friction: {static: {initial: 0.2}, kinetic: {velocities: [0.0, 0.1], coefficients: [0.2, 0.1]}}
    drive: {%s}
"""
NAMED = 'file: feed.csv, file_time: t, file_column: v'


def scene_of(folder: Path, drive: str, rows: str, **changes: object) -> Scene:
    (folder / 'feed.csv').write_text(rows)
    (folder / 'scene.yaml').write_text(SCENE % drive)
    return load_scene(str(folder / 'scene.yaml'), changes)


def points(scene: Scene) -> tuple[object, object]:
    return scene.values['drive.times'], scene.values['drive.velocities']


def test_the_plainest_file_is_linear_between_its_rows_in_si(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, 'file: feed.csv', 'time,velocity\n0,0.0\n0.5,0.01\n2,0.0\n')
    assert scene.values['drive.course'] == 'table'
    assert points(scene) == ((0.0, 0.5, 2.0), (0.0, 0.01, 0.0))
    assert scene.drive.value_at(0.25) == 0.005


@pytest.mark.parametrize('rows', [
    't [ms],x,v [mm/s]\n0,a,0.1\n10,b,0.3\n', '# measured\n\nv_mm_per_s\tx\tt_ms\n0,1\tb\t0\n# stop\n0,3\t\t10\n',
    '"t";"v"\n0;"0,1"\n10;0.3   # the end\n', 't v\n0 1e-1\n\n10 3.e-1', '\ufefft,v\r\n0,.1\r\n10,+.3\r\n',
])
def test_columns_by_name_in_the_units_that_are_stated(tmp_path: Path, rows: str) -> None:
    names = rows.splitlines()[2] if rows.startswith('#') else 't v'
    drive = f'file: feed.csv, file_time: {"t" if names == "t v" else "t_ms"}, file_time_unit: ms,' \
            f' file_column: {"v" if names == "t v" else "v_mm_per_s"}, file_unit: mm/s, course: steps'
    assert points(scene_of(tmp_path, drive, rows)) == ((0.0, 0.01), (0.0001, 0.0003))


def test_units_give_the_decimal_number_that_was_meant() -> None:
    numbers = np.array([0.1, 12.3, -7e-9, 1e22, 0.0, 33.3])
    for unit in (*SPEEDS.values(), *FORCES.values()):
        assert all_in_si(numbers, unit).tolist() == [in_si(number, unit) for number in numbers.tolist()]


@pytest.mark.parametrize(('drive', 'rows', 'hint'), [
    *yaml.safe_load(Path(__file__).with_name('profiles_refused.yaml').read_text(encoding='utf-8')),
    ('NAMED', 'x' * 200_000 + ',t,v\n0,1,2\n', r'feed\.csv = .x+. is refused: must be a line of a CSV file'),
])
def test_one_error_says_what_is_wrong_and_where(tmp_path: Path, drive: str, rows: str, hint: str) -> None:
    with pytest.raises(InputError, match=hint) as caught:
        scene_of(tmp_path, drive.replace('NAMED', NAMED), rows)
    assert 'scene.yaml: ' in str(caught.value)


def test_a_file_that_is_too_long(tmp_path: Path) -> None:
    with pytest.raises(InputError, match='at most 200000 rows'):
        scene_of(tmp_path, NAMED, 't,v\n' + '\n'.join(f'{k},1' for k in range(MOST_POINTS + 1)))


def test_a_run_may_start_within_the_file(tmp_path: Path) -> None:
    rows = 't,v\n12.3,0.1\n12.5,0.3\n12.6,0.5\n'
    assert points(scene_of(tmp_path, f'{NAMED}, file_begin: 12.3', rows))[0] == (0.0, 0.2, 0.3)
    assert points(scene_of(tmp_path, f'{NAMED}, file_begin: 12.4', rows)) == (
        (0.0, 0.1, 0.2), (pytest.approx(0.2), 0.3, 0.5))
    assert points(scene_of(tmp_path, f'{NAMED}, file_begin: 12.4, course: steps', rows))[1] == (0.1, 0.3, 0.5)


def test_resampled_only_where_asked(tmp_path: Path) -> None:
    rows = 't,v\n0,0.0\n0.25,1.0\n0.6,2.0\n'
    assert points(scene_of(tmp_path, f'{NAMED}, file_resample: 0.1', rows)) == (
        (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6), tuple(np.interp(np.arange(7) / 10, [0, 0.25, 0.6], [0, 1, 2]).tolist()))
    held = scene_of(tmp_path, f'{NAMED}, file_resample: 0.2, course: steps', rows)
    assert points(held) == ((0.0, 0.2, 0.4, 0.6), (0.0, 0.0, 1.0, 2.0))


def test_a_column_of_positions_is_the_path_of_the_drive(tmp_path: Path) -> None:
    rows = 'time,position [mm]\n0,12\n0.5,12.1\n2,12.1\n'
    drive = 'course: position, file: feed.csv, file_column: position, file_unit: mm'
    scene = scene_of(tmp_path, drive, rows, **{'initial.position': 0.012})
    assert scene.values['drive.positions'] == (0.012, 0.0121, 0.0121)
    assert scene.drive.values == pytest.approx((0.0002, 0.0, 0.0))
    assert scene.sources['drive'] == ('feed.csv', 'position', 'mm')
    begun = scene_of(tmp_path, f'{drive}, file_begin: 0.25', rows, **{'initial.position': 0.01205})
    assert begun.values['drive.positions'] == (pytest.approx(0.01205), 0.0121, 0.0121)
    with pytest.raises(InputError, match=r'drive\.positions\[0\] = 0\.012 is refused: .* set initial\.position: 0\.01'):
        scene_of(tmp_path, drive, rows)
    with pytest.raises(InputError, match=r'drive\.file = .* is refused: must be omitted with drive\.slopes'):
        scene_of(tmp_path, f'{drive}, slopes: [0.0]', rows)


def test_the_hash_is_that_of_the_values_wherever_they_come_from(tmp_path: Path) -> None:
    rows = 't,v\n0,0.0\n0.5,0.01\n'
    scene = scene_of(tmp_path, NAMED, rows)
    (tmp_path / 'feed.csv').unlink()
    assert parse_scene(scene.text) == scene
    assert scene_of(tmp_path, 'course: table, times: [0.0, 0.5], velocities: [0.0, 0.01]', rows).hash == scene.hash
    assert scene_of(tmp_path, NAMED, rows.replace('0.01', '0.02')).hash != scene.hash
    assert scene.sources['drive'] == ('feed.csv', 'v', 'm/s')


def test_a_unit_has_a_factor_as_at_an_import(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a motor with 35.15 N/V, of a sensor the other way round."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'volts.csv').write_text('time,force\n0,1\n1,-2\n')
    for unit, forces in (('35.15 N', (35.15, -70.3)), ('-1 kN', (-1000.0, 2000.0))):
        scene = load_scene('paper_fig8', {'force.file': 'volts.csv', 'force.file_unit': unit})
        assert scene.values['force.forces'] == forces
        assert scene.sources['force'] == ('volts.csv', 'force', unit)
    with pytest.raises(InputError, match=r'force\.file_unit = .0 N. is refused: must be a unit, or one with a factor'):
        load_scene('paper_fig8', {'force.file': 'volts.csv', 'force.file_unit': '0 N'})


def test_a_file_in_an_override_takes_the_place_of_the_profile(
        tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / 'here').mkdir()
    monkeypatch.chdir(tmp_path / 'here')
    (tmp_path / 'here/pull.csv').write_text('time,force [kN]\n0,0\n1,0.1\n')
    pull = {'force.file': 'pull.csv', 'force.file_column': 'force', 'force.file_unit': 'kN'}
    shipped = load_scene('paper_fig8', pull)
    assert shipped.values['force.forces'] == (0.0, 100.0)
    (tmp_path / 'here/other.csv').write_text('time,velocity\n0,1\n1,2\n')
    rows = 't,v\n0,0.0\n0.5,0.01\n'
    other = scene_of(tmp_path, f'{NAMED}, course: steps', rows, **{'drive.file': 'other.csv'})
    assert (other.values['drive.course'], points(other)) == ('steps', ((0.0, 1.0), (1.0, 2.0)))
    back = scene_of(tmp_path, NAMED, rows, **{'drive.times': [0.0], 'drive.velocities': [0.5]})
    assert points(back) == ((0.0,), (0.5,))
    assert scene_of(tmp_path, NAMED, rows, **{'drive.course': 'constant'}).values['drive.velocity'] == 0.0
    assert points(scene_of(tmp_path, NAMED, rows, **{'drive.file_unit': 'mm/s'}))[1] == (0.0, 1e-5)


def test_no_file_is_read_for_a_scene_that_travels_in_a_bag(tmp_path: Path) -> None:
    (tmp_path / 'feed.csv').write_text('time,velocity\n0,1\n')
    with pytest.raises(InputError, match=r'in a scene file with drive\.file'):
        parse_scene(SCENE % f'file: {tmp_path}/feed.csv')


def test_verify_and_read_run_need_nothing_but_the_bag(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = '\n'.join(f'{k * 1e-3!r},{10 + 9 * math.sin(0.1 * k)!r}' for k in range(2000))
    scene = scene_of(tmp_path, f'{NAMED}, file_unit: mm/s', 't,v\n' + text)
    folder = tmp_path / 'run'
    answered(capsys, 'simulate', tmp_path / 'scene.yaml', '--duration', '0.5', '--bag', folder)
    (tmp_path / 'feed.csv').unlink()
    (tmp_path / 'scene.yaml').unlink()
    run = read_run(folder)
    assert run.scene.hash == scene.hash == run.receipt['scene_hash']
    kept = run.receipt['profiles']['drive']
    assert (kept['file'], kept['unit'], kept['course']) == ('feed.csv', 'mm/s', 'table')
    assert (tuple(kept['times']), tuple(kept['velocities'])) == points(scene)
    assert 'identical' in answered(capsys, 'verify', folder)[1]


def test_a_topic_of_a_bag_is_a_profile(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    answered(capsys, 'simulate', 'paper_fig8', '--duration', '0.2', '--bag', tmp_path / 'run')
    states = read_run(tmp_path / 'run').states
    scene = scene_of(tmp_path, 'file: "run:slider_state", course: steps', '')
    times, velocities = points(scene)
    assert times == tuple((states['time'] - states['time'][0]).tolist())
    assert velocities == tuple(states['velocity'].tolist())
    assert scene.sources['drive'] == ('run:slider_state', 'velocity', 'm/s')
    with pytest.raises(RecordingError, match='no topic nothing'):
        scene_of(tmp_path, 'file: "run:nothing"', '')
    with pytest.raises(InputError, match=r'message 1 = .speed. is refused: must be a field that is a number'):
        scene_of(tmp_path, 'file: "run:slider_state", file_column: speed', '')


def test_the_scene_of_a_simulation_runs_as_one_with_the_numbers_in_it(tmp_path: Path) -> None:
    rows = 't,v\n0,0.0\n0.5,0.01\n1,0.02\n'
    numbers = 'course: table, times: [0.0, 0.5, 1.0], velocities: [0.0, 0.01, 0.02]'
    one, other = (simulate(scene_of(tmp_path, drive, rows), 1.5) for drive in (NAMED, numbers))
    assert one.events == other.events
    assert len(one.events) > 2
    assert 'profiles' not in other.receipt


def test_a_node_takes_the_profile_beside_its_parameter_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip('rclpy')
    from stickslip_sim.ros.node.parameters import scene_at_start
    from stickslip_sim.ros.programs import GivenParameters

    def at_start(*words: object) -> Scene:
        return scene_at_start(GivenParameters.read(['--ros-args', *map(str, words)]).of('/feed_axis'))

    scene = scene_of(tmp_path, NAMED, 't,v\n0,0.0\n0.5,0.01\n')
    in_a_file = '--params-file', tmp_path / 'scene.yaml'
    assert at_start(*in_a_file) == scene
    (tmp_path / 'here').mkdir()
    (tmp_path / 'here/other.csv').write_text('time,velocity\n0,0.3\n')
    monkeypatch.chdir(tmp_path / 'here')
    other = '-p', 'drive.file:=other.csv'
    assert points(at_start('-p', f'scene:={tmp_path}/scene.yaml', *other)) == ((0.0,), (0.3,))
    assert points(at_start(*in_a_file, *other)) == ((0.0,), (0.3,))
