# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""When the contact force of a compliant stick reaches N mu_s(t⁻).

F_c = P(t) + H(t): P is linear (quadratic under a ramp of the drive), H a decaying free motion with |H| <= A exp(−d t).

1. Safe steps with a bound on the curvature that is left, from a contact that may sit on its limit when it begins,
   until the envelope of H leaves room between P and the limit.
2. From there on the guard less the envelope is concave: positive at both ends of an interval, it has no zero in it.
   The root of the guard is sought directly; a time shortly before it, at which the guard less the envelope is positive
   and from which on the guard falls for certain, proves that it is the first (`_direct_root`).
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

from ...axis.layout import (
    ACCELERATION, AT, AT_FIRST, AT_G, AT_RATE, AT_SECOND, CONTACT_DAMPING, CONTACT_STIFFNESS, DAMPING, DEFLECTION,
    F_RATE, ITERATIONS, JERK, LAST, NORMAL, REST, SEARCHED, SNAP, STATIC_INITIAL, STATIC_LIMIT, STATIC_TAU, STIFFNESS,
    V, VELOCITY, V_RATE,
)
from ...axis.motion import TICK, oscillator_of, static_limit, travel, travel_at
from ...axis.transitions import force_rounding
from ...core.jit import compiled, inlined
from ...linear.oscillator import amplitude, bound, impulse, short_integrals
from ...linear.roots import first_crossing, safe_step
from .static_guards import GAVE_UP, STEPS, concave_root, is_concave, law, steep_start

_EPSILON = 2.220446049250313e-16
_DIRECT_STEPS = 8
_WORTH = 0.5   # radian of the free motion: shorter leaps are left to the safe steps
_GO_ON, _IS_ROOT, _IN_BRACKET = 0.0, 1.0, 2.0


@compiled
def compliant_stick(p, s, horizon):
    """Return when |F_c| reaches N mu_s, infinity when that is behind the horizon, or GAVE_UP."""
    osc = oscillator_of(s)
    if horizon < TICK and _keeps_off(p, s, osc, horizon):
        return math.inf
    if p[NORMAL] * p[STATIC_LIMIT] == 0.0:
        return 0.0 if _moves(s) else math.inf
    motion = _contact_motion(p, s, osc)
    rounding = 0.5 * force_rounding(p, s, static_limit(p, s[REST]))
    if motion[3] == 0.0 and motion[4] == 0.0 and _rings_within(p, s, osc, motion, rounding):
        s[SEARCHED] = math.inf
        return math.inf
    may_leap = leaps_far = motion[4] == 0.0 and is_concave(p)
    pace = math.sqrt(osc[1])
    t = 0.0
    for i in range(STEPS):
        s[ITERATIONS] += 1.0
        contact = _contact_at(p, osc, motion, t)
        if may_leap and i == 1:
            root = _direct_root(p, s, osc, motion, contact, t)
            if root > 0.0:
                return root if root <= horizon else math.inf
            s[AT] = -1.0
        if may_leap and i > 0:
            leap = _leap(p, s, osc, contact, t, horizon - t)
            may_leap = leap == 0.0
            t += leap
            if leap > 0.0 and t <= horizon:
                continue
        if i > 0 and not leaps_far:
            leap = _frozen_leap(p, s, osc, motion[4], contact, t)
            if leap * pace > _WORTH:
                t += leap
                if t <= horizon:
                    continue
        if t <= horizon:
            step, found, side = _step(p, s, osc, contact, motion[4], t, rounding)
            if found == _IN_BRACKET:
                return _bracketed_root(p, s, osc, side, t, t + step)
            t += step
            if found == _IS_ROOT:
                return t
        if t > horizon:
            return math.inf
    return GAVE_UP


