# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How well a fit knows its parameters, and whether it fits: intervals, combinations that are free, and tests.

Covariance: (JᵀJ)⁻¹ of the weighted derivatives, times what the residuals of a channel go together for.  Combinations:
right singular vectors of J whose singular value is so small that the data leave the parameters anywhere in their
ranges along them.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaincinv

from ..core.arrays import Numbers
from ..report.quantity import quantity
from .fit_problem import FitProblem, MeasuredStretch
from .free_parameters import FreeParameter
from .identified import FOUND, LEVEL, NOT_IDENTIFIABLE, Combination, Estimate, Misfit
from .least_squares import STEP, Solution, minimise, slopes_of, square_cost
from .readings import Channel

QUANTILE = 2.0 * float(gammaincinv(0.5, LEVEL))   # of the rise of the sum of squares at the ends of an interval
_LOST = 0.3      # of the range of a parameter: a standard deviation so large says nothing
_PART = 0.1      # of the largest weight: below, a parameter has no part in a combination
_ROUNDING = 1e-10   # of JᵀJ with a diagonal of 1: what its derivatives, differences, are exact to


class Certainty(NamedTuple):
    """The covariance (k, k) of what the fit works on, and which parameters (k,) the data determine."""

    covariance: Numbers
    known: NDArray[np.bool_]

    @property
    def deviations(self) -> Numbers:
        """The standard deviations (k,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @property
    def correlation(self) -> Numbers:
        """The correlation (k, k); NaN with parameters that the data do not determine."""
        deviations = np.where(self.known, self.deviations, np.nan)
        return np.asarray(self.covariance / np.outer(deviations, deviations))


def certainty_of(information: Numbers, inflation: float, parameters: Sequence[FreeParameter]) -> Certainty:
    """Return what JᵀJ (k, k) of all residuals says; `inflation` is the factor on the covariance."""
    moves = np.diag(information) > 0.0   # not what is held
    scale = np.sqrt(np.where(moves, np.diag(information), 1.0))
    widths = np.array([one.width for one in parameters])
    sizes, vectors = np.linalg.eigh(information / np.outer(scale, scale))
    covariance = np.zeros_like(information)
    for size, way in zip(sizes, (vectors / scale[:, None]).T):
        if size > _ROUNDING:
            covariance += inflation / size * np.outer(way, way)
        elif moves[np.abs(way / widths).argmax()]:    # anywhere in the ranges along it
            far = way / np.abs(way / widths).max()
            covariance += np.outer(far, far)
    return Certainty(covariance, moves & (np.sqrt(np.diag(covariance)) < _LOST * widths))


def combinations_of(information: Numbers, parameters: Sequence[FreeParameter]) -> tuple[Combination, ...]:
    """Return what JᵀJ (k, k) of the measured channels leaves free."""
    squares, turned = np.linalg.eigh(information)
    rounding = _ROUNDING * np.diag(information) @ turned**2
    sizes, vectors = np.sqrt(np.where(squares > rounding, squares, 0.0)), turned.T
    widths = np.array([one.width for one in parameters])
    found = []
    for size, vector in zip(sizes, vectors):
        weights = vector / vector[np.abs(vector).argmax()]
        reach = float(np.min(widths / np.maximum(np.abs(weights), 1e-9)))
        length = float(np.linalg.norm(weights))
        spread = length**-1 / size if size > 0.0 else np.inf
        if spread < _LOST * reach:
            continue
        rows = [k for k in np.argsort(-np.abs(weights), kind='stable') if abs(weights[k]) >= _PART]
        names = tuple(parameters[k].name for k in rows)
        powers = tuple(_plain(float(weights[k])) for k in rows)
        found.append(Combination(names, powers, spread, _statement(names, powers)))
    return tuple(found)


def _plain(weight: float) -> float:
    """Return a weight, as a simple ratio where it is one but for noise."""
    near = round(6.0 * weight) / 6.0
    return round(near if abs(weight - near) < 0.02 else weight, 3)


def _statement(names: Sequence[str], powers: Sequence[float]) -> str:
    if len(names) == 1:
        return f'the data do not determine {names[0]}'
    if all(power == powers[0] for power in powers):
        return f'the data determine only the ratios of {", ".join(names[:-1])} and {names[-1]}: all may be larger by ' \
               'one factor'
    together = ', '.join(f'{name} to the power {power:g}' for name, power in zip(names, powers))
    return f'the data do not change with one factor on all of: {together}'


# How far off the parameters, and the residuals, may be by the noise in measured inputs.
#
# An input is measured once, and its error is in the whole fit.  So its sensor is let read it again, a few times.  The
# size of the change in the residuals is what they may have beyond the noise of their own sensors; the fit goes along by
# (JᵀJ)⁻¹ Jᵀ of the change, and the spread of that is the covariance.

_TIMES = 16   # the standard deviation is known to a fifth


def changes_by_inputs(problem: FitProblem, point: Numbers) -> list[Numbers]:
    """Return how the residuals (n,) of the whole run change at each reading of inputs that no filter takes care of."""
    if problem.model.is_pushed or not problem.model.has_readings:
        return []
    stretches, random = problem.stretches(), np.random.default_rng(0)
    here = problem.of_stretches(point, stretches)
    again = [problem.with_inputs_read_again(random).of_stretches(point, stretches) for _ in range(_TIMES)]
    return [there - here for there in again if np.isfinite(there[0])]


def more_by_inputs(problem: FitProblem, changes: list[Numbers]) -> Numbers:
    """Return the factor (c,) on the mean square of the residuals of each channel, that of its own sensor being 1."""
    channels, count = problem.measurement.channels, len(problem.measurement.times)
    if not changes:
        return np.ones(len(channels))
    squares = np.mean(np.square(changes), axis=0)
    return np.array([1.0 + float(squares[k * count:(k + 1) * count].sum() / channel.weights.sum())
                     for k, channel in enumerate(channels)])


def covariance_by_inputs(problem: FitProblem, best: Solution, changes: list[Numbers]) -> Numbers:
    """Return the covariance (k, k) of what the fit works on, from the changes of the residuals."""
    if not changes:
        return np.zeros((len(best.point), len(best.point)))
    residuals = problem.of_run()
    slopes = slopes_of(residuals, best.point, residuals(best.point), problem.region, STEP)
    scales = np.outer(*2 * [np.sqrt(np.diag(best.information))])
    moves = np.array(changes) @ slopes @ (np.linalg.pinv(best.information / scales, hermitian=True) / scales)
    return np.asarray(moves.T @ moves / len(changes))


# Profile intervals: how far a parameter may go before the best fit of all the others is worse than chance makes it.
#
# Where the sum of squares is a parabola this is the interval of the covariance.  So the profile is computed only where
# it is none: where the sum of squares at an end of that interval differs from what the parabola says, where the
# interval is cut by the range, and where the data do not determine the parameter by itself.

_DIFFERS = 0.2       # of the rise of the sum of squares at an end: so far a parabola may be off
_TOUCHES = 1e-6      # of a range
_NEAR = 0.02         # of the score: so well an end is found
_STEEP = 3.0         # a score from which on the interval is halved, as where the range of another parameter ends
_FITS = 20           # at most for an end
_WIDE = 0.6          # of a range: a number whose interval is as wide is not known
_FIRST = 0.1         # of the range: the first step, at most
_FARTHER = 2.0       # times, at most, from one step to the next


class _Place(NamedTuple):
    """A value of the fixed parameter, as the fit sees it: its score, and the best point (k,) there.

    The score is the root of the rise of the sum of squares over that at the ends of an interval: 1 is an end.
    """

    at: float
    score: float
    point: Numbers


class Profile:
    """The sum of squares over one parameter, `k`, the others fitted; from the best fit of the whole run."""

    def __init__(self, problem: FitProblem, best: Solution, known: Certainty, inflation: float, k: int) -> None:
        self._problem, self._best, self._k = problem, best, k
        self._residuals = problem.of_run()
        self._limit = QUANTILE * inflation
        self._slope = known.covariance[:, k] / known.covariance[k, k]
        self._reach = float(np.sqrt(QUANTILE) * known.deviations[k])

    def needs(self) -> bool:
        """Return whether the parabola does not hold at an end of the interval of the covariance, within the range."""
        low, high = self._problem.region.low[self._k], self._problem.region.high[self._k]
        margin = _TOUCHES * (high - low)
        for side in (-1.0, 1.0):
            end = self._best.point[self._k] + side * self._reach
            if not low + margin < end < high - margin:
                return True
            point = self._moved(_Place(self._best.point[self._k], 0.0, self._best.point), end)
            rise = self._cost(point) - self._best.cost
            if not abs(rise - self._limit) <= _DIFFERS * self._limit:
                return True
        return False

    def interval(self) -> tuple[float, float]:
        """Return the ends, in the unit of the parameter."""
        one = self._problem.parameters[self._k]
        return one.outer(self._end(-1.0)), one.outer(self._end(1.0))

    def _end(self, side: float) -> float:
        """Return where the score is 1 on a side: by the secant of the score, which is nearly a straight line."""
        begin = float(self._best.point[self._k])
        region = self._problem.region
        bound = float((region.low if side < 0.0 else region.high)[self._k])
        width = float(region.high[self._k] - region.low[self._k])
        inside, outside = _Place(begin, 0.0, self._best.point), None
        step = min(self._reach, _FIRST * width)
        for _ in range(_FITS):
            if outside is not None:
                if abs(outside.at - inside.at) < _NEAR * abs(outside.at - begin):
                    break
                share = (1.0 - inside.score) / (outside.score - inside.score) if outside.score < _STEEP else 0.5
                at = inside.at + min(max(share, 0.1), 0.9) * (outside.at - inside.at)
            else:
                at = inside.at + side * step
                at = max(at, bound) if side < 0.0 else min(at, bound)
                if at == inside.at:
                    return bound
            place = self._fitted(at, inside)
            if abs(place.score - 1.0) < _NEAR:
                return at
            if place.score > 1.0:
                outside = place
                continue
            gone = abs(at - begin)
            wanted = gone / max(place.score, 1e-9) - gone
            inside, step = place, min(max(wanted, 0.1 * gone), _FARTHER * gone)
        return inside.at if outside is None else outside.at

    def _fitted(self, at: float, near: _Place) -> _Place:
        """Return the best fit with the parameter at a value, begun from the fit at another one."""
        region = self._problem.region.holding(self._k, at)
        begin = self._moved(near, at)
        if not np.isfinite(self._cost(begin)):
            begin = region.inside(near.point)
        cost, point = self._cost(begin), begin
        if np.isfinite(cost):
            found = minimise(self._residuals, begin, region, most=10, tolerance=1e-2 * self._limit, informs=False)
            cost, point = found.cost, found.point
        return _Place(at, float(np.sqrt(max(cost - self._best.cost, 0.0) / self._limit)), point)

    def _moved(self, near: _Place, at: float) -> Numbers:
        """Return a point with the parameter at a value, the others moved along as the covariance says."""
        return self._problem.region.holding(self._k, at).inside(near.point + (at - near.at) * self._slope)

    def _cost(self, point: Numbers) -> float:
        return square_cost(self._residuals(point))


def with_profile_intervals(estimates: Sequence[Estimate], problem: FitProblem, best: Solution, known: Certainty,
                           inflation: float) -> tuple[Estimate, ...]:
    """Return estimates with their profile intervals, where those of the covariance do not hold."""
    is_free = problem.region.low < problem.region.high
    profiles = [Profile(problem, best, known, inflation, k) if is_free[k] else None for k in range(len(estimates))]
    return tuple(_with(one, profile.interval() if profile and profile.needs() else None, parameter)
                 for one, profile, parameter in zip(estimates, profiles, problem.parameters, strict=True))


def _with(one: Estimate, profile: tuple[float, float] | None, parameter: FreeParameter) -> Estimate:
    """Return an estimate with its profile interval, if there is one; where that is wide, it was not found."""
    if profile is None:
        return one
    low, high, *ends = (parameter.inner(value) for value in (*profile, one.low, one.high))
    is_wide = one.kind == FOUND and high - low > _WIDE * (ends[1] - ends[0])
    return replace(one, profile=profile, kind=NOT_IDENTIFIABLE if is_wide else one.kind)

# Tests that reject a model which does not fit: by the size of its residuals, as a whole and stretch by stretch.
#
# The noise of a sensor is known from its own readings, neighbour by neighbour, without any model.  Residuals that are
# larger than that, or of which a part goes together from sample to sample where the noise does not, are the model's.
# That part, too, counts by its size: beside the noise, and beside the motion, for what is neither seen by the sensor
# nor matters for the motion rejects no model.

_TOGETHER = 1.5   # samples: below, the correlation is that of chance
_CHANCE = 1e-4       # of rejecting a model that is right
_SLACK = 1.15        # on a mean square: the noise is known only so well
_BY_INPUTS = 1.1     # of a mean square: more by the noise of inputs, whose residuals go together
_CORRELATED = 0.2    # of the square of the noise: the part of residuals that goes together
_MATTERS = 1e-5      # of the range of the readings: a smaller misfit is none
_EXACT = 1e-6        # of that range: no closer does a model know its axis, even where a sensor has no noise


def is_rejected(problem: FitProblem, point: Numbers) -> bool:
    """Return whether a test rejects the fit of the whole run at a point (k,)."""
    fitted = problem.fitted(point, problem.stretches())
    return fitted is None or bool(misfits_of_fit(problem, fitted,
                                                 more_by_inputs(problem, changes_by_inputs(problem, point))))


def misfits_of_fit(problem: FitProblem, fitted: Sequence[Numbers], more: Numbers | None = None) -> list[Misfit]:
    """Return the tests that a fit fails, of what each channel would have measured; `more` (c,) is that of each."""
    stretches, times = problem.stretches(0).parts, problem.measurement.times + problem.measurement.shift
    return [misfit for k, channel in enumerate(problem.measurement.channels)
            for misfit in misfits_of(channel, channel.values - fitted[k], problem.white(k, channel.values - fitted[k]),
                                     times, stretches, 1.0 if more is None else float(more[k]))]


def misfits_of(channel: Channel, residuals: Numbers, white: Numbers, times: Numbers,
               stretches: Sequence[MeasuredStretch], more: float = 1.0) -> list[Misfit]:
    """Return the tests that the residuals (n,) of a channel, in its unit, fail; `white` has what is new in each.

    They may be larger by the factor `more` in the mean square, by the noise of inputs, and go together then.
    """
    squares = channel.weights * (white / channel.resolution)**2 / more
    found = [_size(channel, residuals, squares, times, np.arange(len(times)), 1, 'mean square')]
    if more < _BY_INPUTS:
        found.append(_correlation(channel, white, times))
    if found[0] is not None:
        found += [_size(channel, residuals, squares, times, stretch.rows, len(stretches), 'mean square of a stretch')
                  for stretch in stretches]
    return [misfit for misfit in found if misfit is not None]


def correlation_length(residuals: Numbers, weights: Numbers) -> float:
    """Return how many samples in a row say what one does: 1 + 2 Σ ρ, up to where the correlation ρ is lost in noise."""
    own = _by_runs(residuals, weights)
    own = own - own.mean()
    power = float(own @ own)
    if power == 0.0:
        return 1.0
    total, least = 1.0, 2.0 / len(own)**0.5
    for lag in range(1, len(own) // 4):
        share = float(own[lag:] @ own[:-lag]) / power
        if share < least:
            break
        total += 2.0 * share
    return total


def _size(channel: Channel, residuals: Numbers, squares: Numbers, times: Numbers, rows: NDArray[np.intp], tests: int,
          name: str) -> Misfit | None:
    count = float(channel.weights[rows].sum())
    mean = float(squares[rows].sum()) / count
    limit = _SLACK * 2.0 * float(gammaincinv(0.5 * count, 1.0 - _CHANCE / tests)) / count
    off, span = float(np.sqrt(np.mean(residuals[rows]**2))), float(np.ptp(channel.values))
    if mean <= limit or off <= _MATTERS * span:
        return None
    begin, end = float(times[rows[0]]), float(times[rows[-1]])
    return Misfit(channel.name, name, mean, limit, begin, end,
                  f'{channel.name} is off by {quantity(off, channel.unit, 3)} (rms), {100.0 * off / span:.2g} % of its '
                  f'range, from {begin:.6g} to {end:.6g} s: {mean**0.5:.3g} times what the noise explains')


def _correlation(channel: Channel, residuals: Numbers, times: Numbers) -> Misfit | None:
    """Return the failure where a part of residuals goes together; a sensor that counts in steps makes them do so."""
    if channel.quantum > channel.resolution:
        return None
    own = residuals - residuals.mean()
    together = max(float(own[1:] @ own[:-1]), 0.0) / len(own)
    share, limit = together / channel.resolution**2, max(_CORRELATED, 4.0 / len(own)**0.5)
    if share <= limit or together**0.5 <= _MATTERS * float(np.ptp(channel.values)):
        return None
    return Misfit(channel.name, 'correlation of neighbours', share, limit, float(times[0]), float(times[-1]),
                  f'the residuals of {channel.name} are autocorrelated, so they are not sensor noise: '
                  f'{quantity(together**0.5, channel.unit, 3)} (rms), {share**0.5:.2g} times the noise')


def _by_runs(residuals: Numbers, weights: Numbers) -> Numbers:
    """Return the mean residual of each run of equal readings, in which each weighs 1/L."""
    lengths = np.rint(1.0 / weights).astype(int)
    rows, row = [], 0
    while row < len(lengths):
        rows.append(row)
        row += int(lengths[row])
    return np.asarray(np.add.reduceat(residuals * weights, rows))


def inflation_of(problem: FitProblem, fitted: Sequence[Numbers]) -> float:
    """Return the factor on the covariance: what residuals are larger than the noise, and go together, of the worst.

    Readings without noise know no number better than the model is one: its tables of smooth laws are no closer.
    """
    factors = [1.0, max((_EXACT * float(np.ptp(channel.values)) / channel.resolution)**2
                        for channel in problem.measurement.channels)]
    for k, channel in enumerate(problem.measurement.channels):
        residuals = problem.white(k, channel.values - fitted[k])
        mean = float((channel.weights * residuals**2).sum() / channel.weights.sum()) / channel.resolution**2
        length = correlation_length(residuals, channel.weights)
        factors.append(mean * (length if length > _TOGETHER else 1.0))
    return max(factors)
