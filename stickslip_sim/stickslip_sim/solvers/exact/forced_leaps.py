# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Leaps of a search under sines: how long the envelope of a signal keeps off its limits.

Argument 4 of `forced`.
"""

import math

from ...axis.codes import STICK
from ...axis.layout import Parameters
from ...axis.smooth_load import load_bounds
from ...axis.state_record import State
from ...core.hot_path import compiled
from ...friction.static import CONSTANT
from ...linear.polynomials import first_crossing
from .forced_guards import GuardLimits, steady_limits
from .signal_readings import Reading
from .signals import GuardSignal
from .static_guards import concave_root, is_concave

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
