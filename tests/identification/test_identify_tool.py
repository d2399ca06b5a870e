# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip identify` as a user meets it: from a CSV file to a scene that goes on to other verbs; and misused."""

import csv
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stickslip_sim.identification import many_fits
from stickslip_sim.identification.many_fits import WorkFolder
from stickslip_sim.identification.stages import fit_from
from stickslip_sim.inputs import load_scene
from tests.support.measured_runs import FREE, VALUES, Readings, few_starts, free_file, readings, start_scene
from tests.support.tool import Capture, answered, refused

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures('blank_pictures')]

WIDE = {'axis.drive_stiffness': (5e4, 1e6), 'friction.static.initial': (0.15, 0.9),
        'friction.kinetic.coefficients[0]': (0.02, 0.15), 'friction.kinetic.coefficients[1]': (0.01, 0.3),
        'friction.kinetic.velocities[1]': (1e-3, 0.1)}
FILES = {'identified.yaml', 'posterior.yaml', 'report.html', 'report.json'}


def imported(folder: Path, measured: Readings, capsys: Capture, *options: str) -> Path:
    """Return the run that `stickslip import` makes of readings."""
    table = folder / 'axis.csv'
    with table.open('w', encoding='utf-8', newline='') as file:
        rows = csv.writer(file)
        rows.writerow(['t', *measured.columns])
        rows.writerows(zip(measured.times.tolist(), *(column.tolist() for column in measured.columns.values())))
    columns = ','.join(f'{name}={name}' for name in measured.columns)
    assert answered(capsys, 'import', table, '--columns', f'time=t,{columns}', *options, '--out',
                    folder / 'measured')[0] == 0
    return folder / 'measured'


@pytest.fixture
def start(tmp_path: Path) -> Path:
    path = tmp_path / 'start.yaml'
    path.write_text(start_scene().text, encoding='utf-8')
    return path


def test_from_a_file_to_a_scene_that_the_other_verbs_take(tmp_path: Path, start: Path, capsys: Capture) -> None:
    run, out = imported(tmp_path, readings(), capsys), tmp_path / 'found'
    code, said, _ = answered(capsys, 'identify', run, '--scene', start, '--free', free_file(tmp_path / 'free.yaml'),
                             '--out', out)
    assert code == 0
    assert {path.name for path in out.iterdir()} == FILES
    assert 'the model fits: no test of the residuals rejects it' in said
    assert f'written: {out / "report.html"}' in said
    scene = load_scene(str(out / 'identified.yaml'))
    assert scene.values['axis.drive_stiffness'] == pytest.approx(2e5, rel=0.01)

    beside = tmp_path / 'beside'
    assert answered(capsys, 'compare', run, out / 'identified.yaml', '--duration', '4', '--out', beside)[0] == 0
    figures = {one['name']: one for one in json.loads((beside / 'report.json').read_text())['beside'][0]['figures']}
    for name in ('period', 'jump', 'drive force at break-away'):
        assert figures[name]['other'] == pytest.approx(figures[name]['measured'], rel=0.02), name

    limits = tmp_path / 'limits.yaml'
    limits.write_text('limits:\n  limit_cycle_amplitude: {max: 1.2e-3}\n  sticks: {max: 12}\n', encoding='utf-8')
    assert answered(capsys, 'check', out / 'identified.yaml', '--duration', '4', '--limits', limits)[0] == 0

    code, said, _ = answered(capsys, 'uncertainty', out / 'identified.yaml', '--with', out / 'posterior.yaml',
                             '--samples', '64', '--out', tmp_path / 'spread')
    assert code == 0
    spread = json.loads((tmp_path / 'spread' / 'uncertainty.json').read_text())['percentiles']['period']
    assert spread['5'] < figures['period']['measured'] * 1.01
    assert spread['95'] > figures['period']['measured'] * 0.99
    assert spread['95'] / spread['5'] < 1.02


