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

from ..core.arrays import Numbers
from .certainty import certainty_of, is_rejected
from .direct import friction_at_break_aways, static_residuals
from .fit_problem import FitProblem, Stretches
from .free_parameters import Region
from .least_squares import STEP, Solution, informed, minimise, robust_cost, square_cost, steps_over_jumps
from .motions import MeasuredMotion
from .slip_features import MeasuredSlip

# Points from which the whole run may be fitted: where the figures of single slips are best, from many trials.
#
# What the readings say by themselves is taken from them first: spring and damper from the measured force, static
# friction from the break-aways.

N_TRIALS = 256              # points beside the given one, a power of two
N_STARTS, N_WHOLE = 8, 2   # fitted of them, the best by figures of slips and by the whole run
ROBUST = 3.0            # figures of slips: beyond, a coarse fit counts their size
_COARSE_STEP = 1e-5
_STEEPEST = 1e4          # figures of slips over a logarithm: a hundred times in proportion
_TRIAL_SLIPS = 5        # at each of them
_SLIPS = 10             # at most, for the coarse fit
_NEAR_START = 3.0             # of the cost of a slip, in the mean: a start that is fitted before others are tried
_KEPT = 0.5, 0.8        # of the slips, in turn; in the last also those whose cost is not far above the median
_FAR_OFF = 4.0
_APART = 1e-2           # of the widths of the ranges: nearer points are one start


def starts_of(problem: FitProblem, seed: int) -> Iterator[Numbers]:
    """Yield points to start from, by the figures of single slips: from the given start, then from many others.

    Under a force that drives the slider by itself it is what that shows directly.
    """
    begin, places = _direct(problem)
    if problem.is_direct:
        yield begin
        return
    chosen = _spread_slips(problem, _SLIPS)
    first = _coarse(problem, begin, chosen)
    is_near = first.cost < _NEAR_START * len(chosen)
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


def _shares(problem: FitProblem, seed: int) -> Numbers:
    """Return points (256, k) spread evenly over a cube."""
    from scipy.stats import qmc  # takes half a second, and most runs need no other start

    return np.asarray(qmc.Sobol(len(problem.start), seed=seed).random(N_TRIALS))


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
                         tolerance=1e-2, share=1e-4, robust=ROBUST, step=_COARSE_STEP, steepest=_STEEPEST,
                         informs=False)
    return found._replace(cost=robust_cost(problem.of_slips(found.point, slips)))


def _distinct(points: list[Numbers], problem: FitProblem) -> list[Numbers]:
    """Return points without those that are near one before."""
    kept: list[Numbers] = []
    for point in points:
        if all(np.abs((point - other) / problem.widths).max() > _APART for other in kept):
            kept.append(point)
    return kept


StageProgress = Callable[[str, float], None]

_SAMPLES = 4000         # about so many are enough until the last stage
_FIRST_SLIPS = 1, 3, 8, 20, 50   # that are fitted as one, before the whole run
_FIRST_STEPS, _MOST_STEPS = 10, 60   # before it is looked whether a jump holds the fit, and at all
_NEARER = 10.0          # of the sum of squares: so much nearer a finer table must be,
_MOVES = 0.3            # or so far, in standard deviations, move a number
_ROUNDS, _GAIN = 4, 0.1 # of further fits at most, and what each must gain
_FINER, _FINEST = 1 / 256, 1e-7   # times the tolerance of a table: a sixteenth of its steps; and a tolerance
_BESIDE = 0.01, 0.02, 0.04, 0.08   # of a number, or of its range
_FEW_STEPS = 4          # of a fit of the others beside it
_TRIED = 40             # values of a parameter over its range
_COARSER = 1.0, 1.0, 1.33, 1.6   # times the tolerance of a table that is held, in rounds
_NEAR = 1e4             # a mean square up to which a table may bar the way in any case
_JUMPS = 4.0            # of a derivative squared: by so much differences on both sides are larger at a jump
_FAR = 0.5              # of the sum of squares: so much it must gain far from the run
_OFF, _TIMES_OFF = 4.0, 100.0    # a mean square of a stretch: of 2 % of a slip, and of the median of all
_GOOD = 1.2             # a mean square up to that
_LOST = 100.0           # a mean square from which on the whole run is not followed


