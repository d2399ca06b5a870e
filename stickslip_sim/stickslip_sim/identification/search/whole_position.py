# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An axis that is not quite the model, and driven by a measured force: its position over the whole run.

The filtered residuals take the position that the force leads to for what it is from sample to sample, and let its error
grow as noise of the force does.  Where a test rejects them, what is left is no noise: friction of the axis varies a
little along its way, and the best fit to the samples may leave the measured way by much within some seconds, for an
offset of a percent.  The whole way shows such numbers: of those that the samples leave open, the nearest that follow it
are taken.
"""

from collections.abc import Sequence

import numpy as np

from ...core.arrays import Numbers
from ..certainty.covariance import certainty_of
from ..certainty.residual_tests import inflation_of
from ..fit.fit_problem import FitProblem
from ..fit.least_squares import minimise
from .stages import Ended

_STEP = 1e-4     # of derivatives: the position over the whole run is far from linear only beyond
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

    moved = minimise(residuals, point, problem.region, most=30, tolerance=1e-2, step=_STEP)
    return [best._replace(solution=best.solution._replace(point=moved.point), is_along=True), *ends[1:]]
