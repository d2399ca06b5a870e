# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes held against runs that they were not identified from: sensors found, the physics kept, a wrong one shown."""

import json
from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.errors import InputError
from stickslip_sim.identification.identified import Prediction, fit_percent
from stickslip_sim.identification.prediction import KnownSensors, predicted
from stickslip_sim.scene import Scene, changed, scene_from_values
from tests.support.measured_runs import (
    ENCODER,
    MOTOR,
    VALUES,
    as_run,
    between,
    free_file,
    readings,
    start_scene,
)
from tests.support.tool import Capture, answered, refused

pytestmark = pytest.mark.usefixtures('blank_pictures')
TRUTH = scene_from_values(VALUES)
FINE = 20_000.0   # Hz


def sensed(scene: Scene, duration: float, rate: float, delays: tuple[float, float], offsets: tuple[float, float]
           ) -> tuple[Numbers, dict[str, Numbers]]:
    """Return what late sensors show of a scene: the encoder and the force by their delays (s) and offsets."""
    samples = stickslip.simulate(scene, duration, 1.0 / FINE).samples
    times: Numbers = np.arange(0.0, duration - 0.01, 1.0 / rate, dtype=np.float64)
    place, force = (np.interp(times - late, samples['time'], samples[name]) + off
                    for name, late, off in zip(('position', 'drive_force'), delays, offsets))
    noise = np.random.default_rng(2).standard_normal(len(times))
    return times, {'position': ENCODER * np.round(place / ENCODER), 'drive_force': force + noise}


def channel(prediction: Prediction, name: str = 'position') -> float:
    return next(one.rmse for one in prediction.channels if one.name == name)


@pytest.mark.parametrize('rate', [333.0, 2000.0])
def test_offset_and_delay_of_a_fraction_of_a_sample_are_found(tmp_path: Path, rate: float) -> None:
    times, columns = sensed(TRUTH, 2.5, rate, (0.3 / rate, 1.4 / rate), (0.25, 12.0))
    found = stickslip.predict(TRUTH, as_run(tmp_path / 'late', times, columns))
    late = found.values['sensor.drive_force.delay'] - found.values['sensor.position.delay']
    assert late == pytest.approx(1.1 / rate, abs=9e-5)   # a delay of both is a spring that begins stretched
    assert found.values['sensor.position.offset'] == pytest.approx(0.25, abs=1e-6)
    assert found.values['sensor.drive_force.offset'] == pytest.approx(12.0, abs=0.2)
    assert channel(found) < 1.25 * ENCODER / 12**0.5
    assert channel(found, 'drive_force') < 1.1
    assert found.stretch_fit > 99.5


def test_a_run_without_force_that_begins_anywhere_in_a_cycle_has_its_stretch_found(tmp_path: Path) -> None:
    times, columns = sensed(TRUTH, 3.5, 500.0, (0.0, 0.0), (0.25, 0.0))
    late = slice(617, None)
    run = as_run(tmp_path / 'part', times[late] - times[617], {'position': columns['position'][late]})
    assert channel(stickslip.predict(TRUTH, run)) < 1.1 * ENCODER / 12**0.5


def test_a_gap_costs_nothing(tmp_path: Path) -> None:
    times, columns = sensed(TRUTH, 2.5, 500.0, (0.0, 0.0), (0.0, 0.0))
    columns['drive_force'][900:950] = np.nan
    keep = (times < 0.7) | (times > 1.1)
    found = stickslip.predict(TRUTH, as_run(tmp_path / 'gap', times[keep], {
        name: values[keep] for name, values in columns.items()}))
    assert channel(found) < 1.1 * ENCODER / 12**0.5
    assert '50 of 1044 readings are left out: one of their numbers is missing' in found.notes


def test_the_run_of_another_axis_is_a_bad_fit(tmp_path: Path) -> None:
    run = readings({**VALUES, 'axis.mass': 50.0, 'friction.static.initial': 0.25}).as_run(tmp_path / 'other')
    found = stickslip.predict(TRUTH, run)
    assert channel(found) > 100.0 * ENCODER
    assert found.stretch_fit < 30.0   # the position by itself follows the drive, whatever the friction is


