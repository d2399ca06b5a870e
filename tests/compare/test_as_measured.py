# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene beside a measured run moves by what that run measured, and not by the inputs it was identified from."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.compare.characteristics import characteristics_of
from stickslip_sim.compare.fresh import simulate_densely
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.types import EventKind
from stickslip_sim.identification.identify import identify
from stickslip_sim.identification.report import write_results
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots.characteristics import Characteristics, plot_characteristics
from stickslip_sim.recording import read_run, write_measured
from stickslip_sim.runs import Run, simulate
from stickslip_sim.scene import Scene, changed, scene_from_values
from tests.support.tool import Capture, done, refused

OFFSET, NOISE, ENCODER, RATE = -3.3, 0.2, 1e-6, 500.0   # N, N, m, Hz
MOTOR = scene_from_values({
    'scene': 'motor', 'axis.mass': 95.0, 'axis.drive_stiffness': 0.0, 'axis.drive_damping': 0.0,
    'axis.normal_force': 100.0, 'friction.static.law': 'constant', 'friction.static.initial': 0.2,
    'friction.kinetic.velocities': (0.0, 1.0), 'friction.kinetic.coefficients': (0.2, 1.8), 'drive.velocity': 0.0})
FREE = {'axis.mass': {'distribution': 'uniform', 'low': 50.0, 'high': 200.0},
        'sensor.external_force.offset': {'distribution': 'uniform', 'low': -20.0, 'high': 20.0}}


def measured(folder: Path, forces: Sequence[float], begin: float = 0.0, columns: Sequence[str] = ()) -> Path:
    """Write a run under a motor force, each for 0.5 s, with an encoder that counts from `begin` (m)."""
    edges: Numbers = np.arange(len(forces), dtype=np.float64)
    pushed = changed(MOTOR, {'force.course': 'table', 'force.times': tuple((0.5 * edges).tolist()),
                             'force.forces': tuple(forces)})
    samples = simulate(pushed, 0.5 * len(forces), 1.0 / RATE).samples
    noise = np.random.default_rng(3).normal(0.0, NOISE, len(samples['time']))
    known = {'position': begin + ENCODER * np.round(samples['position'] / ENCODER),
             'drive_force': np.interp(samples['time'], 0.5 * edges, forces) + OFFSET + noise}
    write_measured(folder, samples['time'], {name: known[name] for name in columns or known}, {})
    return folder


