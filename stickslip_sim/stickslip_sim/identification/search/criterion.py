# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The criterion by which laws of friction are compared, each by its best fit of the same run."""

import numpy as np

from ..fit.fit_problem import FitProblem

CRITERION = 'BIC'


def criterion_of(problem: FitProblem, cost: float) -> float:
    """Return the criterion of Bayes of a fit with a sum of squares: the lower, the better."""
    return cost + len(problem.parameters) * float(np.log(_effective_count(problem)))


def _effective_count(problem: FitProblem) -> float:
    """Return how many residuals there are, each counted by its weight."""
    return float(sum(channel.weights.sum() for channel in problem.measurement.channels))
