# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""When the force of a compliant stick reaches N mu_s(t⁻) of its direction.

It is F_c, or F_d + F_e where it ends by that (`contact_force`), and P(t) + H(t): P is linear (quadratic under a ramp of
the drive), H a decaying free motion with |H| <= A exp(−d t).

1. Safe steps with a bound on the curvature that is left, from a contact that may sit on its limit when it begins,
   until the envelope of H leaves room between P and the limit.
2. From there on the guard less the envelope is concave: positive at both ends of an interval, it has no zero in it.
   The root of the guard is sought directly; a time shortly before it, at which the guard less the envelope is positive
   and from which on the guard falls for certain, proves that it is the first (`contact_force.direct_root`).
3. Without that proof: the root of the guard less the envelope is a time before which nothing can happen, one leap over
   the ring-down; then safe steps again.  Where P is bent or the law not concave, many shorter leaps below the limit
   of now take its place.
4. Where their bound proves that the guard falls all the way to its root, the root is bracketed and found there (under
   a concave law).

In floating point: a contact that is not loaded any further holds where the envelope of all that is to come is within
rounding of the limit (it may touch it in every period); else a guard within rounding of 0 that falls is at its root, so
that a peak that stays below the limit by less than that may break it.  H never grows, and where it has died out the
guard is P alone.
"""

import math

from ...axis.forces import force_rounding, holds_nothing, limit_backwards, static_at_once, static_limit
from ...axis.layout import Parameters
from ...axis.motion import oscillator_of
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...linear.oscillator import Oscillator, amplitude, bound
from ...linear.roots import EPSILON, first_crossing, safe_step
from .contact_force import (
    ContactForce,
    ContactMotion,
    bracketed_root,
    contact_at,
    contact_motion,
    contact_rounding,
    direct_root,
    envelope_room,
    force_at,
    gives_way,
    moves,
    rings_within,
    rounding_so_far,
    second_at_start,
)
from .static_guards import GAVE_UP, STEPS, TICK, concave_root, is_concave, law, steep_start

_WORTH = 0.5   # radian of the free motion: shorter leaps are left to the safe steps
_GO_ON, _IS_ROOT, _IN_BRACKET = 0.0, 1.0, 2.0


@compiled
def compliant_stick(p: Parameters, s: State, horizon: float) -> float:
    """Return when F_c reaches N mu_s of its direction, infinity when that is behind the horizon, or GAVE_UP."""
    osc = oscillator_of(s)
    if horizon < TICK and p.ends_by_drive == 0.0 and _keeps_off(p, s, osc, horizon):
        return math.inf
    if holds_nothing(p):
        return 0.0 if moves(s) else math.inf
    if p.sided != 0.0 and gives_way(p, s, osc):
        return 0.0
    motion = contact_motion(p, s, osc)
    limit = static_limit(p, s.rest, 1.0)
    back = limit_backwards(p, s.rest, limit)
    if motion.rate == 0.0 and motion.second == 0.0 and rings_within(
            p, s, osc, motion, p.normal_force * limit + force_rounding(p, s, limit),
            p.normal_force * back + force_rounding(p, s, back)):
        s.next.searched = math.inf
        return math.inf
    rounding = _rounding(p, s, motion, limit)
    rounding_back = _rounding(p, s, motion, back) if p.sided != 0.0 else rounding
    may_leap = leaps_far = motion.second == 0.0 and is_concave(p)
    pace = math.sqrt(osc.omega2)
    t = 0.0
    for i in range(STEPS):
        if t > horizon:
            return math.inf
        s.iterations += 1.0
        contact = contact_at(p, osc, motion, t)
        if may_leap and i == 1:
            root = direct_root(p, s, osc, motion, contact, t)
            if root > 0.0:
                return root if root <= horizon else math.inf
            s.cache.at.time = -1.0
        if may_leap and i > 0:
            leap = _leap(p, s, osc, contact, t, horizon - t)
            may_leap = leap == 0.0
            t += leap
            if leap > 0.0:
                continue
        if i > 0 and not leaps_far:
            leap = _frozen_leap(p, s, osc, motion.second, contact, t)
            if leap * pace > _WORTH:
                t += leap
                continue
        step, found, side = _step(p, s, osc, contact, motion.second, t, rounding, rounding_back)
        if found == _IN_BRACKET:
            return bracketed_root(p, s, osc, side, t, t + step)
        t += step
        if found == _IS_ROOT:
            return t
    return GAVE_UP


@inlined
def _rounding(p: Parameters, s: State, motion: ContactMotion, limit: float) -> float:
    """Return how near to N mu_s = N `limit` the force counts as on it."""
    rounding = 0.5 * force_rounding(p, s, limit)
    return rounding if p.ends_by_drive != 0.0 else min(rounding, contact_rounding(p, s, motion, limit))


@inlined
def _keeps_off(p: Parameters, s: State, osc: Oscillator, t: float) -> bool:
    """Whether the force surely stays below N mu_s up to t: by its rate and a bound on its curvature.

    N mu_s is that of rest time 0, or that of now by more than rounding: no law takes it back.
    """
    stiffness, damping = p.contact_stiffness, p.contact_damping
    u, a, jerk = s.velocity, s.acceleration, s.jerk - 2.0 * osc.gamma * s.acceleration
    snap = s.snap - 2.0 * osc.gamma * jerk - osc.omega2 * a
    rate = abs(stiffness * u + damping * a)
    sag_second = stiffness * s.snap / osc.omega2
    second_rate = bound(osc, stiffness * a + damping * jerk - sag_second, stiffness * jerk + damping * snap)
    second_rate += abs(sag_second)
    force, way = stiffness * s.deflection + damping * u, (rate + 0.5 * second_rate * t) * t
    side = 1.0 if force > 0.0 else -1.0
    if not way - abs(force) < p.normal_force * static_at_once(p, -side):
        return False
    if abs(force) + way < p.normal_force * static_at_once(p, side):
        return True
    limit = static_limit(p, s.rest, side)
    return abs(force) + way < p.normal_force * limit - force_rounding(p, s, limit)


@compiled
def _leap(p: Parameters, s: State, osc: Oscillator, contact: ContactForce, t: float,
          horizon: float) -> float:
    """Return how long the envelope keeps off the limit for certain; 0 when there is no room yet."""
    sag, rate, free, free_rate, _, _ = contact
    size, decay = amplitude(osc, free, free_rate)
    rest, side = s.rest + t, math.copysign(1.0, rate)
    if envelope_room(p, rest, sag, size) <= 0.0:
        return 0.0
    if rate == 0.0:
        return math.inf
    return concave_root(p, s, rest, side, side * sag, abs(rate), size, decay, 0.0, horizon)


@compiled
def _frozen_leap(p: Parameters, s: State, osc: Oscillator, sag_second: float,
                 contact: ContactForce, t: float) -> float:
    """Return how long the force keeps off the limit of now, which no law takes back, for any free motion.

    It serves where P is bent or the law is not concave, under which the guard less the envelope may vanish twice.
    """
    sag, rate, free, free_rate, _, _ = contact
    size, _ = amplitude(osc, free, free_rate)
    limit = static_limit(p, s.rest + t, 1.0)
    room = p.normal_force * limit - size
    room_back = p.normal_force * limit_backwards(p, s.rest + t, limit) - size
    if room <= sag or room_back <= -sag:
        return 0.0
    return min(first_crossing(room - sag, -rate, -sag_second), first_crossing(room_back + sag, rate, sag_second))


@compiled
def _step(p: Parameters, s: State, osc: Oscillator, contact: ContactForce,
          sag_second: float, t: float, rounding: float, rounding_back: float) -> tuple[float, float, float]:
    """Return a step, what is at its end (nothing yet, the root, the upper end of a bracket around it), and the side."""
    _, _, _, _, free_second, free_third = contact
    force, rate = force_at(p, s, t)
    swing = bound(osc, free_second, free_third) + abs(sag_second)
    side = 1.0 if force > 0.0 or (force == 0.0 and rate > 0.0) else -1.0
    limit, growth, curvature = law(p, s.rest + t, side)
    back, back_growth, back_curvature = limit, growth, curvature
    if p.sided != 0.0:
        back, back_growth, back_curvature = law(p, s.rest + t, -side)
        if _is_nearer(p.normal_force * back + side * force, p.normal_force * back_growth + side * rate,
                      p.normal_force * limit - side * force, p.normal_force * growth - side * rate):
            side = -side
            limit, growth, curvature, back, back_growth, back_curvature = (
                back, back_growth, back_curvature, limit, growth, curvature)
    top, top_rate = p.normal_force * limit, p.normal_force * growth
    value, fall = max(top - side * force, 0.0), top_rate - side * rate
    other, other_fall = p.normal_force * back + side * force, p.normal_force * back_growth + side * rate
    if back_curvature == math.inf:
        far = steep_start(p, -side, max(other, 0.0), -side * rate, swing)
    else:
        far = safe_step(max(other, 0.0), other_fall, swing + p.normal_force * back_curvature)
    if curvature == math.inf:
        step = min(steep_start(p, side, value, side * rate, swing), far)
        return step, (_GO_ON if step > 0.0 else _IS_ROOT), side
    second_rate = swing + p.normal_force * curvature
    near = safe_step(value, fall, second_rate)
    rounded = rounding if side > 0.0 else rounding_back
    if p.ends_by_drive == 0.0:
        rounded = min(rounded, rounding_so_far(p, s, limit, t))
    if value <= rounded and fall < 0.0:
        return (0.0 if t == 0.0 else min(value / -fall, near)), _IS_ROOT, side
    step = min(near, far)
    if step <= 2.0 * EPSILON * t:
        bend = side * (sag_second + free_second)
        if t == 0.0:   # of P + H, which may cancel, as under a ramp from a rest
            bend = side * second_at_start(p, s, osc)
        if fall != 0.0 or bend > 0.0 or (bend != 0.0 and top == 0.0 and back == 0.0 and other_fall == 0.0):
            return 0.0, _IS_ROOT, side
        if bend == 0.0:
            if p.sided == 0.0 and side * free_third > 0.0:
                return 0.0, _IS_ROOT, side
            return min(_late_nudge(osc, free_second, free_third), far), _GO_ON, side
        return min(_nudge(osc, bend, free_second, free_third), far), _GO_ON, side
    # a law that is not concave may second_rate the guard up more than `second_rate`: no upper end then
    if step == near and fall < 0.0 and fall * fall > 2.0 * second_rate * value and is_concave(p):
        return 2.0 * value / (math.sqrt(fall * fall - 2.0 * second_rate * value) - fall), _IN_BRACKET, side
    return step, _GO_ON, side


@inlined
def _is_nearer(value: float, fall: float, than: float, than_fall: float) -> bool:
    """Whether a gap is the smaller one, or as small and closes faster."""
    return value < than or (value == than and fall < than_fall)


@compiled
def _nudge(osc: Oscillator, bend: float, free_second: float, free_third: float) -> float:
    """Return a step off a guard that touches its limit: value = slope = 0, and f″ = −`bend` > 0; |f‴| is bounded."""
    free_fourth = -2.0 * osc.gamma * free_third - osc.omega2 * free_second
    third = bound(osc, free_third, free_fourth)
    return 3.0 * abs(bend) / third if third > 0.0 else 0.0


@compiled
def _late_nudge(osc: Oscillator, free_second: float, free_third: float) -> float:
    """Return a step off a guard with value = slope = curvature = 0, as under a ramp from a rest, and f‴ > 0.

    Without any damper f‴ = 0, too, and f⁗ > 0.
    """
    free_fourth = -2.0 * osc.gamma * free_third - osc.omega2 * free_second
    free_fifth = -2.0 * osc.gamma * free_fourth - osc.omega2 * free_third
    if free_third != 0.0:
        fourth = bound(osc, free_fourth, free_fifth)
        return 4.0 * abs(free_third) / fourth if fourth > 0.0 else 0.0
    fifth = bound(osc, free_fifth, -2.0 * osc.gamma * free_fifth - osc.omega2 * free_fourth)
    return 5.0 * abs(free_fourth) / fifth if fifth > 0.0 else 0.0