@inlined
def _keeps_off(p, s, osc, t):
    """Whether the force surely stays below N mu_s(0) up to t: by its rate and a bound on its curvature."""
    stiffness, damping = p[CONTACT_STIFFNESS], p[CONTACT_DAMPING]
    u, a, jerk = s[VELOCITY], s[ACCELERATION], s[JERK] - 2.0 * osc[0] * s[ACCELERATION]
    snap = s[SNAP] - 2.0 * osc[0] * jerk - osc[1] * a
    rate = abs(stiffness * u + damping * a)
    sag_bend = stiffness * s[SNAP] / osc[1]
    bend = bound(osc, stiffness * a + damping * jerk - sag_bend, stiffness * jerk + damping * snap) + abs(sag_bend)
    return abs(stiffness * s[DEFLECTION] + damping * u) + (rate + 0.5 * bend * t) * t < p[NORMAL] * p[STATIC_INITIAL]


@compiled
def _rings_within(p, s, osc, motion, rounding):
    """Whether a contact that the drive does not load any further stays within the limit of now, which never falls.

    Without a damper it may come back to the limit in every period, and touch it: no break-away, whatever rounding says.
    """
    _, _, free, free_rate, _, _ = _contact_at(p, osc, motion, 0.0)
    size, _ = amplitude(osc, free, free_rate)
    return abs(motion[2]) + size <= p[NORMAL] * static_limit(p, s[REST]) + 2.0 * rounding


@compiled
def _moves(s):
    """Whether a contact that holds nothing gives way: it does with the first derivative of its force that is not 0."""
    return not (s[DEFLECTION] == 0.0 and s[VELOCITY] == 0.0 and s[ACCELERATION] == 0.0 and s[JERK] == 0.0
                and s[SNAP] == 0.0)


@compiled
def _contact_motion(p, s, osc):
    """Return (y₀, free velocity, P, P′, P″) at the anchor.

    The slider's travel is y₀ + y₁ t + y₂ t²/2 and a free motion that starts at −y₀ with the free velocity.
    """
    stiffness, damping = p[CONTACT_STIFFNESS], p[CONTACT_DAMPING]
    gamma, omega2 = osc[0], osc[1]
    u = s[VELOCITY]
    y2 = s[SNAP] / omega2
    # u + JERK/ω² without the difference: 0 to the last bit while the drive rests
    pull = p[STIFFNESS] * s[V] + p[DAMPING] * s[V_RATE] + s[F_RATE]
    y1 = pull / (p[STIFFNESS] + stiffness) - 2.0 * gamma * y2 / omega2
    y0 = (s[ACCELERATION] + 2.0 * gamma * (u - y1) - y2) / omega2
    return (y0, u - y1, stiffness * (s[DEFLECTION] + y0) + damping * y1, stiffness * y1 + damping * y2,
            stiffness * y2)


@compiled
def _contact_at(p, osc, motion, t):
    """Return P, P′, H, H′, H″ and H‴ at t."""
    stiffness, damping = p[CONTACT_STIFFNESS], p[CONTACT_DAMPING]
    gamma, omega2 = osc[0], osc[1]
    y0, free_u, steady, rate, bend = motion
    g, slope = impulse(osc, t)
    y = free_u * g - y0 * (slope + 2.0 * gamma * g)
    v = free_u * slope + omega2 * y0 * g
    acc = -2.0 * gamma * v - omega2 * y
    jerk = -2.0 * gamma * acc - omega2 * v
    return (steady + (rate + 0.5 * bend * t) * t, rate + bend * t, stiffness * y + damping * v,
            stiffness * v + damping * acc, stiffness * acc + damping * jerk,
            stiffness * jerk - damping * (2.0 * gamma * jerk + omega2 * acc))


@compiled
def _force_at(p, s, t):
    """Return F_c and its rate at t, from the travel: P + H may cancel."""
    y, u, a = (0.0, s[VELOCITY], s[ACCELERATION]) if t == 0.0 else travel(p, s, t)
    stiffness, damping = p[CONTACT_STIFFNESS], p[CONTACT_DAMPING]
    return stiffness * (s[DEFLECTION] + y) + damping * u, stiffness * u + damping * a


