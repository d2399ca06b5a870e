# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs that were measured stand in the scene that was found, so that it runs as the axis did."""

from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.identification.results import IDENTIFIED_SCENE, write_results
from stickslip_sim.recording import write_measured
from stickslip_sim.recording.measured_run import MeasuredRun
from tests.support.measured_runs import between

MOTOR = stickslip.load_scene('paper_fig7', {
    'axis.drive_stiffness': 0.0, 'axis.drive_damping': 0.0, 'axis.mass': 95.0, 'axis.normal_force': 100.0,
    'friction.static.law': 'constant', 'friction.static.initial': 0.2, 'friction.acceleration_dependence': False,
    'friction.kinetic.velocities': (0.0,), 'friction.kinetic.coefficients': (0.2,), 'friction.kinetic.end_slope': 2.0,
    'drive.velocity': 0.0, 'force.course': 'sine', 'force.amplitude': 60.0, 'force.frequency': 1.0})
OFFSET = -3.0   # N, of the sensor


def measured(folder: Path, begin: float = 0.0) -> MeasuredRun:
    samples = stickslip.simulate(MOTOR, begin + 2.0, 1e-3).samples
    part = samples['time'] >= begin - 1e-9
    noise = np.random.default_rng(2).normal(0.0, 0.1, int(part.sum()))
    write_measured(folder, samples['time'][part] - samples['time'][part][0], {
        'position': np.round(samples['position'][part], 6) + 0.2,
        'external_force': samples['external_force'][part] + noise + OFFSET}, {})
    run = stickslip.read_run(folder)
    assert isinstance(run, MeasuredRun)
    return run


START_CHANGES = {**{name: MOTOR.values[name] for name in (
    'axis.drive_stiffness', 'axis.drive_damping', 'axis.normal_force', 'friction.static.law',
    'friction.acceleration_dependence', 'friction.kinetic.velocities', 'friction.kinetic.end_slope', 'drive.velocity')},
    'axis.mass': 120.0, 'friction.static.initial': 0.3, 'friction.kinetic.coefficients': (0.25,)}
START = stickslip.load_scene('paper_fig7', START_CHANGES)
FREE = {'axis.mass': between(50.0, 200.0), 'friction.kinetic.coefficients[0]': between(0.05, 0.4),
        'friction.static.initial': between(0.05, 0.5), 'sensor.external_force.offset': between(-10.0, 10.0)}


def test_a_measured_force_is_in_the_scene_that_was_found(tmp_path: Path) -> None:
    run = measured(tmp_path / 'run')
    found = stickslip.identify(run, START, FREE)
    assert found.measured_inputs == ('force',)
    assert found.values['sensor.external_force.offset'] == pytest.approx(OFFSET, abs=0.1)
    moved = stickslip.simulate(found.scene, 2.0, 1e-3).samples['position']
    assert np.abs(moved - run.samples['position']).max() < 0.02 * float(np.ptp(run.samples['position']))

    out = tmp_path / 'out'
    out.mkdir()
    write_results(run, found, 'start.yaml', out)
    scene = stickslip.load_scene(str(out / IDENTIFIED_SCENE))
    assert 'file: measured_force.csv' in (out / IDENTIFIED_SCENE).read_text().replace('"', '')
    assert scene.values['force.forces'] == found.scene.values['force.forces']
    again = stickslip.simulate(scene, 2.0, 1e-3).samples['position']
    assert again == pytest.approx(moved, abs=1e-5)


def test_a_motor_axis_that_is_measured_from_mid_motion_on(tmp_path: Path) -> None:
    found = stickslip.identify(measured(tmp_path / 'run', 0.3), START, FREE)
    assert any('initial.velocity is free' in note for note in found.notes)
    assert found.values['axis.mass'] == pytest.approx(95.0, rel=0.02)
    assert found.values['friction.kinetic.coefficients[0]'] == pytest.approx(0.2, rel=0.03)


def test_numbers_of_sensors_alone(tmp_path: Path) -> None:
    """The offset of a force where all else is known; no number of the scene is left open."""
    run = measured(tmp_path / 'run')
    known = {name: MOTOR.values[name] for name in ('axis.mass', 'friction.static.initial',
                                                   'friction.kinetic.coefficients')}
    start = stickslip.load_scene('paper_fig7', {**START_CHANGES, **known})
    found = stickslip.identify(run, start, {'sensor.external_force.offset': between(-10.0, 10.0)})
    assert found.values['sensor.external_force.offset'] == pytest.approx(OFFSET, abs=0.1)
    write_results(run, found, 'start.yaml', tmp_path)
    assert (tmp_path / 'posterior.yaml').read_text().endswith('parameters:\n')
