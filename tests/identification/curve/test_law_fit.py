# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction laws fitted to curves that are known: their values, their intervals, and which one is best."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.errors import InputError
from stickslip_sim.friction import SmoothKinetic, smooth
from stickslip_sim.identification.curve.best_law import Origin, fit_laws, scene_with_friction, sides, sign_changes
from stickslip_sim.identification.curve.law_fit import SMOOTH_FORMS, Fit, fit_smooth, fit_table, points_table
from stickslip_sim.identification.curve.measured_curve import FrictionCurve

SPEEDS: Numbers = np.geomspace(1e-4, 0.2, 40).astype(np.float64)
LAWS: dict[str, SmoothKinetic] = {
    'gaussian': smooth.stribeck(0.15, 0.07, 0.01, 0.1),
    'stribeck': smooth.stribeck(0.15, 0.07, 0.01, 0.1, 0.6),
    'exponential': smooth.exponential(0.15, 0.07, 0.01, 0.1),
    'hyperbolic': smooth.hyperbolic(0.15, 0.05, 0.005, 0.1),
}
FORMS = {form.name: form for form in SMOOTH_FORMS}


def curve(of: Callable[[float], float], noise: float = 0.0, seed: int = 0, speeds: Numbers = SPEEDS) -> FrictionCurve:
    values = np.array([of(speed) for speed in speeds.tolist()])
    drawn = np.random.default_rng(seed).normal(0.0, noise, len(speeds)) if noise else 0.0
    return FrictionCurve(speeds, values + drawn, np.full(len(speeds), True))


@pytest.mark.parametrize('name', LAWS)
def test_a_law_without_noise_is_found_again(name: str) -> None:
    law = LAWS[name]
    fit = fit_smooth(FORMS[name], curve(law.coefficient))
    assert fit.rms < 1e-9
    found = {key: value for key, value in fit.scene.items() if key != 'law'}
    exact = {key: getattr(law, key) for key in ('initial', 'limit', 'stribeck_velocity', 'viscous')}
    assert {key: found[key] for key in exact} == pytest.approx(exact, rel=1e-5)
    if name == 'stribeck':
        assert found['exponent'] == pytest.approx(0.6, rel=1e-5)


@pytest.mark.parametrize('name', LAWS)
def test_the_laws_of_a_fit_are_those_of_the_engine(name: str) -> None:
    fit = fit_smooth(FORMS[name], curve(LAWS[name].coefficient, noise=1e-3))
    scene = scene_with_friction(fit.scene, None, {'friction.kinetic.tolerance': 1e-6}, Origin('made', 0.005))
    made = scene.axis.friction.kinetic
    assert [made.coefficient(speed) for speed in SPEEDS.tolist()] == pytest.approx(fit.at(SPEEDS).tolist(), abs=3e-6)


@pytest.mark.parametrize('name', LAWS)
def test_the_true_law_is_best_or_as_good(name: str) -> None:
    fits = fit_laws(curve(LAWS[name].coefficient, noise=1e-3, seed=1))
    assert name in (fits.by_rank[0].name, *fits.as_good)
    assert [fit.criterion for fit in fits.by_rank] == sorted(fit.criterion for fit in fits.by_rank)


def test_a_curve_of_straight_lines_is_a_table() -> None:
    def bent(speed: float) -> float:
        return 0.16 - 4.0 * min(speed, 0.02) + 0.3 * max(speed - 0.02, 0.0)

    fit = fit_laws(curve(bent, noise=5e-4, seed=2, speeds=np.linspace(0.0, 0.1, 51).astype(np.float64))).by_rank[0]
    assert fit.name == 'table'
    assert fit.scene['velocities'] == pytest.approx((0.0, 0.02), abs=0.003)
    assert fit.scene['end_slope'] == pytest.approx(0.3, rel=0.1)


def test_coulomb_friction_is_a_table_of_one_breakpoint() -> None:
    fit = fit_table(curve(lambda speed: 0.1 + 0.2 * speed, noise=1e-3))
    assert fit.scene['velocities'] == (0.0,)


def test_the_intervals_hold_the_truth_as_often_as_they_say() -> None:
    law, held = LAWS['exponential'], {'initial': 0, 'limit': 0, 'stribeck_velocity': 0, 'viscous': 0}
    rounds = 120
    for seed in range(rounds):
        intervals = fit_smooth(FORMS['exponential'], curve(law.coefficient, noise=2e-3, seed=seed)).intervals()
        for name in held:
            low, high = intervals[name] or (math.nan, math.nan)
            held[name] += low <= getattr(law, name) <= high
    assert all(0.91 * rounds <= count <= 0.985 * rounds for count in held.values()), held


def test_the_band_holds_the_curve() -> None:
    law = LAWS['gaussian']
    inside = 0
    for seed in range(50):
        fit = fit_smooth(FORMS['gaussian'], curve(law.coefficient, noise=2e-3, seed=seed))
        exact = [law.coefficient(speed) for speed in SPEEDS.tolist()]
        inside += int(np.sum(np.abs(fit.at(SPEEDS) - exact) <= fit.band(SPEEDS)))
    assert 0.90 <= inside / (50 * len(SPEEDS)) <= 0.99


