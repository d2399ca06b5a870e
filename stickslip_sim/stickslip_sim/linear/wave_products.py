# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Closed integrals of waves and of their products, over any number of turns or a small part of one.

Complex numbers do without division, so that machine code and plain Python agree to the bit.  A phase is counted in
turns, as in `waves`; a wave e^(iwτ) begins at 1.
"""

import math

from ..core.hot_path import compiled
from .waves import TURN, turns

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
