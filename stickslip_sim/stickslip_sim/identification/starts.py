# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Points from which the whole run may be fitted: where the figures of single slips are best, from many trials.

What the readings say by themselves is taken from them first: spring and damper from the measured force, static friction
from the break-aways.
"""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ..core.arrays import Numbers
from .direct import friction_at_break_aways, static_residuals
from .fit_problem import FitProblem
from .free_parameters import Region
from .least_squares import Solution, minimise, robust_cost
from .slip_features import MeasuredSlip

N_STARTS, N_WHOLE = 8, 2   # fitted of the trial points, the best by figures of slips and by the whole run
ROBUST = 3.0            # figures of slips: beyond, a coarse fit counts their size
_COARSE_STEP = 1e-5
_STEEPEST = 1e4          # figures of slips over a logarithm: a hundred times in proportion
_ASIDE = 0.2             # of a number, or of its range: so far off friction at rest may be
_TRIALS = 256           # points beside the given one, a power of two
_TRIAL_SLIPS = 5        # at each of them
_SLIPS = 10             # at most, for the coarse fit
_NEAR = 3.0             # of the cost of a slip, in the mean: a start that is fitted before others are tried
_KEPT = 0.5, 0.8        # of the slips, in turn; in the last also those whose cost is not far above the median
_FAR_OFF = 4.0
_APART = 1e-2           # of the widths of the ranges: nearer points are one start


def starts_of(problem: FitProblem, seed: int) -> Iterator[Numbers]:
    """Yield points to start from, by the figures of single slips: from the given start, then from many others.

    Under a force that drives the slider by itself what it shows directly comes first, and then few others: those from
    which the whole run is nearest.
    """
    begin, places = _direct(problem)
    if problem.is_direct:
        yield begin
        others = _nearest(problem, _trials_beside(problem, begin, seed))
        yield from _distinct([begin, *others], problem)[1:]
        return
    chosen = _spread_slips(problem, _SLIPS)
    first = _coarse(problem, begin, chosen)
    is_near = first.cost < _NEAR * len(chosen)
    if is_near:
        yield first.point
    trials = _trials(problem, problem.region.holding(places, begin[places]), seed)
    few = _spread_slips(problem, _TRIAL_SLIPS)
    costs = [robust_cost(problem.of_slips(trial, few)) for trial in trials]
    found = [first, *(_coarse(problem, trials[k], chosen) for k in np.argsort(costs)[:N_STARTS])]
    found.sort(key=lambda solution: solution.cost)
    points = [*(solution.point for solution in found), *_nearest(problem, trials)]
    yield from _distinct([first.point, *points], problem)[1:] if is_near else _distinct(points, problem)


def _trials(problem: FitProblem, held: Region, seed: int) -> list[Numbers]:
    """Return trial points all over the region, in turn with those in a part of it that is `held`."""
    return [problem.region.inside(problem.with_direct((held if k % 2 else problem.region).at(share)))
            for k, share in enumerate(_shares(problem, seed))]


def _trials_beside(problem: FitProblem, begin: Numbers, seed: int) -> list[Numbers]:
    """Return trial points that differ from what a measured force shows in friction at rest, which it shows least."""
    names = [one.name for one in problem.parameters]
    far = np.array([_ASIDE if name.startswith('friction.static.') or name.endswith('.initial') else 0.0
                    for name in names]) * np.where([one.logarithmic for one in problem.parameters], 1.0, problem.widths)
    return [problem.region.inside(begin + far * (2.0 * share - 1.0)) for share in _shares(problem, seed)]


def _shares(problem: FitProblem, seed: int) -> Numbers:
    """Return points (256, k) spread evenly over a cube."""
    from scipy.stats import qmc  # takes half a second, and most runs need no other start

    return np.asarray(qmc.Sobol(len(problem.start), seed=seed).random(_TRIALS))


def _nearest(problem: FitProblem, trials: Sequence[Numbers]) -> list[Numbers]:
    """Return the few trial points from which the whole run is nearest."""
    whole = problem.of_run()
    return sorted(trials, key=lambda trial: robust_cost(whole(trial)))[:N_WHOLE]


def _spread_slips(problem: FitProblem, most: int) -> list[MeasuredSlip]:
    """Return at most so many of the slips whose begin is known, the first and the last among them."""
    count = len(problem.clear_slips)
    rows = np.linspace(0, max(count - 1, 0), min(count, most)).round().astype(int)
    return [problem.clear_slips[k] for k in sorted(set(rows.tolist()))]


def _direct(problem: FitProblem) -> tuple[Numbers, list[int]]:
    """Return the given start with what the readings say by themselves, and the places of static friction in it."""
    point = problem.region.inside(problem.nearest_start)
    places = [k for k, one in enumerate(problem.parameters) if one.name.startswith('friction.static.')]
    measured = [one for one in friction_at_break_aways(problem.model, problem.values(point), problem.measurement,
                                                       problem.clear_slips) if one.coefficient > 0.0]
    if not places or not measured:
        return point, []

    def residuals(trial: Numbers) -> Numbers:
        return np.concatenate([static_residuals(problem.model, measured, problem.values(trial)),
                               problem.beforehand(trial)])

    others = [k for k in range(len(point)) if k not in places]   # what is known better must not go back
    region = problem.region.holding(others, point[others])
    return minimise(residuals, point, region, most=20, tolerance=1e-2, robust=ROBUST).point, places


def _coarse(problem: FitProblem, start: Numbers, slips: Sequence[MeasuredSlip]) -> Solution:
    """Return where the figures of slips are best, from a start on: first without the worst, then without those far off.

    What was taken for a slip may be none, and a slip that is another one from a point on bars the way with a step.
    """
    found = Solution(start, np.inf, np.eye(len(start)), True)
    if not slips:
        return found
    for kept in _KEPT:
        costs = np.array([robust_cost(problem.of_slips(found.point, [slip])) for slip in slips])
        limit = max(float(np.quantile(costs, kept)), _FAR_OFF * float(np.median(costs)) if kept == _KEPT[-1] else 0.0)
        near = [slip for slip, cost in zip(slips, costs) if cost <= limit]
        found = minimise(partial(problem.of_slips, slips=near), found.point, problem.region, most=20,
                         tolerance=1e-2, share=1e-4, robust=ROBUST, step=_COARSE_STEP, steepest=_STEEPEST)
    return found._replace(cost=robust_cost(problem.of_slips(found.point, slips)))


def _distinct(points: list[Numbers], problem: FitProblem) -> list[Numbers]:
    """Return points without those that are near one before."""
    kept: list[Numbers] = []
    for point in points:
        if all(np.abs((point - other) / problem.widths).max() > _APART for other in kept):
            kept.append(point)
    return kept
