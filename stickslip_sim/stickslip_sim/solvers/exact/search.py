"""The first event of the present mode: which guard is reached first, and when.

No guard is scanned; `linear.roots` gives the arguments why none of its roots can be missed.

* Slip: the acceleration of a linear mode vanishes at a closed-form time, and until then the speed is monotone; so the
  sign of (speed − knot) at that time decides whether the knot, or standstill, is reached before.
* Coasting: the residual force is a polynomial of the time.
* Rigid stick: N mu_s is concave for most laws and the force a polynomial.  A concave guard that is not negative at both
  ends of an interval has no root inside; and where its end is negative, Newton's method from that end descends to the
  only root without passing it.  A guard that is not concave takes safe steps.
* Compliant stick: the contact force is a polynomial and a decaying free motion.  Once the envelope of the latter leaves
  room, the guard less the envelope is concave again, and its root is a time before which nothing can happen; from
  there, and as long as there is no room, safe steps with a bound on the curvature that is left.
"""

import math

from ...axis.layout import (
    ACCELERATION, COMPLIANT, CONTACT_DAMPING, CONTACT_STIFFNESS, DEFLECTION, DIRECTION, ITERATIONS, JERK, KNOTS, MODE,
    NEXT, NEXT_KIND, NORMAL, PIECE, RESIDUAL, REST, SEARCHED, SNAP, STATIC_EXPONENT, STATIC_INITIAL, STATIC_LAW,
    STATIC_LIMIT, STATIC_TAU, VELOCITY,
)
from ...axis.motion import ACCELERATING, COASTING, STICK, knot_speed, oscillator_of, static_limit
from ...axis.transitions import (
    ACCELERATE, ARREST, BREAKAWAY, COAST, DECELERATE, KNOT, applied_force, band_of, force_rate, force_rounding,
)
from ...compiled import compiled
from ...friction.static import CONSTANT, KATO, LOGARITHMIC, static_growth
from ...linear.oscillator import amplitude, bound, impulse
from ...linear.roots import first_crossing, first_passage, safe_step

_EPSILON = 2.220446049250313e-16
_STEPS = 100_000


@compiled
def find_event(p, s, horizon):
    """Set the next event of the mode at the anchor, searched up to `horizon` (s after the anchor) at least."""
    mode = s[MODE]
    s[SEARCHED] = horizon
    if mode == COASTING:
        _coasting(p, s)
    elif mode != STICK:
        _slipping(p, s, horizon)
    else:
        s[NEXT_KIND] = BREAKAWAY
        s[NEXT] = _compliant_stick(p, s, horizon) if p[COMPLIANT] != 0.0 else _rigid_stick(p, s, horizon)


@compiled
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


@compiled
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
    t, passed = first_passage(oscillator_of(s), sign * s[ACCELERATION] + 0.0, sign * s[JERK], sign * s[SNAP], gap,
                              horizon)
    s[NEXT] = t
    if not passed:
        s[NEXT_KIND] = COAST
    else:
        s[NEXT_KIND] = KNOT if accelerating or piece > 0 else ARREST


@compiled
def _law(p, rest):
    """Return mu_s, its rate and a bound on −mu_s″ after a rest time."""
    return static_growth(p[STATIC_LAW], p[STATIC_INITIAL], p[STATIC_LIMIT], p[STATIC_TAU], p[STATIC_EXPONENT], rest)


@compiled
def _is_concave(p):
    """Whether mu_s rises ever more slowly from the start."""
    return p[STATIC_LAW] != KATO or p[STATIC_EXPONENT] <= 1.0


@compiled
def _rigid_stick(p, s, horizon):
    """Return when |F_d + F_e| reaches N mu_s; both are known in closed form."""
    force = applied_force(p, s)
    rate, bend = force_rate(p, s)
    if rate == 0.0 and bend == 0.0:
        return math.inf
    return min(_one_side(p, s, force, rate, bend, horizon), _one_side(p, s, -force, -rate, -bend, horizon))


