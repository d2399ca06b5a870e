# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The root of the guard of a compliant stick: directly, with the proof that it is the first, or inside a bracket."""

import math

from ...axis.layout import Parameters
from ...axis.motion import travel, travel_at
from ...axis.state_record import State
from ...axis.static_limits import static_numbers
from ...core.hot_path import compiled, inlined
from ...linear.oscillator import Oscillator, amplitude, short_integrals
from ...linear.root_steps import EPSILON, halley, halley_settles
from .contact_force import ContactForce, ContactMotion, envelope_room, limited_force, limited_part
from .static_guards import STEPS, law

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
            break
    else:
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
