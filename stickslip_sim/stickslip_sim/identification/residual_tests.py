# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Tests that reject a model which does not fit: by the size of its residuals, as a whole and stretch by stretch.

The noise of a sensor is known from its own readings, neighbour by neighbour, without any model.  Residuals that are
larger than that, or of which a part goes together from sample to sample where the noise does not, are the model's.
That part, too, counts by its size: beside the noise, and beside the motion, for what is neither seen by the sensor nor
matters for the motion rejects no model.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaincinv

from ..core.arrays import Numbers
from ..report.quantity import quantity
from .certainty import changes_by_inputs, more_by_inputs
from .fit_problem import FitProblem, MeasuredStretch
from .identified import Misfit
from .readings import Channel

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
