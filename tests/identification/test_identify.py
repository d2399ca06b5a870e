# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes found again from what sensors measured of them, from starts up to 40 % off; and what is refused."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.identification.certainty import misfits_of
from stickslip_sim.identification.free_parameters import free_parameters
from stickslip_sim.identification.identified import AT_BOUND, NOT_IDENTIFIABLE, VOID, Identification
from stickslip_sim.identification.identified_scene import interval_words
from stickslip_sim.identification.readings import readings_of
from stickslip_sim.identification.report import result_lines
from stickslip_sim.scene import changed
from tests.support.measured_runs import (
    COMPLIANT,
    DRIVE_OFF,
    OF_DRIVE,
    OF_FRICTION,
    OFF,
    RIGID,
    between,
    check,
    few_starts,
    measure,
    truth,
)

pytestmark = pytest.mark.slow

@pytest.fixture(scope='module')
def rigid(tmp_path_factory: pytest.TempPathFactory) -> stickslip.Run:
    return measure(tmp_path_factory.mktemp('runs') / 'rigid', RIGID, 6.0)


def test_a_rigid_axis_from_position_and_force(rigid: stickslip.Run) -> None:
    found = stickslip.identify(rigid, changed(RIGID, {**OFF, **DRIVE_OFF}), {**OF_FRICTION, **OF_DRIVE})
    check(found, RIGID, 0.01)
    assert found.criterion == 'BIC'
    assert [(law.static, law.n_parameters, law.is_chosen) for law in found.laws] == [('exponential', 6, True)]
    assert found.n_residuals == 2 * 6001
    assert all('whole run' in estimate.derivation for estimate in found.estimates)
    assert all(estimate.profile is None for estimate in found.estimates)   # the covariance says the same
    assert [channel.name for channel in found.channels] == ['position', 'drive_force']
    assert all(channel.correlation_time < 1e-3 for channel in found.channels)
    assert not found.notes
    assert len(found.slips) >= 10
    assert max(abs(slip.fitted_time - slip.time) for slip in found.slips) < 1e-3
    for slip in found.slips:
        assert slip.fitted_break_away_force == pytest.approx(slip.break_away_force, rel=0.05)
        assert slip.fitted_stick_time == pytest.approx(slip.stick_time, rel=0.05)


def test_static_friction_that_begins_at_kinetic_friction(tmp_path: Path) -> None:
    """Where the one is not below the other the fit must go along the border, and a start above it must come back."""
    axis = changed(RIGID, {'friction.static.initial': 0.11, 'friction.static.limit': 0.29,
                           'friction.static.time_constant': 0.31, 'friction.kinetic.coefficients': (0.11, 0.06)})
    run = measure(tmp_path / 'run', axis, 5.0, rate=500.0)
    found = stickslip.identify(run, RIGID, {
        'friction.static.initial': between(0.05, 0.2), 'friction.kinetic.coefficients[0]': between(0.05, 0.2),
        **OF_FRICTION, 'friction.static.time_constant': between(0.05, 1.0)})
    check(found, axis, 0.01)
    assert not found.notes


def test_a_compliant_axis_from_its_position_alone(tmp_path: Path) -> None:
    run = measure(tmp_path / 'run', COMPLIANT, 6.0, force=False, gap=(3.0, 3.05))
    start = changed(COMPLIANT, {**OFF, 'axis.mass': 450.0, 'contact.stiffness': 4e6, 'contact.damping': 2e4})
    free = {**OF_FRICTION, 'axis.mass': between(150.0, 900.0), 'contact.stiffness': between(1e6, 2e7),
            'contact.damping': between(2e3, 1e5)}
    check(stickslip.identify(run, start, free), COMPLIANT, 0.02)


def test_without_a_force_only_ratios(tmp_path: Path) -> None:
    """Mass, spring, damper and normal force all larger by one factor: the same motion."""
    run = measure(tmp_path / 'run', RIGID, 4.0, force=False, rate=500.0)
    found = stickslip.identify(run, RIGID, {**OF_DRIVE, 'axis.normal_force': between(2000.0, 5000.0)})
    (together,) = found.combinations
    assert set(together.names) == {*OF_DRIVE, 'axis.normal_force'}
    assert all(weight == pytest.approx(1.0, abs=0.05) for weight in together.weights)
    assert 'ratios' in together.statement
    assert {estimate.kind for estimate in found.estimates} == {NOT_IDENTIFIABLE}
    mass = found.estimates[0]
    of_normal_force = (350.0 * 2000.0 / RIGID.axis.normal_force, 350.0 * 5000.0 / RIGID.axis.normal_force)
    assert mass.interval == (150.0, 900.0)
    assert mass.profile == pytest.approx(of_normal_force, rel=0.03)


