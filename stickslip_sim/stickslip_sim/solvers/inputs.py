# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The inputs of solvers that step: v(t) and F_e(t) at any time, from what `set_inputs` gave them."""

import math

from ..axis.rows import Sinusoids
from ..axis.state_record import State
from ..core.hot_path import compiled
from ..linear.waves import TURN, phase_at


@compiled
def hold_inputs(s: State, second: float, fraction: float, v: float, v_rate: float, f: float, f_rate: float,
                sinusoids: Sinusoids) -> None:
    """Let the inputs be v + v_rate t, f + f_rate t and the sinusoids from a time on."""
    s.given.second, s.given.fraction = second, fraction
    s.given.v, s.given.v_rate, s.given.f, s.given.f_rate = v, v_rate, f, f_rate
    s.given_sinusoids = float(sinusoids.count)
    for k in range(sinusoids.count):
        s.sinusoids[k].frequency, s.sinusoids[k].phase = sinusoids.rows[k].frequency, sinusoids.rows[k].phase
        s.sinusoids[k].v, s.sinusoids[k].f = sinusoids.rows[k].v, sinusoids.rows[k].f


@compiled
def same_inputs(s: State, v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids) -> bool:
    """Whether the inputs hold already and do not change but for the same sinusoids."""
    if (s.given.v != v or s.given.f != f or s.given.v_rate != 0.0 or s.given.f_rate != 0.0 or v_rate != 0.0
            or f_rate != 0.0 or s.given_sinusoids != sinusoids.count):
        return False
    for k in range(sinusoids.count):
        if (s.sinusoids[k].frequency != sinusoids.rows[k].frequency or s.sinusoids[k].phase != sinusoids.rows[k].phase
                or s.sinusoids[k].v != sinusoids.rows[k].v or s.sinusoids[k].f != sinusoids.rows[k].f):
            return False
    return True


@compiled
def inputs_vary(s: State) -> bool:
    """Whether the inputs change by themselves."""
    return s.given.v_rate != 0.0 or s.given.f_rate != 0.0 or s.given_sinusoids != 0.0


@compiled
def given_inputs_at(s: State, second: float, fraction: float) -> tuple[float, float]:
    """Return v and F_e at a time."""
    t = (second - s.given.second) + (fraction - s.given.fraction)
    v = s.given.v + s.given.v_rate * t
    f = s.given.f + s.given.f_rate * t
    for k in range(int(s.given_sinusoids)):
        sine = math.sin(TURN * phase_at(s.sinusoids[k].frequency, s.sinusoids[k].phase, second, fraction))
        v += s.sinusoids[k].v * sine
        f += s.sinusoids[k].f * sine
    return v, f


@compiled
def refresh_inputs(s: State) -> None:
    """Set V, F and their rates to those at the time of the state."""
    s.inputs.v, s.inputs.f = given_inputs_at(s, s.second, s.fraction)
    s.inputs.v_rate, s.inputs.f_rate = s.given.v_rate, s.given.f_rate
    for k in range(int(s.given_sinusoids)):
        frequency = s.sinusoids[k].frequency
        slope = TURN * frequency * math.cos(TURN * phase_at(frequency, s.sinusoids[k].phase, s.second, s.fraction))
        s.inputs.v_rate += s.sinusoids[k].v * slope
        s.inputs.f_rate += s.sinusoids[k].f * slope
