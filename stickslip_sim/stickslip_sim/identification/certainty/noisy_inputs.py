# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How far off the parameters, and the residuals, may be by the noise in measured inputs.

An input is measured once, and its error is in the whole fit.  So its sensor is let read it again, a few times.  The
size of the change in the residuals is what they may have beyond the noise of their own sensors; the fit goes along by
(JᵀJ)⁻¹ Jᵀ of the change, and the spread of that is the covariance.
"""

import numpy as np

from ...core.arrays import Numbers
from ..fit.fit_problem import FitProblem
from ..fit.least_squares import Solution, slopes_of

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
    stretches = problem.stretches()
    slopes = slopes_of(lambda point: problem.of_stretches(point, stretches), best.point,
                       problem.of_stretches(best.point, stretches), problem.region, problem.steps)
    scales = np.outer(*2 * [np.sqrt(np.diag(best.information))])
    moves = np.array(changes) @ slopes @ (np.linalg.pinv(best.information / scales, hermitian=True) / scales)
    return np.asarray(moves.T @ moves / len(changes))
