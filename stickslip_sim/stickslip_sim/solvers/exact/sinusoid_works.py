# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The works under sines, in closed form: as much for a second at 1 Hz as for a day at 1 MHz.

A motion is its steady answers to the sinusoids and the rest (`sinusoid_answers`), and the works are made of products of
these parts (`sinusoid_answers`).  The works are smooth functions of the frequency even near resonance, where the parts
cancel; they are interpolated there, from where nothing cancels.  What is over within a radian or two is left to
`panels`.
"""

import math
from typing import NamedTuple

from ...axis.codes import COASTING, STICK, YIELDING
from ...axis.forces import feed_damping, kinetic_at_rest, slip_friction
from ...axis.layout import Parameters
from ...axis.motion import drive_travel, oscillator_of, travel
from ...axis.sinusoids import fastest_sinusoid, inputs_at
from ...axis.slip_series import series_deflection
from ...axis.smooth_load import normal_force_at
from ...axis.state_record import State
from ...core.hot_path import compiled
from ...linear.oscillator import Oscillator
from ...linear.wave_products import cycle_within, phase_products, wave_integral, wave_moment, wave_products
from ...linear.waves import TURN
from .sinusoid_answers import (
    answer_to,
    given_sinusoid,
    is_close,
    products_of_inputs,
    rest_of,
    with_a_sinusoid,
    with_two,
)

# The works of a short motion under sines, by Gauss and Legendre's rule over the powers.

# eight nodes of Gauss and Legendre's rule
_NODES = (-0.96028985649753623168, -0.79666647741362673959, -0.52553240991632898582, -0.18343464249564980494,
          0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959, 0.96028985649753623168)
_WEIGHTS = (0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734, 0.36268378337836198297,
            0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915)
_RADIANS = 1.5      # of a panel: the error for a product of two sinusoids is then below 1e-15


class Works(NamedTuple):
    """Works from the segment start on, J: the first two are positive when they give, the others when they take."""

    drive: float
    external: float
    friction: float
    damper: float    # of the drive
    contact: float   # the contact's damper


@compiled
def panels(p: Parameters, s: State, t: float, rate: float) -> Works:
    """Return the works of a moving mode up to t, from eight nodes a panel; `rate` is its fastest rate, rad/s."""
    drive, external, friction, damper, contact = 0.0, 0.0, 0.0, 0.0, 0.0
    count = math.floor(rate * t / _RADIANS) + 1.0
    half = 0.5 * t / count
    panel = 0.0
    while panel < count:
        for i in range(8):
            weight = half * _WEIGHTS[i]
            at = half * (2.0 * panel + 1.0 + _NODES[i])
            of_drive, of_force, of_friction, of_damper, of_contact = _powers(p, s, at)
            drive += weight * of_drive
            external += weight * of_force
            friction += weight * of_friction
            damper += weight * of_damper
            contact += weight * of_contact
        panel += 1.0
    return Works(drive, external, friction, damper, contact)


@compiled
def _powers(p: Parameters, s: State, t: float) -> Works:
    y, u, _ = travel(p, s, t)
    v, force = s.inputs.v + s.inputs.v_rate * t, s.inputs.f + s.inputs.f_rate * t
    if s.sinusoid_count != 0.0:
        v, force = inputs_at(s, s.second, s.fraction + t, t)
    ahead = p.feed_share * v - u
    drive_force = p.stiffness * (s.spring + (drive_travel(s, t) - y)) + p.feed_share * p.damping * ahead
    friction, contact = 0.0, 0.0
    if s.mode == STICK:
        contact = p.contact_damping * u * u
    else:
        normal, _ = normal_force_at(p, s, t)
        if s.mode == YIELDING:
            _, rate = series_deflection(s, t)
            friction = s.direction * normal * kinetic_at_rest(p, s.direction) * (u - rate)
            contact = p.contact_damping * rate * rate
        else:
            steady, slope = slip_friction(p, s)
            friction = normal * (s.direction * steady + slope * u) * u
    return Works(drive_force * v, force * u, friction, p.damping * ahead * ahead, contact)


_FEW = 3.0          # radians that are left to panels
_SOME = 24.0        # and those where a sinusoid would have to be interpolated otherwise
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
        frequency, phase, v, f = given_sinusoid(s, k)
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
            other, phase_j, v_j, _ = given_sinusoid(s, j)
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
        close = close or is_close(osc, w, t)
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
def _closed(p: Parameters, s: State, osc: Oscillator, t: float, shift: float) -> Works:
    """Return the works; sinusoids that are close have their frequency shifted, Hz."""
    steady, slope = (0.0, 0.0) if s.mode == STICK else slip_friction(p, s)
    rest = rest_of(p, s, osc, t, shift, slope)
    products = products_of_inputs(s, rest, t)
    for k in range(int(s.sinusoid_count)):
        one = answer_to(p, s, osc, k, t, shift, slope)
        wave = complex(math.cos(TURN * one.cycle), math.sin(TURN * one.cycle))
        zero = wave_integral(one.frequency, one.cycle, t)
        products = with_a_sinusoid(s, osc, rest, one, wave, zero, products, t)
        for j in range(k + 1):
            other = answer_to(p, s, osc, j, t, shift, slope)
            products = with_two(one, other, j == k, wave, zero, products, t)
    v_x, v_v, xx = products.v_x, products.v_v, products.xx
    apart = v_v - 2.0 * v_x + xx    # ∫ of the square of the other velocity, the slider's or the drive's lead
    if s.mode == STICK:
        return Works(p.stiffness * products.v_w + feed_damping(p) * (v_v - v_x), products.f_x, 0.0,
                     p.damping * (apart if p.feed_share != 0.0 else xx), p.contact_damping * xx)
    friction = p.normal_force * (s.direction * steady * products.path + slope * apart)
    return Works(p.stiffness * products.v_w + feed_damping(p) * v_x, products.f_v - products.f_x, friction,
                 p.damping * (xx if p.feed_share != 0.0 else apart), 0.0)