@inlined
def _direct_root(p, s, osc, motion, contact, begin):
    """Return the root of the guard after `begin`, if it proves to be the first; 0 otherwise.

    `contact` is `_contact_at` at begin.  The steps are Halley's, from the time that stick lasted last time, or else
    from where the steady part alone reaches the limit.
    """
    sag, rate, free, free_rate, wave, _ = contact
    side = 1.0 if rate > 0.0 else -1.0
    size, decay = amplitude(osc, free, free_rate)
    room = p[NORMAL] * static_limit(p, s[REST] + begin) - abs(sag) - size
    if not room > 0.0 or rate == 0.0:
        return 0.0
    frequency = math.sqrt(osc[1]) + 1.0 / p[STATIC_TAU]
    t = s[LAST]
    if t <= begin:
        t = begin + room / abs(rate)
    for _ in range(_DIRECT_STEPS):
        s[ITERATIONS] += 1.0
        value, fall, bow = _guard_at(p, s, osc, t, side)
        if not fall < 0.0:
            return 0.0
        newton = value / fall
        step = newton / max(1.0 - 0.5 * newton * bow / fall, 0.5)
        sharpness = abs(step) * (abs(bow / fall) + frequency)
        t -= step
        if t <= begin:
            return 0.0
        if sharpness < 0.5 and abs(step) * sharpness * sharpness <= 0.1 * _EPSILON * t:
            break
    else:
        return 0.0
    before = t + 4.0 * size * math.exp(-decay * (t - begin)) / fall
    if before <= begin:
        return 0.0
    fading = math.exp(-decay * (before - begin))
    limit, growth, _ = law(p, s[REST] + before)
    clear = p[NORMAL] * limit - side * sag - abs(rate) * (before - begin) - size * fading
    rise, _ = amplitude(osc, free_rate, wave)
    falls = p[NORMAL] * growth - abs(rate) + rise * fading
    return t if clear > 0.0 and falls < 0.0 else 0.0


@inlined
def _guard_at(p, s, osc, t, side):
    """Return N mu_s − side F_c at t, its rate and its bend (with the bound of a law that is not concave)."""
    if s[SNAP] == 0.0:
        s[AT] = t
        s[AT_G], s[AT_RATE], s[AT_FIRST], s[AT_SECOND] = short_integrals(osc, t)
        y, u, a = travel_at(p, s)
    else:
        y, u, a = travel(p, s, t)
    jerk = s[JERK] + s[SNAP] * t + osc[1] * (s[VELOCITY] - u) - 2.0 * osc[0] * a
    stiffness, damping = p[CONTACT_STIFFNESS], p[CONTACT_DAMPING]
    limit, growth, curvature = law(p, s[REST] + t)
    return (p[NORMAL] * limit - side * (stiffness * (s[DEFLECTION] + y) + damping * u),
            p[NORMAL] * growth - side * (stiffness * u + damping * a),
            -p[NORMAL] * curvature - side * (stiffness * a + damping * jerk))


@compiled
def _leap(p, s, osc, contact, t, horizon):
    """Return how long the envelope keeps off the limit for certain; 0 when there is no room yet."""
    sag, rate, free, free_rate, _, _ = contact
    size, decay = amplitude(osc, free, free_rate)
    rest = s[REST] + t
    if p[NORMAL] * static_limit(p, rest) - abs(sag) - size <= 0.0:
        return 0.0
    if rate == 0.0:
        return math.inf
    return concave_root(p, s, rest, math.copysign(1.0, rate) * sag, abs(rate), size, decay, 0.0, horizon)


