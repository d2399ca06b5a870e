# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Least squares within a region: at borders, and over plateaus beyond them."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.identification.certainty import certainty_of, combinations_of
from stickslip_sim.identification.free_parameters import FreeParameter, Region, region_of
from stickslip_sim.identification.least_squares import Solution, bounded_step, minimise

KINETIC, STATIC, LIMIT = 'friction.kinetic.initial', 'friction.static.initial', 'friction.static.limit'
VALUES = {KINETIC: 0.1, STATIC: 0.15, LIMIT: 0.2, 'friction.static.law': 'exponential'}


def parameters(*names: str, low: float = 0.05, high: float = 0.5) -> list[FreeParameter]:
    return [FreeParameter(name, '', VALUES[name], low, high) for name in names]   # type: ignore[arg-type]


def test_a_step_in_ranges_is_that_of_scipy() -> None:
    random = np.random.default_rng(0)
    for _ in range(50):
        slopes, residuals = random.normal(size=(12, 5)), 3.0 * random.normal(size=12)
        point = random.uniform(-1.0, 1.0, 5)
        point[random.integers(5)] = 1.0
        region = Region(np.full(5, -1.0), np.full(5, 1.0))
        step = bounded_step(slopes.T @ slopes, slopes.T @ residuals, 0.0, point, region)
        right = lsq_linear(slopes, -residuals, (-1.0 - point, 1.0 - point), tol=1e-14).x
        assert step == pytest.approx(right, abs=1e-6)


def test_a_step_in_order_is_the_best_of_those_in_order() -> None:
    random = np.random.default_rng(1)
    region = Region(np.zeros(4), np.full(4, 9.0), (0, 2, 3))
    for _ in range(30):
        slopes, residuals = random.normal(size=(9, 4)), 5.0 * random.normal(size=9)
        point = region.inside(random.uniform(0.0, 9.0, 4))
        end = point + bounded_step(slopes.T @ slopes, slopes.T @ residuals, 0.0, point, region)
        assert end == pytest.approx(region.inside(end), abs=1e-12)
        others = [region.inside(end + size * random.normal(size=4)) for size in (1e-3, 0.1, 3.0) for _ in range(100)]
        costs = [float(np.sum((residuals + slopes @ (other - point))**2)) for other in [end, *others]]
        assert costs[0] <= min(costs) + 1e-9


def test_a_fit_leaves_a_border_beyond_which_a_number_does_nothing() -> None:
    """Static friction as the model sees it is never below kinetic friction: from a start below, it must be found."""
    region = region_of(parameters(KINETIC, STATIC, LIMIT), VALUES)
    true = np.log([0.11, 0.13, 0.19])

    def residuals(point: Numbers) -> Numbers:
        kinetic, static, limit = np.maximum.accumulate(point)
        return 1e3 * np.array([kinetic + 0.1 * static, static - 0.3 * limit, limit + static * kinetic])

    for start in ([0.4, 0.06, 0.06], [0.2, 0.2, 0.2], [0.5, 0.5, 0.5], [0.05, 0.3, 0.1]):
        found = minimise(lambda point: residuals(point) - residuals(true), np.log(start), region, most=40,
                         tolerance=1e-9)
        assert np.exp(found.point) == pytest.approx([0.11, 0.13, 0.19], rel=1e-6), start
        assert found.is_settled


def test_a_search_ends_where_it_crawls_far_from_noise() -> None:
    """A long valley leads to the best point, along which a step gains less than a thousandth of a large misfit."""
    sums: list[float] = []

    def found(misfit: float, far: float) -> tuple[Solution, int]:
        def residuals(point: Numbers) -> Numbers:
            x, y = point
            sums.append(0.0)
            return np.array([misfit, 300.0 * (y - x * x), 3.0 * (1.0 - x)])

        sums.clear()
        region = Region(np.full(2, -3.0), np.full(2, 3.0))
        return minimise(residuals, np.array([-1.2, 1.0]), region, most=60, tolerance=1e-9, far=far), len(sums)

    (near, of_near), (same, of_same) = found(10.0, np.inf), found(10.0, 1e5)
    assert near.point == pytest.approx([1.0, 1.0], abs=1e-4)
    assert (same.point.tolist(), of_same) == (near.point.tolist(), of_near)
    (whole, of_whole), (soon, of_soon) = found(1e3, np.inf), found(1e3, 1e5)
    assert soon.is_settled
    assert soon.cost == pytest.approx(whole.cost, rel=1e-4)
    assert of_soon < 0.1 * of_whole


