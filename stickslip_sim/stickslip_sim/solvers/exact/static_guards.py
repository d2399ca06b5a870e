# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""When a known force reaches N mu_s(t⁻): the guards that hold the static law.

N mu_s is concave for most laws.  A concave guard that is not negative at both ends of an interval has no root inside;
where its end is negative it has one root, and a bracket to find it in.  A guard that is not concave takes safe steps.

In floating point: the sign at the far end is that of a computed value, right but within rounding of the forces.  A root
is accepted inside the bracket when the step's own error is rounding or no number is left between the ends; nothing here
grows or dies out but exp(−t/τ), and where that is 0 the guard is a straight line.
"""

import math

from ...axis.forces import applied_force, force_rate, static_at_once, static_limit, static_numbers
from ...axis.layout import Parameters
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...friction.static import CONSTANT, EXPONENTIAL, KATO, LOGARITHMIC, StaticGrowth, static_growth
from ...linear.roots import EPSILON, first_crossing, halley, householder, householder_settles, safe_step

TICK = 0.1         # s; a search no longer than that begins with a bound, which mostly ends it
STEPS = 100_000
_DIRECT_STEPS = 8
GAVE_UP = -1.0     # instead of a time: the steps were used up
_NO_TIME = 1e-30  # of τ: with n near 1 mu_s outruns a force for less than that, and never in doubles
_SAME_TIME = 2.0 ** -50   # of a time: more than rounding of the time of a segment's start


@inlined
def rigid_stick(p: Parameters, s: State, horizon: float) -> float:
    """Return when F_d + F_e reaches N mu_s of its direction; both are known in closed form."""
    force = applied_force(p, s)
    rate, second_rate = force_rate(p, s)
    if second_rate == 0.0:
        if rate == 0.0:
            return math.inf
        if p.static_law == EXPONENTIAL and p.static_delay <= s.rest < math.inf:
            side = 1.0 if rate > 0.0 else -1.0
            t = _exponential_root(p, s, force if rate > 0.0 else -force, abs(rate), side, horizon)
            if t >= 0.0:
                return t if t <= horizon else math.inf
    return min(_one_side(p, s, force, rate, second_rate, 1.0, horizon),
               _one_side(p, s, -force, -rate, -second_rate, -1.0, horizon))


@compiled
def _one_side(p: Parameters, s: State, force: float, rate: float, second_rate: float, side: float,
              horizon: float) -> float:
    """Return when N mu_s − force comes down to 0; `side` is the sign of the force against which mu_s holds."""
    normal, rest = p.normal_force, s.rest
    if p.static_law == CONSTANT or rest == math.inf or rest < p.static_delay:
        t = first_crossing(max(normal * static_limit(p, rest, side) - force, 0.0), -rate, -second_rate)
        return t if t <= horizon else math.inf
    if rate <= 0.0 and second_rate <= 0.0:
        return math.inf
    if second_rate >= 0.0 and is_concave(p):
        return concave_root(p, s, rest, side, force, rate, 0.0, 0.0, second_rate, horizon)
    return _stepped_side(p, s, force, rate, second_rate, side, horizon)


@inlined
def _exponential_root(p: Parameters, s: State, force: float, rate: float, side: float, horizon: float) -> float:
    """Return when force + rate t, rate > 0, reaches N mu_s of the exponential law; −1 where the steps do not settle.

    With z = t/τ the guard is a − d (exp(−z) − 1) − b z: concave and not negative at 0, so that of its zeros after 0
    there is but one at which it falls.  Householder's step, from the last stick's time or else from above: 1 − exp(−z)
    is less than 2z/(2 + z), with which the guard is a quadratic.
    """
    normal, rest, of = p.normal_force, s.rest - p.static_delay, static_numbers(p, side)
    tau = of.tau
    gap = max(normal * static_limit(p, s.rest, side) - force, 0.0)
    if rate * horizon < gap:
        return math.inf   # even the limit of now is out of reach
    d = normal * (of.limit - of.initial)
    if rest > 0.0:
        d *= math.exp(-rest / tau)
    b = rate * tau
    if gap == 0.0 and d < b:
        return 0.0
    z = s.cache.last[0] / tau
    if z <= 0.0:
        q = 2.0 * (b - d) - gap
        root = math.sqrt(q * q + 8.0 * b * gap)
        z = min(4.0 * gap / (q + root) if q > 0.0 else 0.5 * (root - q) / b, (gap + d) / b)
    for _ in range(_DIRECT_STEPS):
        s.iterations += 1.0
        fading = math.expm1(-z)
        wane = d * (1.0 + fading)
        fall = b - wane
        if fall <= 0.0:
            break
        value = d * fading + b * z - gap
        step, ratio = householder(value, fall, wane, -wane)
        sharpness = abs(step) * (1.0 + ratio)
        z -= step
        if z <= 0.0 or not sharpness < 0.5:
            break
        if householder_settles(abs(step), sharpness, z) and (step != 0.0 or value == 0.0):
            return z * tau
    return -1.0


@inlined
def law(p: Parameters, rest: float, side: float) -> StaticGrowth:
    """Return mu_s, its rate and a bound on −mu_s″ after a rest time, against a force of this sign."""
    if rest < p.static_delay:
        return StaticGrowth(static_at_once(p, side), 0.0, 0.0)
    return grown(p, rest - p.static_delay, side)


@inlined
def grown(p: Parameters, age: float, side: float) -> StaticGrowth:
    """Return the same at a time after the growth began."""
    of = static_numbers(p, side)
    return static_growth(p.static_law, of.initial, of.limit, of.tau, of.exponent, age)


@inlined
def delay_left(p: Parameters, s: State) -> float:
    """Return how long mu_s still waits for its growth, s; up to rounding of the time it waits no more."""
    left = p.static_delay - s.rest
    rounding = _SAME_TIME * ((s.fraction if s.second == 0.0 else 1.0) + p.static_delay)
    if p.static_delay == 0.0 or left < -rounding:
        return 0.0
    if left <= rounding:
        s.rest = p.static_delay
        return 0.0
    return left


@compiled
def is_concave(p: Parameters) -> bool:
    """Whether mu_s rises ever more slowly from the start, in both directions."""
    return p.static_law != KATO or (p.static_exponent <= 1.0 and p.backward_exponent <= 1.0)


@compiled
def concave_root(p: Parameters, s: State, rest: float, side: float, force: float, rate: float, size: float,
                 decay: float, second_rate: float, horizon: float) -> float:
    """Return the root of N mu_s(rest + t) − force − rate t − second_rate t²/2 − size exp(−decay t), concave in t.

    It is not negative at 0, or within rounding of it, so it has one root at the most where it comes down; infinity when
    that lies behind the horizon.  Halley's step inside a shrinking bracket, whose end does not depend on the horizon.
    """
    normal, tau = p.normal_force, static_numbers(p, side).tau
    limit, growth, _ = law(p, rest, side)
    if normal * limit - force - size <= 0.0 and normal * growth < rate - decay * size:
        return 0.0
    fading = size * math.exp(-decay * horizon) if size > 0.0 else 0.0
    if horizon == 0.0 or normal * static_limit(p, rest + horizon, side) - force - (
            rate + 0.5 * second_rate * horizon) * horizon - fading > 0.0:
        return math.inf
    low = 0.0
    t = high = _time_to_pass(p, rest, side, force, rate, second_rate)
    for _ in range(STEPS):
        value, slope, bow = _concave_guard(p, rest, side, force, rate, size, decay, second_rate, t)
        if value > 0.0:
            low = t
        else:
            high = t
        if low >= high:
            return t
        s.iterations += 1.0
        step = halley(value, slope, bow) if slope < 0.0 else math.inf
        guess = t - step if slope < 0.0 else math.inf
        if low <= guess <= high:
            sharpness = bow / slope + 1.0 / tau + 3.0 / (rest - p.static_delay + guess) + decay
            if abs(step) <= 2.0 * EPSILON * t or abs(step) * (step * sharpness) ** 2 <= 0.1 * EPSILON * guess:
                return guess
        else:
            guess = 0.5 * (low + high)
            if guess <= low or guess >= high:
                return guess
        t = guess
    return t


@inlined
def _concave_guard(p: Parameters, rest: float, side: float, force: float, rate: float, size: float, decay: float,
                   second_rate: float, t: float) -> tuple[float, float, float]:
    """Return the concave function of `concave_root` at t, its rate and its second rate."""
    limit, growth, curvature = law(p, rest + t, side)
    fading = size * math.exp(-decay * t) if size > 0.0 else 0.0
    return (p.normal_force * limit - force - (rate + 0.5 * second_rate * t) * t - fading,
            p.normal_force * growth - rate - second_rate * t + decay * fading,
            -(p.normal_force * curvature + second_rate + decay * decay * fading))


@compiled
def _time_to_pass(p: Parameters, rest: float, side: float, force: float, rate: float, second_rate: float) -> float:
    """Return a time by which force + rate t + second_rate t²/2 has passed N mu_s(rest + t), given that it does."""
    if p.static_law != LOGARITHMIC:
        return first_crossing(max(p.normal_force * static_limit(p, math.inf, side) - force, 0.0), -rate, -second_rate)
    t = static_numbers(p, side).tau
    while p.normal_force * static_limit(p, rest + t, side) > force + (rate + 0.5 * second_rate * t) * t:
        t *= 2.0
    return t


@compiled
def _stepped_side(p: Parameters, s: State, force: float, rate: float, second_rate: float, side: float,
                  horizon: float) -> float:
    normal, rest = p.normal_force, s.rest
    t = 0.0
    for _ in range(STEPS):
        limit, growth, curvature = law(p, rest + t, side)
        now = force + (rate + 0.5 * second_rate * t) * t
        value = max(normal * limit - now, 0.0)
        slope = normal * growth - rate - second_rate * t
        step = safe_step(value, slope, normal * curvature + max(second_rate, 0.0))
        if curvature == math.inf:
            step = steep_start(p, side, value, rate, abs(second_rate))
        s.iterations += 1.0
        if step <= 2.0 * EPSILON * t or (value <= 4.0 * EPSILON * normal * limit and slope < 0.0):
            return t
        t += step
        if t > horizon:
            return math.inf
    return GAVE_UP


@compiled
def steep_start(p: Parameters, side: float, value: float, rate: float, second_rate: float) -> float:
    """Return a safe step from rest time 0 under Kato's law with n < 1, whose rate is infinite there.

    `rate` is that of the force towards this side, at 0.  The law is concave: on [0, d] it rises at least as fast as at
    d, so that it stays above a force that rises less.  It never falls, so a force that is off the limit by `value`, or
    moves away from it, takes its time as well.
    """
    tau = static_numbers(p, side).tau
    step, least = tau, _NO_TIME * tau
    while p.normal_force * grown(p, step, side).rate < rate + second_rate * step and step > least:
        step *= 0.125
    return max(step if step > least else 0.0, safe_step(value, -rate, second_rate))
