# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A moving mode under sines in two parts: its steady answer to each sinusoid, and the rest of the motion.

The steady answer is Im[X e^(iwt)]; the rest obeys the equation without sinusoids.  Near resonance both grow beyond all
bounds, and cancel.
"""

import math
from typing import NamedTuple

from ...axis.codes import STICK
from ...axis.forces import feed_damping, ground_damping
from ...axis.layout import Parameters
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...linear.moments import moments
from ...linear.oscillator import Oscillator
from ...linear.waves import (
    TURN,
    cycle_within,
    mirrored,
    over,
    phase_products,
    ramped_integral,
    swept_integral,
    wave_integral,
    wave_moment,
    wave_products,
)

_NEAR = 1.0         # up to which its phase is taken from that of the oscillator
_CLOSE = 0.07       # (|γ| + |w − ν|) t up to which a sinusoid is interpolated


class SinusoidAnswer(NamedTuple):
    """A sinusoid, and the steady answer to it at phase 0."""

    frequency: float    # Hz
    cycle: float        # turns within the time
    phase: complex      # factor at the segment start
    v: float            # m/s, amplitude
    f: float            # N, amplitude
    at_x: complex       # m/s, amplitude of x
    lead: complex       # m/s, amplitude of v − ẋ
    against: complex    # what the integral of the rest is divided by


class Rest(NamedTuple):
    """x without the steady answers, x″ + 2γ x′ + ω² x = k₀ + k₁ t: how it begins and ends, and its integrals."""

    k0: float
    k1: float
    x: float
    rate: float
    end: float
    end_rate: float
    once: float     # ∫x
    twice: float    # ∫∫x
    thrice: float   # ∫∫∫x
    square: float   # ∫x²


@compiled
def answer_to(p: Parameters, s: State, osc: Oscillator, k: int, t: float, shift: float, slope: float
           ) -> SinusoidAnswer:
    """Return a sinusoid and the answer to it.

    What distinguishes a sinusoid near resonance from the oscillator's own is taken once: phases and divisor agree on it
    to the last digit.
    """
    gamma, _, nu, near, far = osc
    frequency, phase, v, f = given_sinusoid(s, k)
    apart = TURN * frequency - nu
    near_resonance = nu * t > 1.0 and (abs(gamma) + abs(apart)) * t < _NEAR
    if shift != 0.0 and is_close(osc, TURN * frequency, t):
        frequency += shift
        apart += TURN * shift
    cycle = cycle_within(frequency, t)
    if near_resonance:
        cycle = (math.atan2(math.sin(nu * t), math.cos(nu * t)) + apart * t) / TURN
    w = TURN * frequency
    feed = p.damping * p.feed_share
    resisting = p.damping - feed    # what acts on the slider's velocity alone
    divisor = complex(gamma, apart) * complex(gamma, w + nu) if nu > 0.0 else complex(-near, w) * complex(-far, w)
    against = mirrored(divisor)
    if s.mode == STICK:
        at_x = over(complex(p.stiffness * v, (feed * v + f) * w), p.mass * divisor)
        resisting += p.contact_damping
        lead = complex((p.contact_stiffness - p.mass * w * w) * v, (resisting * v - f) * w)
        return SinusoidAnswer(frequency, cycle, phase, v, f, at_x, over(lead, p.mass * divisor), against)
    resisting += p.normal_force * slope
    lead = over(complex(-p.mass * w * w * v, (resisting * v - f) * w), p.mass * divisor)
    return SinusoidAnswer(frequency, cycle, phase, v, f, lead, lead, against)


@compiled
def is_close(osc: Oscillator, w: float, t: float) -> bool:
    """Whether a sinusoid stays close to the oscillator's own within t."""
    gamma, _, nu, _, _ = osc
    return nu > 0.0 and (abs(gamma) + abs(w - nu)) * t < _CLOSE


@compiled
def given_sinusoid(s: State, k: int) -> tuple[float, complex, float, float]:
    """Return frequency and phase factor of a sinusoid at the segment start, and its amplitudes of v and F_e."""
    phase = complex(s.sinusoids[k].cosine, s.sinusoids[k].sine)
    return s.sinusoids[k].frequency, phase, s.sinusoids[k].v, s.sinusoids[k].f


@compiled
def rest_of(p: Parameters, s: State, osc: Oscillator, t: float, shift: float, slope: float) -> Rest:
    """Return the motion without the steady answers to the sinusoids."""
    stuck = s.mode == STICK
    v0, v1, f1 = s.inputs.base_v, s.inputs.v_rate, s.inputs.f_rate
    if stuck:
        k0, k1 = (p.stiffness * v0 + feed_damping(p) * v1 + f1) / p.mass, p.stiffness * v1 / p.mass
        x, rate = s.velocity, s.acceleration
    else:
        k0, k1 = ((p.normal_force * slope + ground_damping(p)) * v1 - f1) / p.mass, 0.0
        x, rate = s.inputs.v - s.velocity, v1 - s.acceleration
    for k in range(int(s.sinusoid_count)):
        one = answer_to(p, s, osc, k, t, shift, slope)
        at_rate = one.at_x if stuck else one.at_x - one.v
        x -= (one.phase * one.at_x).imag
        rate -= TURN * one.frequency * (one.phase * at_rate).real
    end, end_rate, once, twice, thrice, square = moments(osc, x, rate, k0, k1, t)
    return Rest(k0, k1, x, rate, end, end_rate, once, twice, thrice, square)


# Integrals of products of a motion under sines with itself and its inputs, part by part.
#
# All products of two sinusoids have closed integrals, and so has the rest of the motion (`linear.moments`); that of the
# rest x and a sinusoid follows from the equation times the sinusoid, ∫(x″ + 2γx′ + ω²x) e^(iwt) = ∫(k₀ + k₁t) e^(iwt),
# by parts.

