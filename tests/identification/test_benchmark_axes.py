# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""benchmarks/identify: the axes are what its page says of them, and so is the foreign one."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks.identify.axes import FARTHEST, FREE, NEAREST, SyntheticAxis, axes, value_of
from benchmarks.identify.figures import not_right, of_every_kind
from benchmarks.identify.foreign import LuGreAxis
from benchmarks.identify.measuring import OTHERS, Sensors, measure
from benchmarks.identify.outcomes import Outcome, ParameterOutcome, load, models_of, outcome_of, save
from benchmarks.identify.varied import FEEDS, SENSORS, kind_of, varied_axes
from stickslip_sim.identification.identified import FOUND, NOT_IDENTIFIABLE
from stickslip_sim.inputs.measurement import Measurement
from stickslip_sim.runs import simulate
from stickslip_sim.study.uncertainty import uncertain_of

FEW = 8


@pytest.fixture(scope='module')
def few() -> list[SyntheticAxis]:
    return axes(FEW, seed=3)


def test_axes_come_from_the_seed_alone(few: list[SyntheticAxis]) -> None:
    assert [axis.truth.values for axis in axes(FEW, seed=3)] == [axis.truth.values for axis in few]
    assert axes(1, seed=4)[0].truth.values != few[0].truth.values


def test_forty_axes_have_each_model_once() -> None:
    assert len({models_of(axis) for axis in axes(40)}) == 40


@pytest.mark.parametrize('k', range(FEW))
def test_starts_are_off_as_far_as_stated_and_the_truth_is_in_range(few: list[SyntheticAxis], k: int) -> None:
    axis = few[k]
    assert FREE[0] <= len(axis.free) <= FREE[1]
    for free in uncertain_of(axis.free_file()).distributions:
        true, start = value_of(axis.truth, free.name), value_of(axis.start, free.name)
        assert NEAREST - 1e-9 <= abs(start / true - 1.0) <= FARTHEST + 1e-9
        assert free.low < true < free.high
    fixed = {name for name in axis.truth.values if name not in {name.partition('[')[0] for name in axis.free}}
    assert all(axis.start.values[name] == axis.truth.values[name] for name in fixed)


def test_sensors_count_in_steps_and_have_noise(tmp_path: Path, few: list[SyntheticAxis]) -> None:
    truth = few[0].truth
    shown = measure(truth, 2.0, np.random.default_rng(0), Sensors(rate=500.0))
    true = simulate(truth, 2.0, 0.002).samples
    assert np.abs(shown.columns['position'] - true['position']).max() <= 0.5e-6 * (1.0 + 1e-9)
    noise = shown.columns['drive_force'] - true['drive_force']
    assert noise.std() / np.sqrt(np.mean(true['drive_force']**2)) == pytest.approx(0.01, rel=0.1)
    shown.write_csv(tmp_path / 'axis.csv')
    names = {name: name for name in ('time', 'position', 'drive_force')}
    read = Measurement.from_file(tmp_path / 'axis.csv', names, {})
    assert (read.times == shown.times).all()
    assert all((read.columns[name] == shown.columns[name]).all() for name in shown.columns)


@pytest.mark.slow
@pytest.mark.parametrize('words', ['without noise', '1 µm of noise'])
def test_right_models_are_not_rejected_and_what_is_found_is_near(few: list[SyntheticAxis], words: str) -> None:
    outcome = outcome_of(few[4]._replace(sensors=OTHERS[words]))
    assert outcome.fits
    assert all(each.is_found for each in outcome.parameters if each.kind == FOUND), outcome.parameters


def test_axes_of_every_kind_have_each_feed_and_sensor_and_a_truth_in_range() -> None:
    drawn = varied_axes(2 * len(FEEDS), seed=1)
    assert [axis.truth.values for axis in varied_axes(2, seed=1)] == [axis.truth.values for axis in drawn[:2]]
    assert [kind_of(k) for k in range(0, 18, len(FEEDS))] == list(SENSORS)
    assert not any(axis.sensors.noise for axis in drawn[:len(FEEDS)])
    assert all(axis.sensors.noise for axis in drawn[len(FEEDS):])
    for axis in drawn:
        for free in uncertain_of(axis.free_file()).distributions:
            assert free.low < value_of(axis.truth, free.name) < free.high


def test_the_data_counts_what_is_rejected_and_far_off() -> None:
    wide, near, far = (ParameterOutcome('axis.mass', 100.0, 80.0, 104.0, 104.0 - side, 104.0 + side, kind)
                       for side, kind in ((1.0, FOUND), (0.1, NOT_IDENTIFIABLE), (0.1, FOUND)))
    assert (wide.is_far, near.is_far, far.is_far) == (False, False, True)
    found = [Outcome('constant 0', ('rigid', 'kato', 'table'), (wide, near), True, 1.5, 700),
             Outcome('steps 1', ('rigid', 'kato', 'table'), (far,), False, 1.5, 700)]
    row, *_ = of_every_kind(found)
    assert row == {'axes': 'without noise', 'number': 2, 'rejected': 1, 'found': pytest.approx(2 / 3), 'covered': 0.0,
                   'far_off': 1, 'cpu': 1.5}
    assert not_right(found) == ['steps 1 (rigid, kato, table): rejected',
                                'steps 1 (rigid, kato, table): axis.mass off by 4.00%']
    assert not of_every_kind([])


def test_the_foreign_axis_sticks_slips_and_keeps_the_balance_of_forces() -> None:
    axis = LuGreAxis()
    samples = axis.samples((0.0, 0.8), (0.003, -0.001), 1.0, 2000.0)
    peak = np.abs(samples['velocity']).max()
    assert peak > 0.01
    before = samples['time'] < samples['time'][np.argmax(samples['velocity'] > 0.1 * peak)]
    assert samples['friction_force'][before].max() == pytest.approx(axis.static_force, rel=0.05)
    force = samples['drive_force'] - samples['friction_force']
    smooth = slice(600, 700)
    by_velocity = axis.mass * np.gradient(samples['velocity'], samples['time'])
    assert by_velocity[smooth] == pytest.approx(force[smooth], abs=0.02 * np.abs(force).max())


def test_outcomes_are_kept(tmp_path: Path) -> None:
    found = [Outcome('axis 0', ('rigid', 'kato', 'table'), (
        ParameterOutcome('axis.mass', 100.0, 80.0, 102.0, 99.0, 104.0, 'found'),
        ParameterOutcome('axis.drive_damping', 100.0, 80.0, 103.0, 102.0, 104.0, 'found')), True, 1.5, 700)]
    save(found, tmp_path / 'kept' / 'axes.json')
    assert load(tmp_path / 'kept' / 'axes.json') == found
    near, wrong = found[0].parameters
    assert (near.is_covered, near.is_found, wrong.is_covered, wrong.is_found) == (True, True, False, False)
    assert near.error == pytest.approx(0.02)
    assert not found[0].is_found
