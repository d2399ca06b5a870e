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
