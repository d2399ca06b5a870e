# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Uncertainty: distributions, their sample, and indices of functions and of an axis that have a closed form."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from numpy.typing import NDArray
from scipy import stats

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.errors import InputError
from stickslip_sim.figures.point_figures import FIGURES, Motion
from stickslip_sim.inputs import load_scene
from stickslip_sim.study import Distribution, Saltelli, Study
from stickslip_sim.study.study import description, study_of
from stickslip_sim.study.uncertainty import PERCENTS, sobol_indices, uncertain_of, uncertainty_of
from tests.support.scene_files import refusal

SHARES: Numbers = np.arange(101) / 100.0
STATIC, KINETIC, NORMAL = 0.24, 0.12, 3432.3275
RIGID = {'friction.static.law': 'constant', 'friction.static.initial': STATIC, 'friction.kinetic.velocities': [0.0],
         'friction.kinetic.coefficients': [KINETIC], 'axis.drive_damping': 0.0, 'drive.velocity': 1e-4}
ENDS = {'friction.static.initial': (0.2, 0.28), 'axis.drive_stiffness': (5e5, 8e5), 'drive.velocity': (8e-5, 1.6e-4)}


def uniform(name: str, low: float, high: float) -> Distribution:
    return Distribution(name, 'uniform', (low, high), low, high)


def uncertain_axis(samples: int, *names: str) -> Study:
    scene = load_scene('paper_fig4_constant', RIGID)
    return Study(scene.values, Saltelli(tuple(uniform(name, *ENDS[name]) for name in names), samples))


def columns_of(study: Study) -> dict[str, Numbers]:
    figures = study.figures(0, study.count)
    return {name: getattr(figures, name) for name in FIGURES}


def period(static: Numbers | float, stiffness: Numbers | float, feed: Numbers | float) -> Numbers:
    """Return that of an undamped slider of 350 kg: it stands until the spring has gained twice ΔF, then swings."""
    drop, impedance = NORMAL * (static - KINETIC), np.sqrt(stiffness * 350.0)
    return np.asarray(2.0 * drop / (stiffness * feed)
                      + 2.0 * (np.pi - np.arctan(drop / (feed * impedance))) / np.sqrt(stiffness / 350.0))


def indices_of(sample: Saltelli, values: Numbers) -> NDArray[np.float64]:
    found = sobol_indices(values.reshape(sample.samples, sample.each))
    assert found is not None
    return np.array(found)


@pytest.mark.parametrize(('found', 'theory'), [
    (Distribution('axis.mass', 'normal', (350.0, 10.0), 340.0, 380.0), stats.truncnorm(-1.0, 3.0, 350.0, 10.0)),
    (Distribution('axis.mass', 'lognormal', (350.0, 1.2), 200.0, 600.0), None),
    (Distribution('axis.mass', 'uniform', (300.0, 400.0), 300.0, 400.0), stats.uniform(300.0, 100.0)),
    (Distribution('axis.mass', 'triangular', (300.0, 310.0, 400.0), 300.0, 400.0), None)])
def test_values_follow_the_law(found: Distribution, theory: 'stats.rv_frozen | None') -> None:
    values = found.at(SHARES)
    assert (values[0], values[-1]) == pytest.approx((found.low, found.high), rel=1e-12)
    if theory is not None:
        assert values == pytest.approx(theory.ppf(SHARES), rel=1e-9)
    elif found.law == 'lognormal':
        cut = stats.truncnorm(*np.log(np.array([200.0, 600.0]) / 350.0) / math.log(1.2))
        assert values == pytest.approx(350.0 * 1.2**cut.ppf(SHARES), rel=1e-9)
    else:   # two parabolas, that meet at the mode with 1/10 below
        assert values[:11] == pytest.approx(300.0 + np.sqrt(SHARES[:11] * 100.0 * 10.0), rel=1e-12)
        assert values[10:] == pytest.approx(400.0 - np.sqrt((1.0 - SHARES[10:]) * 100.0 * 90.0), rel=1e-12)


