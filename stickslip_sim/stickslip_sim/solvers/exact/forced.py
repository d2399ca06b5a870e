# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The first event of any mode under sines.

Every guard says that a signal f (see `signals`) stays between a floor and a top: ∓N mu_s(t⁻) in stick, 0 and the band
while coasting, 0 and nothing in a slip.  The search marches in safe steps, and no root can be missed:

1. At t the signal gives f, f′ and a bound M on |f″| over its reach.  The gap to a limit, G = top − f or f − floor, is
   at least G + G′ d − (M + N |mu_s″|) d²/2 for every d within reach, so that a step to the positive root of that never
   passes a root of G.  With ε the size of rounding, the march is that of G + 2ε: it does not come to rest at a gap that
   only touches 0, and passes over nothing deeper than 2ε.
2. An event is declared only where the gap is below −ε in fact, or where the same bound with the other sign proves that
   it falls through −2ε: a wave whose peak stays below its limit, or on it, holds.  Either gives a bracket with a sign
   change, in which Newton's step finds the root to rounding.
3. In a slip the speed is monotone up to the first root of the acceleration, so its value at the end of each step tells
   whether a knot, or standstill, was passed.
4. As long as mean + amplitudes + what is left of the free motion is below the limit, nothing can happen: the search
   leaps to the end of that, which under a constant mean is never.

In floating point: ε is the size of rounding of the signal and of the forces at the anchor; what passes a limit by less
is no event.  A root is accepted inside a bracket whose ends have been evaluated, when Newton's own error is rounding or
no number is left in it; a growing slip is followed to e⁶⁰⁰ at most (`linear.roots`).

