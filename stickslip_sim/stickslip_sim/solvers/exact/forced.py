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
from typing import NamedTuple

from ...axis.codes import ACCELERATE, ACCELERATING, ARREST, BREAKAWAY, COAST, COASTING, DECELERATE, KNOT, STICK
from ...axis.forces import (
    ROUNDING,
    band_of,
    breakpoint_speed,
    force_rate,
    force_rounding,
    friction_line,
    lower_limit,
    segment_end,
    static_limit,
    static_numbers,
)
from ...axis.layout import Parameters
from ...axis.motion import oscillator_of
from ...axis.sinusoids import fastest_sinusoid
from ...axis.smooth_load import LoadBounds, load_bounds, normal_force_at
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...friction.static import CONSTANT
from ...linear.oscillator import Oscillator
from ...linear.roots import EPSILON, ITERATIONS, finite_horizon, first_crossing, safe_step
from .contact_force import moves
from .signals import GuardSignal, Reading, read_signal, signal_of
from .static_guards import GAVE_UP, concave_root, grown, is_concave, law, steep_start

# The guard of a search under sines: between which limits the signal stays, and steps in which no gap to one vanishes.
#
# `forced` has the bounds that make a step safe, and why.

class GuardLimits(NamedTuple):
    """What the signal is to stay between."""

    top: float
    top_rate: float
    bow: float          # bound on −top″ and floor″
    floor: float
    floor_rate: float
    reach: float        # s, how long the bound holds


class Guard(NamedTuple):
    """The gap to the limit that may be reached first, G, and safe steps."""

    side: float    # 1: the top, −1: the floor
    value: float   # G
    fall: float    # G′
    swing: float   # bound on |G″|
    noise: float   # ε, size of rounding
    step: float    # s, within which G + 2ε does not vanish
    exact: float   # s, within which no gap vanishes


@compiled
def guard_limits(p: Parameters, s: State, t: float) -> GuardLimits:
    """Return the limits of the signal at t."""
    return steady_limits(p, s, t) if s.is_loaded == 0.0 else _loaded_limits(p, s, t)


@compiled
def steady_limits(p: Parameters, s: State, t: float) -> GuardLimits:
    """Return the limits at t under the normal force of the parameters."""
    if s.mode == STICK:
        normal = p.normal_force
        if normal == 0.0:
            return GuardLimits(0.0, 0.0, 0.0, 0.0, 0.0, math.inf)
        limit, growth, curvature = law(p, s.rest + t, 1.0)
        back, back_growth, bow = limit, growth, curvature
        if p.sided != 0.0:
            back, back_growth, bow = law(p, s.rest + t, -1.0)
            bow = max(curvature, bow)
        return GuardLimits(normal * limit, normal * growth, normal * bow, -normal * back, -normal * back_growth,
                           math.inf)
    if s.mode == COASTING:
        return GuardLimits(band_of(p, s), 0.0, 0.0, 0.0, 0.0, math.inf)
    return GuardLimits(math.inf, 0.0, 0.0, 0.0, 0.0, math.inf)


@compiled
def _loaded_limits(p: Parameters, s: State, t: float) -> GuardLimits:
    """Return the limits at t under a normal force that varies: (N mu)″ = N″ mu + 2 N′ mu′ + N mu″, mu concave."""
    normal, rate = normal_force_at(p, s, t)
    window = _window(p, s)
    of = load_bounds(p, s, t, window)
    if s.mode == COASTING:
        band = _band_share(p, s)
        return GuardLimits(normal * band, rate * band, of.bend * band, 0.0, 0.0, math.inf)
    limit, growth, bow = _stick_limit(p, s, t, of, window, 1.0)
    back, back_growth = limit, growth
    if p.sided != 0.0:
        back, back_growth, back_bow = _stick_limit(p, s, t, of, window, -1.0)
        bow = max(bow, back_bow)
    return GuardLimits(normal * limit, rate * limit + normal * growth, bow, -normal * back,
                       -(rate * back + normal * back_growth), window)


