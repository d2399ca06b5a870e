# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Axes found from a run whose input was measured: a motor force, or a drive by its encoder."""

from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.core.errors import InputError
from stickslip_sim.identification.identified import NOT_IDENTIFIABLE, VOID
from stickslip_sim.identification.identified_scene import IDENTIFIED_SCENE
from stickslip_sim.identification.results import write_results
from stickslip_sim.recording.measured_run import MeasuredRun
from stickslip_sim.scene import changed
from tests.support.measured_runs import MOTOR, OF_FRICTION, OFF, RIGID, as_run, between, check, estimate_of, few_starts

pytestmark = pytest.mark.slow


def test_a_motor_force_drives_an_axis_without_a_spring(tmp_path: Path) -> None:
    """Its noise, integrated twice, moves the axis by hundreds of the steps of its encoder; the intervals know it."""
    samples = stickslip.simulate(MOTOR, 3.0).samples
    noise = np.random.default_rng(2).normal(0.0, 0.3, len(samples['time']))
    run = as_run(tmp_path / 'run', samples['time'] + 0.7, {   # the clock starts before the motion
        'position': np.round(samples['position'], 6), 'drive_force': samples['external_force'] + noise})
    start = changed(MOTOR, {'axis.mass': 130.0, 'friction.kinetic.end_slope': 1.4, 'force.course': 'constant',
                           'friction.static.initial': 0.3, 'friction.kinetic.coefficients': (0.27,)})
    found = stickslip.identify(run, start, {
        'axis.mass': between(50.0, 200.0), 'friction.kinetic.coefficients[0]': between(0.05, 0.3),
        'friction.static.initial': between(0.05, 0.5), 'friction.kinetic.end_slope': between(0.5, 5.0)})
    assert found.fits, found.misfits
    assert found.shift == 0.7
    (position,) = found.channels
    assert np.std(position.measured - position.fitted) > 20.0 * position.resolution
    assert np.std(position.residuals) == pytest.approx(position.resolution, rel=0.3)
    assert len(found.notes) == 1
    for name, right in (('axis.mass', 95.0), ('friction.kinetic.coefficients[0]', 0.2),
                        ('friction.kinetic.end_slope', 2.0)):
        estimate = estimate_of(found, name)
        low, high = estimate.best_interval
        assert high - low < 0.01 * right
        assert low - 0.5 * (high - low) < right < high + 0.5 * (high - low), estimate
    assert found.runs < 2000


JERKY = changed(MOTOR, {'axis.normal_force': 1000.0, 'friction.kinetic.coefficients': (0.1,), 'force.frequency': 0.8,
                        'friction.kinetic.end_slope': 0.2, 'force.amplitude': 300.0})


@pytest.mark.parametrize('seed', [14, 19])
def test_noise_of_a_motor_force_decides_when_a_slider_breaks_away(seed: int, tmp_path: Path) -> None:
    """A break-away a reading late is worth many times the noise of a sample; static friction followed each of them."""
    samples, random = stickslip.simulate(JERKY, 4.0).samples, np.random.default_rng(seed)
    shape = samples['time'].shape
    run = as_run(tmp_path / 'run', samples['time'], {
        'position': samples['position'] + random.normal(0.0, 1e-6, shape),
        'drive_force': samples['external_force'] + random.normal(0.0, 5.0, shape)})
    start = changed(JERKY, {'axis.mass': 110.0, 'friction.static.initial': 0.23, 'force.course': 'constant',
                            'friction.kinetic.coefficients': (0.12,)})
    found = stickslip.identify(run, start, {
        'axis.mass': between(60.0, 150.0), 'friction.kinetic.coefficients[0]': between(0.05, 0.15),
        'friction.static.initial': between(0.15, 0.4)})
    assert found.fits, found.misfits
    for name, right in (('friction.static.initial', 0.2), ('friction.kinetic.coefficients[0]', 0.1)):
        low, high = estimate_of(found, name).best_interval
        assert low < right < high
        assert high - low < 0.02 * right


@few_starts()
def test_a_motor_force_on_an_axis_that_is_not_quite_the_model(tmp_path: Path) -> None:
    """Its friction varies along the way; the scene that is found still follows the position of the whole run."""
    random = np.random.default_rng(3)
    samples = stickslip.simulate(MOTOR, 6.0).samples
    uneven = 0.6 * np.sin(2.0 * np.pi * samples['position'] / 0.01) * (samples['velocity'] != 0.0)   # N
    run = as_run(tmp_path / 'run', samples['time'], {
        'position': np.round(samples['position'], 7),
        'drive_force': samples['external_force'] + uneven + random.normal(0.0, 0.05, len(samples['time']))})
    start = changed(MOTOR, {'axis.mass': 130.0, 'force.course': 'constant'})
    found = stickslip.identify(run, start, {
        'axis.mass': between(50.0, 200.0), 'friction.kinetic.coefficients[0]': between(0.05, 0.3),
        'friction.kinetic.end_slope': between(0.5, 5.0), 'sensor.external_force.offset': between(-5.0, 5.0)})
    (position,) = found.channels
    off = np.std(position.measured - position.fitted) / np.ptp(position.measured)
    assert off < 0.004   # by the samples alone it is 0.0066
    assert not found.fits
    assert any('follows the whole run' in note for note in found.notes)
    assert found.values['axis.mass'] == pytest.approx(95.0, rel=0.02)