class Ended(NamedTuple):
    """A start, and where the fit from it ended: one that `is_off` is rejected by a test, one that `is_lost` by far.

    `tolerance` is that of the table of its smooth kinetic law, where it is finer than that of the scene.
    `of_slips` has the mean square of the figures of single slips where these alone were fitted (`best_of_slips`); one
    that `is_along` the run was moved to where the position follows it (`along_the_run`).
    """

    start: Numbers
    solution: Solution
    is_off: bool
    is_lost: bool
    tolerance: float | None = None
    of_slips: float | None = None
    is_along: bool = False


def fit_from(problem: FitProblem, start: Numbers) -> Ended:
    """Return the best fit of the whole run from a point near it."""
    if problem.is_direct:   # the filtered residuals lead there, from any point where it breaks away as it did
        return _whole_from(problem, start, start)
    ended = _whole_from(problem, start, _nearer(problem, start))
    ahead = _ahead(problem, start) if ended.is_lost else None
    if ahead is None:
        return ended
    return min(ended, _whole_from(problem, start, ahead), key=lambda end: end.solution.cost)


def _whole_from(problem: FitProblem, start: Numbers, point: Numbers) -> Ended:
    """Return the best fit of the whole run near a point, to which a start has led."""
    problem.model.take_tolerance(None)
    problem.take_input_noise_of(problem.values(point))
    if (better := _beyond_noise(problem, point)) is not None:
        point = better
        problem.take_input_noise_of(problem.values(point))
    solution = _of_whole(problem, point)
    if (better := _beyond_noise(problem, solution.point)) is not None:
        solution = _of_whole(problem, better)
    for _ in range(_ROUNDS):
        if (better := _beside(problem, solution)) is None:
            break
        solution = _of_whole(problem, better)
    for _ in range(_ROUNDS):
        before = solution.cost
        if not problem.take_input_noise_of(problem.values(solution.point)):
            break
        solution = _of_whole(problem, solution.point)
        if abs(solution.cost - before) < _GAIN:
            break
    return _by_finer_table(problem, _ended(problem, start, _polished(problem, solution)))


def _by_finer_table(problem: FitProblem, ended: Ended) -> Ended:
    """Return the fit with a finer table of a smooth law, where it is nearer to the run or moves the numbers.

    The table of the scene may leave more out of the law than a sensor sees, or than an interval is wide.
    """
    tolerance, before = problem.model.tolerance, ended.solution
    if tolerance is None or tolerance <= _FINEST or not _is_near(problem, before.point):
        return ended
    finer = max(_FINER * tolerance, _FINEST)
    problem.model.take_tolerance(finer)
    solution = _polished(problem, _of_whole(problem, before.point))
    if _makes_a_difference(problem, before, solution):
        return _ended(problem, ended.start, solution)._replace(tolerance=finer)
    problem.model.take_tolerance(None)
    return ended


def _makes_a_difference(problem: FitProblem, before: Solution, after: Solution) -> bool:
    """Return whether a fit is nearer to the run than the one before, or as near with other numbers."""
    deviations = certainty_of(before.information, 1.0, problem.parameters).deviations
    moves = float(np.max(np.abs(after.point - before.point) / deviations))
    return after.cost < before.cost - _NEARER or (moves > _MOVES and after.cost < before.cost + _NEARER)


def _ended(problem: FitProblem, start: Numbers, solution: Solution) -> Ended:
    """Return the end of a fit, its derivatives central: where that raises one by far, a jump is on the other side."""
    residuals, before = problem.of_run(), np.diag(solution.information)
    solution = informed(residuals, solution, problem.region)
    if problem.model.is_pushed and np.any(np.diag(solution.information) > _JUMPS * before):
        steps = steps_over_jumps(residuals, solution, problem.region, solution.step)
        solution = informed(residuals, _of_whole(problem, solution.point, steps), problem.region)
    return Ended(start, solution, is_rejected(problem, solution.point), is_lost(problem, solution.point))


