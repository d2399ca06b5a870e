# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Right models that were called wrong, each by a cause of its own."""

from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.scene import Scene, changed, scene_from_values
from tests.support.measured_runs import COMPLIANT, as_run, between, truth

pytestmark = pytest.mark.slow

SMOOTH: dict[str, object] = {
    'friction.kinetic.law': 'stribeck', 'friction.kinetic.initial': 0.11, 'friction.kinetic.limit': 0.06,
    'friction.kinetic.stribeck_velocity': 0.01}
THERE_AND_BACK: dict[str, object] = {
    'drive.course': 'steps', 'drive.times': (0.0, 2.0), 'drive.velocities': (0.003, -0.003)}


def with_smooth_law(scene: Scene, **changes: object) -> Scene:
    """Return a scene with a smooth kinetic law in place of its table."""
    table = {name for name in scene.values if name.startswith('friction.kinetic.')}
    values = {name: value for name, value in scene.values.items() if name not in table}
    return scene_from_values({**values, **SMOOTH, **changes})


def shown(folder: Path, axis: Scene, duration: float, rate: float, noise: float, force_error: float = 0.0,
          has_force: bool = True) -> stickslip.Run:
    """Return what sensors show: a position with noise, and a force that is off, slowly, by a share of its range."""
    samples = stickslip.simulate(axis, duration, 1.0 / rate).samples
    random = np.random.default_rng(0)
    columns = {'position': samples['position'] + noise * random.standard_normal(len(samples['time']))}
    if has_force:
        force = samples['drive_force']
        columns['drive_force'] = force + force_error * np.ptp(force) * np.sin(samples['time'])
    return as_run(folder, samples['time'], columns)


def test_a_force_without_noise_is_followed_as_closely_as_a_model_can(tmp_path: Path) -> None:
    """A systematic 0.002 % of an exact force is seen, and matters to nobody."""
    axis = stickslip.load_scene('paper_fig7', {'drive.velocity': 0.003})
    run = shown(tmp_path / 'run', axis, 4.0, 500.0, 5e-8, force_error=2e-5)
    found = stickslip.identify(run, changed(axis, {'friction.static.limit': 0.25}),
                               {'friction.static.limit': between(0.15, 0.4)})
    assert found.fits, found.misfits
    assert found.estimates[0].value == pytest.approx(truth(axis, 'friction.static.limit'), rel=1e-4)


@pytest.mark.parametrize('tolerance', [1e-3, 1e-4])
def test_tables_of_a_smooth_law_are_as_fine_as_the_sensor_asks(tmp_path: Path, tolerance: float) -> None:
    """The axis has the law itself; the table of the scene is off by more than this encoder, if not by what matters."""
    law = with_smooth_law(stickslip.load_scene('paper_fig7', {'drive.velocity': 0.003}))
    run = shown(tmp_path / 'run', changed(law, {'friction.kinetic.tolerance': 1e-7}), 4.0, 500.0, 3e-8)
    start = changed(law, {'friction.kinetic.limit': 0.07, 'friction.kinetic.tolerance': tolerance})
    found = stickslip.identify(run, start, {'friction.kinetic.limit': between(0.04, 0.1)})
    assert found.fits, found.misfits
    assert float(str(found.scene.values['friction.kinetic.tolerance'])) < 0.1 * tolerance
    assert found.estimates[0].value == pytest.approx(0.06, rel=1e-4)


HEAVY = scene_from_values({
    'scene': 'heavy', 'axis.mass': 1553.0, 'axis.drive_stiffness': 45.7e6, 'axis.drive_damping': 134.6e3,
    'axis.normal_force': 22446.6, 'drive.velocity': 7.14e-5, 'friction.static.law': 'exponential',
    'friction.static.initial': 0.1079, 'friction.static.limit': 0.1914, 'friction.static.time_constant': 0.6529,
    'friction.kinetic.law': 'stribeck', 'friction.kinetic.initial': 0.08321, 'friction.kinetic.limit': 0.0668,
    'friction.kinetic.stribeck_velocity': 0.0142, 'friction.kinetic.viscous': 0.43})


def test_a_table_whose_error_no_test_sees_moves_no_number(tmp_path: Path) -> None:
    """That of the scene moved the mass by 17 standard deviations, and the model fitted."""
    samples = stickslip.simulate(changed(HEAVY, {'friction.kinetic.tolerance': 1e-7}), 6.0, 1e-3).samples
    random, force = np.random.default_rng(2), samples['drive_force']
    shape = samples['time'].shape
    run = as_run(tmp_path / 'run', samples['time'], {
        'position': samples['position'] + 1e-6 * random.standard_normal(shape),
        'drive_force': force + 0.02 * np.sqrt(np.mean(force**2)) * random.standard_normal(shape)})
    found = stickslip.identify(run, changed(HEAVY, {
        'axis.mass': 1390.0, 'friction.kinetic.limit': 0.07373}), {
            'axis.mass': between(911.0, 2720.0), 'friction.kinetic.limit': between(0.0315, 0.106)})
    assert found.fits, found.misfits
    for one in found.estimates:
        assert abs(np.log(one.value / truth(HEAVY, one.name))) < 4.0 * one.standard_deviation


def test_friction_of_each_direction_under_a_smooth_law_and_a_compliant_contact(tmp_path: Path) -> None:
    axis = with_smooth_law(changed(COMPLIANT, THERE_AND_BACK), **{
        'friction.kinetic.backward.initial': 0.09, 'friction.static.backward.initial': 0.1})
    run = shown(tmp_path / 'run', axis, 4.0, 500.0, 1e-7)
    found = stickslip.identify(run, changed(axis, {'friction.kinetic.limit': 0.07}),
                               {'friction.kinetic.limit': between(0.04, 0.09)})
    assert found.fits, found.misfits
    assert found.estimates[0].value == pytest.approx(0.06, rel=1e-3)


RINGING = scene_from_values({
    'scene': 'ringing', 'axis.mass': 63.95, 'axis.drive_stiffness': 47670.0, 'axis.drive_damping': 49.2,
    'axis.normal_force': 627.135, 'contact.model': 'compliant', 'contact.stiffness': 287600.0, 'contact.damping': 657.0,
    'drive.velocity': 0.00233, 'friction.static.law': 'exponential', 'friction.static.initial': 0.1452,
    'friction.static.limit': 0.2601, 'friction.static.time_constant': 0.1142,
    'friction.kinetic.velocities': (0.0, 0.0127), 'friction.kinetic.coefficients': (0.1157, 0.08544)})


def test_a_contact_that_rings_on_after_each_slip(tmp_path: Path) -> None:
    """What looks like a rest is none, and stretches from there on lead away from the truth, even from itself."""
    run = shown(tmp_path / 'run', RINGING, 6.0, 500.0, 0.0, has_force=False)
    found = stickslip.identify(run, RINGING, {
        'axis.drive_stiffness': between(3e4, 7e4), 'contact.stiffness': between(2e5, 5e5),
        'friction.kinetic.coefficients[0]': between(0.07, 0.2), 'friction.kinetic.velocities[1]': between(0.007, 0.02),
        'friction.static.time_constant': between(0.05, 0.2)})
    assert found.fits, found.misfits
    for one in found.estimates:
        assert one.value == pytest.approx(truth(RINGING, one.name), rel=1e-3)
