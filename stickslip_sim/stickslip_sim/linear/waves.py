# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The answer of y″ + 2γ y′ + ω² y to sines, in closed form.  Knows no friction and no axis.

For a forcing Im[B e^{iwt}] of the velocity u = y′ from rest on, u = Im[B I], y = Im[B K] and u′ = Im[B I′] with

    I(t) = ∫₀ᵗ g(t − s) e^{iws} ds,    K = ∫ I,    I′ = i w I + g,    I″ = g′ + i w I′,

g the impulse response (see `oscillator`).  I is the divided difference of exp(t ·) at the eigenvalues and i w (de Boor,
Divided Differences, 2005); its recursion is, with λ₂ the eigenvalue farther from i w,

    I = (φ − g)/(i w − λ₂),    φ = (e^{iwt} − e^{λ₁t})/(i w − λ₁) = e^{λ₁t} expm1((i w − λ₁) t)/(i w − λ₁).

|i w − λ₂| is at least w, and φ has no pole: resonance, equal eigenvalues, no spring and no damper are ordinary cases.
Small times take the power series of the equation.  Complex numbers are pairs of reals, so that machine code and plain
Python agree to the bit.

A phase is counted in turns.  frequency · time mod 1 is taken from an exact product (Dekker, Numer. Math. 18, 1971), so
that late times and high frequencies keep their phase.
"""

import math

from ..core.hot_path import compiled
from .oscillator import Oscillator

TURN = 2.0 * math.pi
_SERIES_BELOW = 2.0
_SERIES_TERMS = 60   # never reached: 35 terms are below rounding at the bound above
_SPLIT = 134217729.0


@compiled
def turns(frequency: float, time: float) -> float:
    """Return frequency · time less its whole turns, to the rounding of one turn."""
    product = frequency * time
    big = _SPLIT * frequency
    frequency_high = big - (big - frequency)
    frequency_low = frequency - frequency_high
    big = _SPLIT * time
    time_high = big - (big - time)
    time_low = time - time_high
    lost = ((frequency_high * time_high - product) + frequency_high * time_low + frequency_low * time_high
            ) + frequency_low * time_low
    return (product - math.floor(product)) + lost


@compiled
def phase_at(frequency: float, phase: float, second: float, fraction: float) -> float:
    """Return the phase in turns, from 0 to 1, of a wave with `phase` at time 0, at the time second + fraction."""
    phase = turns(frequency, second) + turns(frequency, fraction) + phase
    return phase - math.floor(phase)


@compiled
def wave_response(osc: Oscillator, w: float, cycle: float, t: float, g: float, rate: float, first: float
                 ) -> tuple[float, float, float, float, float, float]:
    """Return (I, I′, K) at t as six reals; `cycle` is w t in turns, and g, g′, G₁ are those of `oscillator`."""
    gamma, _, nu, _, _ = osc
    if (abs(gamma) + abs(nu) + w) * t < _SERIES_BELOW:
        return _series(osc, w, t)
    sine, cosine = math.sin(TURN * cycle), math.cos(TURN * cycle)
    re, im = _response(osc, w, sine, cosine, t, g, rate)
    if w * t >= 0.5:
        return re, im, g - w * im, w * re, im / w, (first - re) / w
    sum_re, sum_im = _slow_wave_integral(osc, w, sine, cosine, t, re, im, g)
    return re, im, g - w * im, w * re, sum_re, sum_im


@compiled
def _response(osc: Oscillator, w: float, sine: float, cosine: float, t: float, g: float, rate: float
             ) -> tuple[float, float]:
    gamma, _, nu, slow, fast = osc
    if nu > 0.0:   # λ₁ = −γ + i ν, and e^{λ₁t} follows from g and g′
        re, im = _phi(gamma, w - nu, sine, cosine, rate + gamma * g, nu * g, t)
        re -= g
        far_re, far_im = gamma, w + nu
    else:
        near, far = (slow, fast) if gamma >= 0.0 else (fast, slow)
        re, im = _phi(-near, w, sine, cosine, math.exp(near * t), 0.0, t)
        re -= g
        far_re, far_im = -far, w
    size = far_re * far_re + far_im * far_im
    return (re * far_re + im * far_im) / size, (im * far_re - re * far_im) / size


@compiled
def _phi(d_re: float, d_im: float, sine: float, cosine: float, e_re: float, e_im: float, t: float
        ) -> tuple[float, float]:
    """Return (e^{iwt} − e)/d, with d = i w − λ₁, e = e^{λ₁t}."""
    x, y = d_re * t, d_im * t
    near = abs(x) + abs(y)
    if near < 1e-9:
        return t * (e_re * (1.0 + 0.5 * x) - 0.5 * y * e_im), t * (e_im * (1.0 + 0.5 * x) + 0.5 * y * e_re)
    re, im = cosine - e_re, sine - e_im
    if near < 1.0:
        grown = math.expm1(x)
        half = math.sin(0.5 * y)
        m_re = grown * math.cos(y) - 2.0 * half * half
        m_im = (1.0 + grown) * math.sin(y)
        re, im = e_re * m_re - e_im * m_im, e_re * m_im + e_im * m_re
    size = x * x + y * y
    return t * (re * x + im * y) / size, t * (im * x - re * y) / size


@compiled
def _slow_wave_integral(osc: Oscillator, w: float, sine: float, cosine: float, t: float, re: float, im: float, g: float
                       ) -> tuple[float, float]:
    """Return K where w t is small and the oscillator is not slow."""
    gamma, omega2, nu, slow, fast = osc
    wave_re = sine / w
    wave_im = sine * sine / (1.0 + cosine) / w     # ∫ e^{iws} ds
    if nu <= 0.0 and 4.0 * omega2 < gamma * gamma:
        a_re, a_im = _first_order_integral(slow, w, wave_re, wave_im, sine, cosine, t)
        b_re, b_im = _first_order_integral(fast, w, wave_re, wave_im, sine, cosine, t)
        return (a_re - b_re) / (-2.0 * nu), (a_im - b_im) / (-2.0 * nu)
    return ((wave_re - 2.0 * gamma * re - (g - w * im)) / omega2, (wave_im - 2.0 * gamma * im - w * re) / omega2)


@compiled
def _first_order_integral(eigenvalue: float, w: float, wave_re: float, wave_im: float, sine: float, cosine: float,
                          t: float) -> tuple[float, float]:
    """Return ∫∫ e^{λ(τ−s)} e^{iws} ds dτ, the divided difference of exp(t ·) at 0, λ and i w."""
    z = eigenvalue * t
    if abs(z) > 1.0:
        re, im = _phi(-eigenvalue, w, sine, cosine, math.exp(z), 0.0, t)
        return (re - wave_re) / eigenvalue, (im - wave_im) / eigenvalue
    weight, power = 0.5, 1.0
    h_re, h_im, sum_re, sum_im = 1.0, 0.0, 0.5, 0.0
    for n in range(3, _SERIES_TERMS):
        power *= z
        h_re, h_im = power - w * t * h_im, w * t * h_re
        weight /= n
        sum_re += weight * h_re
        sum_im += weight * h_im
        if weight < 1e-18:
            break
    return t * t * sum_re, t * t * sum_im


@compiled
def _series(osc: Oscillator, w: float, t: float) -> tuple[float, float, float, float, float, float]:
    a, b, turn = -2.0 * osc.gamma * t, -osc.omega2 * t * t, w * t
    p_re, p_im = 1.0, 0.0            # (i w t)ⁿ
    before_re, before_im = 0.0, 0.0
    re, im = 1.0, 0.0                # cₙ tⁿ of I = Σ cₙ tⁿ⁺²/(n + 2)!
    weight = 1.0 / 6.0               # 1/(n + 3)!
    sum_re, sum_im = 3.0 * weight, 0.0               # of I,
    rate_re, rate_im = 6.0 * weight, 0.0             # I′
    integral_re, integral_im = weight, 0.0           # and K
    n = 3.0
    for _ in range(_SERIES_TERMS):
        p_re, p_im = -turn * p_im, turn * p_re
        re, im, before_re, before_im = a * re + b * before_re + p_re, a * im + b * before_im + p_im, re, im
        n += 1.0
        weight /= n
        integral_re, integral_im = integral_re + re * weight, integral_im + im * weight
        sum_re, sum_im = sum_re + n * re * weight, sum_im + n * im * weight
        rate_re, rate_im = rate_re + n * (n - 1.0) * re * weight, rate_im + n * (n - 1.0) * im * weight
        if (abs(re) + abs(im) + abs(before_re) + abs(before_im)) * n * n * weight < 1e-18:
            break
    square = t * t
    return (square * sum_re, square * sum_im, t * rate_re, t * rate_im,
            square * t * integral_re, square * t * integral_im)


# Closed integrals of waves and of their products, over any number of turns or a small part of one.
#
# Complex numbers do without division, so that machine code and plain Python agree to the bit.  A phase is counted in
# turns, as in `waves`; a wave e^(iwτ) begins at 1.

_SERIES = 0.5       # w t up to which powers are summed
_TERMS = 15         # of them


@compiled
def over(a: complex, b: complex) -> complex:
    """Return a/b."""
    size = b.real * b.real + b.imag * b.imag
    return complex((a.real * b.real + a.imag * b.imag) / size, (a.imag * b.real - a.real * b.imag) / size)


@compiled
def mirrored(a: complex) -> complex:
    """Return the conjugate."""
    return complex(a.real, -a.imag)


@compiled
def phase_products(phase: complex, other: complex, alike: bool) -> tuple[complex, complex]:
    """Return e^(i(θ − θ′)) and e^(i(θ + θ′)); the first is 1, without rounding, of a wave and itself."""
    return complex(1.0, 0.0) if alike else phase * mirrored(other), phase * other


@compiled
def cycle_within(frequency: float, t: float) -> float:
    """Return frequency · t less its whole turns."""
    few = frequency * t
    return few if abs(few) < 0.5 else turns(frequency, t)


@compiled
def wave_integral(frequency: float, cycle: float, t: float) -> complex:
    """Return ∫e^(iwτ) dτ from 0 to t."""
    if frequency == 0.0:
        return complex(t, 0.0)
    half = 0.5 * TURN * cycle
    chord = 2.0 * math.sin(half) / (TURN * frequency)
    return complex(chord * math.cos(half), chord * math.sin(half))


@compiled
def wave_moment(w: float, wave: complex, zero: complex, t: float) -> complex:
    """Return ∫τ e^(iwτ) dτ from 0 to t; `wave` is e^(iwt), and `zero` the integral without τ."""
    if abs(w * t) >= _SERIES:
        return (t * wave - zero) * complex(0.0, -1.0 / w)
    term, total = complex(1.0, 0.0), complex(0.5, 0.0)
    for n in range(1, _TERMS):
        term *= complex(0.0, w * t / n)
        total += term * (1.0 / (n + 2.0))
    return t * t * total


@compiled
def swept_integral(w: float, v: float, rate: float, zero: complex, one: complex, t: float) -> complex:
    """Return ∫(v + rate τ) φ(τ) dτ with φ the integral of e^(iwτ), from 0 to t."""
    if abs(w * t) >= _SERIES:
        return (v * (zero - t) + rate * (one - 0.5 * t * t)) * complex(0.0, -1.0 / w)
    term, total, total1 = complex(1.0, 0.0), complex(0.5, 0.0), complex(1.0 / 3.0, 0.0)
    for n in range(1, _TERMS):
        term *= complex(0.0, w * t / (n + 1.0))
        total += term * (1.0 / (n + 2.0))
        total1 += term * (1.0 / (n + 3.0))
    return t * t * (v * total + rate * t * total1)


@compiled
def ramped_integral(w: float, wave: complex, zero: complex, other: float, other_zero: complex, product: complex,
                    t: float) -> complex:
    """Return ∫e^(iwτ) φ(τ) dτ, with φ the integral of e^(iw′τ); `product` is ∫e^(i(w + w′)τ)."""
    if abs(other * t) >= _SERIES:
        return (product - zero) * complex(0.0, -1.0 / other)
    if abs(w * t) >= _SERIES:
        return (wave * other_zero - product) * complex(0.0, -1.0 / w)
    a, both = complex(0.0, w * t), complex(0.0, (w + other) * t)
    power, term, total, weight = complex(1.0, 0.0), complex(1.0, 0.0), complex(0.5, 0.0), 1.0
    for n in range(1, _TERMS):
        power *= a
        term = both * term + power
        weight /= n + 1.0
        total += term * (weight / (n + 2.0))
    return t * t * total


@compiled
def wave_products(frequency: float, cycle: float, other: float, other_cycle: float, t: float
                 ) -> tuple[complex, complex]:
    """Return the integrals of e^(i(w − w′)τ) and of e^(i(w + w′)τ) from 0 to t."""
    few = (frequency - other) * t
    same = wave_integral(frequency - other, few if abs(few) < 0.5 else cycle - other_cycle, t)
    return same, wave_integral(frequency + other, cycle + other_cycle, t)