def test_an_interval_of_a_lopsided_likelihood(tmp_path: Path) -> None:
    """Static friction is at its limit after every rest: the time constant is short, and nothing says how short."""
    run = measure(tmp_path / 'run', changed(RIGID, {'friction.static.time_constant': 0.01}), 4.0)
    found = stickslip.identify(run, changed(RIGID, {'friction.static.time_constant': 0.02}), {
        'friction.static.limit': between(0.1, 0.5), 'friction.static.time_constant': between(1e-3, 0.6)})
    time_constant = found.estimates[1]
    assert time_constant.profile is not None
    assert time_constant.profile[0] == pytest.approx(1e-3)
    assert 0.01 < time_constant.profile[1] < 0.04
    assert time_constant.interval[0] > 0.01   # the covariance excludes the truth
    assert time_constant.best_interval == time_constant.profile


def test_a_sensor_that_is_off(tmp_path: Path) -> None:
    run = measure(tmp_path / 'run', RIGID, 4.0, change={'drive_force': 0.25})
    free = {**OF_FRICTION, 'sensor.drive_force.scale': between(0.1, 10.0),
            'sensor.drive_force.offset': between(-50.0, 50.0)}
    found = stickslip.identify(run, changed(RIGID, OFF), free)
    values = found.values
    assert values['sensor.drive_force.scale'] == pytest.approx(0.25, rel=0.01)
    assert values['sensor.drive_force.offset'] == pytest.approx(0.0, abs=1.0)
    assert values['friction.static.limit'] == pytest.approx(0.24, rel=0.01)
    assert found.fits


@few_starts()
def test_a_model_that_does_not_fit_is_rejected(tmp_path: Path) -> None:
    """Without the excess of the accelerating branch no parameters make this motion."""
    run = measure(tmp_path / 'run', RIGID, 2.0, rate=500.0)
    start = changed(RIGID, {'friction.acceleration_dependence': False})
    found = stickslip.identify(run, start, OF_FRICTION)
    assert not found.fits
    assert {estimate.kind for estimate in found.estimates} <= {VOID, AT_BOUND, NOT_IDENTIFIABLE}
    assert {interval_words(estimate) for estimate in found.estimates if estimate.kind == VOID} == {'void'}
    assert {misfit.test for misfit in found.misfits} >= {'mean square', 'mean square of a stretch'}
    assert 'single slips' in found.notes[-1]
    assert all('single slips' in estimate.derivation for estimate in found.estimates)
    assert all(misfit.statistic > misfit.limit for misfit in found.misfits)
    assert all(0.0 <= misfit.from_time < misfit.to_time <= 2.0 for misfit in found.misfits)
    assert all('off by' in misfit.statement or 'autocorrelated' in misfit.statement for misfit in found.misfits)


KATO = changed(RIGID, {'friction.static.law': 'kato', 'friction.static.limit': 0.24,
                       'friction.static.time_constant': 0.2, 'friction.static.exponent': 0.5})


def criteria(found: Identification) -> dict[str, float]:
    return {law.static: law.criterion for law in found.laws}


@few_starts()
def test_the_law_that_made_the_run_is_preferred(tmp_path: Path) -> None:
    """Growth by Kato's law, fitted with the exponential law: no numbers of it make this motion, those of Kato's do."""
    run = measure(tmp_path / 'run', KATO, 3.0, rate=500.0)
    found = stickslip.identify(run, changed(RIGID, OFF), OF_FRICTION, laws=True)
    best, *others = sorted(found.laws, key=lambda law: law.criterion)
    assert (best.static, best.kinetic, best.n_parameters, best.is_chosen) == ('kato', 'table', 4, False)
    assert best.cost < 2.0 * found.n_residuals
    assert {law.static for law in others} == {'exponential', 'constant', 'hyperbolic', 'logarithmic'}
    assert min(law.criterion for law in others) > best.criterion + 500.0
    assert [law.static for law in found.laws if law.is_chosen] == ['exponential']
    said = '\n'.join(result_lines(found, 'run'))
    assert 'better laws: kato with table, BIC ' in said
    assert 'below exponential with table' in said


