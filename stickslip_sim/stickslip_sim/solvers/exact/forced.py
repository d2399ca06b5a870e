# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The first event of any mode under sines, and of stick and coasting under a normal force that varies.

Every guard says that a signal f (see `signals`) stays between a floor and a top: ∓N mu_s(t⁻) in stick, each with the
mu_s of its direction, 0 and the band while coasting, 0 and nothing in a slip.  The search marches in safe steps, and no
root can be missed:

1. At t the signal gives f, f′ and a bound M on |f″| over its reach.  The gap to a limit, G = top − f or f − floor, is
   at least G + G′ d − (M + N |mu_s″|) d²/2 for every d within reach, so that a step to the positive root of that never
   passes a root of G.  With ε the size of rounding, the march is that of G + 2ε: it does not come to rest at a gap that
   only touches 0, and passes over nothing deeper than 2ε.
2. An event is declared only where the gap is below −ε in fact, or where the same bound with the other sign proves that
   it falls through −2ε: a sinusoid whose peak stays below its limit, or on it, holds.  Either gives a bracket with a
   sign change, in which Newton's step finds the root to rounding.
3. In a slip the speed is monotone up to the first root of the acceleration, so its value at the end of each step shows
   whether a breakpoint, or standstill, was passed.
4. As long as mean + amplitudes + what is left of the free motion is below the limit, nothing can happen: the search
   leaps to the end of that, which under a constant mean is never.

In floating point: ε is the size of rounding of the signal and of the forces at the segment start; what passes a limit
by less is no event.  A root is accepted inside a bracket whose ends have been evaluated, when Newton's own error is
rounding or no number is left in it; a growing slip is followed to e⁶⁰⁰ at most (`linear.roots`).

