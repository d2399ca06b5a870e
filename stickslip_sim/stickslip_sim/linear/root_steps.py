# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Steps to a root and when a root is accepted: what all safeguarded searches share.

A step is made of ratios: products of derivatives leave the range of numbers long before the derivatives do.  A step of
size d is off by about d (d k)³ after Householder, d (d k)² after Halley, where k is f″/f′ and the frequency of the
motion; d k is its sharpness.  A root is accepted when that error is rounding.
"""

import math

from ..core.hot_path import inlined

EPSILON = 2.220446049250313e-16
ITERATIONS = 2200   # halvings between any two numbers


@inlined
def householder(value: float, slope: float, change: float, third: float) -> tuple[float, float]:
    """Return Householder's third-order step to the zero of f from f, f′ > 0, f″ and f‴, and f″/f′.

    The step is infinite where there is none.  Its error is about size (size (f″/f′ + frequency))³.  The form is one of
    ratios: products of three derivatives leave the range of numbers long before the derivatives do.  A step of 0 is a
    root only where f is 0.
    """
    inverse = 1.0 / slope
    newton = value * inverse
    ratio = change * inverse
    curving = newton * ratio
    curve = 6.0 * (1.0 - curving) + newton * newton * (third * inverse)
    step = newton * (6.0 - 3.0 * curving) / curve if curve > 0.0 else math.inf
    return step, ratio


@inlined
def halley(value: float, slope: float, change: float) -> float:
    """Return Halley's step to the zero of f from f, f′ that is not 0, and f″; at most twice Newton's."""
    newton = value / slope
    return newton / max(1.0 - 0.5 * newton * change / slope, 0.5)


@inlined
def householder_settles(size: float, sharpness: float, root: float) -> bool:
    """Whether the error of Householder's step is rounding of the root."""
    return size * sharpness * sharpness * sharpness <= 0.1 * EPSILON * root


@inlined
def halley_settles(size: float, sharpness: float, root: float) -> bool:
    """Whether the error of Halley's step is rounding of the root."""
    return size * sharpness * sharpness <= 0.1 * EPSILON * root