class Products(NamedTuple):
    """Integrals of products of x, of the drive's velocity v, the force f and the stretch w; and the slider's path."""

    xx: float
    v_x: float
    v_v: float
    f_x: float
    f_v: float
    v_w: float
    path: float


@compiled
def products_of_inputs(s: State, rest: Rest, t: float) -> Products:
    """Return the products of the rest of the motion, and of the inputs without sinusoids."""
    v0, v1, f0, f1, spring = s.inputs.base_v, s.inputs.v_rate, s.inputs.base_f, s.inputs.f_rate, s.spring
    once, twice = rest.once, rest.twice
    once1, twice1 = t * once - twice, t * twice - rest.thrice     # ∫ t x and ∫ t ∫x
    v_x, f_x = v0 * once + v1 * once1, f0 * once + f1 * once1
    v_v = (v0 * v0 + (v0 + v1 * t / 3.0) * v1 * t) * t
    f_v = (f0 * v0 + (0.5 * (f0 * v1 + f1 * v0) + f1 * v1 * t / 3.0) * t) * t
    if s.mode == STICK:
        v_w = (v0 * ((spring + (0.5 * v0 + v1 * t / 6.0) * t) * t - twice)
               + v1 * ((0.5 * spring + (v0 / 3.0 + 0.125 * v1 * t) * t) * t * t - twice1))
    else:
        v_w = v0 * (spring * t + twice) + v1 * (0.5 * spring * t * t + twice1)
    return Products(rest.square, v_x, v_v, f_x, f_v, v_w, (v0 + 0.5 * v1 * t) * t - once)


@inlined
def with_a_sinusoid(s: State, osc: Oscillator, rest: Rest, one: SinusoidAnswer, wave: complex, zero: complex,
                     before: Products, t: float) -> Products:
    """Add the products of a sinusoid with the rest and the inputs; `wave` is e^(iwt) and `zero` its integral."""
    v0, v1, f0, f1 = s.inputs.base_v, s.inputs.v_rate, s.inputs.base_f, s.inputs.f_rate
    v, f, at_x, phase, w = one.v, one.f, one.at_x, one.phase, TURN * one.frequency
    moment = wave_moment(w, wave, zero, t)
    lag = complex(2.0 * osc.gamma, -w)
    ends = (rest.end_rate + lag * rest.end) * wave - (rest.rate + lag * rest.x)
    of_x = over(rest.k0 * zero + rest.k1 * moment - ends, one.against)
    of_path = (rest.once * wave - of_x) * complex(0.0, -1.0 / w)
    if s.mode == STICK:
        square = (t * t * wave - 2.0 * moment) * complex(0.0, -1.0 / w)
        of_stretch = phase * (s.spring * zero + v0 * moment + 0.5 * v1 * square - of_path)
    else:
        of_stretch = phase * (s.spring * zero + of_path)
    of_x, of_v, of_f = phase * of_x, phase * (v0 * zero + v1 * moment), phase * (f0 * zero + f1 * moment)
    swept = one.lead * phase * swept_integral(w, v0, v1, zero, moment, t)
    return Products(before.xx + 2.0 * (at_x * of_x).imag,
                    before.v_x + (v * of_x.imag + (at_x * of_v).imag),
                    before.v_v + 2.0 * v * of_v.imag,
                    before.f_x + (f * of_x.imag + (at_x * of_f).imag),
                    before.f_v + (v * of_f.imag + f * of_v.imag),
                    before.v_w + (v * of_stretch.imag + swept.imag),
                    before.path + ((v - at_x) * (phase * zero)).imag)


@inlined
def with_two(one: SinusoidAnswer, other: SinusoidAnswer, alike: bool, wave: complex, zero: complex,
              before: Products, t: float) -> Products:
    """Add the products of two sinusoids, or of one with itself."""
    w, w_j = TURN * one.frequency, TURN * other.frequency
    same, sum_ = wave_products(one.frequency, one.cycle, other.frequency, other.cycle, t)
    apart, joint = phase_products(one.phase, other.phase, alike)
    zero_j = wave_integral(other.frequency, other.cycle, t)
    swept = joint * ramped_integral(w, wave, zero, w_j, zero_j, sum_, t)
    away = mirrored(apart) * ramped_integral(-w, mirrored(wave), mirrored(zero), w_j, zero_j, mirrored(same), t)
    v_w = before.v_w + 0.5 * one.v * (other.lead * (away - swept)).real
    if not alike:
        wave_j = complex(math.cos(TURN * other.cycle), math.sin(TURN * other.cycle))
        swept = joint * ramped_integral(w_j, wave_j, zero_j, w, zero, sum_, t)
        away = apart * ramped_integral(-w_j, mirrored(wave_j), mirrored(zero_j), w, zero, same, t)
        v_w += 0.5 * other.v * (one.lead * (away - swept)).real
    half = 0.25 if alike else 0.5
    same, sum_ = apart * same, joint * sum_
    real = same - sum_                       # of two sinusoids in phase with the inputs
    with_x = mirrored(other.at_x) * same - other.at_x * sum_
    return Products(before.xx + 2.0 * half * (one.at_x * with_x).real,
                    before.v_x + half * (one.v * with_x.real + other.v * (one.at_x * real).real),
                    before.v_v + 2.0 * half * one.v * other.v * real.real,
                    before.f_x + half * (one.f * with_x.real + other.f * (one.at_x * real).real),
                    before.f_v + half * (one.f * other.v + one.v * other.f) * real.real,
                    v_w, before.path)