The steps depend on the segment start alone, and the search rests at the last one (PROGRESS): splits of a run change no
bit.
"""

import math

from ...axis.codes import ACCELERATE, ACCELERATING, ARREST, BREAKAWAY, COAST, COASTING, DECELERATE, KNOT, STICK
from ...axis.forces import ROUNDING, breakpoint_speed, force_rounding, friction_line, lower_limit, segment_end
from ...axis.layout import Parameters
from ...axis.motion import oscillator_of
from ...axis.smooth_load import load_bounds
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...linear.oscillator import Oscillator
from ...linear.zeros import EPSILON, ITERATIONS, finite_horizon
from .forced_guards import GuardLimits, guard_at, guard_limits, leap_of
from .signal_readings import read_signal
from .signals import GuardSignal, signal_of
from .static_guards import GAVE_UP, is_concave

_STEPS = 10_000_000


@compiled
def forced_event(p: Parameters, s: State, due: float) -> None:
    """Set the next event of the mode, searched up to `due` (s after the segment start) at least."""
    osc = oscillator_of(s)
    signal = signal_of(p, s, osc)
    slips = s.mode != STICK and s.mode != COASTING
    gap = speed_gap(p, s) if slips else math.inf
    rounding = _rounding(p, s, slips)
    last = finite_horizon(osc, math.inf) if slips else math.inf
    s.next.time = math.inf
    if gap <= 0.0:
        _set_event(s, 0.0, passed_kind(p, s))
        return
    t = before = s.next.progress
    value_before, rose = 0.0, False
    for _ in range(_STEPS):
        s.iterations += 1.0
        now = read_signal(p, s, osc, signal, t)
        if now.gained >= gap:
            _set_event(s, _root(p, s, osc, signal, 0.0, gap, t, before, t), passed_kind(p, s))
            return
        limits = guard_limits(p, s, t)
        if _holds_nothing(s, limits):
            _set_event(s, t, BREAKAWAY)
            return
        if not slips:
            leap = leap_of(p, s, signal, now, limits, t, max(now.noise, rounding), max(due, 2.0 * s.next.searched) - t)
            if leap == math.inf or _lands_beyond(s, t, leap, due):
                return
            if leap > 0.0:
                t += leap
                before, value_before, rose = t, 0.0, False
                continue
        guard = guard_at(p, now, limits, rounding, signal.fastest)
        high = _root_at_last(p, s, guard.value, guard.fall, guard.swing, guard.noise, t)
        if high <= t + min(now.reach, limits.reach) and high < math.inf:
            low = before if guard.value <= 0.0 else t
            hovered = guard.value <= 0.0 and value_before <= 0.0
            if hovered and not rose:
                root = before
            else:
                root = _root(p, s, osc, signal, guard.side, 0.0, high if hovered else low, low, high)
            _conclude(p, s, osc, signal, slips, guard.side, gap, low, root)
            return
        if _is_searched(s, t, t if slips else t + guard.exact, due, last):
            return
        before, value_before, rose = t, guard.value, guard.fall > 0.0
        t += max(guard.step, 4.0 * EPSILON * t)
    s.next.time = GAVE_UP


@inlined
def _holds_nothing(s: State, limits: GuardLimits) -> bool:
    """Whether stick has no friction at all."""
    return limits.top == limits.floor and limits.top_rate == 0.0 and limits.bow == 0.0 and s.mode == STICK


@inlined
def _lands_beyond(s: State, t: float, leap: float, due: float) -> bool:
    """Note a leap from t, if there is one; return whether it ends the search."""
    if leap > 0.0:
        s.next.progress = s.next.searched = t + leap
    return leap > 0.0 and t + leap >= due


@inlined
def _is_searched(s: State, t: float, searched: float, due: float, last: float) -> bool:
    """Note a step from t that reaches `searched`; return whether that is far enough."""
    s.next.progress, s.next.searched = t, searched
    if searched < due and t > last:
        s.next.searched = math.inf
    return s.next.searched >= due


@compiled
def _set_event(s: State, t: float, kind: float) -> None:
    s.next.time = t
    s.next.kind = kind


@compiled
def speed_gap(p: Parameters, s: State) -> float:
    """Return how much speed is left to the next breakpoint, or to standstill."""
    speed, segment = abs(s.velocity), int(s.segment)
    if s.mode != ACCELERATING:
        return speed - breakpoint_speed(p, segment)
    return segment_end(p, segment) - speed


@compiled
def passed_kind(p: Parameters, s: State) -> float:
    """Return the event at which that speed is lost or gained."""
    return KNOT if s.mode == ACCELERATING or breakpoint_speed(p, int(s.segment)) > 0.0 else ARREST


@compiled
def _rounding(p: Parameters, s: State, slips: bool) -> float:
    """Return the size of rounding of the signal at the segment start, N or m/s²."""
    if not slips:
        limit = lower_limit(p, s.rest) if s.mode == STICK else 0.0
        if s.is_loaded == 0.0:
            return force_rounding(p, s, limit)
        return force_rounding(p, s, 0.0) + ROUNDING * load_bounds(p, s, 0.0, 0.0).most * limit
    coefficient, _, _, _ = friction_line(p, int(s.segment), abs(s.velocity))
    return force_rounding(p, s, coefficient) / p.mass


@compiled
def _root_at_last(p: Parameters, s: State, value: float, fall: float, swing: float, noise: float, t: float) -> float:
    """Return a time by which the gap has vanished for certain, infinity if there is none."""
    if value < -noise:
        return t
    if not fall < 0.0 or fall * fall <= 2.0 * swing * (max(value, 0.0) + 2.0 * noise):
        return math.inf
    if value <= 0.0:
        return t
    if s.mode == STICK and not is_concave(p):
        return math.inf    # a limit that is not concave may second_rate upwards more than the bound
    return t + 2.0 * value / (math.sqrt(fall * fall - 2.0 * swing * value) - fall)


@compiled
def _root(p: Parameters, s: State, osc: Oscillator, signal: GuardSignal, side: float, gap: float, t: float, low: float,
          high: float) -> float:
    """Return the root, between low and high, of what is positive at low and not at high; the search begins at t.

    That is the gap from a limit (`side` 1: top, −1: floor), or what a slip's speed has still to gain of `gap` (0).
    Newton's step inside a shrinking bracket.
    """
    before = 2.0 * (high - low)
    for _ in range(ITERATIONS):
        s.iterations += 1.0
        value, fall, curve, change = _reading(p, s, osc, signal, side, gap, t)
        if value > 0.0:
            low = t
        else:
            high = t
        guess = t - value / fall if fall < 0.0 else math.inf
        size = abs(guess - t)
        if low <= guess <= high and size <= 0.5 * before:
            if size * size * (curve + change * size) <= 0.2 * EPSILON * guess * -fall:
                return guess
        else:
            guess = 0.5 * (low + high)
            size = abs(guess - t)
            if guess <= low or guess >= high:
                return guess
        if size <= EPSILON * t:
            return guess
        before, t = size, guess
    return t


@compiled
def _reading(p: Parameters, s: State, osc: Oscillator, signal: GuardSignal, side: float, gap: float, t: float
            ) -> tuple[float, float, float, float]:
    """Return what `_root` seeks the zero of, its rate, and bounds on its second and third derivative at t."""
    now = read_signal(p, s, osc, signal, t)
    if side == 0.0:
        return gap - now.gained, -now.value, abs(now.rate), now.curvature
    limits = guard_limits(p, s, t)
    if side > 0.0:
        return limits.top - now.value, limits.top_rate - now.rate, now.curvature + limits.bow, 0.0
    return now.value - limits.floor, now.rate - limits.floor_rate, now.curvature + limits.bow, 0.0


@compiled
def _conclude(p: Parameters, s: State, osc: Oscillator, signal: GuardSignal, slips: bool, side: float, gap: float,
              low: float, root: float) -> None:
    """Set the event that a root means."""
    if not slips:
        if s.mode == STICK:
            _set_event(s, root, BREAKAWAY)
        else:
            _set_event(s, root, ACCELERATE if side > 0.0 else DECELERATE)
        return
    gained = read_signal(p, s, osc, signal, root).gained
    if gained >= gap:
        _set_event(s, _root(p, s, osc, signal, 0.0, gap, root, min(low, root), root), passed_kind(p, s))
    else:
        _set_event(s, root, COAST)
