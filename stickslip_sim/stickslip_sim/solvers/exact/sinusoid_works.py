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

from ...axis.layout import Parameters, State
from ...axis.motion import COASTING, STICK, oscillator_of, slip_friction
from ...axis.sinusoids import fastest_sinusoid
from ...core.jit import compiled
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
_HARDLY = 0.01      # radians of a sinusoid and of the oscillator that are left to panels, however fast others are
# Chebyshev's twenty points, those above 0, and Lagrange's weights for the middle between them
_POINTS = (0.996917333733127976, 0.972369920397676602, 0.923879532511286756, 0.852640164354092222,
           0.760405965600030938, 0.649448048330183656, 0.522498564715948865, 0.382683432365089772,
           0.233445363855905412, 0.078459095727844945)
_SHARES = (-0.0039350853412309224, 0.012003937954005802, -0.0207106781186547524, 0.0306400394069965998,
           -0.0427040342731733319, 0.0585424783056269613, -0.0815925843564394809, 0.120710678118654752,
           -0.20826498850452086, 0.635310236808735232)


@compiled
def still_works(p: Parameters, s: State, t: float) -> Works:
    """Return `works.works` of a slider that stands still or coasts."""
    u = s.velocity if s.mode == COASTING else 0.0
    rate, ahead = s.v_rate, s.base_v - u
    lead = (ahead + 0.5 * rate * t) * t                      # ∫(v − ẋ)
    stretch = (s.spring + (0.5 * ahead + rate * t / 6.0) * t) * t
    square = (ahead * ahead + (ahead + rate * t / 3.0) * rate * t) * t
    push = (s.base_f + 0.5 * s.f_rate * t) * t
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
    drive = stiffness * ((s.spring + 0.5 * lead) * lead + u * stretch) + damping * (square + u * lead)
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
        slow = slow or w * t < _HARDLY
    rate = max(fastest_sinusoid(s), abs(osc.gamma) + abs(osc.nu))
    if rate * t <= (_SOME if close else _FEW) or (slow and own < _HARDLY):
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
    """Whether a sinusoid hardly leaves the oscillator's own within t."""
    gamma, _, nu, _, _ = osc
    return nu > 0.0 and (abs(gamma) + abs(w - nu)) * t < _CLOSE


