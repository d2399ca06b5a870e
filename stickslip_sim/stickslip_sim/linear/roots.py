# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""First roots that cannot be missed.

Three arguments cover every guard of a linear mode; none of them scans:

1. *A zero of a free motion* (`first_zero`) has a closed form: one atan2, or one logarithm when over-damped.
2. *Monotone pieces* (`first_passage`): between the closed-form zeros of its derivative a function is monotone, so its
   sign at the two ends decides whether it has a root between them, and a bracketed Newton step finds it.  The zeros of
   a free motion are at least half a period apart (an over-damped one has one at most): a derivative that is positive
   from the start on, and positive at a time within half a period, was positive all the way.
3. *Safe steps* (`zeros.safe_step`): when |f″| <= M from t on, f cannot vanish before the positive root d of
   f(t) + f′(t) d − M d²/2 = 0.  Steps of that length never pass a root, and converge to a simple one quadratically.

`zeros.first_crossing` is exact for polynomials of degree two.  "Never" is infinity.

What the arguments assume of floating point (tests/linear/test_linear.py holds each to it):

a. *Overflow*: nothing is evaluated where a growing mode has grown by more than e⁶⁰⁰; it has left every bounded piece
   before.  There a value is a number, a product of two is not, so that steps are taken in ratios.
b. *Underflow*: the rate of a mode that has died out may be 0 or have lost its digits.  A step from there is infinite
   or beyond the bracket, and the bracket is halved; a value that is not 0 never gives a step of 0.
c. *When a root is accepted*: inside a bracket whose ends have been evaluated and differ in sign, or where argument 2
   proves that there is one root, and only when the value is within rounding of 0, the step's own error is, or no number
   is left between the ends.  Loops allow for more halvings than there are between any two numbers.
d. *Signs at the ends* are those of computed values, right but within some 1e-15 of the terms that add up: a peak that
   passes the limit by less than that may be reported either way.
"""

import math
from typing import NamedTuple

from ..core.hot_path import compiled, inlined
from .oscillator import Oscillator, integrals, short_integrals

# Zeros of a free motion, in closed form, and how far a growing one may be followed (argument 1 and a).

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


# First roots of polynomials of degree two: exact ones, and bounds that make a step safe (argument 3).

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


# The root of a rise that is monotone, and the rise under a ramp of the drive (argument 2).

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


_DIRECT_STEPS = 8


class Passage(NamedTuple):
    """When a rise reached its gap or ended, and the evaluation next to that."""

    t: float
    passed: bool    # it was the gap
    at: float       # where g, g′, G₁ and G₂ (see `oscillator`) were evaluated; negative where they were not needed
    g: float
    rate: float
    first: float
    second: float


@inlined
def first_passage(osc: Oscillator, rate: float, jerk: float, snap: float, gap: float, horizon: float, guess: float
                 ) -> Passage:
    """Return when r reaches `gap`, or stops growing, whichever is first, and whether it was the gap.

    r(0) = 0 and r′ = a with a = rate g′ + jerk g + snap G₁ (see `oscillator`), rising at first: rate > 0, or
    rate = 0 and jerk (or else snap) > 0.  The time is infinite past the horizon, which decides whether there is a root,
    never which digits it has; `guess` (0: none) is a time near which the gap may be reached.

    The evaluation that comes with it, near t or at the horizon, is for who has to go there.
    """
    if gap <= 0.0:
        return Passage(0.0, True, -1.0, 0.0, 0.0, 0.0, 0.0)
    horizon = finite_horizon(osc, horizon)
    if snap != 0.0:
        t, passed = passage_under_ramp(osc, rate, jerk, snap, gap, horizon)
        return Passage(t, passed, -1.0, 0.0, 0.0, 0.0, 0.0)
    half = finite_horizon(osc, half_period(osc))
    if guess > 0.0:
        t, at, g, slope, first, second = _direct_root(osc, rate, jerk, gap, half, guess)
        if 0.0 <= t <= horizon:
            return Passage(t, True, at, g, slope, first, second)
        if t > horizon:
            return Passage(math.inf, False, -1.0, 0.0, 0.0, 0.0, 0.0)
    turn = first_zero(osc, rate, jerk)
    end = min(turn, horizon)
    g, slope, first, second = short_integrals(osc, end)
    reached = rate * g + jerk * first
    if gap < math.inf and reached >= gap:
        if end < turn:
            end, reached = bracket(osc, rate, jerk, snap, gap, turn)
        t, at, g, slope, first, second = _direct_root(osc, rate, jerk, gap, half,
                                                      end * first_guess(rate, gap / reached))
        if not 0.0 <= t <= end:
            t, at = monotone_root(osc, rate, jerk, snap, gap, end, reached), -1.0
        return Passage(t, True, at, g, slope, first, second)
    return Passage(turn if turn <= horizon else math.inf, False, end, g, slope, first, second)


@inlined
def _direct_root(osc: Oscillator, rate: float, jerk: float, gap: float, half: float, t: float
                ) -> tuple[float, float, float, float, float, float]:
    """Return the root of r(t) = gap by Householder's step from t on, and `at`, g, g′, G₁, G₂ of its last evaluation.

    The root is the first: see argument 2.  Where the steps leave the half period in which that holds, or do not
    settle, the root is −1.
    """
    frequency = abs(osc.gamma) + math.sqrt(osc.omega2)
    for _ in range(_DIRECT_STEPS):
        if t >= half:
            break
        g, slope, first, second = short_integrals(osc, t)
        speed = rate * slope + jerk * g
        if not speed > 0.0:
            break
        value = rate * g + jerk * first - gap
        change = jerk * slope - rate * (2.0 * osc.gamma * slope + osc.omega2 * g)
        step, ratio = householder(value, speed, change, -2.0 * osc.gamma * change - osc.omega2 * speed)
        size = abs(step)
        if not size < t:
            break
        sharpness = size * (abs(ratio) + frequency)
        root = t - step   # its own size counts: a guess may be far larger
        if sharpness < 0.3 and householder_settles(size, sharpness, root) and (
                size <= 0.5 * t and (size > 0.0 or value == 0.0)):
            return root, t, g, slope, first, second
        t = root
    return -1.0, -1.0, 0.0, 0.0, 0.0, 0.0
