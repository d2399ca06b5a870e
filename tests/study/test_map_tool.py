# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip map` as a user meets it: pictures of sweeps, and folders that are none."""

import math
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.figures.cycles import cycle_figures
from stickslip_sim.figures.point_figures import Runs
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate_events
from stickslip_sim.study import EvenGrid, Study, diagrams, variation
from stickslip_sim.study.diagrams import bifurcation, borders, ending_at
from stickslip_sim.study.folder import PARTIAL, POINTS_TABLE, Folder
from stickslip_sim.study.study import study_of
from stickslip_sim.study.table import read_columns
from tests.support.tool import Capture, refused

SMALL = ['paper_fig7', '--over', 'drive.velocity=1e-3:0.06:6:log', '--over', 'axis.drive_stiffness=1e5:1e6:4:log']


@pytest.fixture(scope='module')
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('swept') / 'out'
    assert run(['sweep', *SMALL, '--out', str(folder)]) == 0
    return folder


def test_a_map_with_picks(swept: Path, tmp_path: Path) -> None:
    pictures = [tmp_path / 'map.png', tmp_path / 'map.svg']
    assert run(['map', str(swept), *(word for path in pictures for word in ('--out', str(path))),
                '--pick', '0.002,6e5', '--show', 'period']) == 0
    assert pictures[0].read_bytes().startswith(b'\x89PNG')
    text = pictures[1].read_text()
    for words in ('drive velocity / (mm/s)', 'drive stiffness / (N/µm)', 'period / ms', 'smooth sliding',
                  'steady sliding loses stability', 'spring stretch / mm'):
        assert words in text