@few_starts()
def test_a_model_that_does_not_fit_has_its_files_and_exit_code_3(tmp_path: Path, start: Path, capsys: Capture) -> None:
    """The axis has half the mass of the scene, and that is not free."""
    run, out = imported(tmp_path, readings({**VALUES, 'axis.mass': 50.0}, 2.0), capsys), tmp_path / 'found'
    code, said, error = answered(capsys, 'identify', run, '--scene', start, '--free', free_file(tmp_path / 'free.yaml'),
                                 '--out', out)
    assert code == 3
    assert error.count('\n') == 1
    assert 'the model does not fit measured: ' in error
    assert 'THE MODEL DOES NOT FIT this run:' in said
    assert {path.name for path in out.iterdir()} == FILES
    assert 'THE MODEL DOES NOT FIT' in (out / 'identified.yaml').read_text()


def without_motion() -> Readings:
    return readings({**VALUES, 'drive.velocity': 0.0})


def without_stick() -> Readings:
    return readings({**VALUES, 'friction.static.initial': 0.08, 'friction.kinetic.coefficients': (0.08, 0.08),
                     'drive.velocity': 0.01})


def with_another_clock() -> Readings:
    """Each half of the run is as it was, but 100 s lie between."""
    found = readings()
    late = np.where(np.arange(len(found.times)) > len(found.times) // 2, 100.0, 0.0)
    return found._replace(times=found.times + late)


def in_millimetres() -> Readings:
    found = readings()
    return found._replace(columns={**found.columns, 'position': 1e3 * found.columns['position']})


def few() -> Readings:
    return readings(rate=2.0, duration=0.5)


WRONG: Mapping[str, tuple[Callable[[], Readings], Mapping[str, tuple[float, float]], tuple[str, ...]]] = {
    'no motion': (without_motion, FREE, ('a position that changes by', 'the slider moves')),
    'no stick': (without_stick, FREE, ('friction.static.initial', 'there is no rest between two motions')),
    'another clock': (with_another_clock, FREE, ('a jump of its time from 2 to',)),
    'another unit': (in_millimetres, FREE, ('check the unit of the position',)),
    'too few readings': (few, FREE, ('samples',)),
    'fixed by the law': (readings, {'friction.static.time_constant': (0.1, 1.0)},
                         ('friction.static.time_constant', 'one that the laws of the scene have')),
    'start out of range': (readings, {'axis.drive_stiffness': (1.8e5, 3e5)},
                           ('axis.drive_stiffness = 160000.0 is refused: must be in its range',)),
    'not of the scene': (readings, {'axis.drive_stifness': (1e5, 3e5)}, ('did you mean axis.drive_stiffness?',)),
    'no such channel': (readings, {'sensor.velocity.offset': (-1.0, 1.0)},
                        ('sensor.velocity.offset', 'of a channel that was measured: position')),
}


@pytest.mark.parametrize('case', WRONG)
def test_bad_input_gets_one_line_and_writes_nothing(case: str, tmp_path: Path, start: Path, capsys: Capture) -> None:
    measured, free, words = WRONG[case]
    run = imported(tmp_path, measured(), capsys, *{
        'no motion': ('--stick-velocity', '1e-4'), 'another unit': ('--meant', 'position')}.get(case, ()))
    before = set(tmp_path.iterdir())
    said = refused(capsys, 'identify', run, '--scene', start, '--free', free_file(tmp_path / 'free.yaml', free),
                   '--out', tmp_path / 'found')
    for word in words:
        assert word in said, said
    assert set(tmp_path.iterdir()) == before | {tmp_path / 'free.yaml'}


def test_a_clock_that_goes_back_is_refused_by_import(tmp_path: Path, capsys: Capture) -> None:
    table = tmp_path / 'axis.csv'
    table.write_text('t,x\n0.0,0.0\n0.1,1e-3\n0.05,2e-3\n', encoding='utf-8')
    assert 'a time after the one before it' in refused(
        capsys, 'import', table, '--columns', 'time=t,position=x', '--out', tmp_path / 'run')


@pytest.mark.parametrize(('options', 'words'), [
    (('--out', 'there'), ('--out', 'does not exist')), (('--workers', '0'), ('--workers', '0')),
    (('--scene', 'paper_fig77'), ('paper_fig77',)), (('--free', 'nowhere.yaml'), ('nowhere.yaml',)),
    (('--set', 'axis.mass=-1.0'), ('axis.mass', '-1.0'))])
def test_misuse_gets_one_line(options: tuple[str, str], words: tuple[str, ...], tmp_path: Path, start: Path,
                              capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path('there').mkdir()
    readings(duration=1.0).as_run(tmp_path / 'measured')
    given = {'--scene': str(start), '--free': str(free_file(tmp_path / 'free.yaml')), '--out': 'found',
             **dict([options])}
    said = refused(capsys, 'identify', 'measured', *(word for pair in given.items() for word in pair))
    for word in words:
        assert word in said
    assert not Path('found').exists()


def test_a_scene_is_no_run(tmp_path: Path, capsys: Capture) -> None:
    assert 'this is a scene' in refused(capsys, 'identify', 'paper_fig7', '--scene', 'paper_fig7', '--free',
                                        free_file(tmp_path / 'free.yaml'), '--out', tmp_path / 'found')



@pytest.fixture
def without_a_fit(tmp_path: Path, start: Path, capsys: Capture) -> tuple[Path | str, ...]:
    """An identification that tries all of its starts, since none fits."""
    run = imported(tmp_path, readings({**VALUES, 'axis.mass': 20.0}, 1.0, 250.0), capsys)
    return ('identify', run, '--scene', start, '--free', free_file(tmp_path / 'free.yaml', WIDE), '--out')


@few_starts()
def test_an_interrupted_one_ends_as_one_of_two_processes(without_a_fit: tuple[Path | str, ...], tmp_path: Path,
                                                         capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    whole, cut = tmp_path / 'whole', tmp_path / 'cut'
    assert answered(capsys, *without_a_fit, whole, '--workers', '2')[0] == 3
    done: list[int] = []

    def interrupted(*arguments: Any) -> Any:
        if len(done) == 2:
            raise KeyboardInterrupt
        done.append(1)
        return fit_from(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr(many_fits, 'fit_from', interrupted)
        said = refused(capsys, *without_a_fit, cut, code=130)
    assert f'what is done is kept in {cut}, --resume goes on' in said
    assert {path.name for path in cut.iterdir()} == {'identify.json', 'fit_0.npz', 'fit_1.npz'}
    assert 'a folder that does not exist' in refused(capsys, *without_a_fit, cut)
    (cut / 'fit_1.npz').write_bytes(b'PK damaged')    # as a crash of the machine may leave it
    code, _, error = answered(capsys, *without_a_fit, cut, '--resume')
    assert (code, error.count('\n')) == (3, 1)
    assert {path.name for path in cut.iterdir()} == FILES
    for name in ('identified.yaml', 'posterior.yaml'):
        assert (cut / name).read_bytes() == (whole / name).read_bytes()
    runs = [json.loads((folder / 'report.json').read_text())['runs'] for folder in (whole, cut)]
    assert runs[0] == runs[1]
    assert 'the folder of an interrupted identification' in refused(capsys, *without_a_fit, cut, '--resume')


@few_starts()
def test_another_one_is_not_gone_on_with(without_a_fit: tuple[Path | str, ...], tmp_path: Path, capsys: Capture,
                                         monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: Any) -> Any:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(many_fits, 'fit_from', interrupted)
        assert 'kept' not in refused(capsys, *without_a_fit, tmp_path / 'cut', code=130)   # nothing was done
    assert not (tmp_path / 'cut').exists()
    work = WorkFolder(tmp_path / 'cut', {'form': 'stickslip identification 1', 'run': 'another'}, False)
    work.keep('fit_0', {'point': np.zeros(3)})
    assert 'its run is another' in refused(capsys, *without_a_fit, tmp_path / 'cut', '--resume')
