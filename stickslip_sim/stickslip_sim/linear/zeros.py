# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Zeros of a free motion, in closed form, and how far a growing one may be followed (`roots`, argument 1 and a)."""

import math

from ..core.hot_path import compiled, inlined
from .oscillator import Oscillator

_OVERFLOW = 600.0   # largest exponent of a growing mode; by then it has left every bounded segment


@inlined
def first_zero(osc: Oscillator, z: float, jerk: float) -> float:
    """Return the first t > 0 at which the free motion z g′ + jerk g comes down to 0; z >= 0."""
    gamma, _, nu, slow, _ = osc
    if nu > 0.0:
        if z == 0.0 and jerk > 0.0:
            return math.pi / nu
        return math.atan2(abs(z) * nu, gamma * z - jerk) / nu
    fall = -(jerk + slow * z)
    if z == 0.0:
        return 0.0 if jerk < 0.0 else math.inf
    if fall <= 0.0:
        return math.inf
    if nu == 0.0:
        return z / fall
    return math.log1p(-2.0 * nu * z / fall) / (-2.0 * nu)


@inlined
def half_period(osc: Oscillator) -> float:
    """Return the least distance of two zeros of a free motion: infinite when it has one at most."""
    return math.pi / osc.nu if osc.nu > 0.0 else math.inf


@compiled
def next_zero(osc: Oscillator, t: float) -> float:
    """Return the zero of a free motion that follows one at t."""
    return t + half_period(osc)


@inlined
def finite_horizon(osc: Oscillator, t: float) -> float:
    """Return t, or less where a growing mode would leave the range of numbers before."""
    gamma, _, nu, slow, _ = osc
    growth = -gamma if nu > 0.0 else slow
    return min(t, _OVERFLOW / growth) if growth > 0.0 else t


# First roots of polynomials of degree two: exact ones, and bounds that make a step safe (`roots`, argument 3).

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


# Steps to a root and when a root is accepted: what all safeguarded searches share.
#
# A step is made of ratios: products of derivatives leave the range of numbers long before the derivatives do.  A step
# of size d is off by about d (d k)³ after Householder, d (d k)² after Halley, where k is f″/f′ and the frequency of the
# motion; d k is its sharpness.  A root is accepted when that error is rounding.

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