def test_a_slider_that_is_pushed_and_rests_from_a_start_far_off(tmp_path: Path) -> None:
    """Noise of the force must not decide when it breaks away, nor a number that is far off keep the others from it.

    The start never moves.
    """
    pushes = (0.0, 0.3, 0.6, 0.8, 1.0, 1.4, 1.7, 1.9, 2.2, 2.5, 2.7, 2.9, 3.2, 3.5, 3.7, 4.0)   # s
    forces = (0.0, 0.0, 50.0, 45.0, 0.0, 0.0, -55.0, -50.0, 0.0, 0.0, -48.0, 0.0, 0.0, 60.0, 40.0, 0.0)   # N
    axis = changed(MOTOR, {
        'friction.static.initial': 0.4, 'friction.kinetic.law': 'stribeck', 'friction.kinetic.velocities': None,
        'friction.kinetic.coefficients': None, 'friction.kinetic.end_slope': None, 'friction.kinetic.initial': 0.3,
        'friction.kinetic.limit': 0.2, 'friction.kinetic.stribeck_velocity': 0.01, 'friction.kinetic.viscous': 1.0,
        'force.course': 'table', 'force.times': pushes, 'force.forces': forces})
    samples = stickslip.simulate(axis, 4.0, 2e-3).samples
    noise = np.random.default_rng(6).normal(0.0, 0.3, len(samples['time']))
    run = as_run(tmp_path / 'run', samples['time'], {
        'position': np.round(samples['position'], 7), 'drive_force': samples['external_force'] + 2.0 + noise})
    start = changed(axis, {'axis.mass': 140.0, 'friction.static.initial': 0.6, 'friction.kinetic.initial': 0.18,
                           'friction.kinetic.limit': 0.15, 'friction.kinetic.viscous': 0.6, 'force.course': 'constant'})
    free = {'axis.mass': (50.0, 300.0), 'friction.static.initial': (0.1, 0.9), 'friction.kinetic.initial': (0.1, 0.5),
            'friction.kinetic.limit': (0.05, 0.4), 'friction.kinetic.viscous': (0.2, 3.0),
            'sensor.external_force.offset': (-20.0, 20.0)}
    found = stickslip.identify(run, start,
                               {name: between(*ends) for name, ends in free.items()})
    assert found.fits, found.misfits
    assert len(found.starts) == 1
    for name, right in (('axis.mass', 95.0), ('friction.static.initial', 0.4), ('friction.kinetic.initial', 0.3),
                        ('friction.kinetic.limit', 0.2), ('sensor.external_force.offset', 2.0)):
        assert found.values[name] == pytest.approx(right, rel=0.02), name


def test_what_is_no_run_and_no_scene_is_said_so(tmp_path: Path) -> None:
    columns = {'time': [0.0, 1.0], 'position': [0.0, 1.0]}
    with pytest.raises(InputError, match="run = 'dict' is refused: must be a run, or the path of its folder"):
        stickslip.identify(columns, RIGID, OF_FRICTION)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="scene = 'dict' is refused: must be a Scene, or the name or path of one"):
        stickslip.identify(tmp_path, {'axis.mass': 3.0}, OF_FRICTION)  # type: ignore[arg-type]


def positioned(folder: Path) -> stickslip.Run:
    """Return 15 s of a positioning axis at 1 kHz: the force acts 2 ms late and is read 3 N too low; friction varies."""
    random = np.random.default_rng(4)
    times = 1e-3 * np.arange(15_001, dtype=np.float64)
    way = 0.08 * np.sin(0.9 * times) + 0.04 * np.sin(2.3 * times)
    speed = np.gradient(way, times)
    force = 95.0 * np.gradient(speed, times) + 20.0 * np.sign(speed) + 200.0 * speed
    late = (0.0, *(times[1:] + 2e-3).tolist())
    uneven = force - 2.0 * np.sin(2.0 * np.pi * way / 0.03)   # N
    axis = changed(MOTOR, {'force.course': 'table', 'force.times': late, 'force.forces': tuple(uneven)})
    samples = stickslip.simulate(axis, 15.0, 1e-3).samples
    return as_run(folder, times, {'position': np.round(samples['position'], 6),
                                   'drive_force': force - 3.0 + random.normal(0.0, 0.1, len(times))})


