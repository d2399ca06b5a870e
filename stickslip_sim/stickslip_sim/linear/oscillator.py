# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Closed-form motion of y″ + 2γ y′ + ω² y = q(t), q a polynomial of degree two.

Everything is built on the impulse response g (g(0) = 0, g′(0) = 1) and its repeated integrals G₁, G₂, G₃, which start
as t²/2, t³/6 and t⁴/24.  With the start values u₀ = y′(0), a₀ = y″(0), and with q″ = k, j = q′(0) − ω² u₀:

    y  = u₀ t + a₀ G₁ + j G₂ + k G₃        y″ = a₀ g′ + j g + k G₁
    y′ = u₀   + a₀ g  + j G₁ + k G₂        y‴ = a₀ g″ + j g′ + k g

No term divides by ω², γ or the distance of the eigenvalues, so that a vanishing spring, a vanishing damper and
critical damping are ordinary cases.  The integrals obey

    g′ + 2γ g + ω² G₁ = 1,    g + 2γ G₁ + ω² G₂ = t,    G₁ + 2γ G₂ + ω² G₃ = t²/2.

They are read upwards when ω t is large; for small times their power series are summed and they are read downwards; a
strongly over-damped mode takes divided differences of the φ-functions (Hochbruck and Ostermann, Acta Numerica 2010).