@compiled
def _one_side(p, s, force, rate, bend, horizon):
    """Return when N mu_s − force comes down to 0."""
    normal, rest = p[NORMAL], s[REST]
    if p[STATIC_LAW] == CONSTANT or rest == math.inf:
        t = first_crossing(max(normal * static_limit(p, rest) - force, 0.0), -rate, -bend)
        return t if t <= horizon else math.inf
    if rate <= 0.0 and bend <= 0.0:
        return math.inf
    if bend >= 0.0 and _is_concave(p):
        return _concave_root(p, s, rest, force, rate, 0.0, 0.0, bend, horizon)
    return _stepped_side(p, s, force, rate, bend, horizon)


@compiled
def _concave_root(p, s, rest, force, rate, wave, decay, bend, horizon):
    """Return the root of N mu_s(rest + t) − force − rate t − bend t²/2 − wave exp(−decay t), a concave function of t.

    It is not negative at 0, or within rounding of it, so it has one root at the most where it comes down; infinity when
    that lies behind the horizon.  Halley's step inside a shrinking bracket, whose end does not depend on the horizon.
    """
    normal = p[NORMAL]
    limit, growth, _ = _law(p, rest)
    if normal * limit - force - wave <= 0.0 and normal * growth < rate - decay * wave:
        return 0.0
    fading = wave * math.exp(-decay * horizon) if wave > 0.0 else 0.0
    if horizon == 0.0 or normal * static_limit(p, rest + horizon) - force - (
            rate + 0.5 * bend * horizon) * horizon - fading > 0.0:
        return math.inf
    low = 0.0
    t = high = _time_to_pass(p, rest, force, rate, bend)
    for _ in range(_STEPS):
        limit, growth, curvature = _law(p, rest + t)
        fading = wave * math.exp(-decay * t) if wave > 0.0 else 0.0
        value = normal * limit - force - (rate + 0.5 * bend * t) * t - fading
        if value > 0.0:
            low = t
        else:
            high = t
        if low >= high:
            return t
        s[ITERATIONS] += 1.0
        slope = normal * growth - rate - bend * t + decay * fading
        bow = -(normal * curvature + bend + decay * decay * fading)
        step = value / slope if slope < 0.0 else -math.inf
        step /= max(1.0 - 0.5 * step * bow / slope, 0.5)
        guess = t - step
        if low <= guess <= high:
            sharpness = bow / slope + 1.0 / p[STATIC_TAU] + 3.0 / (rest + guess) + decay
            if abs(step) <= 2.0 * _EPSILON * t or abs(step) * (step * sharpness) ** 2 <= 0.1 * _EPSILON * t:
                return guess
        else:
            guess = 0.5 * (low + high)
            if guess <= low or guess >= high:
                return guess
        t = guess
    return t


@compiled
def _time_to_pass(p, rest, force, rate, bend):
    """Return a time by which force + rate t + bend t²/2 has passed N mu_s(rest + t), given that it does."""
    if p[STATIC_LAW] != LOGARITHMIC:
        return first_crossing(max(p[NORMAL] * static_limit(p, math.inf) - force, 0.0), -rate, -bend)
    t = p[STATIC_TAU]
    while p[NORMAL] * static_limit(p, rest + t) > force + (rate + 0.5 * bend * t) * t:
        t *= 2.0
    return t


@compiled
def _stepped_side(p, s, force, rate, bend, horizon):
    normal, rest = p[NORMAL], s[REST]
    t = 0.0
    for _ in range(_STEPS):
        limit, growth, curvature = _law(p, rest + t)
        now = force + (rate + 0.5 * bend * t) * t
        value = max(normal * limit - now, 0.0)
        slope = normal * growth - rate - bend * t
        step = safe_step(value, slope, normal * curvature + max(bend, 0.0))
        if curvature == math.inf:
            step = _steep_start(p, abs(rate), abs(bend))
        s[ITERATIONS] += 1.0
        if step <= 2.0 * _EPSILON * t or (value <= 4.0 * _EPSILON * normal * limit and slope < 0.0):
            return t
        t += step
        if t > horizon:
            return math.inf
    return t


