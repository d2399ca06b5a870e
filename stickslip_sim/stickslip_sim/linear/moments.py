# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Integrals over the motion x″ + 2γ x′ + ω² x = k₀ + k₁ t: of x, of its repeated integrals, and of x².

They start from x and x′ at 0 and know nothing of where the motion is said to end; none is made from a balance.  Four
cases, so that none divides by what vanishes:

* a short span takes the power series of the equation at the five nodes of Gauss and Legendre's rule;
* a swing is a polynomial and a wave Re Z e^(λt), whose products have closed integrals;
* two real eigenvalues far apart, and the square near critical damping, have integrals of their own (below).
"""

import math

from ..core.hot_path import compiled
from .oscillator import Oscillator, impulse

# Integrals over a motion with two real eigenvalues far apart, however slow the one and however fast the other.
#
# A fast exponential goes beside a slow motion a e^(λ₁t) + k ∫e^(λ₁t) + …, which becomes a polynomial where λ₁ vanishes;
# nothing divides by a λ₁ that is small.

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


_SHORT = 0.15        # (|γ| + |ν|) t up to which five nodes and ten powers are exact to rounding
_APART = 0.09        # (ν/ω)² from which on the eigenvalues are far enough apart to be split
_NODES = (0.046910077030668003601, 0.23076534494715845448, 0.5,
          0.76923465505284154552, 0.9530899229693319964)
_WEIGHTS = (0.11846344252809454376, 0.23931433524968323402, 0.28444444444444444444,
            0.23931433524968323402, 0.11846344252809454376)


@compiled
def moments(osc: Oscillator, x: float, rate: float, k0: float, k1: float, t: float
           ) -> tuple[float, float, float, float, float, float]:
    """Return x and x′ at t, and from 0 to t ∫x, ∫∫x, ∫∫∫x and ∫x²."""
    gamma, omega2, nu, _, _ = osc
    if (abs(gamma) + abs(nu)) * t < _SHORT:
        return _short(gamma, omega2, x, rate, k0, k1, t)
    if nu < 0.0 and nu * nu > _APART * omega2:
        return far_apart(osc, x, rate, k0, k1, t)
    ramp = k1 / omega2
    level = (k0 - 2.0 * gamma * ramp) / omega2
    z, z_rate = x - level, rate - ramp
    if nu > 0.0 and nu * nu > _APART * omega2:
        end, end_rate, square = _swing(gamma, nu, z, z_rate, t)
    else:
        g, slope = impulse(osc, t)
        end, end_rate = z * (slope + 2.0 * gamma * g) + z_rate * g, z_rate * slope - omega2 * z * g
        square = free_square(osc, z, z_rate, t)
    once, once_end = _integral(gamma, omega2, z, z_rate), _integral(gamma, omega2, end, end_rate)
    twice, twice_end = _integral(gamma, omega2, once, z), _integral(gamma, omega2, once_end, end)
    thrice, thrice_end = _integral(gamma, omega2, twice, once), _integral(gamma, omega2, twice_end, once_end)
    first = once_end - once
    second = (twice_end - twice) - once * t
    third = (thrice_end - thrice) - (twice + 0.5 * once * t) * t
    square += 2.0 * (level * first + ramp * (t * first - second)) + ((level + ramp * t / 3.0) * ramp * t
                                                                      + level * level) * t
    return (level + ramp * t + end, ramp + end_rate, (level + 0.5 * ramp * t) * t + first,
            (0.5 * level + ramp * t / 6.0) * t * t + second, (level / 6.0 + ramp * t / 24.0) * t * t * t + third,
            square)


@compiled
def _integral(gamma: float, omega2: float, z: float, rate: float) -> float:
    """Return the integral of a free motion that is a free motion itself."""
    return -(rate + 2.0 * gamma * z) / omega2


@compiled
def _short(gamma: float, omega2: float, x: float, rate: float, k0: float, k1: float, t: float
          ) -> tuple[float, float, float, float, float, float]:
    a, b = -2.0 * gamma * t, -omega2 * t * t
    x1 = rate * t
    x2 = k0 * t * t + a * x1 + b * x      # the derivatives times powers of t
    x3 = k1 * t * t * t + a * x2 + b * x1
    x4 = a * x3 + b * x2
    x5 = a * x4 + b * x3
    x6 = a * x5 + b * x4
    x7 = a * x6 + b * x5
    x8 = a * x7 + b * x6
    x9 = a * x8 + b * x7
    x10 = a * x9 + b * x8
    x2, x3, x4, x5, x6 = 0.5 * x2, x3 * (1.0 / 6.0), x4 * (1.0 / 24.0), x5 * (1.0 / 120.0), x6 * (1.0 / 720.0)
    x7, x8, x9, x10 = x7 * (1.0 / 5040.0), x8 * (1.0 / 40320.0), x9 * (1.0 / 362880.0), x10 * (1.0 / 3628800.0)
    square = 0.0
    for i in range(5):
        at = _NODES[i]
        value = x + at * (x1 + at * (x2 + at * (x3 + at * (x4 + at * (x5 + at * (x6 + at * (x7 + at * (
            x8 + at * (x9 + at * x10)))))))))
        square += _WEIGHTS[i] * value * value
    first = (x + (x1 * (1.0 / 2.0) + (x2 * (1.0 / 3.0) + (x3 * (1.0 / 4.0) + (
        x4 * (1.0 / 5.0) + (x5 * (1.0 / 6.0) + (x6 * (1.0 / 7.0) + (x7 * (1.0 / 8.0) + (
            x8 * (1.0 / 9.0) + (x9 * (1.0 / 10.0) + x10 * (1.0 / 11.0)))))))))))
    second = (x * (1.0 / 2.0) + (x1 * (1.0 / 6.0) + (x2 * (1.0 / 12.0) + (x3 * (1.0 / 20.0) + (
        x4 * (1.0 / 30.0) + (x5 * (1.0 / 42.0) + (x6 * (1.0 / 56.0) + (x7 * (1.0 / 72.0) + (
            x8 * (1.0 / 90.0) + (x9 * (1.0 / 110.0) + x10 * (1.0 / 132.0)))))))))))
    third = (x * (1.0 / 6.0) + (x1 * (1.0 / 24.0) + (x2 * (1.0 / 60.0) + (x3 * (1.0 / 120.0) + (
        x4 * (1.0 / 210.0) + (x5 * (1.0 / 336.0) + (x6 * (1.0 / 504.0) + (x7 * (1.0 / 720.0) + (
            x8 * (1.0 / 990.0) + (x9 * (1.0 / 1320.0) + x10 * (1.0 / 1716.0)))))))))))
    end = x + (x1 + (x2 + (x3 + (x4 + (x5 + (x6 + (x7 + (x8 + (x9 + x10)))))))))
    slope = x1 + (2.0 * x2 + (3.0 * x3 + (4.0 * x4 + (5.0 * x5 + (6.0 * x6 + (7.0 * x7 + (
        8.0 * x8 + (9.0 * x9 + 10.0 * x10))))))))
    return (end, slope / t if t > 0.0 else rate, first * t, second * t * t, third * t * t * t, square * t)


@compiled
def _swing(gamma: float, nu: float, z: float, rate: float, t: float) -> tuple[float, float, float]:
    """Return the free motion and its rate at t, and ∫z² of z = e^(−γt) (a cos νt + b sin νt)."""
    lost = math.expm1(-gamma * t)
    decay, sine, cosine = 1.0 + lost, math.sin(nu * t), math.cos(nu * t)
    a, b = z, (rate + gamma * z) / nu
    lost *= 2.0 + lost                                   # e^(−2γt) − 1
    twice = decay * decay
    real, imaginary = lost - 2.0 * twice * sine * sine, 2.0 * twice * sine * cosine   # of e^(2λt) − 1
    size = 2.0 * (gamma * gamma + nu * nu)
    real, imaginary = (nu * imaginary - gamma * real) / size, -(gamma * imaginary + nu * real) / size
    mean = t if gamma == 0.0 else lost / (-2.0 * gamma)
    square = 0.5 * ((a - b) * (a + b) * real + 2.0 * a * b * imaginary + (a * a + b * b) * mean)
    return (decay * (a * cosine + b * sine), decay * ((b * nu - gamma * a) * cosine - (a * nu + gamma * b) * sine),
            square)