An `Oscillator` is (γ, ω², ν, λ₁, λ₂): ν > 0 is the damped angular frequency of an under-damped one; otherwise −ν >= 0
is half the distance of the real eigenvalues λ₁ >= λ₂.
"""

import math
from typing import NamedTuple

from ..core.hot_path import compiled, inlined

_SERIES_BELOW = 2.0   # (|γ| + |ν|) t up to which the power series is summed
_SHORT_SERIES_BELOW = 0.4   # where G₃ is not asked for
_SERIES_TERMS = 60    # never reached: 30 terms are below rounding at the bound above


class Oscillator(NamedTuple):
    """y″ + 2γ y′ + ω² y."""

    gamma: float    # 1/s
    omega2: float   # 1/s²
    nu: float       # 1/s: > 0 the damped angular frequency, else minus half the distance of the eigenvalues
    slow: float     # 1/s, λ₁, where ν <= 0
    fast: float     # 1/s, λ₂


class Integrals(NamedTuple):
    """The impulse response, its rate and its repeated integrals at a time."""

    g: float        # s
    rate: float
    first: float    # s², G₁
    second: float   # s³, G₂
    third: float    # s⁴, G₃


class ShortIntegrals(NamedTuple):
    """`Integrals` without G₃."""

    g: float        # s
    rate: float
    first: float    # s², G₁
    second: float   # s³, G₂


@inlined
def oscillator(gamma: float, omega2: float) -> Oscillator:
    """Return (γ, ω², ν, λ₁, λ₂) of y″ + 2γ y′ + ω² y."""
    omega = math.sqrt(omega2)
    gap = (gamma - omega) * (gamma + omega)
    if gap < 0.0:
        return Oscillator(gamma, omega2, math.sqrt(-gap), 0.0, 0.0)
    nu = math.sqrt(gap)
    if gamma > 0.0:
        return Oscillator(gamma, omega2, -nu, -omega2 / (gamma + nu), -(gamma + nu))
    if gamma < 0.0:
        return Oscillator(gamma, omega2, -nu, nu - gamma, omega2 / (nu - gamma))
    return Oscillator(0.0, omega2, 0.0, 0.0, 0.0)


@compiled
def impulse(osc: Oscillator, t: float) -> tuple[float, float]:
    """Return g(t) and g′(t)."""
    gamma, _, nu, slow, fast = osc
    if nu > 0.0:
        decay = math.exp(-gamma * t)
        phase = nu * t
        g = decay * math.sin(phase) / nu
        return g, decay * math.cos(phase) - gamma * g
    g = math.exp(slow * t)
    g *= t if nu == 0.0 else math.expm1(2.0 * nu * t) / (2.0 * nu)
    return g, math.exp(fast * t) + slow * g


@compiled
def integrals(osc: Oscillator, t: float) -> Integrals:
    """Return g, g′, G₁, G₂ and G₃ at t."""
    gamma, omega2, nu, slow, fast = osc
    if (abs(gamma) + abs(nu)) * t < _SERIES_BELOW:
        return _series(gamma, omega2, t)
    g, rate = impulse(osc, t)
    if nu <= 0.0 and 4.0 * omega2 < gamma * gamma:
        first1, second1, third1 = _phi(slow, t)
        first2, second2, third2 = _phi(fast, t)
        distance = -2.0 * nu
        return Integrals(g, rate, (first1 - first2) / distance, (second1 - second2) / distance,
                         (third1 - third2) / distance)
    first = (1.0 - rate - 2.0 * gamma * g) / omega2
    second = (t - g - 2.0 * gamma * first) / omega2
    third = (0.5 * t * t - first - 2.0 * gamma * second) / omega2
    return Integrals(g, rate, first, second, third)


@compiled
def short_integrals(osc: Oscillator, t: float) -> ShortIntegrals:
    """Return g, g′, G₁ and G₂ at t; where G₃ is not asked for, less is lost to cancellation."""
    gamma, omega2, nu, _, _ = osc
    if (abs(gamma) + abs(nu)) * t < _SHORT_SERIES_BELOW or (nu <= 0.0 and 4.0 * omega2 < gamma * gamma):
        g, rate, first, second, _ = integrals(osc, t)
        return ShortIntegrals(g, rate, first, second)
    g, rate = impulse(osc, t)
    inverse = 1.0 / omega2
    first = (1.0 - rate - 2.0 * gamma * g) * inverse
    return ShortIntegrals(g, rate, first, (t - g - 2.0 * gamma * first) * inverse)


@compiled
def _series(gamma: float, omega2: float, t: float) -> Integrals:
    a = -2.0 * gamma * t
    b = -omega2 * t * t
    before, term = 0.0, 1.0      # c_n t^(n-1) of g = Σ c_n tⁿ/n!
    weight = 1.0 / 24.0          # 1/(n+3)!
    second, third = 4.0 * weight, weight
    n = 4.0
    for _ in range(_SERIES_TERMS):
        before, term = term, a * term + b * before
        n += 1.0
        weight /= n
        third += term * weight
        second += n * term * weight
        if (abs(term) + abs(before)) * n * weight < 1e-18:
            break
    square = t * t
    third *= square * square
    second *= square * t
    first = 0.5 * square - 2.0 * gamma * second - omega2 * third
    g = t - 2.0 * gamma * first - omega2 * second
    return Integrals(g, 1.0 - 2.0 * gamma * g - omega2 * first, first, second, third)


@compiled
def _phi(rate: float, t: float) -> tuple[float, float, float]:
    """Return the first three repeated integrals of exp(rate t) from 0."""
    z = rate * t
    if abs(z) > 1.0:
        first = math.expm1(z) / rate
        second = (first - t) / rate
        return first, second, (second - 0.5 * t * t) / rate
    weight, third, n = 1.0 / 6.0, 1.0 / 6.0, 3.0
    for _ in range(_SERIES_TERMS):
        n += 1.0
        weight *= z / n
        third += weight
        if abs(weight) < 1e-18:
            break
    third *= t * t * t
    second = 0.5 * t * t + rate * third
    return t + rate * second, second, third


@inlined
def bound(osc: Oscillator, z: float, rate: float) -> float:
    """Return a bound on |z(t + s)| for all s >= 0 of a free motion with γ >= 0 from its value and rate at t."""
    gamma, _, nu, slow, _ = osc
    drift = abs(rate + gamma * z) if nu > 0.0 else abs(rate - slow * z)
    decay = gamma if nu > 0.0 else -slow
    reach = 1.0 / nu if nu > 0.0 else (-0.5 / nu if nu < 0.0 else math.inf)
    if decay > 0.0:
        reach = min(reach, 0.36787944117144233 / decay)
    return abs(z) if drift == 0.0 else abs(z) + drift * reach


@compiled
def amplitude(osc: Oscillator, z: float, rate: float) -> tuple[float, float]:
    """Return (A, d) with |z(t + s)| <= A exp(−d s) for all s >= 0 of a free motion with its value and rate at t."""
    gamma, _, nu, slow, _ = osc
    if nu > 0.0:
        sine = (rate + gamma * z) / nu
        return math.sqrt(z * z + sine * sine), gamma
    drift = abs(rate - slow * z)
    return (abs(z) - 0.5 * drift / nu if nu < 0.0 else (abs(z) if drift == 0.0 else math.inf)), -slow