@compiled
def _steep_start(p, rate, bend):
    """Return a safe step from rest time 0 under Kato's law with n < 1, whose rate is infinite there.

    The law is concave: on [0, d] it rises at least as fast as at d, so that it stays above a force that rises less.
    """
    step = p[STATIC_TAU]
    while p[NORMAL] * _law(p, step)[1] < rate + bend * step and step > 0.0:
        step *= 0.125
    return step


@compiled
def _compliant_stick(p, s, horizon):
    """Return when |F_c| reaches N mu_s: F_c = P(t) + H(t), P linear (quadratic under a ramp), H a free motion."""
    osc = oscillator_of(s)
    gamma, omega2 = osc[0], osc[1]
    stiffness, damping = p[CONTACT_STIFFNESS], p[CONTACT_DAMPING]
    u, a = s[VELOCITY], s[ACCELERATION]
    # the particular motion y0 + y1 t + y2 t²/2; the free one starts at −y0 with the velocity free_u
    y2 = s[SNAP] / omega2
    y1 = u + (s[JERK] - 2.0 * gamma * y2) / omega2
    y0 = (a + 2.0 * gamma * (u - y1) - y2) / omega2
    free_u = u - y1
    steady = stiffness * (s[DEFLECTION] + y0) + damping * y1
    steady_rate = stiffness * y1 + damping * y2
    steady_bend = stiffness * y2
    normal, rest = p[NORMAL], s[REST]
    rounding = 0.5 * force_rounding(p, s, static_limit(p, rest))
    may_leap = steady_bend == 0.0 and _is_concave(p)
    t = 0.0
    for _ in range(_STEPS):
        s[ITERATIONS] += 1.0
        g, slope = impulse(osc, t)
        y = free_u * g - y0 * (slope + 2.0 * gamma * g)
        v = free_u * slope + omega2 * y0 * g
        acc = -2.0 * gamma * v - omega2 * y
        jerk = -2.0 * gamma * acc - omega2 * v
        sag = steady + (steady_rate + 0.5 * steady_bend * t) * t
        sag_rate = steady_rate + steady_bend * t
        free, free_rate = stiffness * y + damping * v, stiffness * v + damping * acc
        wave, wave_rate = stiffness * acc + damping * jerk, stiffness * jerk - damping * (
            2.0 * gamma * jerk + omega2 * acc)
        limit, growth, curvature = _law(p, rest + t)
        top, top_rate = normal * limit, normal * growth
        if may_leap:
            size, decay = amplitude(osc, free, free_rate)
            if top - abs(sag) - size > 0.0:
                may_leap = False
                leap = math.inf
                if sag_rate != 0.0:
                    leap = _concave_root(p, s, rest + t, math.copysign(1.0, sag_rate) * sag, abs(sag_rate), size,
                                         decay, 0.0, horizon - t)
                t += leap
                if t > horizon:
                    return math.inf
                if leap > 0.0:
                    continue
        force, rate = sag + free, sag_rate + free_rate
        side = 1.0 if force > 0.0 or (force == 0.0 and rate > 0.0) else -1.0
        value, fall = max(top - side * force, 0.0), top_rate - side * rate
        bend = abs(steady_bend) + normal * curvature + bound(osc, wave, wave_rate)
        if curvature == math.inf:
            t += _steep_start(p, abs(rate), bound(osc, wave, wave_rate) + abs(steady_bend))
            continue
        step = min(safe_step(value, fall, bend), safe_step(top + side * force, top_rate + side * rate, bend))
        if value <= rounding and fall < 0.0:
            return t if t == 0.0 else t + min(value / -fall, step)
        if step <= 2.0 * _EPSILON * t:
            if fall != 0.0 or side * (steady_bend + wave) > 0.0:
                return t
            step = _nudge(osc, wave, wave_rate)
        t += step
        if t > horizon:
            return math.inf
    return t


@compiled
def _nudge(osc, wave, wave_rate):
    """Return a step off a guard that touches its limit: value = slope = 0, and f″ > 0 with a bound on |f‴|."""
    wave_bend = -2.0 * osc[0] * wave_rate - osc[1] * wave
    third = bound(osc, wave_rate, wave_bend)
    return 3.0 * abs(wave) / third if third > 0.0 else 0.0