def test_where_a_sample_is_cut_changes_no_bit() -> None:
    sample = Saltelli((Distribution('axis.mass', 'lognormal', (350.0, 1.2), 200.0, 600.0),
                       uniform('drive.velocity', 1e-3, 2e-3)), 64, seed=3)
    whole = sample.points(0, 256)
    for first, last in ((0, 1), (3, 9), (100, 256)):
        assert np.array_equal(sample.points(first, last), whole[first:last])
    a, b, first_of_b, second_of_b = whole.reshape(64, 4, 2).transpose(1, 0, 2)
    assert np.array_equal(first_of_b, np.stack([b[:, 0], a[:, 1]], axis=1))
    assert np.array_equal(second_of_b, np.stack([a[:, 0], b[:, 1]], axis=1))
    assert abs(np.corrcoef(a[:, 0], b[:, 0])[0, 1]) < 0.3


def test_the_indices_of_ishigami_are_those_of_theory() -> None:
    """f = sin x + 7 sin² y + 0.1 z⁴ sin x (Ishigami and Homma, 1990)."""
    sample = Saltelli(tuple(uniform(name, -math.pi, math.pi) for name in 'xyz'), 4096)
    x, y, z = sample.points(0, sample.count).T
    first, error, total, _ = indices_of(sample, np.sin(x) + 7.0 * np.sin(y)**2 + 0.1 * z**4 * np.sin(x)).T
    one, two = 0.5 * (1.0 + 0.1 * math.pi**4 / 5.0)**2, 49.0 / 8.0
    both = 0.01 * math.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    variance = one + two + both
    assert first == pytest.approx(np.array([one, two, 0.0]) / variance, abs=0.01)
    assert total == pytest.approx(np.array([one + both, two, both]) / variance, abs=0.02)
    assert (np.abs(first - np.array([one, two, 0.0]) / variance) < 2.0 * error).all()


def test_the_indices_of_a_sum_add_up_to_one() -> None:
    sample = Saltelli(tuple(uniform(name, 0.0, 1.0) for name in 'xyz'), 1024)
    first, _, total, _ = indices_of(sample, sample.points(0, sample.count) @ np.array([3.0, 2.0, 0.0])).T
    for index in (first, total):
        assert index == pytest.approx([9.0 / 13.0, 4.0 / 13.0, 0.0], abs=0.005)


def test_errors_are_those_of_points_drawn_at_random() -> None:
    """Of the g-function of Sobol' (1993), whose indices have a closed form; 64 samples of 256 points."""
    weights = np.array([0.0, 1.0, 4.5])
    parts = 1.0 / (3.0 * (1.0 + weights)**2)
    variance = np.prod(1.0 + parts) - 1.0
    theory = np.array([parts, parts * np.prod(1.0 + parts) / (1.0 + parts)]) / variance
    rng = np.random.default_rng(1)
    found = []
    for _ in range(64):
        a, b = rng.random((2, 256, 3))
        points = np.stack([a, b, *(np.where(np.arange(3) == k, b, a) for k in range(3))], axis=1)
        values = np.prod((np.abs(4.0 * points - 2.0) + weights) / (1.0 + weights), axis=2)
        found.append(np.array(sobol_indices(values)).T)
    first, error, total, total_error = np.array(found).transpose(1, 0, 2)
    for values, errors, exact in zip((first, total), (error, total_error), theory):
        off = (values - exact) / errors
        assert off.mean(axis=0) == pytest.approx(0.0, abs=0.5)
        assert off.std(axis=0) == pytest.approx(1.0, abs=0.35)