The steps depend on the anchor alone, and the search rests at the last one (PROGRESS): splits of a run change no bit.
"""

import math

from ...axis.layout import (
    ITERATIONS, KNOTS, MASS, MODE, NEXT, NEXT_KIND, NORMAL, PIECE, PROGRESS, REST, SEARCHED, STATIC_LAW, VELOCITY,
)
from ...axis.motion import ACCELERATING, COASTING, STICK, friction_line, knot_speed, oscillator_of, static_limit
from ...axis.transitions import ACCELERATE, ARREST, BREAKAWAY, COAST, DECELERATE, KNOT, band_of, force_rounding
from ...core.jit import compiled
from ...friction.static import CONSTANT
from ...linear.roots import finite_horizon, first_crossing, safe_step
from .signals import read_signal, signal_of
from .static_guards import GAVE_UP, concave_root, is_concave, law, steep_start

_EPSILON = 2.220446049250313e-16
_STEPS = 10_000_000
_ITERATIONS = 2200   # halvings between any two numbers
_WORTH_A_LEAP = 1e-6   # room between envelope and limit, as a part of what lies between the limits


@compiled
def forced_event(p, s, due):
    """Set the next event of the mode at the anchor, searched up to `due` (s after the anchor) at least."""
    osc = oscillator_of(s)
    signal = signal_of(p, s, osc)
    slips = s[MODE] != STICK and s[MODE] != COASTING
    gap = _speed_gap(p, s) if slips else math.inf
    rounding = _rounding(p, s, slips)
    last = finite_horizon(osc, math.inf) if slips else math.inf
    s[NEXT] = math.inf
    if gap <= 0.0:
        _set_event(s, 0.0, _passed_kind(s))
        return
    t = before = s[PROGRESS]
    value_before = 0.0
    for _ in range(_STEPS):
        s[ITERATIONS] += 1.0
        f, rate, bend, reach, size, decay, noise, gained = read_signal(p, s, osc, signal, t)
        if gained >= gap:
            _set_event(s, _root(p, s, osc, signal, 0.0, gap, t, before, t), _passed_kind(s))
            return
        top, top_rate, bow, floor, floor_rate = _limits(p, s, t)
        if top == floor and top_rate == 0.0 and bow == 0.0 and s[MODE] == STICK:   # nothing holds
            _set_event(s, t, BREAKAWAY)
            return
        if not slips:
            horizon = max(due, 2.0 * s[SEARCHED]) - t
            leap = _leap(p, s, signal, t, top, floor, size, decay, max(noise, rounding), horizon)
            if leap == math.inf:
                return
            if leap > 0.0:
                t += leap
                before, value_before = t, 0.0
                s[PROGRESS] = t
                s[SEARCHED] = t
                if t >= due:
                    return
                continue
        swing = bend + bow
        noise = max(noise + rounding, swing * (1e-15 / signal[14]) ** 2)
        side, value, fall, step = _nearer(top - f, top_rate - rate, f - floor, rate - floor_rate, swing, noise)
        exact = _exact_step(top - f, top_rate - rate, f - floor, rate - floor_rate, swing)
        if swing == math.inf:   # Kato's law right after the arrest
            step = exact = steep_start(p, max(value, 0.0), abs(rate), bend) if value >= -noise else 0.0
        step, exact = min(step, reach), min(exact, reach)
        high = _root_at_last(p, s, value, fall, swing, noise, t)
        if high <= t + reach and high < math.inf:
            low = before if value <= 0.0 else t
            hovered = value <= 0.0 and value_before <= 0.0
            root = before if hovered else _root(p, s, osc, signal, side, 0.0, low, low, high)
            _conclude(p, s, osc, signal, slips, side, gap, low, root)
            return
        s[PROGRESS] = t
        s[SEARCHED] = t if slips else t + exact
        if s[SEARCHED] >= due:
            return
        if t > last:
            s[SEARCHED] = math.inf
            return
        before, value_before = t, value
        t += max(step, 4.0 * _EPSILON * t)
    s[NEXT] = GAVE_UP


@compiled
def _set_event(s, t, kind):
    s[NEXT] = t
    s[NEXT_KIND] = kind


@compiled
def _speed_gap(p, s):
    """Return how much speed is left to the next knot, or to standstill."""
    speed, piece = abs(s[VELOCITY]), int(s[PIECE])
    if s[MODE] != ACCELERATING:
        return speed - knot_speed(p, piece)
    return knot_speed(p, piece + 1) - speed if piece + 1 < p[KNOTS] else math.inf


@compiled
def _passed_kind(s):
    return KNOT if s[MODE] == ACCELERATING or s[PIECE] > 0.0 else ARREST


@compiled
def _rounding(p, s, slips):
    """Return the size of rounding of the signal at the anchor, N or m/s²."""
    if not slips:
        return force_rounding(p, s, static_limit(p, s[REST]) if s[MODE] == STICK else 0.0)
    coefficient, _, _, _ = friction_line(p, int(s[PIECE]), abs(s[VELOCITY]))
    return force_rounding(p, s, coefficient) / p[MASS]


@compiled
def _limits(p, s, t):
    """Return top, its rate, a bound on the downward bend of the gaps from it, floor and its rate at t."""
    if s[MODE] == STICK:
        limit, growth, curvature = law(p, s[REST] + t)
        normal = p[NORMAL]
        if normal == 0.0:
            return 0.0, 0.0, 0.0, 0.0, 0.0
        return normal * limit, normal * growth, normal * curvature, -normal * limit, -normal * growth
    if s[MODE] == COASTING:
        return band_of(p, s), 0.0, 0.0, 0.0, 0.0
    return math.inf, 0.0, 0.0, 0.0, 0.0


@compiled
def _leap(p, s, signal, t, top, floor, size, decay, noise, horizon):
    """Return how long the envelope keeps off both limits for certain: 0 without room, infinity up to the horizon.

    Where it does so for good, the search is over: SEARCHED is infinite.
    """
    _, _, rate, bend, _, _, mean, swing = signal[:8]
    mean += (rate + 0.5 * bend * t) * t
    reach = swing + size
    room = min(top - mean, mean - floor) - reach
    if room > noise and rate == 0.0 and bend == 0.0:
        s[SEARCHED] = math.inf
        return math.inf
    if not room > _WORTH_A_LEAP * (top - floor) or horizon <= 0.0:
        return 0.0
    rate += bend * t
    leap = min(_envelope_root(p, s, t, top - mean - swing, mean + swing, rate, bend, size, decay, horizon),
               _envelope_root(p, s, t, mean - floor - swing, swing - mean, -rate, -bend, size, decay, horizon))
    if leap > horizon:
        s[SEARCHED] = t + horizon
        return math.inf
    return leap


@compiled
def _envelope_root(p, s, t, room, force, rate, bend, size, decay, horizon):
    """Return when force + rate d + bend d²/2 + size exp(−decay d) may reach a limit that is `room` + size away now."""
    bend = max(bend, 0.0)
    if rate <= 0.0 and bend == 0.0:
        return math.inf
    if s[MODE] == STICK and p[STATIC_LAW] != CONSTANT and is_concave(p):
        return concave_root(p, s, s[REST] + t, force, rate, size, decay, bend, horizon)
    return first_crossing(room - size, -rate, -bend)


@compiled
def _nearer(up, up_rate, down, down_rate, swing, noise):
    """Return the side (1: top) whose limit may come first, its gap, the gap's rate, and a safe step for gap + 2ε."""
    below = safe_step(max(down + 2.0 * noise, 0.5 * noise), down_rate, swing)
    if up == math.inf:
        return -1.0, down, down_rate, below
    above = safe_step(max(up + 2.0 * noise, 0.5 * noise), up_rate, swing)
    if above < below or (above == below and up < down):
        return 1.0, up, up_rate, above
    return -1.0, down, down_rate, below


