# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Time integrals of one decaying or growing wave, e^(−γt) (a cos νt + b sin νt), in closed form.

The wave is the real part of Z e^(λt) with Z = a − i b and λ = −γ + i ν.  The forms divide by λ, so they are for spans
of time that are not short against 1/|λ|; shorter ones are a matter of quadrature.
"""

import math

from ..compiled import compiled


@compiled
def wave_moments(gamma, nu, t):
    """Return ∫ e^(λτ) dτ and ∫ τ e^(λτ) dτ from 0 to t, each as real and imaginary part; ν > 0."""
    decay = math.exp(-gamma * t)
    real, imaginary = decay * math.cos(nu * t), decay * math.sin(nu * t)
    zero_real, zero_imaginary = over_rate(gamma, nu, real - 1.0, imaginary)
    one_real, one_imaginary = over_rate(gamma, nu, t * real - zero_real, t * imaginary - zero_imaginary)
    return zero_real, zero_imaginary, one_real, one_imaginary


@compiled
def wave_square(gamma, nu, a, b, t):
    """Return ∫ (e^(−γτ) (a cos ντ + b sin ντ))² dτ from 0 to t; ν > 0."""
    real, imaginary, _, _ = wave_moments(2.0 * gamma, 2.0 * nu, t)
    mean = t if gamma == 0.0 else -math.expm1(-2.0 * gamma * t) / (2.0 * gamma)
    return 0.5 * ((a - b) * (a + b) * real + 2.0 * a * b * imaginary + (a * a + b * b) * mean)


@compiled
def over_rate(gamma, nu, real, imaginary):
    """Return (real + i imaginary)/λ as real and imaginary part."""
    size = gamma * gamma + nu * nu
    return (nu * imaginary - gamma * real) / size, -(gamma * imaginary + nu * real) / size