def test_what_the_points_do_not_determine_has_no_interval() -> None:
    fit = fit_smooth(FORMS['gaussian'], curve(lambda speed: 0.1, noise=1e-3))
    assert fit.intervals().get('stribeck_velocity') is None
    assert all(math.isnan(half) or half > 0.0 for half in fit.band(SPEEDS))


def test_a_law_at_an_end_of_its_range_says_so() -> None:
    fit = fit_smooth(FORMS['exponential'], curve(smooth.exponential(0.15, 0.07, 0.01).coefficient, 1e-3, seed=3))
    assert fit.scene['viscous'] == 0.0
    assert fit.held == ('viscous',)
    assert 'viscous' not in fit.intervals()


def test_too_few_points_leave_laws_out_or_refuse() -> None:
    few = curve(LAWS['gaussian'].coefficient, speeds=np.array([0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2]))
    assert fit_laws(few).left_out == ('stribeck',)
    for speeds in (np.array([0.001, 0.01, 0.02, 0.1]), np.full(9, 0.01)):
        with pytest.raises(InputError, match='at least 5 points, at 2 speeds'):
            fit_laws(curve(LAWS['gaussian'].coefficient, speeds=speeds))


def test_a_law_that_misses_the_shape_leaves_a_pattern() -> None:
    measured = curve(LAWS['hyperbolic'].coefficient, noise=5e-4)
    assert sign_changes(fit_smooth(FORMS['hyperbolic'], measured)).chance > 0.05
    assert sign_changes(fit_smooth(FORMS['gaussian'], measured)).chance < 1e-3


def test_the_chance_of_few_changes_is_that_of_all_orders() -> None:
    """Of the six orders of two and two signs two have one change, and four at most two."""
    left = np.array([1.0, 1.0, -1.0, -1.0])
    fit = Fit('flat', _Flat(), (), np.array([]), (), 0, {},
              FrictionCurve(left + 2.0, left, np.full(4, True)))
    assert sign_changes(fit) == pytest.approx((1, 2 / 6, 2 / 6))


class _Flat:
    logarithms = ()

    def coefficients(self, parameters: Numbers, speeds: Numbers) -> Numbers:
        return np.zeros_like(speeds)


def spread(low: float, count: int, high: float = 0.1) -> Numbers:
    return np.geomspace(low, high, count).astype(np.float64)


SEVEN = FrictionCurve(spread(5e-4, 7), np.array([0.158, 0.147, 0.13, 0.11, 0.094, 0.083, 0.076]), np.full(7, True))


def test_few_points_of_a_falling_curve_are_no_constant() -> None:
    """The constant has the lower AICc, by its last term alone: it misses the points by a third of their range."""
    fits = fit_laws(SEVEN)
    table = next(fit for fit in fits.by_rank if fit.name == 'table')
    assert table.criterion < fits.by_rank[0].criterion
    assert table.miss > 0.3
    assert (fits.by_rank[0].name, fits.passed_over) == ('hyperbolic', ['table'])
    assert 'table' not in fits.as_good


def test_noise_about_a_constant_stays_a_constant() -> None:
    for seed in range(3):
        fits = fit_laws(curve(lambda speed: 0.1, noise=1e-3, seed=seed, speeds=spread(5e-4, 9)))
        assert (fits.by_rank[0].name, fits.passed_over) == ('table', [])


def test_seven_residuals_cannot_show_a_pattern() -> None:
    assert sign_changes(fit_table(SEVEN)).least > 0.05
    assert sign_changes(fit_smooth(FORMS['hyperbolic'], curve(LAWS['gaussian'].coefficient))).least < 1e-6


def test_a_fit_knows_when_its_value_at_rest_is_above_all_points() -> None:
    slow, fast = (curve(LAWS['exponential'].coefficient, noise=1e-4, speeds=spread(low, 12, 0.2))
                  for low in (1e-5, 5e-3))
    assert not fit_smooth(FORMS['exponential'], slow).extrapolates
    assert fit_smooth(FORMS['exponential'], fast).extrapolates


def test_directions_that_differ_are_seen() -> None:
    one = curve(LAWS['gaussian'].coefficient, noise=5e-4)
    two = FrictionCurve(np.repeat(one.speeds, 2), np.repeat(one.coefficients, 2) * np.tile([1.02, 0.98], len(SPEEDS)),
                        np.tile([True, False], len(SPEEDS)))
    forward, backward = sides(fit_smooth(FORMS['gaussian'], two))
    assert (forward.ratio, backward.ratio) == pytest.approx((1.02, 0.98), abs=1e-3)
    assert sides(fit_smooth(FORMS['gaussian'], one)) == []


def test_points_become_a_table_of_means() -> None:
    points = FrictionCurve(np.array([0.001, 0.001, 0.02]), np.array([0.1, 0.12, 0.08]), np.full(3, True))
    assert points_table(points) == {'law': 'table', 'velocities': (0.0, 0.001, 0.02), 'end_slope': 0.0,
                                    'coefficients': pytest.approx((0.11, 0.11, 0.08))}