@compiled
def _closed(p: Parameters, s: State, osc: Oscillator, t: float, shift: float) -> Works:
    """Return the works; sinusoids that are close have their frequency shifted, Hz."""
    stuck = s.mode == STICK
    gamma, count = osc.gamma, int(s.sinusoid_count)
    steady, slope = (0.0, 0.0) if stuck else slip_friction(p, s)
    v0, v1, f0, f1 = s.base_v, s.v_rate, s.base_f, s.f_rate
    if stuck:
        k0, k1 = (p.stiffness * v0 + p.damping * v1 + f1) / p.mass, p.stiffness * v1 / p.mass
        x, rate = s.velocity, s.acceleration
    else:
        k0, k1 = (p.normal_force * slope * v1 - f1) / p.mass, 0.0
        x, rate = s.v - s.velocity, v1 - s.acceleration
    spring = s.spring
    for k in range(count):
        frequency, _, phase, v, _, at_x, _, _ = _answer(p, s, osc, k, t, shift, slope)
        x -= (phase * at_x).imag
        rate -= TURN * frequency * (phase * (at_x if stuck else at_x - v)).real
    end, end_rate, once, twice, thrice, xx = moments(osc, x, rate, k0, k1, t)
    once1, twice1 = t * once - twice, t * twice - thrice     # ∫ t x and ∫ t ∫x
    v_x, f_x = v0 * once + v1 * once1, f0 * once + f1 * once1
    v_v = (v0 * v0 + (v0 + v1 * t / 3.0) * v1 * t) * t
    f_v = (f0 * v0 + (0.5 * (f0 * v1 + f1 * v0) + f1 * v1 * t / 3.0) * t) * t
    if stuck:
        v_w = (v0 * ((spring + (0.5 * v0 + v1 * t / 6.0) * t) * t - twice)
               + v1 * ((0.5 * spring + (v0 / 3.0 + 0.125 * v1 * t) * t) * t * t - twice1))
    else:
        v_w = v0 * (spring * t + twice) + v1 * (0.5 * spring * t * t + twice1)
    path = (v0 + 0.5 * v1 * t) * t - once                      # of the slider, in slip
    for k in range(count):
        frequency, cycle, phase, v, f, at_x, lead, against = _answer(p, s, osc, k, t, shift, slope)
        w = TURN * frequency
        wave = complex(math.cos(TURN * cycle), math.sin(TURN * cycle))
        zero = wave_integral(frequency, cycle, t)
        one = wave_moment(w, wave, zero, t)
        lag = complex(2.0 * gamma, -w)
        of_x = over(k0 * zero + k1 * one - ((end_rate + lag * end) * wave - (rate + lag * x)), against)
        of_path = (once * wave - of_x) * complex(0.0, -1.0 / w)
        if stuck:
            square = (t * t * wave - 2.0 * one) * complex(0.0, -1.0 / w)
            of_stretch = phase * (spring * zero + v0 * one + 0.5 * v1 * square - of_path)
        else:
            of_stretch = phase * (spring * zero + of_path)
        of_x, of_v, of_f = phase * of_x, phase * (v0 * zero + v1 * one), phase * (f0 * zero + f1 * one)
        xx += 2.0 * (at_x * of_x).imag
        v_x += v * of_x.imag + (at_x * of_v).imag
        v_v += 2.0 * v * of_v.imag
        f_x += f * of_x.imag + (at_x * of_f).imag
        f_v += v * of_f.imag + f * of_v.imag
        v_w += v * of_stretch.imag + (lead * phase * swept_integral(w, v0, v1, zero, one, t)).imag
        path += ((v - at_x) * (phase * zero)).imag
        for j in range(k + 1):
            other, cycle_j, phase_j, v_j, f_j, x_j, lead_j, _ = _answer(p, s, osc, j, t, shift, slope)
            same, sum_ = wave_products(frequency, cycle, other, cycle_j, t)
            apart, joint = phase_products(phase, phase_j, j == k)
            w_j, zero_j = TURN * other, wave_integral(other, cycle_j, t)
            swept = joint * ramped_integral(w, wave, zero, w_j, zero_j, sum_, t)
            away = mirrored(apart) * ramped_integral(-w, mirrored(wave), mirrored(zero), w_j, zero_j, mirrored(same), t)
            v_w += 0.5 * v * (lead_j * (away - swept)).real
            if j < k:
                wave_j = complex(math.cos(TURN * cycle_j), math.sin(TURN * cycle_j))
                swept = joint * ramped_integral(w_j, wave_j, zero_j, w, zero, sum_, t)
                away = apart * ramped_integral(-w_j, mirrored(wave_j), mirrored(zero_j), w, zero, same, t)
                v_w += 0.5 * v_j * (lead * (away - swept)).real
            half = 0.25 if j == k else 0.5
            same, sum_ = apart * same, joint * sum_
            real = same - sum_                       # of two sinusoids in phase with the inputs
            with_x = mirrored(x_j) * same - x_j * sum_
            xx += 2.0 * half * (at_x * with_x).real
            v_v += 2.0 * half * v * v_j * real.real
            f_v += half * (f * v_j + v * f_j) * real.real
            v_x += half * (v * with_x.real + v_j * (at_x * real).real)
            f_x += half * (f * with_x.real + f_j * (at_x * real).real)
    if stuck:
        return Works(p.stiffness * v_w + p.damping * (v_v - v_x), f_x, 0.0, p.damping * (v_v - 2.0 * v_x + xx),
                     p.contact_damping * xx)
    friction = p.normal_force * (s.direction * steady * path + slope * (v_v - 2.0 * v_x + xx))
    return Works(p.stiffness * v_w + p.damping * v_x, f_v - f_x, friction, p.damping * xx, 0.0)


@compiled
def _given(s: State, k: int) -> tuple[float, complex, float, float]:
    """Return frequency and phase factor of a sinusoid at the segment start, and its amplitudes of v and F_e."""
    phase = complex(s.sinusoids[k].cosine, s.sinusoids[k].sine)
    return s.sinusoids[k].frequency, phase, s.sinusoids[k].v, s.sinusoids[k].f


@compiled
def _answer(p: Parameters, s: State, osc: Oscillator, k: int, t: float, shift: float, slope: float
           ) -> tuple[float, float, complex, float, float, complex, complex, complex]:
    """Return frequency, turns within t, phase factor, amplitudes of v and F_e, and the answer to them at phase 0.

    That is the amplitudes of x and of v − ẋ, and what the integral of the rest is divided by.  What distinguishes a
    sinusoid near resonance from the oscillator's own is taken once: phases and divisor agree on it to the last digit.
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
    divisor = complex(gamma, apart) * complex(gamma, w + nu) if nu > 0.0 else complex(-near, w) * complex(-far, w)
    against = mirrored(divisor)
    if s.mode == STICK:
        at_x = over(complex(p.stiffness * v, (p.damping * v + f) * w), p.mass * divisor)
        lead = complex((p.contact_stiffness - p.mass * w * w) * v, (p.contact_damping * v - f) * w)
        return frequency, cycle, phase, v, f, at_x, over(lead, p.mass * divisor), against
    lead = over(complex(-p.mass * w * w * v, (p.normal_force * slope * v - f) * w), p.mass * divisor)
    return frequency, cycle, phase, v, f, lead, lead, against
