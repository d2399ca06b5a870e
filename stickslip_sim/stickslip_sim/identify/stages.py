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
from scipy.stats import qmc

from .least_squares import Solution, minimise
from .problem import FitProblem
from .slip_features import MeasuredSlip

Numbers = NDArray[np.float64]
Progress = Callable[[str, float], None]

_STARTS = 64            # trial points beside the given one, a power of two
_TRIAL_SLIPS = 3        # at each of them
_FITTED_STARTS = 4      # of them, the best
_SLIPS = 10             # at most, for the coarse fit
_SAMPLES = 4000         # about so many are enough until the last stage
_LENGTHS = 1, 4, 16     # slips a stretch, before the whole run
_GOOD = 1.5             # a mean square up to that, and no other start is tried
_COARSE_STEP = 1e-5
_ROBUST = 3.0           # figures of slips: beyond, a coarse fit counts their size


class Ended(NamedTuple):
    """A start, where the fit from it ended, and the mean square of the residuals of the whole run there."""

    start: Numbers
    solution: Solution
    mean_square: float


def starts_of(problem: FitProblem, seed: int) -> Iterator[Numbers]:
    """Yield points to start from, by the figures of single slips: from the given start, then from many others."""
    chosen = [problem.slips[k] for k in _spread(len(problem.slips), _SLIPS)]
    first = _coarse(problem, problem.with_direct(problem.start), chosen)
    yield first.point
    few = [problem.slips[k] for k in _spread(len(problem.slips), _TRIAL_SLIPS)]
    shares = qmc.Sobol(len(problem.start), seed=seed).random(_STARTS)
    trials = [problem.with_direct(trial) for trial in problem.low + shares * (problem.high - problem.low)]
    costs = [_cost(problem.of_slips(trial, few)) for trial in trials]
    found = [first, *(_coarse(problem, trials[k], chosen) for k in np.argsort(costs)[:_FITTED_STARTS])]
    found.sort(key=lambda solution: solution.cost)
    yield from (point for point in _distinct([first.point, *(solution.point for solution in found)], problem)[1:])


def _coarse(problem: FitProblem, start: Numbers, slips: Sequence[MeasuredSlip]) -> Solution:
    if not slips:
        return Solution(problem.with_direct(start), np.inf, np.eye(len(start)), True)
    return minimise(partial(problem.of_slips, slips=slips), start, problem.low, problem.high, most=30, tolerance=1e-2,
                    share=1e-4, robust=_ROBUST, step=_COARSE_STEP)


def fit_from(problem: FitProblem, start: Numbers) -> Ended:
    """Return the best fit of the whole run from a point near it."""
    count = len(problem.measurement.times)
    point = start
    stride = max(1, count // _SAMPLES)
    for length in _LENGTHS:
        if length < max(len(problem.motions), 2):
            part = problem.stretches(length, stride)
            point = minimise(partial(problem.of_stretches, stretches=part), point, problem.low, problem.high, most=10,
                             tolerance=1.0, share=1e-3, robust=problem.far()).point
    whole = problem.stretches(0)
    solution = minimise(partial(problem.of_stretches, stretches=whole), point, problem.low, problem.high, most=60,
                        tolerance=1e-3)
    return Ended(start, solution, solution.cost / effective_count(problem))


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