def test_a_law_is_not_preferred_for_a_number_more(tmp_path: Path) -> None:
    """Kato's law with the exponent 1 is the exponential law: it fits as well, and has a parameter more."""
    run = measure(tmp_path / 'run', RIGID, 3.0, rate=500.0)
    found = stickslip.identify(run, changed(RIGID, OFF), OF_FRICTION, laws=True)
    found_by = criteria(found)
    assert 0.0 < found_by['kato'] - found_by['exponential'] < 12.0
    assert min(found_by, key=found_by.__getitem__) == 'exponential'
    said = '\n'.join(result_lines(found, 'run'))
    assert 'none of 4 other laws is better by more than 10 of BIC than exponential with table' in said


@few_starts()
def test_kinetic_laws_are_compared_where_one_is_fitted(tmp_path: Path) -> None:
    smooth = changed(RIGID, {'friction.kinetic.law': 'exponential', 'friction.kinetic.initial': 0.12,
                             'friction.kinetic.limit': 0.05, 'friction.kinetic.stribeck_velocity': 0.02,
                             'friction.kinetic.viscous': 0.2})
    run = measure(tmp_path / 'run', smooth, 2.0, rate=500.0)
    start = changed(smooth, {'friction.kinetic.law': 'stribeck', 'friction.kinetic.initial': 0.12,
                             'friction.kinetic.limit': 0.055, 'friction.kinetic.stribeck_velocity': 0.025,
                             'friction.kinetic.viscous': 0.2})
    found = stickslip.identify(run, start, {
        'friction.kinetic.limit': between(0.02, 0.09), 'friction.kinetic.stribeck_velocity': between(0.005, 0.08)},
        laws=True)
    by = {law.kinetic: law.criterion for law in found.laws}
    assert set(by) == {'stribeck', 'exponential', 'hyperbolic'}
    assert {law.static for law in found.laws} == {'exponential'}
    assert min(by, key=by.__getitem__) == 'exponential'


@few_starts()
def test_a_range_that_ends_before_the_truth(rigid: stickslip.Run) -> None:
    found = stickslip.identify(rigid, changed(RIGID, {'axis.mass': 300.0}), {'axis.mass': between(200.0, 340.0)})
    assert found.estimates[0].kind == AT_BOUND
    assert found.estimates[0].value == 340.0
    assert not found.fits


Refused = Callable[[], Identification]


def test_what_is_refused(rigid: stickslip.Run, tmp_path: Path) -> None:
    mass = {'axis.mass': between(200.0, 500.0)}
    identify = partial(stickslip.identify, rigid)
    cases: list[tuple[str, Refused]] = [
        ("parameters = 'list' is refused: must be the path of a file, or names with their distributions",
         lambda: identify(RIGID, ['axis.mass'])),    # type: ignore[arg-type]
        ("free parameter = 'friction.kinetic.velocities\\[0\\]' is refused",
         lambda: identify(RIGID, {'friction.kinetic.velocities[0]': between(0.0, 1.0)})),
        ("free parameter = 'sensor.speed.scale' is refused",
         lambda: identify(RIGID, {'sensor.speed.scale': between(0.5, 2.0)})),
        ('check its unit, or free sensor.drive_force.scale', lambda: stickslip.identify(
            measure(tmp_path / 'kn', RIGID, 2.0, change={'drive_force': 1e-3}), RIGID, mass)),
        ('resolution = .velocity. is refused', lambda: identify(RIGID, mass, resolutions={'velocity': 1e-3})),
    ]
    for text, refused in cases:
        with pytest.raises(stickslip.InputError, match=text):
            refused()


def test_too_few_samples(tmp_path: Path) -> None:
    run = measure(tmp_path / 'run', RIGID, 1.0, rate=25.0, force=False)
    with pytest.raises(stickslip.InputError, match='5 or more for each of the 6 free parameters'):
        stickslip.identify(run, RIGID, {**OF_DRIVE, **OF_FRICTION})


