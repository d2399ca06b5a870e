# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The force that ends a compliant stick, P(t) + H(t), see `compliant_stick`.

It is F_c = c_c δ + h_c ẋ.  Where a stick ends by the drive it is F_d + F_e = F_c + m ẍ; H is then −c y − h ẏ of
the free motion y.
"""

import math
from typing import NamedTuple

from ...axis.forces import drive_force, feed_damping, limit_backwards, static_limit, static_numbers
from ...axis.layout import Parameters
from ...axis.motion import drive_travel, travel, travel_at
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...linear.oscillator import Oscillator, amplitude, impulse, short_integrals
from ...linear.roots import EPSILON, halley, halley_settles
from .static_guards import STEPS, law


class ContactMotion(NamedTuple):
    """A travel y₀ + y₁ t + y₂ t²/2 and a free motion that starts at −y₀ with `free_u` and `free_a`.

    P is steady + rate t + second t²/2.
    """

    y0: float       # m
    free_u: float   # m/s
    free_a: float   # m/s²
    free_push: float   # m/s³, of its jerk what its damping does not make
    steady: float   # N
    rate: float     # N/s
    second: float   # N/s²


class ContactForce(NamedTuple):
    """P and its rate, H and its first three derivatives at a time: N, N/s, ..."""

    sag: float
    rate: float
    free: float
    free_rate: float
    free_second: float
    free_third: float


@compiled
def contact_motion(p: Parameters, s: State, osc: Oscillator) -> ContactMotion:
    """Return the motion of the contact from the segment start on."""
    stiffness, damping = p.contact_stiffness, p.contact_damping
    gamma, omega2 = osc.gamma, osc.omega2
    u = s.velocity
    y2 = s.snap / omega2
    # u + JERK/ω² without the difference: 0 to the last bit while the drive rests
    force_rate = p.stiffness * s.inputs.v + feed_damping(p) * s.inputs.v_rate + s.inputs.f_rate
    y1 = force_rate / (p.stiffness + stiffness) - 2.0 * gamma * y2 / omega2
    y0 = (s.acceleration + 2.0 * gamma * (u - y1) - y2) / omega2
    steady = stiffness * (s.deflection + y0) + damping * y1
    if p.ends_by_drive != 0.0:
        steady += p.mass * y2
    return ContactMotion(y0, u - y1, s.acceleration - y2, s.jerk - 2.0 * gamma * y2, steady,
                         stiffness * y1 + damping * y2, stiffness * y2)


@compiled
def contact_at(p: Parameters, osc: Oscillator, motion: ContactMotion, t: float) -> ContactForce:
    """Return the contact force at t, in its two parts.

    Far over-damped, 2γ v and ω² y leave nothing of their difference; there the acceleration moves freely by itself.
    """
    stiffness, damping = limited_part(p)
    gamma, omega2 = osc.gamma, osc.omega2
    y0, free_u, free_a, free_push, steady, rate, second = motion
    g, slope = impulse(osc, t)
    y = free_u * g - y0 * (slope + 2.0 * gamma * g)
    v = free_u * slope + omega2 * y0 * g
    if osc.nu < 0.0:
        acc = free_a * slope + free_push * g
        jerk = (free_push - 2.0 * gamma * free_a) * slope - omega2 * free_a * g
    else:
        acc = -2.0 * gamma * v - omega2 * y
        jerk = -2.0 * gamma * acc - omega2 * v
    return ContactForce(steady + (rate + 0.5 * second * t) * t, rate + second * t, stiffness * y + damping * v,
                        stiffness * v + damping * acc, stiffness * acc + damping * jerk,
                        stiffness * jerk - damping * (2.0 * gamma * jerk + omega2 * acc))


@compiled
def force_at(p: Parameters, s: State, t: float) -> tuple[float, float]:
    """Return F_c and its rate at t, from the travel: P + H may cancel."""
    y, u, a = (0.0, s.velocity, s.acceleration) if t == 0.0 else travel(p, s, t)
    return limited_force(p, s, t, y, u, a)


@inlined
def limited_part(p: Parameters) -> tuple[float, float]:
    """Return what part of the force a deflection and a velocity are, N/m and N s/m."""
    if p.ends_by_drive != 0.0:
        return -p.stiffness, -p.damping
    return p.contact_stiffness, p.contact_damping


@inlined
def limited_force(p: Parameters, s: State, t: float, y: float, u: float, a: float) -> tuple[float, float]:
    """Return the force and its rate at t, after the travel y at the velocity u with the acceleration a."""
    stiffness, damping = p.contact_stiffness, p.contact_damping
    if p.ends_by_drive == 0.0:
        return stiffness * (s.deflection + y) + damping * u, stiffness * u + damping * a
    v = s.inputs.v + s.inputs.v_rate * t
    held = drive_force(p, s.spring + (drive_travel(s, t) - y), v, u)
    return (held + (s.inputs.f + s.inputs.f_rate * t),
            p.stiffness * (v - u) + p.damping * (p.feed_share * s.inputs.v_rate - a) + s.inputs.f_rate)


@inlined
def contact_rounding(p: Parameters, s: State, motion: ContactMotion, limit: float) -> float:
    """Return the rounding of the contact force and its limit: the mass and the drive's damper take what is beyond."""
    stiffness, damping = p.contact_stiffness, p.contact_damping
    return 4.0 * EPSILON * (abs(motion.steady) + stiffness * (abs(s.deflection) + abs(motion.y0))
                            + damping * (abs(s.velocity) + abs(motion.free_u))
                            + p.normal_force * limit)