def test_slopes_at_a_corner_of_the_order_are_those_of_each_number() -> None:
    region = region_of(parameters(KINETIC, STATIC, LIMIT), VALUES)
    matrix = np.array([[3.0, 1.0, 0.5], [0.2, 2.0, -1.0], [1.0, 0.0, 4.0]])
    corner = np.full(3, np.log(0.1))
    found = minimise(lambda point: matrix @ (np.maximum.accumulate(point) - corner), corner, region, most=1,
                     tolerance=1e-3)
    assert found.information == pytest.approx(matrix.T @ matrix, rel=1e-6)


def test_numbers_that_are_not_free_are_borders() -> None:
    region = region_of(parameters(STATIC, LIMIT), VALUES)
    assert np.exp(region.inside(np.log([0.06, 0.06]))) == pytest.approx([0.1, 0.1])
    assert np.exp(region_of(parameters(LIMIT), VALUES).low) == pytest.approx([0.15])
    held = region_of(parameters(KINETIC, STATIC, LIMIT), VALUES).holding(1, float(np.log(0.12)))
    assert np.exp(held.high) == pytest.approx([0.12, 0.12, 0.5])
    assert np.exp(held.low) == pytest.approx([0.05, 0.12, 0.12])
    assert np.exp(held.at(np.full(3, 0.5))) == pytest.approx([(0.05 * 0.12)**0.5, 0.12, (0.12 * 0.5)**0.5])


def test_ranges_that_begin_at_0_are_in_order_too() -> None:
    free = [FreeParameter(KINETIC, '', 0.1, 0.0, 0.4), FreeParameter(STATIC, '', 0.15, 0.0, 0.8)]
    inside = region_of(free, VALUES).inside(np.array([0.75, 0.1]))   # shares of the ranges: 0.3 and 0.08
    assert [one.outer(number) for one, number in zip(free, inside)] == pytest.approx([0.3, 0.3])


# What a singular JᵀJ says: parameters that the data do not tell apart are not known, however exact the data are.

SIGMA = 1e-9    # of a reading, relative


def numbers(count: int) -> list[FreeParameter]:
    return [FreeParameter(f'axis.number_{k}', '', 1.0, 0.5, 2.0) for k in range(count)]


def information(jacobian: Numbers, error: float) -> Numbers:
    """Return JᵀJ of derivatives in units of the noise, with relative errors as differences have them."""
    noisy = jacobian * (1.0 + error * np.random.default_rng(5).standard_normal(jacobian.shape)) / SIGMA
    return np.asarray(noisy.T @ noisy)


@pytest.mark.parametrize('error', [0.0, 1e-9, 1e-7])
def test_a_slope_known_to_all_digits_leaves_both_ends_open(error: float) -> None:
    """The first column alone, and two whose ratio alone matters."""
    t = np.linspace(0.0, 1.0, 400)
    found = information(np.stack([np.sin(9.0 * t), t, -t], axis=1), error)
    certainty = certainty_of(found, 1.0, numbers(3))
    assert certainty.known.tolist() == [True, False, False]
    assert 6e-11 < certainty.deviations[0] < 1e-8    # and not that of the other two
    (combination,) = combinations_of(found, numbers(3))
    assert combination.names == ('axis.number_1', 'axis.number_2')


def test_what_the_data_tell_apart_is_known_as_before() -> None:
    t = np.linspace(0.0, 1.0, 400)
    jacobian = np.stack([np.sin(9.0 * t), t, t + 1e-3 * t**2], axis=1)
    found = information(jacobian, 0.0)
    certainty = certainty_of(found, 2.0, numbers(3))
    assert certainty.known.all()
    assert certainty.covariance == pytest.approx(2.0 * np.linalg.inv(found), rel=1e-6, abs=0.0)
    assert combinations_of(found, numbers(3)) == ()


def test_what_is_held_is_not_known() -> None:
    certainty = certainty_of(np.diag([4.0e18, 0.0]), 1.0, numbers(2))
    assert certainty.known.tolist() == [True, False]
    assert certainty.covariance[0, 0] == pytest.approx(2.5e-19, abs=0.0)
