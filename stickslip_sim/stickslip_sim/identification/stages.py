# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The way from a start far off to the best fit: single slips from many starts, stretches, and the whole run.

The sum of squares over a whole run has a minimum wherever another number of slips fits into it.  The figures of single
slips, each from a measured arrest, have few; what they find is near enough for the samples of the same stretches, and
these for longer ones, up to the whole run, which knows the parameters best.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .least_squares import STEP, Solution, minimise
from .problem import FitProblem
from .slip_features import MeasuredSlip

Numbers = NDArray[np.float64]
Progress = Callable[[str, float], None]

_STARTS = 256           # trial points beside the given one, a power of two
_TRIAL_SLIPS = 5        # at each of them
_FITTED_STARTS = 8      # of them, the best
_SLIPS = 10             # at most, for the coarse fit
_SAMPLES = 4000         # about so many are enough until the last stage
_FIRST_SLIPS = 0, 1, 3, 8, 20, 50   # that are fitted as one, before the whole run
_GOOD = 1.5             # a mean square up to that, and no other start is tried
_COARSE_STEP = 1e-5
_LOST = 100.0           # a mean square from which on the whole run is not followed
_FEWEST_SLIPS, _MOST_SLIPS = 3, 30
_TRIED = 40             # values of a parameter over its range
_TABLES = 4             # times at most that tables of smooth laws are made anew
_STEEPEST = 1e4         # figures of slips over a logarithm: a hundred times in proportion
_KEPT = 0.5, 0.8        # of the slips, in turn; in the last also those whose cost is not far above the median
_FAR_OFF = 4.0
_ROBUST = 3.0           # figures of slips: beyond, a coarse fit counts their size


class Ended(NamedTuple):
    """A start, where the fit from it ended, and the mean square of the residuals of the whole run there.

    `of_slips` has the mean square of the figures of single slips where these alone were fitted (`best_of_slips`).
    """

    start: Numbers
    solution: Solution
    mean_square: float
    of_slips: float | None = None


def starts_of(problem: FitProblem, seed: int) -> Iterator[Numbers]:
    """Yield points to start from, by the figures of single slips: from the given start, then from many others.

    Before them that which a force that drives the slider by itself shows directly.
    """
    if problem.is_direct:
        yield problem.with_direct(problem.start)
    chosen = [problem.clear_slips[k] for k in _spread(len(problem.clear_slips), _SLIPS)]
    first = _coarse(problem, problem.with_direct(problem.start), chosen)
    yield first.point
    from scipy.stats import qmc  # takes half a second, and most runs need no other start

    few = [problem.clear_slips[k] for k in _spread(len(problem.clear_slips), _TRIAL_SLIPS)]
    shares = qmc.Sobol(len(problem.start), seed=seed).random(_STARTS)
    trials = [problem.with_direct(trial) for trial in problem.low + shares * (problem.high - problem.low)]
    costs = [_cost(problem.of_slips(trial, few)) for trial in trials]
    found = [first, *(_coarse(problem, trials[k], chosen) for k in np.argsort(costs)[:_FITTED_STARTS])]
    found.sort(key=lambda solution: solution.cost)
    yield from (point for point in _distinct([first.point, *(solution.point for solution in found)], problem)[1:])


def _coarse(problem: FitProblem, start: Numbers, slips: Sequence[MeasuredSlip]) -> Solution:
    """Return where the figures of slips are best, from a start on: first without the worst, then without those far off.

    What was taken for a slip may be none, and a slip that is another one from a point on bars the way with a step.
    """
    if not slips:
        return Solution(start, np.inf, np.eye(len(start)), True)
    found = Solution(start, np.inf, np.eye(len(start)), True)
    for kept in _KEPT:
        costs = np.array([_cost(problem.of_slips(found.point, [slip])) for slip in slips])
        limit = max(float(np.quantile(costs, kept)), _FAR_OFF * float(np.median(costs)) if kept == _KEPT[-1] else 0.0)
        near = [slip for slip, cost in zip(slips, costs) if cost <= limit]
        found = minimise(partial(problem.of_slips, slips=near), found.point, problem.low, problem.high, most=20,
                         tolerance=1e-2, share=1e-4, robust=_ROBUST, step=_COARSE_STEP, steepest=_STEEPEST)
    return found._replace(cost=_cost(problem.of_slips(found.point, slips)))


