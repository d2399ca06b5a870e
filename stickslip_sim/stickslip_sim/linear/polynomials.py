# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""First roots of polynomials of degree two: exact ones, and bounds that make a step safe (`roots`, argument 3)."""

import math

from ..core.hot_path import compiled


@compiled
def first_crossing(value: float, slope: float, second_rate: float) -> float:
    """Return the first t >= 0 after which value + slope t + second_rate t²/2 is negative.

    value >= 0; where it is 0 the next term decides.
    """
    if value <= 0.0 and (slope < 0.0 or (slope == 0.0 and second_rate < 0.0)):
        return 0.0
    if second_rate == 0.0:
        return value / -slope if slope < 0.0 else math.inf
    inside = slope * slope - 2.0 * second_rate * value
    if inside < 0.0 or (inside == 0.0 and second_rate > 0.0):
        return math.inf
    root = math.sqrt(inside)
    if slope < 0.0:
        return 2.0 * value / (root - slope) if value > 0.0 else (0.0 if second_rate < 0.0 else math.inf)
    return -(slope + root) / second_rate if second_rate < 0.0 else math.inf


@compiled
def safe_step(value: float, slope: float, curvature: float) -> float:
    """Return the longest d before which f >= value + slope d − curvature d²/2 cannot vanish (value >= 0)."""
    if curvature == math.inf:
        return 0.0
    root = math.sqrt(slope * slope + 2.0 * curvature * value)
    if slope < 0.0:
        return 2.0 * value / (root - slope)
    return (slope + root) / curvature if curvature > 0.0 else math.inf
