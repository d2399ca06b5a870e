# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The works under sines, in closed form: as much for a second at 1 Hz as for a day at 1 MHz.

A motion is its steady answer to each sinusoid, Im[X e^(iwt)], and the rest, which obeys the equation without sinusoids.
All products of two sinusoids have closed integrals, and so has the rest (`linear.moments`); that of the rest x and a
sinusoid follows from the equation times the sinusoid, ∫(x″ + 2γx′ + ω²x) e^(iwt) = ∫(k₀ + k₁t) e^(iwt), by parts.

Near resonance the steady answer and the rest grow beyond all bounds, and cancel.  The works are smooth functions of the
frequency even there; they are interpolated, from where nothing cancels.  What is over within a radian or two is left to
`panels`.
"""

import math
from typing import NamedTuple

from ...axis.codes import COASTING, STICK
from ...axis.forces import feed_damping, ground_damping
from ...axis.friction_segments import slip_friction
from ...axis.layout import Parameters, State
from ...axis.motion import oscillator_of
from ...axis.sinusoids import fastest_sinusoid
from ...core.hot_path import compiled, inlined
from ...linear.moments import moments
from ...linear.oscillator import Oscillator
from ...linear.wave_products import (
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
from ...linear.waves import TURN
from .panels import Works, panels

_FEW = 3.0          # radians that are left to panels
_SOME = 24.0        # and those where a sinusoid would have to be interpolated otherwise
_NEAR = 1.0         # up to which its phase is taken from that of the oscillator
_CLOSE = 0.07       # (|γ| + |w − ν|) t up to which a sinusoid is interpolated
_WIDE = 1.25        # radians over which it is,
_OF_OWN = 0.6       # or that part of the oscillator's own, which is not to be turned back
_LITTLE = 0.01      # radians of a sinusoid and of the oscillator that are left to panels, however fast others are
# Chebyshev's twenty points, those above 0, and Lagrange's weights for the middle between them
_POINTS = (0.996917333733127976, 0.972369920397676602, 0.923879532511286756, 0.852640164354092222,
           0.760405965600030938, 0.649448048330183656, 0.522498564715948865, 0.382683432365089772,
           0.233445363855905412, 0.078459095727844945)
_SHARES = (-0.0039350853412309224, 0.012003937954005802, -0.0207106781186547524, 0.0306400394069965998,
           -0.0427040342731733319, 0.0585424783056269613, -0.0815925843564394809, 0.120710678118654752,
           -0.20826498850452086, 0.635310236808735232)


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
def still_works(p: Parameters, s: State, t: float) -> Works:
    """Return `works.works` of a slider that stands still or coasts."""
    u = s.velocity if s.mode == COASTING else 0.0
    rate, ahead = s.inputs.v_rate, s.inputs.base_v - u
    lead = (ahead + 0.5 * rate * t) * t                      # ∫(v − ẋ)
    stretch = (s.spring + (0.5 * ahead + rate * t / 6.0) * t) * t
    square = (ahead * ahead + (ahead + rate * t / 3.0) * rate * t) * t
    push = (s.inputs.base_f + 0.5 * s.inputs.f_rate * t) * t
    for k in range(int(s.sinusoid_count)):
        frequency, phase, v, f = _given(s, k)
        cycle = cycle_within(frequency, t)
        zero = wave_integral(frequency, cycle, t)
        wave = complex(math.cos(TURN * cycle), math.sin(TURN * cycle))
        one = phase * wave_moment(TURN * frequency, wave, zero, t)
        zero = phase * zero
        lead += v * zero.imag
        stretch += v * (t * zero.imag - one.imag)
        square += 2.0 * v * (ahead * zero.imag + rate * one.imag)
        push += f * zero.imag
        for j in range(k + 1):
            other, phase_j, v_j, _ = _given(s, j)
            same, sum_ = wave_products(frequency, cycle, other, cycle_within(other, t), t)
            apart, joint = phase_products(phase, phase_j, j == k)
            square += (0.5 if j == k else 1.0) * v * v_j * (apart * same - joint * sum_).real
    stiffness, damping = p.stiffness, p.damping
    drive = stiffness * ((s.spring + 0.5 * lead) * lead + u * stretch) + feed_damping(p) * (square + u * lead)
    if p.feed_share == 0.0:
        lead, square = -u * t, u * u * t
    friction = u * (stiffness * stretch + damping * lead + push)
    return Works(drive, u * push, friction, damping * square, 0.0)


@compiled
def moving_works(p: Parameters, s: State, t: float) -> Works:
    """Return `works.works` of a slip, or of a compliant contact."""
    osc = oscillator_of(s)
    own = (abs(osc.gamma) + abs(osc.nu)) * t
    close, slow = False, False
    for k in range(int(s.sinusoid_count)):
        w = TURN * s.sinusoids[k].frequency
        close = close or _is_close(osc, w, t)
        slow = slow or w * t < _LITTLE
    rate = max(fastest_sinusoid(s), abs(osc.gamma) + abs(osc.nu))
    if rate * t <= (_SOME if close else _FEW) or (slow and own < _LITTLE):
        return panels(p, s, t, rate)
    if not close:
        return _closed(p, s, osc, t, 0.0)
    drive, external, friction, damper, contact = 0.0, 0.0, 0.0, 0.0, 0.0
    wide = min(_WIDE, _OF_OWN * osc.nu * t) / (TURN * t)
    for i in range(20):
        share, point = (_SHARES[i], _POINTS[i]) if i < 10 else (_SHARES[i - 10], -_POINTS[i - 10])
        of_drive, of_force, of_friction, of_damper, of_contact = _closed(p, s, osc, t, point * wide)
        drive += share * of_drive
        external += share * of_force
        friction += share * of_friction
        damper += share * of_damper
        contact += share * of_contact
    return Works(drive, external, friction, damper, contact)


@compiled
def _is_close(osc: Oscillator, w: float, t: float) -> bool:
    """Whether a sinusoid stays close to the oscillator's own within t."""
    gamma, _, nu, _, _ = osc
    return nu > 0.0 and (abs(gamma) + abs(w - nu)) * t < _CLOSE