@compiled
def _exact_step(up, up_rate, down, down_rate, swing):
    """Return a step within which no gap vanishes."""
    below = safe_step(max(down, 0.0), down_rate, swing)
    return below if up == math.inf else min(safe_step(max(up, 0.0), up_rate, swing), below)


@compiled
def _root_at_last(p, s, value, fall, swing, noise, t):
    """Return a time by which the gap has vanished for certain, infinity if there is none."""
    if value < -noise:
        return t
    if not fall < 0.0 or fall * fall <= 2.0 * swing * (max(value, 0.0) + 2.0 * noise):
        return math.inf
    if value <= 0.0:
        return t
    if s[MODE] == STICK and not is_concave(p):
        return math.inf    # a limit that is not concave may bend upwards more than the bound
    return t + 2.0 * value / (math.sqrt(fall * fall - 2.0 * swing * value) - fall)


@compiled
def _root(p, s, osc, signal, side, gap, t, low, high):
    """Return the root, between low and high, of what is positive at low and not at high; the search begins at t.

    That is the gap from a limit (`side` 1: top, −1: floor), or what a slip's speed has still to gain of `gap` (0).
    Newton's step inside a shrinking bracket.
    """
    before = 2.0 * (high - low)
    for _ in range(_ITERATIONS):
        s[ITERATIONS] += 1.0
        value, fall, curve, change = _reading(p, s, osc, signal, side, gap, t)
        if value > 0.0:
            low = t
        else:
            high = t
        guess = t - value / fall if fall < 0.0 else math.inf
        size = abs(guess - t)
        if low <= guess <= high and size <= 0.5 * before:
            if size * size * (curve + change * size) <= 0.2 * _EPSILON * guess * -fall:
                return guess
        else:
            guess = 0.5 * (low + high)
            size = abs(guess - t)
            if guess <= low or guess >= high:
                return guess
        if size <= _EPSILON * t:
            return guess
        before, t = size, guess
    return t


@compiled
def _reading(p, s, osc, signal, side, gap, t):
    """Return what `_root` seeks the zero of, its rate, and bounds on its second and third derivative at t."""
    f, rate, bend, _, _, _, _, gained = read_signal(p, s, osc, signal, t)
    if side == 0.0:
        return gap - gained, -f, abs(rate), bend
    top, top_rate, bow, floor, floor_rate = _limits(p, s, t)
    if side > 0.0:
        return top - f, top_rate - rate, bend + bow, 0.0
    return f - floor, rate - floor_rate, bend + bow, 0.0


@compiled
def _conclude(p, s, osc, signal, slips, side, gap, low, root):
    """Set the event that a root means."""
    if not slips:
        if s[MODE] == STICK:
            _set_event(s, root, BREAKAWAY)
        else:
            _set_event(s, root, ACCELERATE if side > 0.0 else DECELERATE)
        return
    gained = read_signal(p, s, osc, signal, root)[7]
    if gained >= gap:
        _set_event(s, _root(p, s, osc, signal, 0.0, gap, root, min(low, root), root), _passed_kind(s))
    else:
        _set_event(s, root, COAST)
