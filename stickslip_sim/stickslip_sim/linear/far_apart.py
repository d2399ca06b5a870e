# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Integrals over a motion with two real eigenvalues far apart, however slow the one and however fast the other.

A fast exponential goes beside a slow motion a e^(λ₁t) + k ∫e^(λ₁t) + …, which becomes a polynomial where λ₁ vanishes;
nothing divides by a λ₁ that is small.
"""

import math

from ..core.hot_path import compiled
from .oscillator import Oscillator, impulse

_TERMS = 60          # never reached: 25 terms are below rounding


@compiled
def far_apart(osc: Oscillator, x: float, rate: float, k0: float, k1: float, t: float
             ) -> tuple[float, float, float, float, float, float]:
    """Return what `moments` does, from x = a e^(λ₁t) + q₀ φ₁ + q₁ φ₂ + c e^(λ₂t).

    φₙ are the repeated integrals of e^(λ₁t).
    """
    _, _, _, near, far = osc
    if abs(near) > abs(far):
        near, far = far, near
    q1 = -k1 / far
    q0 = (q1 - k0) / far
    c = (rate - near * x - q0) / (far - near)
    a = x - c
    b = near * a + q0
    grown, p1, p2, p3, p4, p5 = _repeated(near, t)
    fast, f1, f2, f3, _, _ = _repeated(far, t)
    end, end_rate = a * grown + q0 * p1 + q1 * p2, b * grown + q1 * p1
    both = _exponential(near + far, t)                          # ∫ of the product of the two exponentials
    mixed = b * both + q1 * (p1 * fast - both) / far             # ∫ of the slow rate times the fast exponential
    mixed = (end * fast - a - mixed) / far
    square = _slow_square(near, t, a, q0, q1, p1, p2, p3) + c * (2.0 * mixed + c * _exponential(2.0 * far, t))
    return (end + c * fast, end_rate + c * far * fast, a * p1 + q0 * p2 + q1 * p3 + c * f1,
            a * p2 + q0 * p3 + q1 * p4 + c * f2, a * p3 + q0 * p4 + q1 * p5 + c * f3, square)


@compiled
def _slow_square(rate: float, t: float, a: float, q0: float, q1: float, p1: float, p2: float, p3: float) -> float:
    """Return ∫(a e^(λ₁t) + q₀ φ₁ + q₁ φ₂)².

    Beyond a time constant it is made from where the motion settles: a² t would leave nothing of what has faded.
    """
    if abs(rate * t) > 1.0:
        ramp = -q1 / rate
        level = (ramp - q0) / rate
        z = a - level
        return (z * z * _exponential(2.0 * rate, t) + 2.0 * z * (level * p1 + ramp * (t * p1 - p2))
                + ((level + ramp * t / 3.0) * ramp * t + level * level) * t)
    b = rate * a + q0
    return (a * a * t + 2.0 * a * (b * p2 + q1 * p3) + b * b * _first_square(rate, t)
            + q1 * (b * p2 * p2 + (q1 * _second_square(rate, t) if q1 != 0.0 else 0.0)))


@compiled
def _exponential(rate: float, t: float) -> float:
    return t if rate == 0.0 else math.expm1(rate * t) / rate


@compiled
def _repeated(rate: float, t: float) -> tuple[float, float, float, float, float, float]:
    """Return exp(rate t) and its first five repeated integrals from 0."""
    z = rate * t
    if abs(z) > 1.0:
        first = math.expm1(z) / rate
        second = (first - t) / rate
        third = (second - 0.5 * t * t) / rate
        fourth = (third - t * t * t / 6.0) / rate
        return 1.0 + rate * first, first, second, third, fourth, (fourth - t * t * t * t / 24.0) / rate
    weight, fifth, n = 1.0 / 120.0, 1.0 / 120.0, 5.0
    for _ in range(_TERMS):
        n += 1.0
        weight *= z / n
        fifth += weight
        if abs(weight) < 1e-19:
            break
    square = t * t
    fourth = 1.0 / 24.0 + z * fifth
    third = 1.0 / 6.0 + z * fourth
    second = 0.5 + z * third
    first = 1.0 + z * second
    return (1.0 + z * first, t * first, square * second, square * t * third, square * square * fourth,
            square * square * t * fifth)


@compiled
def _first_square(rate: float, t: float) -> float:
    """Return ∫φ₁² of the first integral of exp(rate t), |rate t| no more than 1."""
    z = rate * t
    power, weight, total, n = 4.0, 0.5, 1.0 / 3.0, 2.0
    for _ in range(_TERMS):
        n += 1.0
        power *= 2.0
        weight *= z / n
        term = (power - 2.0) * weight / (n + 1.0)
        total += term
        if abs(term) < 1e-18:
            break
    return t * t * t * total


@compiled
def _second_square(rate: float, t: float) -> float:
    """Return ∫φ₂² of the second integral of exp(rate t), |rate t| no more than 1."""
    z = rate * t
    power, weight, total, n = 16.0, 1.0 / 24.0, 0.05, 4.0
    for _ in range(_TERMS):
        n += 1.0
        power *= 2.0
        weight *= z / n
        term = (power - 2.0 * n - 2.0) * weight / (n + 1.0)
        total += term
        if abs(term) < 1e-18:
            break
    return t * t * t * t * t * total


# ∫z² of a free motion near critical damping, where splitting it into two exponentials would divide by what vanishes.
#
# Over a short span it is a quadratic form in value and rate at the start, known from a power series; that of the double
# span follows from it, and so on.

_STRETCH = 0.25      # ω t of the first span


@compiled
def free_square(osc: Oscillator, z: float, rate: float, t: float) -> float:
    """Return ∫z² from 0 to t of a free motion near critical damping, from its value and rate at 0."""
    gamma, omega2, _, _, _ = osc
    doublings = 0
    span = t
    while span * span * omega2 > _STRETCH * _STRETCH:
        span *= 0.5
        doublings += 1
    g, slope = impulse(osc, span)
    late = _impulse_square(gamma, omega2, span)          # ∫g²
    mixed = 0.5 * g * g + 2.0 * gamma * late             # ∫(g′ + 2γg) g
    early = g * slope + gamma * g * g + omega2 * late    # ∫g′²
    early += 2.0 * gamma * (g * g + 2.0 * gamma * late)
    keeps, gains, drops = slope + 2.0 * gamma * g, g, -omega2 * g     # (z, z′) over the span: keeps gains | drops slope
    for _ in range(doublings):
        more_early = (keeps * early + 2.0 * drops * mixed) * keeps + drops * drops * late
        more_mixed = keeps * (early * gains + mixed * slope) + drops * (mixed * gains + late * slope)
        more_late = (gains * early + 2.0 * slope * mixed) * gains + slope * slope * late
        early, mixed, late = early + more_early, mixed + more_mixed, late + more_late
        sum_ = keeps + slope
        keeps, slope = keeps * keeps + gains * drops, slope * slope + gains * drops
        gains *= sum_
        drops *= sum_
        if keeps == 0.0 and gains == 0.0 and slope == 0.0:
            break
    return (early * z + 2.0 * mixed * rate) * z + late * rate * rate


@compiled
def _impulse_square(gamma: float, omega2: float, t: float) -> float:
    """Return ∫g² of the impulse response over a short span, by the power series of g²."""
    a, b, c = -6.0 * gamma * t, -(8.0 * gamma * gamma + 4.0 * omega2) * t * t, -8.0 * gamma * omega2 * t * t * t
    first, second, third = 0.0, 0.0, 2.0
    weight, total, n = 1.0 / 6.0, 1.0 / 3.0, 3.0
    for _ in range(_TERMS):
        first, second, third = second, third, a * third + b * second + c * first
        n += 1.0
        weight /= n
        total += third * weight
        if (abs(first) + abs(second) + abs(third)) * weight < 1e-18:
            break
    return total * t * t * t