@inlined
def _window(p: Parameters, s: State) -> float:
    """Return how long the bounds on a normal force that varies hold, s: a time in which it, or mu_s, changes."""
    fastest = fastest_sinusoid(s)
    if fastest > 0.0:
        return 2.0 / fastest
    return min(static_numbers(p, 1.0).tau, static_numbers(p, -1.0).tau)   # of both, as in the mirror


@inlined
def _stick_limit(p: Parameters, s: State, t: float, of: LoadBounds, window: float, side: float
                 ) -> tuple[float, float, float]:
    """Return mu_s at t, its rate, and a bound on the second rate of N mu_s over the window."""
    limit, growth, curvature = law(p, s.rest + t, side)
    if growth == 0.0:
        return limit, growth, of.bend * limit
    later = static_limit(p, s.rest + t + window, side)
    return limit, growth, of.bend * later + 2.0 * of.slope * growth + of.most * curvature


@inlined
def _band_share(p: Parameters, s: State) -> float:
    """Return the width of the coasting band over the normal force."""
    _, _, psi, _ = friction_line(p, int(s.segment), abs(s.velocity))
    return s.excess * psi


@inlined
def guard_at(p: Parameters, now: Reading, limits: GuardLimits, rounding: float, fastest: float) -> Guard:
    """Return the guard from a reading of the signal and its limits."""
    up, up_rate = limits.top - now.value, limits.top_rate - now.rate
    down, down_rate = now.value - limits.floor, now.rate - limits.floor_rate
    swing = now.curvature + limits.bow
    if swing == math.inf:   # Kato's law right after the arrest
        return _steep_guard(p, now, limits, now.noise + rounding)
    noise = max(now.noise + rounding, swing * (1e-15 / fastest) ** 2)
    side, value, fall, step = _nearer(up, up_rate, down, down_rate, swing, noise)
    exact = _exact_step(up, up_rate, down, down_rate, swing)
    reach = min(now.reach, limits.reach)
    return Guard(side, value, fall, swing, noise, min(step, reach), min(exact, reach))


@compiled
def _steep_guard(p: Parameters, now: Reading, limits: GuardLimits, noise: float) -> Guard:
    """Return the guard at rest time 0, where Kato's law lets the limit of one direction, or of both, rise steeply."""
    up, down = limits.top - now.value, now.value - limits.floor
    up_rate, down_rate = limits.top_rate - now.rate, now.rate - limits.floor_rate
    above = _side_step(p, now, 1.0, up + 2.0 * noise, up_rate)
    below = _side_step(p, now, -1.0, down + 2.0 * noise, down_rate)
    exact = min(_side_step(p, now, 1.0, up, up_rate), _side_step(p, now, -1.0, down, down_rate), now.reach)
    if above < below:
        return Guard(1.0, up, up_rate, now.curvature + p.normal_force * grown(p, 0.0, 1.0).curvature, noise,
                     min(above, now.reach), exact)
    return Guard(-1.0, down, down_rate, now.curvature + p.normal_force * grown(p, 0.0, -1.0).curvature, noise,
                 min(below, now.reach), exact)


@compiled
def _side_step(p: Parameters, now: Reading, side: float, gap: float, gap_rate: float) -> float:
    """Return a step from rest time 0 within which the gap to the limit of a direction does not vanish."""
    curvature = grown(p, 0.0, side).curvature
    if curvature == math.inf:
        return steep_start(p, side, max(gap, 0.0), side * now.rate, now.curvature)
    return safe_step(max(gap, 0.0), gap_rate, now.curvature + p.normal_force * curvature)


@compiled
def _nearer(up: float, up_rate: float, down: float, down_rate: float, swing: float, noise: float
           ) -> tuple[float, float, float, float]:
    """Return the side (1: top) whose limit may come first, its gap, the gap's rate, and a safe step for gap + 2ε."""
    below = safe_step(max(down + 2.0 * noise, 0.5 * noise), down_rate, swing)
    if up == math.inf:
        return -1.0, down, down_rate, below
    above = safe_step(max(up + 2.0 * noise, 0.5 * noise), up_rate, swing)
    if above < below or (above == below and up < down):
        return 1.0, up, up_rate, above
    return -1.0, down, down_rate, below