def test_an_axis_has_the_indices_of_its_theory() -> None:
    """Slow feed on constant friction: T = 2 ΔF/(c v) but for the slip, a product of three independent factors."""
    study = uncertain_axis(512, *ENDS)
    assert isinstance(study.sample, Saltelli)
    columns = columns_of(study)
    assert columns['period'] == pytest.approx(period(*study.points(0, study.count).T), rel=1e-9)
    found = uncertainty_of(study.sample, columns)
    factors = [_varied(*(end - KINETIC for end in ENDS['friction.static.initial']))]
    factors += [_inverse_varied(*ENDS[name]) for name in list(ENDS)[1:]]
    together = math.prod(1.0 + square for square in factors) - 1.0
    of_period = found.indices['period']
    assert of_period is not None
    assert found.stick_slip == 1.0
    assert [of_period[name].first_order for name in ENDS] == pytest.approx([f / together for f in factors], abs=0.02)
    assert found.indices['stick_slip'] is None   # all stick and slip: there is nothing to explain


def test_percentiles_of_one_number_are_those_of_the_monotonic_theory() -> None:
    study = uncertain_axis(1024, 'drive.velocity')
    assert isinstance(study.sample, Saltelli)
    found = uncertainty_of(study.sample, columns_of(study))
    low, high = ENDS['drive.velocity']
    feeds = high - (high - low) * np.array(PERCENTS) / 100.0   # the slowest have the longest periods
    assert found.percentiles['period'] == pytest.approx(period(STATIC, 6e5, feeds), rel=3e-3)
    assert found.points == found.known == 2048


def test_points_without_a_cycle_have_a_share_and_no_percentile() -> None:
    scene = load_scene('paper_fig7')
    study = Study(scene.values, Saltelli((uniform('drive.velocity', 0.01, 0.06),), 64))
    assert isinstance(study.sample, Saltelli)
    columns = columns_of(study)
    found = uncertainty_of(study.sample, columns)
    drawn = columns['stick_slip'].reshape(64, 3)[:, :2]
    assert 0.0 < drawn.mean() < 1.0
    assert found.stick_slip == drawn.mean()
    assert found.indices['period'] is None
    assert found.percentiles['period'] is not None
    slips = columns['period'].reshape(64, 3)[:, :2][drawn == 1.0]
    assert found.percentiles['period'] == np.percentile(slips, PERCENTS).tolist()
    decides = found.indices['stick_slip']
    assert decides is not None
    assert decides['drive.velocity'].total == pytest.approx(1.0, abs=0.1)   # the only one there is


def test_of_points_that_nobody_could_solve_nothing_is_reported() -> None:
    sample = Saltelli((uniform('axis.mass', 300.0, 400.0),), 16)
    columns = {**{name: np.full(sample.count, np.nan) for name in FIGURES}, 'settled': np.zeros(sample.count),
               'motion': np.full(sample.count, float(Motion.FAILED))}
    found = uncertainty_of(sample, columns)
    assert (found.known, found.failed, found.undecided, found.stick_slip) == (0, 32, 0, None)
    assert {*found.percentiles.values(), *found.indices.values()} == {None}


def test_the_sidecar_is_the_study() -> None:
    study = uncertain_axis(16, *ENDS)
    again = study_of(description(study))
    assert again.sample == study.sample
    assert description(again) == description(study)


def test_a_file_says_what_is_known() -> None:
    found = uncertain_of({'seed': 4, 'parameters': {
        'axis.mass': {'distribution': 'normal', 'mean': 350, 'standard_deviation': 10.0, 'between': [330.0, 370.0]},
        'friction.kinetic.coefficients[1]': {'distribution': 'triangular', 'low': 0.0, 'mode': 0.0, 'high': 0.1}}})
    assert found.seed == 4
    assert found.distributions == (Distribution('axis.mass', 'normal', (350.0, 10.0), 330.0, 370.0), Distribution(
        'friction.kinetic.coefficients[1]', 'triangular', (0.0, 0.0, 0.1), 0.0, 0.1))
    assert found.distributions[0].kept == pytest.approx(0.9545, abs=1e-4)


NORMAL_MASS = {'distribution': 'normal', 'mean': 350.0, 'standard_deviation': 10.0}


