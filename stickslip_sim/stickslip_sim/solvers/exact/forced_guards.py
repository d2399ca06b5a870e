# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The guard of a search under sines: between which limits the signal stays, and steps in which no gap to one vanishes.

`forced` has the bounds that make a step safe, and why.
"""

import math
from typing import NamedTuple

from ...axis.codes import COASTING, STICK
from ...axis.forces import band_of
from ...axis.layout import Parameters
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...linear.polynomials import safe_step
from .signal_readings import Reading
from .static_guards import grown, law, steep_start


class GuardLimits(NamedTuple):
    """What the signal is to stay between."""

    top: float
    top_rate: float
    bow: float          # bound on −top″ and floor″
    floor: float
    floor_rate: float


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
    if s.mode == STICK:
        normal = p.normal_force
        if normal == 0.0:
            return GuardLimits(0.0, 0.0, 0.0, 0.0, 0.0)
        limit, growth, curvature = law(p, s.rest + t, 1.0)
        back, back_growth, bow = limit, growth, curvature
        if p.sided != 0.0:
            back, back_growth, bow = law(p, s.rest + t, -1.0)
            bow = max(curvature, bow)
        return GuardLimits(normal * limit, normal * growth, normal * bow, -normal * back, -normal * back_growth)
    if s.mode == COASTING:
        return GuardLimits(band_of(p, s), 0.0, 0.0, 0.0, 0.0)
    return GuardLimits(math.inf, 0.0, 0.0, 0.0, 0.0)


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
    return Guard(side, value, fall, swing, noise, min(step, now.reach), min(exact, now.reach))


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