@inlined
def rounding_so_far(p: Parameters, s: State, limit: float, t: float) -> float:
    """Return the rounding of the contact force and its limit at t from what moves it: early, none of the drive's."""
    velocity = abs(s.velocity) + (abs(s.acceleration) + (0.5 * abs(s.jerk) + abs(s.snap) * t) * t) * t
    return 4.0 * EPSILON * (p.contact_stiffness * (abs(s.deflection) + velocity * t) + p.contact_damping * velocity
                            + p.normal_force * limit)


@inlined
def envelope_room(p: Parameters, rest: float, sag: float, size: float) -> float:
    """Return how far P = `sag` and a free motion of that size keep off the limits of both directions, N."""
    limit = static_limit(p, rest, 1.0)
    back = limit_backwards(p, rest, limit)
    return min(p.normal_force * limit - sag, p.normal_force * back + sag) - size


@compiled
def moves(s: State) -> bool:
    """Whether a contact that holds nothing gives way: it does with the first derivative of its force that is not 0."""
    return not (s.deflection == 0.0 and s.velocity == 0.0 and s.acceleration == 0.0 and s.jerk == 0.0
                and s.snap == 0.0)


@inlined
def second_at_start(p: Parameters, s: State, osc: Oscillator) -> float:
    """Return the second derivative of the force at the segment start."""
    stiffness, damping = limited_part(p)
    of_drive = p.stiffness * s.inputs.v_rate if p.ends_by_drive != 0.0 else 0.0
    return stiffness * s.acceleration + damping * (s.jerk - 2.0 * osc.gamma * s.acceleration) + of_drive


@compiled
def gives_way(p: Parameters, s: State, osc: Oscillator) -> bool:
    """Whether a contact without a force is pushed in a direction in which static friction never holds anything.

    The first derivative of its force that is not 0 says which way it is pushed.
    """
    stiffness, damping = limited_part(p)
    u, a = s.velocity, s.acceleration
    force, push = limited_force(p, s, 0.0, 0.0, u, a)
    if force != 0.0:
        return False
    jerk = s.jerk - 2.0 * osc.gamma * a
    snap = s.snap - 2.0 * osc.gamma * jerk - osc.omega2 * a
    if push == 0.0:
        push = second_at_start(p, s, osc)
    if push == 0.0:
        push = stiffness * jerk + damping * snap
    if push == 0.0 and p.ends_by_drive == 0.0:
        push = snap
    return push != 0.0 and p.normal_force * static_limit(p, math.inf, push) == 0.0


@compiled
def rings_within(p: Parameters, s: State, osc: Oscillator, motion: ContactMotion, top: float, bottom: float) -> bool:
    """Whether a contact that the drive does not load any further stays within the limits of now, which never fall.

    `top` and `bottom` are those limits forwards and backwards, N, with room for rounding.

    Without a damper it may come back to the limit in every period, and touch it: no break-away, with any rounding.
    """
    _, _, free, free_rate, _, _ = contact_at(p, osc, motion, 0.0)
    size, _ = amplitude(osc, free, free_rate)
    return motion.steady + size <= top and size - motion.steady <= bottom


