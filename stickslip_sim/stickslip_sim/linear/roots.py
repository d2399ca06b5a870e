# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""First roots that cannot be missed.

Three arguments cover every guard of a linear mode; none of them scans:

1. *A zero of a free motion* (`zeros.first_zero`) has a closed form: one atan2, or one logarithm when over-damped.
2. *Monotone pieces* (`first_passage`): between the closed-form zeros of its derivative a function is monotone, so its
   sign at the two ends decides whether it has a root between them, and a bracketed Newton step finds it.  The zeros of
   a free motion are at least half a period apart (an over-damped one has one at most): a derivative that is positive
   from the start on, and positive at a time within half a period, was positive all the way.
3. *Safe steps* (`zeros.safe_step`): when |f″| <= M from t on, f cannot vanish before the positive root d of
   f(t) + f′(t) d − M d²/2 = 0.  Steps of that length never pass a root, and converge to a simple one quadratically.

`zeros.first_crossing` is exact for polynomials of degree two.  "Never" is infinity.

What the arguments assume of floating point (tests/linear/test_linear.py holds each to it):

a. *Overflow*: nothing is evaluated where a growing mode has grown by more than e⁶⁰⁰; it has left every bounded piece
   before.  There a value is a number, a product of two is not, so that steps are taken in ratios (`zeros`).
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

from ..core.hot_path import inlined
from .monotone import bracket, first_guess, monotone_root, passage_under_ramp
from .oscillator import Oscillator, short_integrals
from .zeros import finite_horizon, first_zero, half_period, householder, householder_settles

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
