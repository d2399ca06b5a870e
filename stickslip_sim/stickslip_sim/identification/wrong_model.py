# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The best numbers of a model that is not that of the axis: by single slips, or by the position of the whole run.

Single slips are fitted each from a measured arrest.

In the whole run its slips come ever more too late or too early, and the least sum of squares means nothing.  It still
can have the right rests and break-aways, and these weigh most here: they are what such a model is used for.  Where the
force was measured, the spring begins as far stretched as that says: the stretch must not make up for other errors.
"""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from ..core.arrays import Numbers
from .certainty import certainty_of
from .fit_problem import FitProblem
from .least_squares import minimise, robust_cost, slopes_of, square_cost
from .residual_tests import inflation_of
from .stages import Ended

_FEWEST_SLIPS, _MOST_SLIPS = 3, 30
_POINTS = 2             # to begin from, of those where fits began and ended, and with what the force says directly
_AGAIN = 2              # times that the best is sought from once more: a simplex that has shrunk stands still
_TRIALS = 60            # at each of them, for each parameter
_STEP, _STEEPEST = 1e-5, 1e4
_ROBUST = 10.0          # figures of slips: beyond, their size counts
_NEAR = 1e-3            # of a logarithm or of a range: so well a point is sought


def best_of_slips(problem: FitProblem, ends: Sequence[Ended]) -> list[Ended]:
    """Return the ends, before them the best fit of single slips where no fit of the whole run is near the data."""
    count = len(problem.sharp_slips)
    if not ends[0].is_lost or count < _FEWEST_SLIPS:
        return [*ends]
    rows = np.unique(np.linspace(0, count - 1, min(count, _MOST_SLIPS)).round().astype(int))
    slips = [problem.sharp_slips[k] for k in rows]

    def residuals(point: Numbers) -> Numbers:
        return problem.of_slips(problem.tied(point), slips, telling=True)

    def cost(point: Numbers) -> float:
        return robust_cost(residuals(point), _ROBUST)

    ended = [point for end in ends for point in (end.start, end.solution.point)]
    direct = [problem.region.inside(problem.with_direct(point)) for point in (*ended, problem.start)]
    points = [point for of in (ended, direct) for point in sorted(of, key=cost)[:_POINTS]]
    nearest = min((_nearest(cost, point, problem) for point in points), key=cost)
    for _ in range(_AGAIN):
        nearest = _nearest(cost, nearest, problem)
    best = minimise(residuals, nearest, problem.region, most=10, tolerance=1e-3, share=1e-4, robust=_ROBUST,
                    step=_STEP, steepest=_STEEPEST)
    point = problem.tied(best.point)
    whole = square_cost(problem.of_run()(point))
    if not np.isfinite(whole):
        return [*ends]
    untied = partial(problem.of_slips, slips=slips, telling=True)
    figures = untied(point)
    slopes = slopes_of(untied, point, figures, problem.region, _STEP)
    slopes[np.abs(slopes) > _STEEPEST] = 0.0
    best = best._replace(point=point, cost=whole, information=slopes.T @ slopes)
    of_slips = float(figures @ figures) / len(figures)
    return [Ended(ends[0].start, best, True, True, ends[0].tolerance, of_slips), *ends]


def _nearest(cost: Callable[[Numbers], float], start: Numbers, problem: FitProblem) -> Numbers:
    """Return where the figures are best, by the simplex of Nelder and Mead.

    A slip that is another one from a point on, and a contact that rings, make steps on which slopes mean nothing.
    """
    from scipy.optimize import Bounds, minimize  # takes a while, and only a wrong model needs it

    region = problem.region
    found = minimize(lambda point: cost(region.inside(point)), start, method='Nelder-Mead',
                     bounds=Bounds(region.low, region.high),
                     options={'maxfev': _TRIALS * len(start), 'xatol': _NEAR, 'fatol': _NEAR, 'adaptive': True})
    return region.inside(np.asarray(found.x))




# An axis that is not quite the model, and driven by a measured force: its position over the whole run.
#
# The filtered residuals take the position that the force leads to for what it is from sample to sample, and let its
# error grow as noise of the force does.  Where a test rejects them, what is left is no noise: friction of the axis
# varies a little along its way, and the best fit to the samples may leave the measured way by much within some seconds,
# for an offset of a percent.  The whole way shows such numbers: of those that the samples leave open, the nearest that
# follow it are taken.

_POSITION_STEP = 1e-4     # of derivatives: the position over the whole run is far from linear only beyond
_LEAST = 1e-12   # of the largest variance: less is rounding


def along_the_run(problem: FitProblem, ends: Sequence[Ended]) -> list[Ended]:
    """Return the ends, the best of them moved to where the position follows the run, if a misfit asks for it.

    Sought is the least of the squares of the position over what is known of it after a rest, counted once for each
    motion, and of the way from the best fit over its covariance.  The cost stays that of the best fit to the samples,
    by which starts and laws are compared.
    """
    best, channels = ends[0], problem.measurement.channels
    rows = [k for k, channel in enumerate(channels) if channel.name == 'position']
    if not (rows and problem.is_direct and problem.motions and best.is_off):
        return [*ends]
    k, point, whole = rows[0], best.solution.point, problem.stretches()
    fitted = problem.fitted(point, whole)
    assert fitted is not None
    covariance = certainty_of(best.solution.information, inflation_of(problem, fitted), problem.parameters).covariance
    variances, ways = np.linalg.eigh(covariance)
    near = (ways / np.sqrt(np.maximum(variances, _LEAST * variances[-1]))).T
    count = len(channels[k].values)
    factor = np.sqrt(len(problem.motions) / count) / problem.roughly(channels[k])

    def residuals(trial: Numbers) -> Numbers:
        found = problem.fitted(trial, whole)
        if found is None:
            return np.full(count + len(trial), np.nan)
        return np.concatenate([factor * (channels[k].values - found[k]), near @ (trial - point)])

    moved = minimise(residuals, point, problem.region, most=30, tolerance=1e-2, step=_POSITION_STEP)
    return [best._replace(solution=best.solution._replace(point=moved.point), is_along=True), *ends[1:]]