# The root of the guard of a compliant stick: directly, with the proof that it is the first, or inside a bracket.

_DIRECT_STEPS = 8


@inlined
def direct_root(p: Parameters, s: State, osc: Oscillator, motion: ContactMotion,
                 contact: ContactForce, begin: float) -> float:
    """Return the root of the guard after `begin`, if it proves to be the first; 0 otherwise.

    `contact` is `contact_at` at begin.  The steps are Halley's, from the time that stick lasted last time, or else
    from where the steady part alone reaches the limit.
    """
    sag, rate, free, free_rate, free_second, _ = contact
    side = 1.0 if rate > 0.0 else -1.0
    size, decay = amplitude(osc, free, free_rate)
    room = envelope_room(p, s.rest + begin, sag, size)
    if not room > 0.0 or rate == 0.0:
        return 0.0
    frequency = math.sqrt(osc.omega2) + 1.0 / static_numbers(p, side).tau
    t = s.cache.last[0]
    if t <= begin:
        t = begin + room / abs(rate)
    settled, fall = False, -1.0
    for _ in range(_DIRECT_STEPS):
        s.iterations += 1.0
        value, fall, bow = _guard_at(p, s, osc, t, side)
        if not fall < 0.0:
            return 0.0
        step = halley(value, fall, bow)
        sharpness = abs(step) * (abs(bow / fall) + frequency)
        t -= step
        if t <= begin:
            return 0.0
        if sharpness < 0.5 and halley_settles(abs(step), sharpness, t):
            settled = True
            break
    if not settled:
        return 0.0
    before = t + 4.0 * size * math.exp(-decay * (t - begin)) / fall
    if before <= begin:
        return 0.0
    fading = math.exp(-decay * (before - begin))
    limit, growth, _ = law(p, s.rest + before, side)
    clear = p.normal_force * limit - side * sag - abs(rate) * (before - begin) - size * fading
    rise, _ = amplitude(osc, free_rate, free_second)
    falls = p.normal_force * growth - abs(rate) + rise * fading
    return t if clear > 0.0 and falls < 0.0 else 0.0


@inlined
def _guard_at(p: Parameters, s: State, osc: Oscillator, t: float, side: float) -> tuple[float, float, float]:
    """Return N mu_s − side F_c at t, its rate and its second_rate (with the bound of a law that is not concave)."""
    if s.snap == 0.0:
        s.cache.at.time = t
        s.cache.at.g, s.cache.at.rate, s.cache.at.first, s.cache.at.second = short_integrals(osc, t)
        y, u, a = travel_at(p, s)
    else:
        y, u, a = travel(p, s, t)
    jerk = s.jerk + s.snap * t + osc.omega2 * (s.velocity - u) - 2.0 * osc.gamma * a
    force, rate = limited_force(p, s, t, y, u, a)
    stiffness, damping = limited_part(p)
    second_rate = stiffness * a + damping * jerk
    if p.ends_by_drive != 0.0:
        second_rate += p.stiffness * s.inputs.v_rate
    limit, growth, curvature = law(p, s.rest + t, side)
    return (p.normal_force * limit - side * force, p.normal_force * growth - side * rate,
            -p.normal_force * curvature - side * second_rate)


@compiled
def bracketed_root(p: Parameters, s: State, osc: Oscillator, side: float, low: float, high: float) -> float:
    """Return the root of the falling guard between low and high: Halley's step inside a shrinking bracket.

    Its error after a step d is about d (d (f″/f′ + frequency))²; the last step is the one that makes it rounding.
    """
    frequency = math.sqrt(osc.omega2) + 1.0 / static_numbers(p, side).tau
    t, before = low, high - low
    for _ in range(STEPS):
        s.iterations += 1.0
        value, fall, bow = _guard_at(p, s, osc, t, side)
        if value > 0.0:
            low = t
        else:
            high = t
        newton = value / fall if fall < 0.0 else math.inf
        size = halley(value, fall, bow) if fall < 0.0 else math.inf
        guess = t - size
        if low <= guess <= high and abs(size) <= before:
            sharpness = abs(size) * (abs(bow / fall) + frequency)
            if abs(newton) <= 2.0 * EPSILON * t or halley_settles(abs(size), sharpness, guess):
                return guess
        else:
            guess = 0.5 * (low + high)
        before = abs(guess - t)
        if before <= EPSILON * t:
            return guess
        t = guess
    return t