@pytest.fixture(scope='module')
def found(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of what was identified from one run."""
    folder = tmp_path_factory.mktemp('motor')
    train = read_run(measured(folder / 'train', (60.0, -70.0, 80.0, -50.0, 75.0, -60.0, 40.0)))
    results = folder / 'found'
    results.mkdir()
    write_results(train, identify(train, changed(MOTOR, {'axis.mass': 110.0}), FREE), 'start.yaml', results)
    return results


TEST_FORCES = (40.0, 90.0, -45.0, -80.0, 60.0, -40.0, -70.0, 55.0)


@pytest.mark.usefixtures('blank_pictures')
def test_another_run_is_followed_by_its_own_force(found: Path, tmp_path: Path, capsys: Capture) -> None:
    """To a thousandth of its way; the force of the run that it was identified from leads elsewhere."""
    run = measured(tmp_path / 'test', TEST_FORCES, begin=0.01)
    said = done(capsys, 'compare', run, found / 'identified.yaml', '--out', tmp_path / 'beside')
    assert 'its force is the one measured in test, less the errors of its sensor: offset -3.' in said
    assert 'it starts where test does' in said
    assert ' RMSE over the same time' in said
    (beside,) = json.loads((tmp_path / 'beside' / 'report.json').read_text())['beside']
    way = np.ptp(read_run(run).samples['position'])
    assert 0.0 < beside['position_rmse'] < 0.005 * way
    assert 'RMSE' in (tmp_path / 'beside' / 'report.html').read_text()
    assert 'drive force' in (tmp_path / 'beside' / 'overlay.svg').read_text()


def test_a_run_that_did_not_measure_what_moves_it_is_refused(found: Path, tmp_path: Path, capsys: Capture) -> None:
    run = measured(tmp_path / 'blind', TEST_FORCES, columns=('position',))
    line = refused(capsys, 'compare', run, found / 'identified.yaml', '--out', tmp_path / 'beside')
    assert 'must be measured with its external_force or drive_force' in line
    assert 'is the one of another run; import it with drive_force=COLUMN' in line
    line = refused(capsys, 'compare', run, write_scene(tmp_path / 'motor.yaml', MOTOR), '--out', tmp_path / 'beside')
    assert 'nothing else moves this scene' in line
    assert not (tmp_path / 'beside').exists()


def test_it_ends_with_the_run(found: Path, tmp_path: Path, capsys: Capture) -> None:
    run = measured(tmp_path / 'test', TEST_FORCES)
    line = refused(capsys, 'compare', run, found / 'identified.yaml', '--duration', '9', '--out', tmp_path / 'beside')
    assert '--duration = 9.0 is refused: must be > 0 and <= 4 s, as long as test' in line


def test_a_motion_without_cycles_is_compared_over_time(found: Path, tmp_path: Path, capsys: Capture) -> None:
    run = measured(tmp_path / 'once', (60.0, 60.0, 60.0))
    said = done(capsys, 'compare', run, found / 'identified.yaml', '--out', tmp_path / 'beside')
    assert ' RMSE over the same time' in said
    assert 'means of' not in said
    assert 'over the same time: (a) forces' in (tmp_path / 'beside' / 'report.html').read_text()


def test_a_damaged_report_is_named(found: Path, tmp_path: Path, capsys: Capture) -> None:
    other = tmp_path / 'damaged'
    other.mkdir()
    for file in found.iterdir():
        (other / file.name).write_bytes(file.read_bytes())
    (other / 'report.json').write_text('{"estimates": [1]}', encoding='utf-8')
    run = measured(tmp_path / 'test', TEST_FORCES)
    line = refused(capsys, 'compare', run, other / 'identified.yaml', '--out', tmp_path / 'beside')
    assert 'must be as identify wrote it' in line


def write_scene(path: Path, scene: Scene) -> Path:
    path.write_text(scene.text, encoding='utf-8')
    return path


# The picture of the friction characteristics: of one direction, or of both where they differ.

TO_AND_FRO = {'drive.course': 'steps', 'drive.times': [0.0, 1.5], 'drive.velocities': [0.004, -0.006]}
BACKWARD = {'friction.static.backward.initial': 0.08, 'friction.static.backward.limit': 0.15,
            'friction.kinetic.backward.velocities': [0.0, 0.02], 'friction.kinetic.backward.coefficients': [0.08, 0.03]}


@pytest.fixture(scope='module')
def run() -> Run:
    return simulate_densely(load_scene('paper_fig7', {**TO_AND_FRO, **BACKWARD}), 3.0)


def test_friction_that_is_the_same_both_ways_is_drawn_once(tmp_path: Path) -> None:
    run = simulate_densely(load_scene('paper_fig7', TO_AND_FRO), 3.0)
    (alone,) = sides = characteristics_of(run)
    assert len(alone.break_aways.x) + alone.has_prolonged_rest == len(away(run, 1)) + len(away(run, -1))
    assert drawn(sides, tmp_path).isdisjoint({'static, forwards', 'static, backwards'})


def test_each_direction_has_its_own_curves_and_break_aways(run: Run) -> None:
    ahead, back = characteristics_of(run)
    assert (ahead.decelerating.y[0], back.decelerating.y[0]) == (0.12, 0.08)
    assert (ahead.static_limit, back.static_limit) == (0.24, 0.15)
    assert np.array_equal(ahead.static.x, back.static.x)
    assert (ahead.has_prolonged_rest, back.has_prolonged_rest) == (True, False)
    assert ahead.break_aways.y.tolist() == away(run, 1)[1:]     # the first one is that after the prolonged rest
    assert back.break_aways.y.tolist() == away(run, -1)
    assert len(back.break_aways.y) > 1
    for side in (ahead, back):
        assert set(side.accelerating) == {'first slip', 'last slip'}
        assert all(curve.y[0] > side.decelerating.y[0] for curve in side.accelerating.values())


def test_both_are_drawn(run: Run, tmp_path: Path) -> None:
    names = drawn(characteristics_of(run), tmp_path)
    assert {'static, forwards', 'static, backwards', 'break-aways of the run, backwards',
            'after prolonged rest, forwards', 'decelerating'} <= names


def away(run: Run, direction: int) -> list[float]:
    """Return the static coefficients of the break-aways in a direction."""
    return [event.static_coefficient for event in run.events
            if event.kind == EventKind.BREAKAWAY and event.direction == direction]


def drawn(sides: list[Characteristics], folder: Path) -> set[str]:
    """Return the labels in a picture."""
    plot_characteristics(sides, folder / 'friction.svg')
    text = (folder / 'friction.svg').read_text(encoding='utf-8')
    return {line.removeprefix('<!-- ').removesuffix(' -->') for line in map(str.strip, text.split('\n'))
            if line.startswith('<!-- ')}