@compiled
def _exact_step(up: float, up_rate: float, down: float, down_rate: float, swing: float) -> float:
    """Return a step within which no gap vanishes."""
    below = safe_step(max(down, 0.0), down_rate, swing)
    return below if up == math.inf else min(safe_step(max(up, 0.0), up_rate, swing), below)


# Leaps of a search under sines: how long the envelope of a signal keeps off its limits.
#
# Argument 4 of `forced`.

_WORTH_IT = 1e-6   # room between envelope and limit, as a part of what lies between the limits


@compiled
def leap_of(p: Parameters, s: State, signal: GuardSignal, now: Reading, limits: GuardLimits, t: float, noise: float,
          horizon: float) -> float:
    """Return how long the envelope keeps off both limits for certain: 0 without room, infinity up to the horizon.

    Where it does so for good, the search is over: SEARCHED is infinite.  Under a normal force that varies the limits
    are those of the least; where that has a rate, of the least over a window, in which alone a leap ends.
    """
    if s.is_loaded == 0.0:
        return _steady_leap(p, s, signal, now, limits, t, noise, horizon)
    normal = p.normal_force
    within = horizon
    if p.normal_rate != 0.0:   # half of the time in which it would double, or vanish
        within = 0.5 * abs((s.inputs.base_n + p.normal_rate * t) / p.normal_rate)
    p.normal_force = load_bounds(p, s, t, within).least
    leap = _steady_leap(p, s, signal, now, steady_limits(p, s, t), t, noise, within)
    p.normal_force = normal
    if p.normal_rate == 0.0:
        return leap
    return min(leap, within)


@compiled
def _steady_leap(p: Parameters, s: State, signal: GuardSignal, now: Reading, limits: GuardLimits, t: float,
                 noise: float, horizon: float) -> float:
    rate, second_rate, mean, swing = signal.rate, signal.second, signal.mean, signal.amplitude
    top, floor, size, decay = limits.top, limits.floor, now.size, now.decay
    mean += (rate + 0.5 * second_rate * t) * t
    reach = swing + size
    room = min(top - mean, mean - floor) - reach
    if room > noise and rate == 0.0 and second_rate == 0.0:
        s.next.searched = math.inf
        return math.inf
    if not room > _WORTH_IT * (top - floor) or horizon <= 0.0:
        return 0.0
    rate += second_rate * t
    leap = min(
        _envelope_root(p, s, t, 1.0, top - mean - swing, mean + swing, rate, second_rate, size, decay, horizon),
        _envelope_root(p, s, t, -1.0, mean - floor - swing, swing - mean, -rate, -second_rate, size, decay, horizon))
    if leap > horizon:
        s.next.searched = t + horizon
        return math.inf
    return leap


@compiled
def _envelope_root(p: Parameters, s: State, t: float, side: float, room: float, force: float, rate: float,
                   second_rate: float, size: float, decay: float, horizon: float) -> float:
    """Return when force + rate d + second_rate d²/2 + size exp(−decay d) may reach a limit, now `room` off.

    `side` is the sign of the force at that limit in stick.
    """
    second_rate = max(second_rate, 0.0)
    if rate <= 0.0 and second_rate == 0.0:
        return math.inf
    if s.mode == STICK and p.static_law != CONSTANT and is_concave(p):
        return concave_root(p, s, s.rest + t, side, force, rate, size, decay, second_rate, horizon)
    return first_crossing(room - size, -rate, -second_rate)


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
        if _holds_nothing(s, limits) and _is_decided(p, s, signal, t):
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


@compiled
def _is_decided(p: Parameters, s: State, signal: GuardSignal, t: float) -> bool:
    """Let a slider that nothing holds slip at t where the force, 0 within rounding now, has a rate at all.

    Return True if it does, or rests for good.
    """
    rate, second_rate = force_rate(p, s)
    if rate != 0.0 or second_rate != 0.0 or (p.compliant != 0.0 and moves(s)):
        _set_event(s, t, BREAKAWAY)
        return True
    if signal.amplitude == 0.0:
        s.next.searched = math.inf
        return True
    return False


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
