# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The first event of the present mode: which guard is reached first, and when.

No guard is scanned; `linear.roots` gives the arguments why none of its roots can be missed, and what they assume of
floating point; `soundness` holds each event of a run to it.

* Slip: the acceleration of a linear mode vanishes at a closed-form time, and until then the speed is monotone; so the
  sign of (speed − breakpoint) at that time decides whether the breakpoint, or standstill, is reached before.
* Coasting: the residual force is a polynomial of the time.
* Stick: `static_guards` for a rigid contact, `compliant_stick` for a compliant one.  The force of a contact that has
  rung for long may change by more than rounding within the last bit of the time since the segment start.  Then the
  segment is renewed a few such bits before the root, without an event, and what is left is searched from there.
* Any mode under sines: `forced`; under a normal force that varies, too, but for a slip.
* A slip under a normal force that varies, and a contact that yields: `series_events`.
"""

import math

from ...axis.codes import ACCELERATE, ACCELERATING, ARREST, BREAKAWAY, COAST, COASTING, DECELERATE, KNOT, STICK
from ...axis.forces import band_of, breakpoint_speed, force_rate, segment_end
from ...axis.layout import Parameters
from ...axis.motion import oscillator_of, tick_integrals, travel_at
from ...axis.slip_series import moves_by_series
from ...axis.state_record import State
from ...core.hot_path import inlined
from ...linear.roots import EPSILON, finite_horizon, first_crossing, first_passage, half_period
from .compliant_stick import compliant_stick
from .forced import forced_event
from .series_events import RENEWAL, series_event
from .static_guards import TICK, delay_left, rigid_stick

STAMP = 2.0 ** -51       # s, more than the time of an event is rounded by
_LONG_RING = 1e10        # (ω t)² of a contact that has rung for long
_DIED_OUT = 40.0         # γ t of one that rings no more
_LEAD = 8.0 * EPSILON    # of the time of a root: more than it is off by
_SURELY = 1e-9   # of the change over a tick: far more than it changes within a STAMP


@inlined
def find_event(p: Parameters, s: State, due: float) -> None:
    """Set the next event of the mode, searched up to `due` (s after the segment start) at least.

    A stick whose mu_s waits for its growth is searched up to there with that limit, and then renewed.
    """
    wait = delay_left(p, s) if s.mode == STICK else 0.0
    if wait == 0.0:
        _find_at_once(p, s, due)
        return
    rest = s.rest
    s.rest = -math.inf
    _find_at_once(p, s, wait)
    s.rest = rest
    s.next.searched = math.inf
    if s.next.time > wait:
        s.next.time = wait
        s.next.kind = RENEWAL
        s.cache.at.time = -1.0


@inlined
def _find_at_once(p: Parameters, s: State, due: float) -> None:
    if moves_by_series(s):
        series_event(p, s)
        return
    if s.sinusoid_count != 0.0 or s.is_loaded != 0.0:
        forced_event(p, s, due)
        return
    mode = s.mode
    horizon = max(due, 2.0 * s.next.searched)
    s.next.searched = horizon
    if mode == COASTING:
        _coasting(p, s)
    elif mode != STICK:
        _slipping(p, s, horizon)
    else:
        s.next.kind = BREAKAWAY
        if p.compliant != 0.0:
            _pressed(p, s, horizon)
        else:
            s.next.time = rigid_stick(p, s, horizon)


@inlined
def _pressed(p: Parameters, s: State, horizon: float) -> None:
    """Search a compliant stick, also for roots whose renewal is within the horizon."""
    t = compliant_stick(p, s, horizon * (1.0 + 2.0 * _LEAD))
    s.next.time = t
    rings = s.oscillator.nu > 0.0 and s.oscillator.gamma * t < _DIED_OUT
    if t < math.inf and rings and s.oscillator.omega2 * t * t > _LONG_RING:
        s.next.kind = RENEWAL
        s.next.time = t * (1.0 - _LEAD)
        s.cache.at.time = -1.0


@inlined
def _coasting(p: Parameters, s: State) -> None:
    direction = s.direction
    rate, second_rate = force_rate(p, s)
    rate *= direction
    second_rate *= direction
    rise = first_crossing(max(band_of(p, s) - s.residual, 0.0), -rate, -second_rate)
    fall = first_crossing(s.residual, rate, second_rate)
    s.next.time = min(rise, fall)
    s.next.kind = ACCELERATE if rise <= fall else DECELERATE
    s.next.searched = math.inf


@inlined
def _slipping(p: Parameters, s: State, horizon: float) -> None:
    accelerating = s.mode == ACCELERATING
    speed = abs(s.velocity)
    segment = int(s.segment)
    if accelerating:
        gap = segment_end(p, segment) - speed
        sign = s.direction
    else:
        gap = speed - breakpoint_speed(p, segment)
        sign = -s.direction
    if horizon < TICK and _keeps_on(p, s, sign, gap, horizon - STAMP):
        s.next.time = math.inf
        return
    t, passed, s.cache.at.time, s.cache.at.g, s.cache.at.rate, s.cache.at.first, s.cache.at.second = first_passage(
        oscillator_of(s), sign * s.acceleration + 0.0, sign * s.jerk, sign * s.snap, gap, horizon,
        s.cache.last[int(s.mode)])
    s.next.time = t
    if t == math.inf:
        s.cache.at.time = -1.0   # where a search ends depends on the ticks; a command there must not
    if not passed:
        s.next.kind = COAST
    else:
        s.next.kind = KNOT if accelerating or breakpoint_speed(p, segment) > 0.0 else ARREST


@inlined
def _keeps_on(p: Parameters, s: State, sign: float, gap: float, t: float) -> bool:
    """Whether a short slip surely lasts up to t, and a STAMP beyond: the same sign of the acceleration, within the gap.

    See argument 2 of `linear.roots`.  What was evaluated is noted for who goes to t.
    """
    osc = oscillator_of(s)
    if s.snap != 0.0 or gap <= 0.0 or not t < finite_horizon(osc, half_period(osc)):
        return False
    s.cache.at.g, s.cache.at.rate, s.cache.at.first, s.cache.at.second = tick_integrals(s, t)
    s.cache.at.time = t
    _, u, a = travel_at(p, s)
    still = _SURELY * (abs(s.acceleration) + abs(s.jerk) * t)
    if sign * a > still and sign * (u - s.velocity) < gap - still * t:
        return True
    s.cache.at.time = -1.0
    return False
