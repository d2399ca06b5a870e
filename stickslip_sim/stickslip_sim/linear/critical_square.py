# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""∫z² of a free motion near critical damping, where splitting it into two exponentials would divide by what vanishes.

Over a short span it is a quadratic form in value and rate at the start, known from a power series; that of the double
span follows from it, and so on.
"""

from ..core.hot_path import compiled
from .oscillator import Oscillator, impulse

_STRETCH = 0.25      # ω t of the first span
_TERMS = 60          # never reached: 20 terms are below rounding


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
