# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that a run knows only together, as distributions: each by itself is wide, and all go up and down as one.

Where only the product of pₖ to the power wₖ is free, ln pₖ = ln p̂ₖ + wₖ s with one s for all: the covariance of the
logarithms is σ² w wᵀ, with σ as wide as the ranges leave it.
"""

import math
from dataclasses import replace

import numpy as np

from ...core.arrays import Numbers
from ..identified import FOUND, NOT_IDENTIFIABLE, Combination, Estimate, Identification

REACH = 2.0   # standard deviations from the value to the nearest end of a range


def with_shared_factors(found: Identification) -> tuple[list[Estimate], Numbers, frozenset[str]]:
    """Return the estimates and their correlation (k, k), with those of combinations as if found, and their names."""
    estimates = list(found.estimates)
    places = {one.name: k for k, one in enumerate(estimates) if one.kind == NOT_IDENTIFIABLE}
    covariance = np.zeros((len(estimates),) * 2)
    for together in found.combinations:
        if len(together.names) > 1 and all(name in places for name in together.names):
            rows = [places[name] for name in together.names]
            weights = np.zeros(len(estimates))
            weights[rows] = together.weights
            covariance += _spread(together, [estimates[k] for k in rows])**2 * np.outer(weights, weights)
    deviations = np.sqrt(np.diag(covariance))
    shared = [k for k in range(len(estimates)) if deviations[k] > 0.0]
    correlation = np.array(found.correlation, dtype=np.float64)
    correlation[shared] = correlation[:, shared] = 0.0
    for i in shared:
        for j in shared:
            correlation[i, j] = covariance[i, j] / (deviations[i] * deviations[j])
        scale = 1.0 if estimates[i].logarithmic else estimates[i].high - estimates[i].low
        estimates[i] = replace(estimates[i], kind=FOUND, standard_deviation=float(deviations[i]) * scale)
    return estimates, correlation, frozenset(estimates[k].name for k in shared)


def _spread(together: Combination, estimates: list[Estimate]) -> float:
    """Return the standard deviation of what is free: no number is to leave its range within REACH of them."""
    ways = [_way(one) / abs(weight) for one, weight in zip(estimates, together.weights, strict=True)]
    return min(together.spread, min(ways) / REACH)


def _way(one: Estimate) -> float:
    """Return how far it is to the nearest end of the range, as the fit sees the number."""
    if one.logarithmic:
        return max(min(math.log(one.high / one.value), math.log(one.value / one.low)), 0.0)
    return max(min(one.high - one.value, one.value - one.low), 0.0) / (one.high - one.low)