def fit_from(problem: FitProblem, start: Numbers) -> Ended:
    """Return the best fit of the whole run from a point near it."""
    point = start
    stride = max(1, len(problem.measurement.times) // _SAMPLES)
    few = 0 if problem.is_direct else len(problem.motions)   # the filtered residuals lead there from any point
    for first in (first for first in _FIRST_SLIPS if first < few):
        part = problem.stretches(first, stride)
        point = minimise(partial(problem.of_stretches, stretches=part), point, problem.low, problem.high, most=10,
                         tolerance=1.0, share=1e-3, robust=_ROBUST if first == 0 else np.inf).point
    solution = _fit_whole(problem, point, 60)
    if (better := _beyond_noise(problem, solution)) is not None:
        solution = _fit_whole(problem, better, 60)
    for _ in range(_TABLES):
        values = problem.values(solution.point)
        if not problem.model.take_tables_of(values) | problem.take_input_noise_of(values):
            break
        before = solution.cost
        solution = _fit_whole(problem, solution.point, 30)
        if abs(solution.cost - before) < 0.1:
            break
    return Ended(start, solution, solution.cost / effective_count(problem))


def _fit_whole(problem: FitProblem, point: Numbers, most: int) -> Solution:
    residuals = partial(problem.of_stretches, stretches=problem.stretches())
    return minimise(residuals, point, problem.low, problem.high, most=most, tolerance=1e-3, step=problem.steps)


def _beyond_noise(problem: FitProblem, found: Solution) -> Numbers | None:
    """Return a point that is better than where a fit ended, by a parameter whose derivative is that of noise.

    The sum of squares over such a one has steps, on which a fit comes to rest: its whole range is tried.
    """
    residuals = partial(problem.of_stretches, stretches=problem.stretches())
    best, cost = found.point, found.cost
    for k in np.flatnonzero(problem.steps > STEP):
        for number in np.linspace(problem.low[k], problem.high[k], _TRIED):
            trial = best.copy()
            trial[k] = number
            left = residuals(trial)
            if np.isfinite(left[0]) and float(left @ left) < cost:
                best, cost = trial, float(left @ left)
    return None if best is found.point else best


def effective_count(problem: FitProblem) -> float:
    """Return how many residuals there are, each counted by its weight."""
    return float(sum(channel.weights.sum() for channel in problem.measurement.channels))


def best_fit(ends: Iterator[Ended], progress: Progress) -> list[Ended]:
    """Return the ends of the fits that were made, the best first; others are tried only where the first is not good."""
    ended: list[Ended] = []
    progress('fit', 0.0)
    for k, end in enumerate(ends, 1):
        progress('fit', k / (1 + _FITTED_STARTS))
        ended.append(end)
        if end.mean_square < _GOOD:
            break
    return sorted(ended, key=lambda end: end.solution.cost)


def best_of_slips(problem: FitProblem, ends: Sequence[Ended]) -> list[Ended]:
    """Return the ends, before them the best fit of single slips where no fit of the whole run is near the data.

    A model that is not that of the axis still has the right rests and break-aways, each from a measured arrest; in the
    whole run its slips come ever more too late or too early, and the least sum of squares means nothing.
    """
    slips = [problem.clear_slips[k] for k in _spread(len(problem.clear_slips), _MOST_SLIPS)]
    if ends[0].mean_square < _LOST or len(slips) < _FEWEST_SLIPS:
        return [*ends]
    residuals = partial(problem.of_slips, slips=slips)
    found = [minimise(residuals, point, problem.low, problem.high, most=20, tolerance=1e-2, share=1e-4, robust=_ROBUST,
                      step=_COARSE_STEP, steepest=_STEEPEST) for point in (ends[0].start, ends[0].solution.point)]
    best = min(found, key=lambda solution: solution.cost)
    whole = problem.of_stretches(best.point, problem.stretches())
    if not np.isfinite(whole).all():
        return [*ends]
    figures = residuals(best.point)
    cost = float(whole @ whole)
    return [Ended(ends[0].start, best._replace(cost=cost), cost / effective_count(problem),
                  float(figures @ figures) / len(figures)), *ends]


def _cost(residuals: Numbers) -> float:
    return float(np.sum(np.sqrt(1.0 + residuals**2) - 1.0)) if np.isfinite(residuals).all() else np.inf


def _spread(count: int, most: int) -> list[int]:
    """Return at most so many whole numbers below a count, the first and the last among them."""
    if not count:
        return []
    return sorted(set(np.linspace(0, count - 1, min(count, most)).round().astype(int).tolist()))


def _distinct(points: list[Numbers], problem: FitProblem) -> list[Numbers]:
    """Return points without those that are near one before."""
    kept: list[Numbers] = []
    for point in points:
        if all(np.abs((point - other) / (problem.high - problem.low)).max() > 1e-2 for other in kept):
            kept.append(point)
    return kept