MASS_AND_LOAD = {
    'axis.mass': {**NORMAL_MASS, 'between': [310.0, 390.0]},
    'axis.normal_force': {'distribution': 'lognormal', 'median': 3000.0, 'geometric_standard_deviation': 1.1,
                          'between': [2000.0, 4500.0]},
}


def test_correlated_numbers_keep_their_own_distributions() -> None:
    found = uncertain_of({'parameters': MASS_AND_LOAD, 'correlations': {'axis.normal_force': {'axis.mass': -0.9}}})
    sample = Saltelli(found.distributions, 4096, 1, found.correlations)
    assert (sample.each, sample.count) == (2, 8192)
    points = sample.points(0, sample.count)
    assert np.corrcoef(points[:, 0], np.log(points[:, 1]))[0, 1] == pytest.approx(-0.9, abs=0.005)
    assert points[:, 0].mean() == pytest.approx(350.0, abs=0.05)
    assert points[:, 0].std() == pytest.approx(10.0, rel=0.005)
    assert np.log(points[:, 1]).std() == pytest.approx(math.log(1.1), rel=0.005)
    assert abs(np.corrcoef(points[::2, 0], points[1::2, 0])[0, 1]) < 0.03   # A and B are independent
    assert np.array_equal(sample.points(3, 9), points[3:9])


def test_correlated_numbers_narrow_what_depends_on_their_product() -> None:
    """T of the axis above depends on N μ alone: known to 1 % when N and μ go against each other, to 14 % when not."""
    normal = {'distribution': 'lognormal', 'geometric_standard_deviation': 1.1}
    known = {'axis.normal_force': {**normal, 'median': NORMAL, 'between': [0.7 * NORMAL, 1.4 * NORMAL]},
             'friction.scale': {**normal, 'median': 1.0, 'between': [0.7, 1.4]}}
    spreads = []
    for correlations in (None, {'axis.normal_force': {'friction.scale': -0.995}}):
        found = uncertain_of({'parameters': known, 'correlations': correlations})
        sample = Saltelli(found.distributions, 64, 0, found.correlations)
        study = Study(load_scene('paper_fig4_constant', RIGID).values, sample)
        assert study_of(description(study)).sample == sample
        result = uncertainty_of(sample, columns_of(study))
        assert (result.indices['period'] is None) == (correlations is not None)
        period = result.percentiles['period']
        assert period is not None
        spreads.append(math.log(period[-1] / period[0]) / (2.0 * stats.norm.ppf(0.95)))
    assert spreads[0] == pytest.approx(0.135, rel=0.15)
    assert spreads[1] == pytest.approx(0.0095, rel=0.25)


REFUSED = yaml.safe_load(Path(__file__).with_name('uncertain_refused.yaml').read_text(encoding='utf-8'))[1:]


@pytest.mark.parametrize('row', REFUSED)
def test_what_makes_no_sense_is_refused(row: list[Any]) -> None:
    document, *words = row
    said = str(refusal(uncertain_of, document))
    assert [word for word in words if word not in said] == [], said


def test_a_changed_sidecar_without_such_numbers_is_refused() -> None:
    found = description(uncertain_axis(16, *ENDS))
    found['uncertain']['correlations'] = [[1.0, 0.9, -0.9], [0.9, 1.0, 0.9], [-0.9, 0.9, 1.0]]
    with pytest.raises(InputError, match='it was changed'):
        study_of(found)


@pytest.mark.parametrize('samples', [0, 8, 100, 1 << 25])
def test_a_sample_is_a_power_of_two(samples: int) -> None:
    with pytest.raises(InputError, match='power of two'):
        Saltelli((uniform('axis.mass', 300.0, 400.0),), samples)


def _varied(low: float, high: float) -> float:
    """Return the squared coefficient of variation of a uniform number."""
    return (high - low)**2 / 12.0 / (0.5 * (low + high))**2


def _inverse_varied(low: float, high: float) -> float:
    """Return that of one over it."""
    mean = math.log(high / low) / (high - low)
    return 1.0 / (low * high) / mean**2 - 1.0
