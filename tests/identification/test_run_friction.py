# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction curve out of a run: force less inertia in bins of the velocity, both ways."""

import csv
from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.inputs import load_scene
from tests.support.tool import Capture, answered

MASS, FORWARD, BACKWARD = 30.0, 60.0, 48.0
STEP = 1e-7


def friction_at(velocity: Numbers) -> Numbers:
    side = np.where(velocity > 0.0, FORWARD, BACKWARD)
    return np.asarray(np.sign(velocity) * (side + 0.6 * side * np.exp(-np.abs(velocity) / 0.005))
                      + 300.0 * velocity)


def measured(quantum: float = STEP, noise: float = 1.0) -> stickslip.Measurement:
    """Moves to and fro whose amplitude grows, by a motor force with noise, seen by an encoder that counts."""
    times = np.arange(24_000) * 1e-3
    turn, growth = 2.0 * np.pi * 0.75, 0.02 / 24.0
    phase = turn * times
    position = growth * times * np.sin(phase)
    velocity = growth * (np.sin(phase) + times * turn * np.cos(phase))
    acceleration = growth * turn * (2.0 * np.cos(phase) - times * turn * np.sin(phase))
    force = MASS * acceleration + friction_at(velocity)
    force += np.random.default_rng(3).normal(0.0, noise, len(times))
    if quantum:
        position = np.round(position / quantum) * quantum
    return stickslip.Measurement.from_arrays(time=times, position=position, drive_force=force)


@pytest.fixture(scope='module')
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('runs') / 'moves'
    measured().write(folder)
    return folder


def test_the_friction_is_that_of_the_axis(run_folder: Path) -> None:
    found = stickslip.friction_curve(run_folder, mass=MASS, slowest=1e-3)
    off = found.friction - friction_at(found.velocities)
    assert np.abs(off).max() < 0.02 * np.abs(found.friction).max()
    assert (found.lower <= found.friction).all()
    assert (found.friction <= found.upper).all()
    assert (np.diff(found.velocities) > 0.0).all()
    assert found.counts.min() >= 8
    assert found.velocities[0] < -0.05
    assert found.velocities[-1] > 0.05
    assert 'cubic polynomials through' in found.notes[1]


def test_inertia_that_is_left_out_shows_in_the_quartiles(run_folder: Path) -> None:
    found = stickslip.friction_curve(run_folder, mass=MASS, slowest=0.02)
    wrong = stickslip.friction_curve(run_folder, mass=0.1 * MASS, slowest=0.02)
    assert np.median(wrong.upper - wrong.lower) > 2.0 * np.median(found.upper - found.lower)


def test_both_directions_in_one_command(run_folder: Path, tmp_path: Path, capsys: Capture) -> None:
    table, made = tmp_path / 'curve.csv', tmp_path / 'made.yaml'
    code, out, _ = answered(capsys, 'friction', run_folder, '--mass', str(MASS), '--slowest', '1e-3', '--csv', table,
                            '--normal-force', '800', '--direction', 'each', '--law', 'exponential', '--out', made)
    assert code == 0
    assert 'force less inertia of 30 kg' in out
    axis = load_scene(str(made)).axis
    ahead, back = axis.friction.sides
    assert (axis.mass, axis.normal_force) == (MASS, 800.0)
    for side, level in ((ahead, FORWARD), (back, BACKWARD)):
        assert 800.0 * side.kinetic.coefficient(0.05) == pytest.approx(level + 15.0, rel=0.03)
        assert 800.0 * side.kinetic.coefficient(0.002) == pytest.approx(float(level * (1.0 + 0.6 * np.exp(-0.4))),
                                                                        rel=0.05)
    with table.open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ['velocity', 'friction_force', 'lower_quartile', 'upper_quartile', 'readings']
    again = ('friction', table, '--speed-unit', 'm/s', '--force-unit', 'N', '--direction', 'forward')
    code, out, _ = answered(capsys, *again, '--plot', tmp_path / 'curve.svg')
    assert code == 0
    assert 'friction               ' in out
    assert ' N s/m' in out
    assert '--normal-force is missing' in answered(capsys, *again, '--out', tmp_path / 'other.yaml')[2]


def test_friction_of_a_simulation_is_its_own(tmp_path: Path) -> None:
    run = stickslip.simulate('paper_fig4_falling', 3.0)
    found = stickslip.friction_curve(run)
    kinetic = run.scene.axis.friction.kinetic
    coefficients = [kinetic.coefficient(speed) for speed in found.velocities.tolist()]
    assert found.friction / run.scene.axis.normal_force == pytest.approx(np.array(coefficients), rel=0.01)


@pytest.mark.parametrize(('given', 'said'), [
    ((), 'mass is missing: must be given in kg'),
    (('--mass', '-1'), 'axis.mass = -1.0 is refused'),
    (('--mass', '30', '--slowest', '9'), 'with motion of 8 readings or more'),
    (('--mass', '30', '--speed-unit', 'mm/s'), '--speed-unit: not for a run'),
    (('--mass', '30', '--normal-force', '0'), '--normal-force = 0.0 is refused'),
])
def test_what_is_refused(run_folder: Path, given: tuple[str, ...], said: str, capsys: Capture) -> None:
    code, _, error = answered(capsys, 'friction', run_folder, *given)
    assert code == 2
    assert said in error


def test_torque_speed_and_share_of_a_rating(tmp_path: Path, capsys: Capture) -> None:
    rows = [(speed, 2.0 + 0.8 * np.exp(-speed / 100.0)) for speed in (10, 20, 50, 100, 200, 400, 800, 1200, 2000)]
    torques, shares = tmp_path / 'torques.csv', tmp_path / 'shares.csv'
    torques.write_text('n [rpm];M [N m]\n' + ''.join(f'{n};{m}\n'.replace('.', ',') for n, m in rows))
    shares.write_text('n [1/min];M [%]\n' + ''.join(f'{n};{m / 4.0 * 100.0}\n' for n, m in rows))
    lead = ('--law', 'exponential', '--lead', '10 mm')
    first = answered(capsys, 'friction', torques, '--speed-unit', 'rpm', '--force-unit', 'N m', *lead)
    rated = ('--force-unit', '%', '--rated', '4 N m')
    other = answered(capsys, 'friction', shares, '--speed-unit', '1/min', *rated, *lead)
    assert (first[0], other[0]) == (0, 0)
    assert first[1].splitlines()[2:4] == other[1].splitlines()[2:4]
    values = [{line.split()[0]: line.split()[1] for line in out.splitlines() if line.startswith(('initial', 'limit'))}
              for _, out, _ in (first, other)]
    assert values[0] == values[1]
    assert len(values[0]) == 2
    assert 'speed                  0.00166667 to 0.333333 m/s' in first[1]
    assert f'friction               {2.0 * 2 * np.pi / 0.01:.4g} to' in first[1]