def _is_near(problem: FitProblem, point: Numbers) -> bool:
    """Return whether what is off may be by the table of a smooth law."""
    return worst_square(problem, point) <= _NEAR or not is_lost(problem, point)


def _nearer(problem: FitProblem, start: Numbers) -> Numbers:
    """Return a point from which the whole run may be fitted: by single slips, then by ever more of them as one."""
    stride = max(1, len(problem.measurement.times) // _SAMPLES)
    single = problem.stretches(0, stride)
    near = problem.stretches(0, stride, _not_followed(problem, start, single))
    point = _fitted_to(problem, start, near, ROBUST).point
    wrong = _not_followed(problem, point, single)
    for first in (first for first in _FIRST_SLIPS if first < len(problem.motions)):
        point = _fitted_to(problem, point, problem.stretches(first, stride, wrong), np.inf).point
    return point


def _ahead(problem: FitProblem, start: Numbers) -> Numbers | None:
    """Return such a point by ever more slips from the start of the run on, and nothing else; None where one is lost.

    Where a contact rings on, what was taken for rests is none, and leads away from the best fit.
    """
    stride, point = max(1, len(problem.measurement.times) // _SAMPLES), start
    problem.model.take_tolerance(None)
    for first in (first for first in _FIRST_SLIPS if first < len(problem.motions)):
        part = problem.stretches(first, stride, problem.motions)
        point = _fitted_to(problem, point, part, np.inf).point
        if is_lost(problem, point, part):
            return None
    return point


def _of_whole(problem: FitProblem, start: Numbers, steps: Numbers | None = None) -> Solution:
    residuals, steps, measured = problem.of_run(), problem.steps if steps is None else steps, problem.measurement
    search = partial(minimise, residuals, region=problem.region, tolerance=1e-3, informs=False,
                     far=max(_NEAR, *_lost_from(problem)) * len(measured.times) * len(measured.channels))
    most = _FIRST_STEPS if problem.model.is_pushed else _MOST_STEPS
    found = search(start, step=steps, most=most)
    while problem.model.is_pushed:
        before, steps = steps, steps_over_jumps(residuals, found, problem.region, steps)
        if np.array_equal(steps, before) and (found.is_settled or most == _MOST_STEPS):
            break
        most = _MOST_STEPS
        found = search(found.point, step=steps, most=most)
    return found


def _polished(problem: FitProblem, found: Solution) -> Solution:
    """Return a better end of a fit that has not come to rest, or follows the run but is not good.

    One that does not follow it goes on as long as each round gains by far.
    The table of a smooth law has now and then a breakpoint more or less, a step that bars the way: held as it is, it
    lets the fit by.  Where the breakpoints themselves make a minimum, those of a coarser table do not.
    """
    for coarser in _COARSER:
        square, lost = worst_square(problem, found.point), is_lost(problem, found.point)
        if found.is_settled and (square < _GOOD or not _is_near(problem, found.point)):
            break
        has_table = problem.model.hold_table(problem.values(found.point), coarser)
        again = _of_whole(problem, found.point)
        is_settled = again.is_settled
        if has_table:
            problem.model.hold_table(None)
            again = _of_whole(problem, again.point)
        gained = found.cost - again.cost
        if gained > 0.0:
            found = again
        if gained < (_FAR * found.cost if lost else _GAIN):
            found = found._replace(is_settled=is_settled or found.is_settled)
            if not has_table or square < _GOOD or not _is_near(problem, found.point):
                break
    return found


def worst_square(problem: FitProblem, point: Numbers) -> float:
    """Return the mean square of the weighted residuals of the whole run, of the channel where it is the largest."""
    return float(np.max(_mean_squares(problem, point, problem.stretches())))


def is_lost(problem: FitProblem, point: Numbers, part: Stretches | None = None) -> bool:
    """Return whether a fit does not follow the whole run, or a part: beside the noise, and beside a slip."""
    return bool(np.any(_mean_squares(problem, point, part or problem.stretches()) >= _lost_from(problem)))


def _lost_from(problem: FitProblem) -> list[float]:
    """Return the mean square of each channel from which on it is not followed."""
    return [max(_LOST, (problem.roughly(channel) / channel.resolution)**2) for channel in problem.measurement.channels]


def _mean_squares(problem: FitProblem, point: Numbers, part: Stretches) -> Numbers:
    """Return the mean square of the weighted residuals of a part of the run, of each channel (c,)."""
    channels = problem.measurement.channels
    residuals = problem.of_channels(point, part)
    squares = np.array([own @ own / channel.weights[part.rows].sum()
                        for own, channel in zip(residuals, channels, strict=True)])
    return np.where(np.isfinite(squares), squares, np.inf)


def _fitted_to(problem: FitProblem, start: Numbers, part: Stretches, robust: float) -> Solution:
    return minimise(partial(problem.of_stretches, stretches=part), start, problem.region, most=10, tolerance=1.0,
                    share=1e-3, robust=robust, informs=False)


def _not_followed(problem: FitProblem, point: Numbers, single: Stretches) -> list[MeasuredMotion]:
    """Return the motions after which a stretch is far off while most are near: what ended there was no rest."""
    squares = problem.mean_squares(point, single)
    limit = max(_OFF, _TIMES_OFF * float(np.median(squares)))
    return [part.before for part, square in zip(single.parts, squares) if part.before is not None and square > limit]


def _beyond_noise(problem: FitProblem, point: Numbers) -> Numbers | None:
    """Return a point that is better than one, by a parameter whose derivative is that of noise.

    The sum of squares over such a one has steps, on which a fit comes to rest: its whole range is tried, and then what
    is about the best.
    """
    residuals, best = problem.of_run(), point
    cost = square_cost(residuals(point))
    for k in np.flatnonzero(problem.steps > STEP):
        low, high = problem.region.low[k], problem.region.high[k]
        for _ in range(2):
            for number in np.linspace(low, high, _TRIED):
                trial = problem.region.holding(int(k), float(number)).inside(best)
                there = square_cost(residuals(trial))
                if there < cost:
                    best, cost = trial, there
            step = (high - low) / (_TRIED - 1)
            low, high = max(best[k] - step, low), min(best[k] + step, high)
    return None if best is point else best


def _beside(problem: FitProblem, found: Solution) -> Numbers | None:
    """Return a point that is better than where a fit ended, by such a parameter a little off and all others with it.

    Where single break-aways hold a number, its neighbours seem worse until the others have followed.
    """
    residuals, best = problem.of_run(), found
    for k in np.flatnonzero(problem.steps > STEP):
        for share in (*_BESIDE, *(-share for share in _BESIDE)):
            number = found.point[k] + share * (1.0 if problem.parameters[k].logarithmic else problem.widths[k])
            if not problem.region.low[k] <= number <= problem.region.high[k]:
                continue
            trial = minimise(residuals, found.point, problem.region.holding(int(k), float(number)), most=_FEW_STEPS,
                             tolerance=1.0, share=1e-3, step=problem.steps, informs=False)
            if trial.cost < best.cost - _NEARER:
                best = trial
    return None if best is found else best.point


def best_fit(ends: Iterator[Ended], progress: StageProgress) -> list[Ended]:
    """Return the ends of the fits that were made, the best first; others are tried while a test rejects each."""
    ended: list[Ended] = []
    progress('fit', 0.0)
    for k, end in enumerate(ends, 1):
        progress('fit', k / (1 + N_STARTS))
        ended.append(end)
        if not end.is_off:
            break
    return sorted(ended, key=lambda end: end.solution.cost)
