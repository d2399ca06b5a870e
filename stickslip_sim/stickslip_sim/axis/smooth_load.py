# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A normal force that varies smoothly: N(t) = base + rate t + Σ A sin(2π f t + phase).

Its sinusoids stand among those of the inputs (`sinusoids`), its rate among the parameters.  The normal force of the
parameters is that at the segment start; `base_n` of the inputs is what is left of it without the sinusoids.
"""

import math
from typing import NamedTuple

from ..core.hot_path import compiled, inlined
from ..linear.waves import TURN, turns
from .codes import COASTING
from .forces import friction_line
from .layout import Parameters
from .state_record import State


class LoadBounds(NamedTuple):
    """Bounds on N(t) over a stretch of time."""

    least: float   # N
    most: float    # N
    slope: float   # N/s, on |N′|
    bend: float    # N/s², on |N″|


@inlined
def load_share(p: Parameters, s: State) -> float:
    """Return what a change of N takes from F_d + F_e − F along x, by its size: σ mu_k while coasting, else 0."""
    if s.is_loaded == 0.0 or s.mode != COASTING:
        return 0.0
    coefficient, _, _, _ = friction_line(p, int(s.segment), abs(s.velocity))
    return s.direction * coefficient


@inlined
def take_load(p: Parameters, s: State) -> None:
    """Let the parameters have the normal force at the segment start, which is the state's where it varies smoothly."""
    if s.is_loaded != 0.0:
        p.normal_force = s.inputs.n


@compiled
def begin_load(p: Parameters, s: State) -> None:
    """Set the normal force and its rate at the segment start, where the sinusoids have been brought to."""
    n, rate, varies = s.inputs.base_n, p.normal_rate, p.normal_rate != 0.0
    for k in range(int(s.sinusoid_count)):
        if s.sinusoids[k].n != 0.0:
            varies = True
            n += s.sinusoids[k].n * s.sinusoids[k].sine
            rate += s.sinusoids[k].n * TURN * s.sinusoids[k].frequency * s.sinusoids[k].cosine
    s.is_loaded = 1.0 if varies else 0.0
    s.inputs.n_rate = rate
    if varies:
        s.inputs.n = max(n, 0.0)   # rounding of a sum that is not negative
        p.normal_force = s.inputs.n


@compiled
def normal_force_at(p: Parameters, s: State, t: float) -> tuple[float, float]:
    """Return N and N′ at t after the segment start."""
    if s.is_loaded == 0.0:
        return p.normal_force, 0.0
    n, rate = s.inputs.base_n + p.normal_rate * t, p.normal_rate
    for k in range(int(s.sinusoid_count)):
        if s.sinusoids[k].n != 0.0:
            frequency = s.sinusoids[k].frequency
            phase = TURN * (s.sinusoids[k].turns + turns(frequency, t))
            n += s.sinusoids[k].n * math.sin(phase)
            rate += s.sinusoids[k].n * TURN * frequency * math.cos(phase)
    return max(n, 0.0), rate


@compiled
def load_bounds(p: Parameters, s: State, t: float, reach: float) -> LoadBounds:
    """Return bounds from t after the segment start on, over `reach` s."""
    if s.is_loaded == 0.0:
        return LoadBounds(p.normal_force, p.normal_force, 0.0, 0.0)
    swing, slope, bend = 0.0, abs(p.normal_rate), 0.0
    for k in range(int(s.sinusoid_count)):
        amplitude, w = abs(s.sinusoids[k].n), TURN * s.sinusoids[k].frequency
        swing += amplitude
        slope += amplitude * w
        bend += amplitude * w * w
    now = s.inputs.base_n + p.normal_rate * t
    later = now + p.normal_rate * reach if p.normal_rate != 0.0 else now
    return LoadBounds(max(min(now, later) - swing, 0.0), max(now, later) + swing, slope, bend)
