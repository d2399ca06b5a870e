# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The first event of the present mode: which guard is reached first, and when.

No guard is scanned; `linear.roots` gives the arguments why none of its roots can be missed, and what they assume of
floating point; `judge` holds each event of a run to it.

* Slip: the acceleration of a linear mode vanishes at a closed-form time, and until then the speed is monotone; so the
  sign of (speed − knot) at that time decides whether the knot, or standstill, is reached before.
* Coasting: the residual force is a polynomial of the time.
* Stick: `static_guards` for a rigid contact, `compliant_stick` for a compliant one.
* Any mode under sines: `forced`.
"""

import math

from ...axis.layout import (
    ACCELERATION, AT, AT_FIRST, AT_G, AT_RATE, AT_SECOND, COMPLIANT, DIRECTION, JERK, KNOTS, LAST, MODE, NEXT,
    NEXT_KIND, PIECE, RESIDUAL, SEARCHED, SNAP, VELOCITY, WAVES,
)
from ...axis.motion import (
    ACCELERATING, COASTING, STAMP, STICK, TICK, knot_speed, oscillator_of, tick_integrals, travel_at,
)
from ...axis.transitions import ACCELERATE, ARREST, BREAKAWAY, COAST, DECELERATE, KNOT, band_of, force_rate
from ...core.jit import inlined
from ...linear.roots import finite_horizon, first_crossing, first_passage, half_period
from .compliant_stick import compliant_stick
from .forced import forced_event
from .static_guards import rigid_stick

_SURELY = 1e-9   # of the change over a tick: far more than it changes within a STAMP


@inlined
def find_event(p, s, due):
    """Set the next event of the mode at the anchor, searched up to `due` (s after the anchor) at least."""
    if s[WAVES] != 0.0:
        forced_event(p, s, due)
        return
    mode = s[MODE]
    horizon = max(due, 2.0 * s[SEARCHED])
    s[SEARCHED] = horizon
    if mode == COASTING:
        _coasting(p, s)
    elif mode != STICK:
        _slipping(p, s, horizon)
    else:
        s[NEXT_KIND] = BREAKAWAY
        s[NEXT] = compliant_stick(p, s, horizon) if p[COMPLIANT] != 0.0 else rigid_stick(p, s, horizon)


@inlined
def _coasting(p, s):
    direction = s[DIRECTION]
    rate, bend = force_rate(p, s)
    rate *= direction
    bend *= direction
    rise = first_crossing(max(band_of(p, s) - s[RESIDUAL], 0.0), -rate, -bend)
    fall = first_crossing(s[RESIDUAL], rate, bend)
    s[NEXT] = min(rise, fall)
    s[NEXT_KIND] = ACCELERATE if rise <= fall else DECELERATE
    s[SEARCHED] = math.inf


@inlined
def _slipping(p, s, horizon):
    accelerating = s[MODE] == ACCELERATING
    speed = abs(s[VELOCITY])
    piece = int(s[PIECE])
    if accelerating:
        gap = knot_speed(p, piece + 1) - speed if piece + 1 < p[KNOTS] else math.inf
        sign = s[DIRECTION]
    else:
        gap = speed - knot_speed(p, piece)
        sign = -s[DIRECTION]
    if horizon < TICK and _keeps_on(p, s, sign, gap, horizon - STAMP):
        s[NEXT] = math.inf
        return
    t, passed, s[AT], s[AT_G], s[AT_RATE], s[AT_FIRST], s[AT_SECOND] = first_passage(
        oscillator_of(s), sign * s[ACCELERATION] + 0.0, sign * s[JERK], sign * s[SNAP], gap, horizon,
        s[LAST + int(s[MODE])])
    s[NEXT] = t
    if t == math.inf:
        s[AT] = -1.0   # where a search ends depends on the ticks; a command there must not
    if not passed:
        s[NEXT_KIND] = COAST
    else:
        s[NEXT_KIND] = KNOT if accelerating or piece > 0 else ARREST


@inlined
def _keeps_on(p, s, sign, gap, t):
    """Whether a short slip surely lasts up to t, and a STAMP beyond: the same sign of the acceleration, within the gap.

    See argument 2 of `linear.roots`.  What was evaluated is noted for who goes to t.
    """
    osc = oscillator_of(s)
    if s[SNAP] != 0.0 or gap <= 0.0 or not t < finite_horizon(osc, half_period(osc)):
        return False
    s[AT_G], s[AT_RATE], s[AT_FIRST], s[AT_SECOND] = tick_integrals(s, t)
    s[AT] = t
    _, u, a = travel_at(p, s)
    still = _SURELY * (abs(s[ACCELERATION]) + abs(s[JERK]) * t)
    if sign * a > still and sign * (u - s[VELOCITY]) < gap - still * t:
        return True
    s[AT] = -1.0
    return False
