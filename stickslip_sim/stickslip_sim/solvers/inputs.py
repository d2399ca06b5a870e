# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The inputs of solvers that step: v(t) and F_e(t) at any time, from what `set_inputs` gave them.

Waves stand after the state, four numbers each.
"""

import math

from ..axis.layout import (
    F, FRACTION, F_RATE, INPUT_F, INPUT_FRACTION, INPUT_F_RATE, INPUT_SECOND, INPUT_V, INPUT_V_RATE, INPUT_WAVES,
    SECOND, STATE_SIZE, V, V_RATE, WAVE_INPUTS,
)
from ..core.jit import compiled
from ..linear.waves import TURN, phase_at


@compiled
def hold_inputs(s, second, fraction, v, v_rate, f, f_rate, waves):
    """Let the inputs be v + v_rate t, f + f_rate t and the waves from a time on."""
    s[INPUT_SECOND], s[INPUT_FRACTION] = second, fraction
    s[INPUT_V], s[INPUT_V_RATE], s[INPUT_F], s[INPUT_F_RATE] = v, v_rate, f, f_rate
    s[INPUT_WAVES] = float(len(waves))
    for i in range(len(waves)):
        s[STATE_SIZE + i] = waves[i]


@compiled
def same_inputs(s, v, v_rate, f, f_rate, waves):
    """Whether the inputs hold already and do not change but for the same waves."""
    if (s[INPUT_V] != v or s[INPUT_F] != f or s[INPUT_V_RATE] != 0.0 or s[INPUT_F_RATE] != 0.0 or v_rate != 0.0
            or f_rate != 0.0 or s[INPUT_WAVES] != len(waves)):
        return False
    changed = 0
    for i in range(len(waves)):
        changed += s[STATE_SIZE + i] != waves[i]
    return changed == 0


@compiled
def inputs_vary(s):
    """Whether the inputs change by themselves."""
    return s[INPUT_V_RATE] != 0.0 or s[INPUT_F_RATE] != 0.0 or s[INPUT_WAVES] != 0.0


@compiled
def inputs_at(s, second, fraction):
    """Return v and F_e at a time."""
    t = (second - s[INPUT_SECOND]) + (fraction - s[INPUT_FRACTION])
    v = s[INPUT_V] + s[INPUT_V_RATE] * t
    f = s[INPUT_F] + s[INPUT_F_RATE] * t
    for at in range(STATE_SIZE, STATE_SIZE + int(s[INPUT_WAVES]), WAVE_INPUTS):
        wave = math.sin(TURN * phase_at(s[at], s[at + 1], second, fraction))
        v += s[at + 2] * wave
        f += s[at + 3] * wave
    return v, f


@compiled
def refresh_inputs(s):
    """Set V, F and their rates to those at the time of the state."""
    s[V], s[F] = inputs_at(s, s[SECOND], s[FRACTION])
    s[V_RATE], s[F_RATE] = s[INPUT_V_RATE], s[INPUT_F_RATE]
    for at in range(STATE_SIZE, STATE_SIZE + int(s[INPUT_WAVES]), WAVE_INPUTS):
        slope = TURN * s[at] * math.cos(TURN * phase_at(s[at], s[at + 1], s[SECOND], s[FRACTION]))
        s[V_RATE] += s[at + 2] * slope
        s[F_RATE] += s[at + 3] * slope