@pytest.mark.parametrize(('point', 'times'), [('0.001,1e5', 0), ('0.002,6e5', 1)])
def test_only_a_picked_point_that_the_table_lacks_is_run_until_it_settles(
        point: str, times: int, swept: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ran, runs = [], Study.runs

    def counted(study: Study, points: Numbers) -> Runs:
        ran.append(points)
        return runs(study, points)

    def blank(*given: Any) -> None:
        for path in given[-1]:
            Path(path).touch()

    monkeypatch.setattr(Study, 'runs', counted)
    monkeypatch.setattr(diagrams, 'draw_map', blank)
    assert run(['map', str(swept), '--out', str(tmp_path / 'map.svg'), '--pick', point]) == 0
    assert len(ran) == times


def test_the_table_has_the_motion_that_a_run_of_the_point_ends_in(swept: Path) -> None:
    study = study_of(Folder(swept).described())
    table = read_columns(swept / POINTS_TABLE, study)
    without = {name: column[:0] for name, column in table.items()}
    for point in study.points(0, study.count)[::5]:
        *in_table, of_table = ending_at(study, table, point)
        *found, of_run = ending_at(study, without, point)
        assert (in_table, of_table.end, of_table.events) == (found, of_run.end, of_run.events)


def test_a_sweep_whose_steps_numpy_rounded_otherwise_is_drawn(swept: Path, tmp_path: Path) -> None:
    there = tmp_path / 'there'
    shutil.copytree(swept, there)
    titles, *rows = (there / POINTS_TABLE).read_text().splitlines()
    moved = [f'{math.nextafter(float(feed), 1.0)!r},{rest}' for feed, rest in (row.split(',', 1) for row in rows)]
    (there / POINTS_TABLE).write_text('\n'.join((titles, *moved, '')))
    assert (there / POINTS_TABLE).read_text() != (swept / POINTS_TABLE).read_text()
    assert run(['map', str(there), '--out', str(tmp_path / 'map.svg')]) == 0


def test_the_feed_lies_along_x_and_the_critical_feed_is_drawn(tmp_path: Path) -> None:
    assert run(['sweep', 'paper_fig4_constant', '--set', 'friction.static.law=constant', '--set',
                'friction.static.initial=0.24', '--over', 'axis.drive_damping=100:8000:3:log', '--over',
                'drive.velocity=1e-3:0.2:4:log', '--out', str(tmp_path / 'out')]) == 0
    assert run(['map', str(tmp_path / 'out'), '--out', str(tmp_path / 'map.svg')]) == 0
    text = (tmp_path / 'map.svg').read_text()
    assert 'critical feed, closed form' in text
    assert text.index('drive velocity') < text.index('drive damping')


def test_a_feed_that_rests_has_no_steady_sliding_that_could_be_lost() -> None:
    scene = load_scene('paper_fig7')
    study = Study(scene.values, EvenGrid((variation('drive.velocity=0:0.06:3'), variation('axis.mass=300:400:2'))))
    known = borders(study)
    assert known is not None
    assert np.isnan(known.is_lost[:, 0]).all()
    assert (known.is_lost[:, 1:] == (known.feeds[1:] < 0.035)).all()
    through_rest = Study(scene.values, EvenGrid((variation('drive.velocity=-0.01:0.01:3'),)))
    sliding = bifurcation(through_rest, through_rest.figures(0, 3)).sliding
    friction = scene.axis.normal_force * (0.12 - 0.07 * 0.01 / 0.035)
    assert sliding[:, 1] == pytest.approx([-friction, np.nan, friction], rel=1e-9, nan_ok=True)


def test_a_bifurcation_diagram(tmp_path: Path) -> None:
    assert run(['sweep', 'paper_fig4_falling', '--over', 'drive.velocity=1e-3:0.06:8:log', '--out',
                str(tmp_path / 'out')]) == 0
    assert run(['map', str(tmp_path / 'out'), '--out', str(tmp_path / 'b.svg')]) == 0
    text = (tmp_path / 'b.svg').read_text()
    for words in ('drive force / N', 'at break-away', 'steady sliding', 'unstable', 'jump from cycle to cycle / mm'):
        assert words in text


@pytest.mark.parametrize('over', ['drive.velocity=1e-3:0.03:4:log', 'axis.drive_stiffness=2.3e6:2.6e6:3'])
def test_the_cycles_of_a_diagram_are_the_last_of_the_whole_run(over: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """To the last bit, also where cycles come in groups; no run is looked at but at its end."""
    study = Study(load_scene('paper_fig8').values, EvenGrid((variation(over),)))
    figures = study.figures(0, study.count)
    points = study.points(0, study.count)
    expected = []
    for k, point in enumerate(points):
        cycles = cycle_figures(simulate_events(study.scene_at(point), float(figures.duration[k])).events)
        expected += [(point[0], cycle.break_away_drive_force, cycle.arrest_drive_force, cycle.jump)
                     for cycle in cycles[len(cycles) // 2:][-40:]]
    monkeypatch.setattr('stickslip_sim.study.diagrams.simulate_events', None)
    assert bifurcation(study, figures).cycles.tolist() == [list(row) for row in expected]


@pytest.mark.parametrize(('arguments', 'said'), [
    (['--out', 'map.jpg'], '.png'), (['--out', 'map.png', '--show', 'colour'], 'amplitude'),
    (['--out', 'map.png', '--pick', '1'], '--pick'), (['--out', 'map.png', '--pick', '1,2'], '--pick'),
    (['--out', 'map.png', '--pick', 'a,b'], '--pick'), (['--out', 'map.png', '--pick', 'nan,6e5'], '--pick'),
    (['--out', '/dev/null/map.png'], '/dev/null'), (['--out', 'map.png', '--out', 'map.png'], 'a different file'),
    (['--out', 'map.png', *['--pick', '0.002,6e5'] * 7], 'at most 6')])
def test_a_map_that_cannot_be_is_refused(swept: Path, arguments: list[str], said: str, tmp_path: Path, capsys: Capture,
                                         monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert said in refused(capsys, 'map', swept, *arguments)
    assert list(tmp_path.iterdir()) == []


def test_what_is_no_complete_sweep_of_one_or_two_parameters_is_refused(swept: Path, tmp_path: Path,
                                                                       capsys: Capture) -> None:
    picture = ['--out', str(tmp_path / 'map.png')]
    assert 'study.json' in refused(capsys, 'map', tmp_path, *picture)
    shutil.copytree(swept, tmp_path / 'part')
    (tmp_path / 'part' / POINTS_TABLE).rename(tmp_path / 'part' / PARTIAL)
    assert '--resume' in refused(capsys, 'map', tmp_path / 'part', *picture)
    drawn = ['--over', 'axis.mass=300:400', '--sobol', '4', '--out', str(tmp_path / 's')]
    assert run(['sweep', 'paper_fig7', *drawn]) == 0
    capsys.readouterr()
    assert 'a grid of two parameters' in refused(capsys, 'map', tmp_path / 's', *picture)
    shutil.copytree(swept, tmp_path / 'cut')
    (tmp_path / 'cut' / POINTS_TABLE).write_bytes((swept / POINTS_TABLE).read_bytes()[:-300])
    assert 'points' in refused(capsys, 'map', tmp_path / 'cut', *picture)