@compiled
def _frozen_leap(p, s, osc, sag_bend, contact, t):
    """Return how long the force keeps off the limit of now, which no law takes back, whatever the free motion does.

    It serves where P is bent or the law is not concave, under which the guard less the envelope may vanish twice.
    """
    sag, rate, free, free_rate, _, _ = contact
    size, _ = amplitude(osc, free, free_rate)
    room = p[NORMAL] * static_limit(p, s[REST] + t) - size
    if room <= abs(sag):
        return 0.0
    return min(first_crossing(room - sag, -rate, -sag_bend), first_crossing(room + sag, rate, sag_bend))


@compiled
def _step(p, s, osc, contact, sag_bend, t, rounding):
    """Return a step, what is at its end (nothing yet, the root, the upper end of a bracket around it), and the side."""
    _, _, _, _, wave, wave_rate = contact
    force, rate = _force_at(p, s, t)
    limit, growth, curvature = law(p, s[REST] + t)
    top, top_rate = p[NORMAL] * limit, p[NORMAL] * growth
    swing = bound(osc, wave, wave_rate) + abs(sag_bend)
    side = 1.0 if force > 0.0 or (force == 0.0 and rate > 0.0) else -1.0
    value, fall = max(top - side * force, 0.0), top_rate - side * rate
    if curvature == math.inf:
        step = steep_start(p, value, abs(rate), swing)
        return step, (_GO_ON if step > 0.0 else _IS_ROOT), side
    bend = swing + p[NORMAL] * curvature
    near, far = safe_step(value, fall, bend), safe_step(top + side * force, top_rate + side * rate, bend)
    if value <= rounding and fall < 0.0:
        return (0.0 if t == 0.0 else min(value / -fall, near)), _IS_ROOT, side
    step = min(near, far)
    if step <= 2.0 * _EPSILON * t:
        if fall != 0.0 or side * (sag_bend + wave) > 0.0 or (top == 0.0 and sag_bend + wave != 0.0):
            return 0.0, _IS_ROOT, side
        return min(_nudge(osc, wave, wave_rate), far), _GO_ON, side
    # a law that is not concave may bend the guard up more than `bend`: no upper end then
    if step == near and fall < 0.0 and fall * fall > 2.0 * bend * value and is_concave(p):
        return 2.0 * value / (math.sqrt(fall * fall - 2.0 * bend * value) - fall), _IN_BRACKET, side
    return step, _GO_ON, side


@compiled
def _bracketed_root(p, s, osc, side, low, high):
    """Return the root of the falling guard between low and high: Halley's step inside a shrinking bracket.

    Its error after a step d is about d (d (f″/f′ + frequency))²; the last step is the one that makes it rounding.
    """
    frequency = math.sqrt(osc[1]) + 1.0 / p[STATIC_TAU]
    t, before = low, high - low
    for _ in range(STEPS):
        s[ITERATIONS] += 1.0
        value, fall, bow = _guard_at(p, s, osc, t, side)
        if value > 0.0:
            low = t
        else:
            high = t
        newton = value / fall if fall < 0.0 else math.inf
        size = newton / max(1.0 - 0.5 * newton * bow / fall, 0.5) if fall < 0.0 else math.inf
        guess = t - size
        if low <= guess <= high and abs(size) <= before:
            sharpness = abs(size) * (abs(bow / fall) + frequency)
            if abs(newton) <= 2.0 * _EPSILON * t or abs(size) * sharpness * sharpness <= 0.1 * _EPSILON * guess:
                return guess
        else:
            guess = 0.5 * (low + high)
        before = abs(guess - t)
        if before <= _EPSILON * t:
            return guess
        t = guess
    return t


@compiled
def _nudge(osc, wave, wave_rate):
    """Return a step off a guard that touches its limit: value = slope = 0, and f″ > 0 with a bound on |f‴|."""
    wave_bend = -2.0 * osc[0] * wave_rate - osc[1] * wave
    third = bound(osc, wave_rate, wave_bend)
    return 3.0 * abs(wave) / third if third > 0.0 else 0.0
