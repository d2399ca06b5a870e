# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The guard of a search under sines: between which limits the signal stays, and steps in which no gap to one vanishes.

`forced` has the bounds that make a step safe, and why.
"""

import math
from typing import NamedTuple

from ...axis.codes import COASTING, STICK
from ...axis.forces import band_of, friction_line, static_limit, static_numbers
from ...axis.layout import Parameters
from ...axis.sinusoids import fastest_sinusoid
from ...axis.smooth_load import LoadBounds, load_bounds, normal_force_at
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...friction.static import CONSTANT
from ...linear.zeros import first_crossing, safe_step
from .signal_readings import Reading
from .signals import GuardSignal
from .static_guards import concave_root, grown, is_concave, law, steep_start


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
    return 2.0 / fastest if fastest > 0.0 else static_numbers(p, 1.0).tau


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