def test_identified_predicts_as_well_as_the_truth(tmp_path: Path) -> None:
    """On a run of another feed, rate and duration, which the identification holds its scene against itself."""
    fitted = readings().as_run(tmp_path / 'fitted')
    samples = stickslip.simulate(changed(TRUTH, {'drive.velocity': 0.005}), 3.0, 1.0 / 700.0).samples
    noise = np.random.default_rng(5).standard_normal((2, len(samples['time'])))
    other = as_run(tmp_path / 'other', samples['time'], {
        'position': ENCODER * np.round(samples['position'] / ENCODER),
        'drive_force': samples['drive_force'] + noise[0],
        'drive_velocity': samples['drive_velocity'] + 1e-5 * noise[1]})
    free = {name: between(low, high) for name, (low, high) in (
        ('axis.drive_stiffness', (1e5, 4e5)), ('friction.static.initial', (0.15, 0.3)),
        ('friction.kinetic.coefficients[0]', (0.08, 0.15)))}
    identified = stickslip.identify(fitted, start_scene(), free, test=[other])
    (found,), own = identified.predictions, stickslip.predict(TRUTH, other)
    for name in ('position', 'drive_force'):
        assert channel(found, name) < 1.05 * channel(own, name), name
    with pytest.raises(InputError, match='another run than fitted: its readings are the same'):
        stickslip.identify(fitted, start_scene(), free, test=[fitted])


def test_a_pushed_axis_has_offset_and_delay_of_its_force_found(tmp_path: Path) -> None:
    samples = stickslip.simulate(MOTOR, 4.0, 1e-4).samples
    times: Numbers = np.arange(0.0, 3.9, 1e-3, dtype=np.float64)
    force = np.interp(times + 7e-4, samples['time'], samples['external_force']) + 3.0
    place = np.interp(times, samples['time'], samples['position'])
    run = as_run(tmp_path / 'pushed', times, {'position': ENCODER * np.round(place / ENCODER), 'drive_force': force})
    found = stickslip.predict(MOTOR, run)
    assert found.values['sensor.external_force.delay'] == pytest.approx(7e-4, abs=5e-5)
    assert found.values['sensor.external_force.offset'] == pytest.approx(3.0, abs=0.02)
    assert found.channels[0].fit_percent > 99.9
    for late, least, most in ((7e-4, 99.9, 100.0), (6e-3, 0.0, 99.9)):   # one that is known stays, right or wrong
        known = predicted(MOTOR, 'pushed', KnownSensors({'sensor.external_force.delay': late}, ()), run)
        assert [one.name for one in known.found] == ['sensor.position.offset', 'sensor.external_force.offset']
        assert least < known.channels[0].fit_percent <= most
    with pytest.raises(InputError, match='measured with its external_force or drive_force: nothing else moves'):
        stickslip.predict(MOTOR, as_run(tmp_path / 'unmeasured', times, {'position': place}))


def test_the_fit_of_a_constant_channel_is_undefined(tmp_path: Path, capsys: Capture) -> None:
    assert np.isnan(fit_percent(np.full(5, 3.1), np.ones(5)))
    assert fit_percent(np.array([0.0, 1.0]), np.zeros(2)) == 100.0
    measured = readings(duration=2.0)
    as_run(tmp_path / 'dead', measured.times, {**measured.columns, 'drive_force': np.full(len(measured.times), 2.0)})
    scene, out = tmp_path / 'truth.yaml', tmp_path / 'out'
    scene.write_text(TRUTH.text, encoding='utf-8')
    code, said, _ = answered(capsys, 'predict', scene, tmp_path / 'dead', '--out', out)
    assert code == 0
    assert 'drive_force is constant: its fit in % is undefined' in said
    (values,) = json.loads((out / 'report.json').read_text())['predictions']
    by_name = {one['name']: one for one in values['channels']}
    assert by_name['drive_force']['fit_percent'] is None
    assert by_name['position']['fit_percent'] > 99.9
    assert 'stretch of the spring' in (out / 'report.html').read_text()
    assert (out / 'dead.svg').is_file()

    assert 'another run than dead: its readings are the same; give it once' in refused(
        capsys, 'predict', scene, tmp_path / 'dead', tmp_path / 'dead')
    assert 'no such run' in refused(capsys, 'predict', scene, tmp_path / 'none')


def test_the_tool_predicts_beside_the_identification(tmp_path: Path, capsys: Capture) -> None:
    readings().as_run(tmp_path / 'one')
    readings(duration=3.0, seed=7).as_run(tmp_path / 'two')
    start, out = tmp_path / 'start.yaml', tmp_path / 'found'
    start.write_text(start_scene().text, encoding='utf-8')
    code, said, _ = answered(capsys, 'identify', tmp_path / 'one', '--scene', start, '--free',
                             free_file(tmp_path / 'free.yaml'), '--test', tmp_path / 'two', '--out', out)
    assert code == 0
    assert 'measured_axis predicts two:' in said
    assert 'the drive is that of the scene: two measured none' in said
    (values,) = json.loads((out / 'report.json').read_text())['predictions']
    assert values['channels'][0]['fit_percent'] > 99.9
    assert 'measured_axis predicts two' in (out / 'report.html').read_text()
