# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs that were cut out of a longer one, and begin within a cycle."""

from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.scene import changed
from tests.support.measured_runs import OF_DRIVE, OF_FRICTION, OFF, as_run, between, estimate_of, few_starts, truth

OF_ALL = {'drive.velocity': 0.003, 'friction.acceleration_dependence': False}
SLIDER = stickslip.load_scene('paper_fig7', OF_ALL)

FREE = 'friction.static.limit', 'axis.drive_stiffness'


def cut(folder: Path, begin: float, end: float, force: bool, zero: float = 0.0) -> stickslip.Run:
    """Return what sensors show of a part of a run, whose clock and encoder begin anew there."""
    samples = stickslip.simulate(SLIDER, end, 2e-3).samples
    part = samples['time'] >= begin - 1e-9
    x, drive_force = samples['position'][part], samples['drive_force'][part]
    columns = {'position': np.round((x - x[0] + zero) * 1e6) * 1e-6}
    if force:
        noise = np.random.default_rng(3).normal(0.0, 0.01 * np.abs(drive_force).max(), len(x))
        columns['drive_force'] = drive_force + noise
    return as_run(folder, samples['time'][part] - samples['time'][part][0], columns)


def test_a_run_that_begins_shortly_before_a_break_away(tmp_path: Path) -> None:
    """From the position alone: the spring cannot have been slack."""
    samples = stickslip.simulate(SLIDER, 4.0, 1e-3).samples
    slips = np.flatnonzero((samples['velocity'][1:] > 0.0) & (samples['velocity'][:-1] == 0.0))
    begin = float(samples['time'][slips[4]]) - 0.05
    run = cut(tmp_path / 'run', begin, begin + 3.0, False)
    start = stickslip.load_scene('paper_fig7', {**OF_ALL, 'friction.static.limit': 0.3})
    found = stickslip.identify(run, start, {'friction.static.limit': between(0.1, 0.5)})
    assert any('within a cycle' in note for note in found.notes)
    assert found.fits, found.misfits
    assert found.values['friction.static.limit'] == pytest.approx(0.24, rel=0.01)
    assert found.values['initial.stretch'] > 1e-4


def test_without_a_force_the_stretch_at_the_start_is_named(tmp_path: Path) -> None:
    run = cut(tmp_path / 'run', 0.0, 4.0, False)
    found = stickslip.identify(run, SLIDER, {'friction.static.limit': between(0.1, 0.5)})
    assert [note for note in found.notes if 'begins stretched by 0 m' in note]
    assert found.values['friction.static.limit'] == pytest.approx(0.24, rel=0.01)


def test_a_compliant_contact_that_yields_from_the_first_sample_on(tmp_path: Path) -> None:
    """Without noise: where the run starts is one reading, and not the mean of ten in which the slider moves."""
    axis = stickslip.load_scene('paper_fig8', {'drive.velocity': 0.003})
    samples = stickslip.simulate(axis, 3.0, 0.004).samples
    run = as_run(tmp_path / 'run', samples['time'], {name: samples[name] for name in ('position', 'drive_force')})
    found = stickslip.identify(run, changed(axis, {'friction.static.limit': 0.3}),
                               {'friction.static.limit': between(0.1, 0.5)})
    assert found.fits, found.misfits
    assert found.scene.initial.position == 0.0
    assert found.values['friction.static.limit'] == pytest.approx(0.24, rel=1e-6)


def test_an_encoder_that_counts_from_elsewhere_is_not_taken_at_its_word(tmp_path: Path) -> None:
    """One reading with noise of 5 µm is no start for all others."""
    samples = stickslip.simulate(SLIDER, 4.0, 1e-3).samples
    noise = np.random.default_rng(8).normal(0.0, 5e-6, len(samples['time']))
    run = as_run(tmp_path / 'run', samples['time'], {'position': samples['position'] + 0.02 + noise})
    found = stickslip.identify(run, changed(SLIDER, {'friction.static.limit': 0.3}),
                               {'friction.static.limit': between(0.1, 0.5)})
    assert found.fits, found.misfits
    assert found.values['initial.position'] == pytest.approx(0.02, abs=1e-6)
    assert abs(noise[0]) > 1e-6


@few_starts()
def test_a_stretch_stays_with_the_measured_force_where_the_model_is_wrong(tmp_path: Path) -> None:
    """The load on the slideway varies by 12 %, which no scene here knows."""
    random = np.random.default_rng(5)
    times = np.arange(0.0, 9.0, 0.35).tolist()
    axis = stickslip.load_scene('paper_fig7', {
        'drive.velocity': 0.003, 'normal_load.course': 'steps', 'normal_load.times': tuple(times),
        'normal_load.forces': tuple(random.normal(0.0, 412.0, len(times)).tolist())})
    samples = stickslip.simulate(axis, 4.1, 2e-3).samples
    part = samples['time'] >= 2.1 - 1e-9
    force, x = samples['drive_force'][part], samples['position'][part]
    run = as_run(tmp_path / 'run', samples['time'][part] - 2.1, {
        'position': np.round((x - x[0]) * 1e6) * 1e-6, 'drive_force': force + random.normal(0.0, 3.0, len(x))})
    found = stickslip.identify(run,
                               stickslip.load_scene('paper_fig7', {'drive.velocity': 0.003, **OFF}),
                               {name: {**OF_FRICTION, **OF_DRIVE}[name] for name in FREE})
    assert not found.fits
    stiffness, damping = (truth(found.scene, f'axis.drive_{name}') for name in ('stiffness', 'damping'))
    begins = stiffness * found.values['initial.stretch'] + damping * 0.003
    assert begins == pytest.approx(force[0], abs=0.01 * float(np.ptp(force)))


@few_starts()
def test_a_run_that_begins_in_a_slip_is_not_at_a_bound(tmp_path: Path) -> None:
    samples = stickslip.simulate(SLIDER, 4.0, 1e-3).samples
    begin = float(samples['time'][int(samples['velocity'][:3000].argmax())]) - 0.02
    run = cut(tmp_path / 'run', begin, begin + 5.0, True)
    found = stickslip.identify(run, changed(SLIDER, {'friction.kinetic.coefficients': (0.12, 0.085)}), {
        'friction.static.limit': between(0.12, 0.5)})   # kinetic friction is not that of the axis
    velocity = estimate_of(found, 'initial.velocity')
    assert not found.fits
    assert velocity.low < 0.0 < velocity.high
    assert velocity.kind != 'at a bound'