@pytest.mark.parametrize(('start', 'found_scene'), [
    ('paper_fig7', {'axis.normal_force': 3000.0, 'friction.static.limit': 0.26}),
    ('paper_fig8', {'axis.normal_force': 3000.0, 'friction.static.limit': 0.26})])
def test_a_right_model_without_noise_is_not_rejected(start: str, found_scene: dict[str, float]) -> None:
    """What is left is rounding of 1e-14 m, which goes together from sample to sample."""
    axis = stickslip.load_scene(start, found_scene)
    found = stickslip.identify(stickslip.simulate(axis, 6.0), start, {
        'axis.normal_force': between(1000.0, 10000.0), 'friction.static.limit': between(0.1, 0.6)})
    assert found.fits, found.misfits
    for estimate in found.estimates:
        assert estimate.value == pytest.approx(truth(axis, estimate.name), rel=1e-6)
        assert estimate.interval[0] < estimate.interval[1]
        assert ' ± ' in interval_words(estimate)   # and not "3 kN to 3 kN"


def test_a_small_misfit_rejects_where_it_matters(rigid: stickslip.Run) -> None:
    """A part of residuals that goes together counts beside the noise: below it, it rejects nothing."""
    (channel, _) = readings_of(rigid, RIGID, {}).channels
    noise = np.random.default_rng(0).normal(0.0, channel.resolution, len(channel.values))
    channel = replace(channel, quantum=0.0, values=0.1 * channel.values)
    times = 1e-3 * np.arange(len(noise), dtype=np.float64)
    slow = np.sin(2.0 * np.pi * times)
    for size, rejected in ((0.0, False), (0.3, False), (1.0, True)):
        residuals = (noise + size * channel.resolution * slow) / np.hypot(1.0, size / 2.0**0.5)
        assert bool(misfits_of(channel, residuals, residuals, times, ())) is rejected, size
    wide = replace(channel, values=1e6 * channel.values)   # the same misfit, of a motion a million times as large
    assert not misfits_of(wide, residuals, residuals, times, ())


def test_a_run_that_starts_elsewhere(tmp_path: Path) -> None:
    """The encoder counts from somewhere, and the spring is stretched already."""
    there = changed(RIGID, {'initial.position': 0.05, 'initial.stretch': 4e-4})
    run = measure(tmp_path / 'run', there, 1.5, rate=500.0)
    found = stickslip.identify(run, changed(RIGID, {'friction.static.limit': 0.3}),
                               {'friction.static.limit': between(0.1, 0.5)})
    assert found.fits, found.misfits
    assert found.values['initial.stretch'] == pytest.approx(4e-4, rel=0.01)
    assert found.values['friction.static.limit'] == pytest.approx(0.24, rel=0.01)
    assert found.scene.initial.position == pytest.approx(0.05, abs=1e-6)
    assert 'initial.rest_time' in found.values
    for words in ('the run starts at 0.05 m', 'initial.stretch is free, too', 'initial.rest_time is free, too'):
        assert any(words in note for note in found.notes), words


@few_starts()
def test_a_misfit_is_said_once_for_each_channel(rigid: stickslip.Run) -> None:
    found = stickslip.identify(rigid, changed(RIGID, {'axis.mass': 300.0}), {
        'friction.static.limit': between(0.1, 0.5)})
    assert {misfit.channel for misfit in found.misfits} == {'position', 'drive_force'}
    assert len(found.misfits) > 4
    lines = list(result_lines(found, 'run'))
    said = lines[lines.index('THE MODEL DOES NOT FIT this run:') + 1:]
    assert [line.split()[0] for line in said] == ['position', 'drive_force', 'and']
    assert '(rms)' in said[0]
    assert '% of its range' in said[0]


def test_more_parameters_than_a_study_takes() -> None:
    """Those of friction, drive and start, and offsets and scales of the sensors."""
    free = {**OF_FRICTION, **OF_DRIVE, 'friction.kinetic.coefficients[0]': between(0.05, 0.12),
            'friction.static.initial': between(0.05, 0.2), 'sensor.drive_force.offset': between(-50.0, 50.0),
            'sensor.drive_force.scale': between(0.9, 1.1), 'sensor.position.offset': between(-1e-3, 1e-3)}
    assert [one.name for one in free_parameters(RIGID, free)] == list(free)
    assert len(free) == 11