@few_starts()
@pytest.mark.parametrize('static', [0.2, 0.6])   # with the second each noisy break-away is a jump
def test_an_offset_alone_under_a_measured_force(static: float, tmp_path: Path) -> None:
    start = changed(MOTOR, {'force.course': 'constant', 'friction.static.initial': static})
    found = stickslip.identify(positioned(tmp_path / 'run'), start, {
        'sensor.external_force.offset': between(-20.0, 20.0)})
    offset = found.estimates[0]
    assert not found.fits
    assert offset.value == pytest.approx(-3.0, abs=0.5)
    assert offset.standard_deviation > 1e-3      # N: as a jump has it, 1e-6
    assert offset.kind == VOID
    assert np.isnan(offset.interval).all()


def test_static_friction_without_a_break_away_is_not_identifiable(tmp_path: Path) -> None:
    """It moves at the start, and only turns: nothing rests."""
    axis = changed(MOTOR, {'initial.velocity': 0.1, 'force.amplitude': 80.0})
    samples = stickslip.simulate(axis, 3.0).samples
    noise = np.random.default_rng(2).normal(0.0, 0.3, len(samples['time']))
    run = as_run(tmp_path / 'run', samples['time'], {
        'position': np.round(samples['position'], 6), 'drive_force': samples['external_force'] + noise})
    start = changed(axis, {'axis.mass': 120.0, 'initial.velocity': 0.0, 'force.course': 'constant'})
    found = stickslip.identify(run, start, {
        'axis.mass': between(50.0, 200.0), 'friction.static.initial': between(0.05, 0.9)})
    static = estimate_of(found, 'friction.static.initial')
    assert static.kind == NOT_IDENTIFIABLE
    assert static.value == static.start
    assert static.interval == (0.05, 0.9)
    assert static.profile is not None
    assert static.profile[0] <= 0.2 < static.profile[1]   # with more it would rest where it turned
    assert found.values['axis.mass'] == pytest.approx(95.0, rel=0.02)


def test_a_drive_that_was_measured_by_its_encoder(tmp_path: Path) -> None:
    """Its feed is not known otherwise; what the steps of the encoder leave open of it is in the intervals."""
    samples = stickslip.simulate(RIGID, 6.0, 1e-3).samples
    random = np.random.default_rng(5)
    run = as_run(tmp_path / 'run', samples['time'], {
        'position': np.round(samples['position'], 6), 'drive_position': np.round(samples['drive_position'], 6),
        'drive_force': samples['drive_force'] + random.normal(0.0, 2.0, len(samples['time']))})
    start = changed(RIGID, {**OFF, 'drive.course': 'constant', 'drive.velocity': 0.0})
    found = stickslip.identify(run, start, {
        **OF_FRICTION, 'axis.drive_stiffness': between(2.5e5, 1.5e6)})
    check(found, RIGID, 0.005)
    assert found.notes == ('the drive moves as it was measured',)
    assert found.runs < 10_000


# Inputs that were measured stand in the scene that was found, so that it runs as the axis did.

OFFSET = -3.0   # N, of the sensor


def measured(folder: Path, begin: float = 0.0) -> MeasuredRun:
    samples = stickslip.simulate(MOTOR, begin + 2.0, 1e-3).samples
    part = samples['time'] >= begin - 1e-9
    noise = np.random.default_rng(2).normal(0.0, 0.1, int(part.sum()))
    return as_run(folder, samples['time'][part] - samples['time'][part][0], {
        'position': np.round(samples['position'][part], 6) + 0.2,
        'external_force': samples['external_force'][part] + noise + OFFSET})


START = changed(MOTOR, {'axis.mass': 120.0, 'friction.static.initial': 0.3, 'friction.kinetic.coefficients': (0.25,),
                        'force.course': 'constant'})
FREE = {'axis.mass': between(50.0, 200.0), 'friction.kinetic.coefficients[0]': between(0.05, 0.4),
        'friction.static.initial': between(0.05, 0.5), 'sensor.external_force.offset': between(-10.0, 10.0)}


@pytest.mark.usefixtures('blank_pictures')
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


@pytest.mark.usefixtures('blank_pictures')
def test_numbers_of_sensors_alone(tmp_path: Path) -> None:
    """The offset of a force where all else is known; no number of the scene is left open."""
    run = measured(tmp_path / 'run')
    found = stickslip.identify(run, changed(MOTOR, {'force.course': 'constant'}), {
        'sensor.external_force.offset': between(-10.0, 10.0)})
    assert found.values['sensor.external_force.offset'] == pytest.approx(OFFSET, abs=0.1)
    write_results(run, found, 'start.yaml', tmp_path)
    assert (tmp_path / 'posterior.yaml').read_text().endswith('parameters:\n')