@compiled
def _closed(p: Parameters, s: State, osc: Oscillator, t: float, shift: float) -> Works:
    """Return the works; sinusoids that are close have their frequency shifted, Hz."""
    steady, slope = (0.0, 0.0) if s.mode == STICK else slip_friction(p, s)
    rest = _rest_of(p, s, osc, t, shift, slope)
    products = _of_the_inputs(s, rest, t)
    for k in range(int(s.sinusoid_count)):
        one = _answer(p, s, osc, k, t, shift, slope)
        wave = complex(math.cos(TURN * one.cycle), math.sin(TURN * one.cycle))
        zero = wave_integral(one.frequency, one.cycle, t)
        products = _with_a_sinusoid(s, osc, rest, one, wave, zero, products, t)
        for j in range(k + 1):
            other = _answer(p, s, osc, j, t, shift, slope)
            products = _with_two(one, other, j == k, wave, zero, products, t)
    v_x, v_v, xx = products.v_x, products.v_v, products.xx
    apart = v_v - 2.0 * v_x + xx    # ∫ of the square of the other velocity, the slider's or the drive's lead
    if s.mode == STICK:
        return Works(p.stiffness * products.v_w + feed_damping(p) * (v_v - v_x), products.f_x, 0.0,
                     p.damping * (apart if p.feed_share != 0.0 else xx), p.contact_damping * xx)
    friction = p.normal_force * (s.direction * steady * products.path + slope * apart)
    return Works(p.stiffness * products.v_w + feed_damping(p) * v_x, products.f_v - products.f_x, friction,
                 p.damping * (xx if p.feed_share != 0.0 else apart), 0.0)


@compiled
def _rest_of(p: Parameters, s: State, osc: Oscillator, t: float, shift: float, slope: float) -> Rest:
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
        one = _answer(p, s, osc, k, t, shift, slope)
        at_rate = one.at_x if stuck else one.at_x - one.v
        x -= (one.phase * one.at_x).imag
        rate -= TURN * one.frequency * (one.phase * at_rate).real
    end, end_rate, once, twice, thrice, square = moments(osc, x, rate, k0, k1, t)
    return Rest(k0, k1, x, rate, end, end_rate, once, twice, thrice, square)


@compiled
def _of_the_inputs(s: State, rest: Rest, t: float) -> Products:
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
def _with_a_sinusoid(s: State, osc: Oscillator, rest: Rest, one: SinusoidAnswer, wave: complex, zero: complex,
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
def _with_two(one: SinusoidAnswer, other: SinusoidAnswer, alike: bool, wave: complex, zero: complex,
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


@compiled
def _given(s: State, k: int) -> tuple[float, complex, float, float]:
    """Return frequency and phase factor of a sinusoid at the segment start, and its amplitudes of v and F_e."""
    phase = complex(s.sinusoids[k].cosine, s.sinusoids[k].sine)
    return s.sinusoids[k].frequency, phase, s.sinusoids[k].v, s.sinusoids[k].f


@compiled
def _answer(p: Parameters, s: State, osc: Oscillator, k: int, t: float, shift: float, slope: float
           ) -> SinusoidAnswer:
    """Return a sinusoid and the answer to it.

    What distinguishes a sinusoid near resonance from the oscillator's own is taken once: phases and divisor agree on it
    to the last digit.
    """
    gamma, _, nu, near, far = osc
    frequency, phase, v, f = _given(s, k)
    apart = TURN * frequency - nu
    near_resonance = nu * t > 1.0 and (abs(gamma) + abs(apart)) * t < _NEAR
    if shift != 0.0 and _is_close(osc, TURN * frequency, t):
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
