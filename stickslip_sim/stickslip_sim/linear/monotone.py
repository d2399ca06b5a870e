# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The root of a rise that is monotone, and the rise under a ramp of the drive (`roots`, argument 2)."""

import math

from ..core.hot_path import compiled, inlined
from .oscillator import Oscillator, integrals, short_integrals
from .zeros import EPSILON, ITERATIONS, finite_horizon, first_zero, householder, householder_settles, next_zero


@compiled
def passage_under_ramp(osc: Oscillator, rate: float, jerk: float, snap: float, gap: float, horizon: float
                       ) -> tuple[float, bool]:
    """Return (t, passed) of `first_passage` where the drive's velocity changes: snap is not 0."""
    turn = _first_turn(osc, rate, jerk, snap)
    end = min(turn, horizon)
    if gap < math.inf:
        reached, _, _ = _passage(osc, rate, jerk, snap, end)
        if reached >= gap:
            if end < turn:
                end, reached = bracket(osc, rate, jerk, snap, gap, turn)
            return monotone_root(osc, rate, jerk, snap, gap, end, reached), True
    return (turn, False) if turn <= horizon else (math.inf, False)


@compiled
def bracket(osc: Oscillator, rate: float, jerk: float, snap: float, gap: float, turn: float) -> tuple[float, float]:
    """Return an end of the rise of r at which it has reached the gap, and r there."""
    last = finite_horizon(osc, math.inf)
    if turn <= last and turn < math.inf:
        return turn, _passage(osc, rate, jerk, snap, turn)[0]
    if osc.gamma != 0.0 or osc.omega2 > 0.0:
        end = min(1.0 / (abs(osc.gamma) + math.sqrt(osc.omega2)), last)
    else:
        end = gap / rate if rate > 0.0 else math.sqrt(2.0 * gap / jerk)   # as without the next term
    while True:
        reached = _passage(osc, rate, jerk, snap, end)[0]
        if reached >= gap or end == last:
            return end, reached
        end = min(2.0 * end, last)


@inlined
def _passage(osc: Oscillator, rate: float, jerk: float, snap: float, t: float) -> tuple[float, float, float]:
    """Return r, r′ and r″ at t."""
    if snap != 0.0:
        g, slope, first, second, _ = integrals(osc, t)
    else:
        g, slope, first, second = short_integrals(osc, t)
    second_rate = -2.0 * osc.gamma * slope - osc.omega2 * g
    return (rate * g + jerk * first + snap * second,
            rate * slope + jerk * g + snap * first,
            rate * second_rate + jerk * slope + snap * g)


@compiled
def monotone_root(osc: Oscillator, rate: float, jerk: float, snap: float, gap: float, end: float, reached: float
                  ) -> float:
    """Return the root of r(t) = gap on (0, end], r growing on it: Householder's step inside a shrinking bracket.

    The last step is the one whose error is rounding.
    """
    frequency = abs(osc.gamma) + math.sqrt(osc.omega2)
    low, high = 0.0, end
    t = end * first_guess(rate, gap / reached)
    before = end
    for _ in range(ITERATIONS):
        value, slope, change = _passage(osc, rate, jerk, snap, t)
        value -= gap
        if value < 0.0:
            low = t
        else:
            high = t
        if abs(value) <= 2.0 * EPSILON * t * slope:
            return min(max(t - value / slope, low), high) if slope > 0.0 else t
        guess, ratio = math.inf, 0.0
        if slope > 0.0:
            step, ratio = householder(value, slope, change, snap - 2.0 * osc.gamma * change - osc.omega2 * slope)
            guess = t - step
        size = abs(guess - t)
        if low <= guess <= high and size <= 0.5 * before and (size > 0.0 or value == 0.0):
            sharpness = size * (abs(ratio) + frequency)
            if sharpness < 0.3 and householder_settles(size, sharpness, guess):
                return guess
        else:
            guess = 0.5 * (low + high)
            size = 0.5 * (high - low)
            if guess <= low or guess >= high:
                return guess
        before = size
        t = guess
    return t


@compiled
def first_guess(rate: float, share: float) -> float:
    """Return where, as a share of the interval, a sine that flattens at its end has risen to a share of its height."""
    if not 0.0 < share < 1.0:
        return 1.0
    return 2.0 / math.pi * math.asin(share if rate > 0.0 else math.sqrt(share))


@compiled
def _first_turn(osc: Oscillator, rate: float, jerk: float, snap: float) -> float:
    """Return the first t > 0 at which a, rising or positive at first, comes down to 0; snap is not 0, and so ω² > 0.

    a is monotone between the zeros of the free motion a′.  It swings around snap/ω² ever less (γ > 0), so that it stays
    positive once its swing is smaller than that.
    """
    slope = jerk - 2.0 * osc.gamma * rate
    second_rate = snap - osc.omega2 * rate      # a′ = slope g′ + second_rate g
    steady = snap / osc.omega2
    sign = 1.0 if slope > 0.0 or (slope == 0.0 and second_rate > 0.0) else -1.0
    last = finite_horizon(osc, math.inf)
    low, high = 0.0, first_zero(osc, sign * slope, sign * second_rate)
    if high == math.inf and (sign > 0.0 or (osc.gamma >= 0.0 and steady >= 0.0)):
        return math.inf
    while True:
        high = min(high, last)
        if high == math.inf:
            high = max(2.0 * low, 1.0 / math.sqrt(osc.omega2))
        value = _passage(osc, rate, jerk, snap, high)[1]
        if value < 0.0:
            return _turn_between(osc, rate, jerk, snap, low, high)
        if high == last or (osc.gamma >= 0.0 and abs(value - steady) <= steady):
            return math.inf
        low, high = high, next_zero(osc, high)


@compiled
def _turn_between(osc: Oscillator, rate: float, jerk: float, snap: float, low: float, high: float) -> float:
    """Return the zero of the falling, monotone a between low and high: Newton's step inside a shrinking bracket."""
    t = 0.5 * (low + high)
    before = high - low
    for _ in range(ITERATIONS):
        _, value, slope = _passage(osc, rate, jerk, snap, t)
        if value > 0.0:
            low = t
        else:
            high = t
        guess = t - value / slope if slope < 0.0 else math.inf
        if not (low <= guess <= high and abs(guess - t) <= 0.5 * before):
            guess = 0.5 * (low + high)
        before = abs(guess - t)
        if before <= 2.0 * EPSILON * t:
            return guess
        t = guess
    return t
