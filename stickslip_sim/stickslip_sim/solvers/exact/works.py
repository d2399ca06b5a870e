# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The work of each force along the motion from the segment start, and the energies that are stored.

The works are integrals over the motion that follows from the state at the segment start, and none is the balance
itself: they know nothing of where the engine says that the motion arrives (see `linear.moments`).  Without sinusoids
the inputs are v + v′t and F + F′t, and every work is made from the integrals of x and of x²; x is the variable that a
motion settles in, the slider's velocity in stick, and in slip what the drive is ahead of it, v − ẋ.  Where that is
nearly all of v, little is left for the other one, and few of its digits; then the other one is x: of a slow slider that
slips under a fast drive, and of a contact so weak that it holds little.  The sines add theirs (below).
"""

import math
from typing import NamedTuple

from ...axis.codes import COASTING, STICK, YIELDING
from ...axis.forces import feed_damping, ground_damping, is_rigid_stick, kinetic_at_rest, slip_friction
from ...axis.layout import Parameters
from ...axis.motion import drive_travel, oscillator_of, travel
from ...axis.rows import EnergyRow
from ...axis.sinusoids import fastest_sinusoid, inputs_at
from ...axis.slip_series import moves_by_series, series_deflection
from ...axis.smooth_load import normal_force_at
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...linear.moments import moments
from ...linear.oscillator import Oscillator
from ...linear.waves import TURN, cycle_within, phase_products, wave_integral, wave_moment, wave_products
from .sinusoid_answers import (
    answer_to,
    given_sinusoid,
    is_close,
    products_of_inputs,
    rest_of,
    with_a_sinusoid,
    with_two,
)

# The works under sines, in closed form: as much for a second at 1 Hz as for a day at 1 MHz.
#
# A motion is its steady answers to the sinusoids and the rest (`sinusoid_answers`), and the works are made of products
# of these parts (`sinusoid_answers`).  The works are smooth functions of the frequency even near resonance, where the
# parts cancel; they are interpolated there, from where nothing cancels.  What is over within a radian or two is left to
# `panels`.

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


_REST = 0.05   # of the drive's path: what is left of it with more than one digit less is integrated by itself


class MotionIntegrals(NamedTuple):
    """Integrals over a motion with w = s − x and x = v − ẋ, the drive's lead."""

    stretch: float       # ∫w
    stretch1: float      # ∫t w
    v_lead: float        # ∫v x
    lead_square: float   # ∫x²
    travel: float        # ∫ẋ
    moment: float        # ∫t ẋ
    square: float        # ∫ẋ²


@inlined
def works(p: Parameters, s: State, t: float) -> Works:
    """Return the works from the segment start up to t."""
    if moves_by_series(s):
        return panels(p, s, t, 1.0 / s.series_end)
    if s.sinusoid_count != 0.0:
        if s.mode == COASTING or is_rigid_stick(p, s):
            return still_works(p, s, t)
        return moving_works(p, s, t)
    if s.mode == COASTING:
        return _coasting(p, s, t)
    return _rigid_hold(p, s, t) if is_rigid_stick(p, s) else _moving(p, s, t)


@inlined
def _rigid_hold(p: Parameters, s: State, t: float) -> Works:
    v, rate = s.inputs.v, s.inputs.v_rate
    path = (v + 0.5 * rate * t) * t
    damper = feed_damping(p) * _square(v, rate, t)
    return Works(p.stiffness * (s.spring + 0.5 * path) * path + damper, 0.0, 0.0, damper, 0.0)


@inlined
def _coasting(p: Parameters, s: State, t: float) -> Works:
    u, v, rate = s.velocity, s.inputs.v, s.inputs.v_rate
    ahead = v - u
    lead = (ahead + 0.5 * rate * t) * t
    stretch = s.spring * t + (0.5 * ahead + rate * t / 6.0) * t * t
    stretch1 = (0.5 * s.spring + (ahead / 3.0 + 0.125 * rate * t) * t) * t * t
    lead1 = (0.5 * ahead + rate * t / 3.0) * t * t
    drive = (p.stiffness * (v * stretch + rate * stretch1) + feed_damping(p) * (v * lead + rate * lead1))
    external = u * (s.inputs.f + 0.5 * s.inputs.f_rate * t) * t
    damper = p.damping * (_square(ahead, rate, t) if p.feed_share != 0.0 else u * u * t)
    damped = p.damping * (lead if p.feed_share != 0.0 else -u * t)
    return Works(drive, external, u * (p.stiffness * stretch + damped) + external, damper, 0.0)


@inlined
def _moving(p: Parameters, s: State, t: float) -> Works:
    """Return the works in slip, or in a compliant contact."""
    v, rate = s.inputs.v, s.inputs.v_rate
    slips = s.mode != STICK
    steady, slope = slip_friction(p, s) if slips else (0.0, 0.0)
    contact, damping = (0.0, p.normal_force * slope) if slips else (p.contact_stiffness, p.contact_damping)
    path = (v + 0.5 * rate * t) * t
    if slips:
        of = _from_lead(p, s, t, contact, damping + ground_damping(p))
        if abs(of.travel) < _REST * abs(path):
            of = _from_slider(p, s, t)
    else:
        of = _from_slider(p, s, t)
        if abs(path - of.travel) < _REST * abs(path):
            of = _from_lead(p, s, t, contact, damping + ground_damping(p))
    drive = p.stiffness * (v * of.stretch + rate * of.stretch1) + feed_damping(p) * of.v_lead
    external = s.inputs.f * of.travel + s.inputs.f_rate * of.moment
    damper = p.damping * (of.lead_square if p.feed_share != 0.0 else of.square)
    lost = damping * of.square
    if slips:
        return Works(drive, external, p.normal_force * s.direction * steady * of.travel + lost, damper, 0.0)
    return Works(drive, external, 0.0, damper, lost)


@compiled
def _from_slider(p: Parameters, s: State, t: float) -> MotionIntegrals:
    """Return the integrals from the moments of ẋ."""
    v, rate = s.inputs.v, s.inputs.v_rate
    push = (p.stiffness * v + feed_damping(p) * rate + s.inputs.f_rate) / p.mass
    _, _, y, once, twice, square = moments(oscillator_of(s), s.velocity, s.acceleration, push,
                                           p.stiffness * rate / p.mass, t)
    u1 = t * y - once
    v_u, v_square = v * y + rate * u1, _square(v, rate, t)
    stretch = (s.spring + (0.5 * v + rate * t / 6.0) * t) * t - once
    stretch1 = (0.5 * s.spring + (v / 3.0 + 0.125 * rate * t) * t) * t * t - (t * once - twice)
    return MotionIntegrals(stretch, stretch1, v_square - v_u, v_square - 2.0 * v_u + square, y, u1, square)


@compiled
def _from_lead(p: Parameters, s: State, t: float, contact: float, damping: float) -> MotionIntegrals:
    """Return the integrals from the moments of x.

    What resists the motion is `contact` times the path, `damping` times the speed, and what does not change.
    """
    v, rate = s.inputs.v, s.inputs.v_rate
    push = (contact * v + damping * rate - s.inputs.f_rate) / p.mass
    _, _, lead, once, twice, square = moments(oscillator_of(s), v - s.velocity, rate - s.acceleration, push,
                                              contact * rate / p.mass, t)
    lead1 = t * lead - once
    v_lead = v * lead + rate * lead1
    y = (v + 0.5 * rate * t) * t - lead
    u1 = (0.5 * v + rate * t / 3.0) * t * t - lead1
    stretch = s.spring * t + once
    stretch1 = 0.5 * s.spring * t * t + (t * once - twice)
    return MotionIntegrals(stretch, stretch1, v_lead, square, y, u1, _square(v, rate, t) - 2.0 * v_lead + square)


@inlined
def _square(v: float, rate: float, t: float) -> float:
    """Return ∫(v + rate t)²."""
    return (v * v + (v + rate * t / 3.0) * rate * t) * t


@compiled
def stored_energy(p: Parameters, s: State, t: float) -> float:
    """Return m ẋ²/2 + c (s − x)²/2 + c_c δ²/2 at t after the segment start, J."""
    if t == 0.0:
        y, u, spring = 0.0, s.velocity, s.spring
    else:
        y, u, _ = travel(p, s, t)
        spring = s.spring + (drive_travel(s, t) - y)
    if s.mode == YIELDING and t != 0.0:
        deflection, _ = series_deflection(s, t)
        y = deflection - s.deflection
    return 0.5 * (p.mass * u * u + p.stiffness * spring * spring) + contact_energy(p, s, y)


@compiled
def contact_energy(p: Parameters, s: State, y: float) -> float:
    """Return c_c δ²/2 after δ has changed by y from the segment start, J; 0 in slip and in a rigid contact."""
    if (s.mode != STICK and s.mode != YIELDING) or p.compliant == 0.0:
        return 0.0
    deflection = s.deflection + y
    return 0.5 * p.contact_stiffness * deflection * deflection


# Keep the account of energy in the state: add up works and exchanges so that a run of any length loses nothing.
#
# Each sum carries what rounding has lost of it (Neumaier, ZAMM 54, 1974).

@compiled
def book_works(p: Parameters, s: State, t: float) -> None:
    """Add the works from the segment start up to t, where the next segment is about to start."""
    done = works(p, s, t)
    s.sums.drive, s.lost.drive = _added(s.sums.drive, s.lost.drive, done.drive)
    s.sums.external, s.lost.external = _added(s.sums.external, s.lost.external, done.external)
    s.sums.friction, s.lost.friction = _added(s.sums.friction, s.lost.friction, done.friction)
    s.sums.damper, s.lost.damper = _added(s.sums.damper, s.lost.damper, done.damper)
    s.sums.contact, s.lost.contact = _added(s.sums.contact, s.lost.contact, done.contact)
    _book_throughput(s, _size(done, 0.0))


@compiled
def book_contact(p: Parameters, s: State, before: float) -> None:
    """Add the contact energy that a transition made appear or vanish; it was `before`, J."""
    amount = contact_energy(p, s, 0.0) - before
    s.sums.contact_exchange, s.lost.contact_exchange = _added(s.sums.contact_exchange, s.lost.contact_exchange, amount)
    _book_throughput(s, abs(amount))


@compiled
def book_parameters(p: Parameters, s: State, before: float) -> None:
    """Add what a change of parameters did to the stored energy; it was `before`, J."""
    amount = stored_energy(p, s, 0.0) - before
    s.sums.parameter_exchange, s.lost.parameter_exchange = _added(s.sums.parameter_exchange, s.lost.parameter_exchange,
                                                                  amount)
    _book_throughput(s, abs(amount))


@compiled
def read_account(p: Parameters, s: State, t: float, out: EnergyRow) -> None:
    """Fill a row of `energy.EnergyBalance`: the sums, and what came up to t after the segment start."""
    done = works(p, s, t)
    out.drive = s.sums.drive + s.lost.drive + done.drive
    out.external = s.sums.external + s.lost.external + done.external
    out.friction = s.sums.friction + s.lost.friction + done.friction
    out.damper = s.sums.damper + s.lost.damper + done.damper
    out.contact = s.sums.contact + s.lost.contact + done.contact
    out.contact_exchange = s.sums.contact_exchange + s.lost.contact_exchange
    out.parameter_exchange = s.sums.parameter_exchange + s.lost.parameter_exchange
    out.stored = stored_energy(p, s, t)
    out.stored_at_start = s.stored_at_start
    out.throughput = _size(done, s.sums.throughput + s.lost.throughput)


@compiled
def balance(p: Parameters, s: State, t: float) -> tuple[float, float]:
    """Return what the balance leaves open at t after the segment start, and what went through or is stored, J."""
    given = (s.sums.drive + s.lost.drive) + (s.sums.external + s.lost.external)
    given += s.sums.contact_exchange + s.lost.contact_exchange
    given += s.sums.parameter_exchange + s.lost.parameter_exchange
    taken = (s.sums.friction + s.lost.friction) + (s.sums.damper + s.lost.damper) + (s.sums.contact + s.lost.contact)
    scale = s.sums.throughput + s.lost.throughput
    if t != 0.0:
        done = works(p, s, t)
        given += done.drive + done.external
        taken += done.friction + done.damper + done.contact
        scale += _size(done, 0.0)
    stored = stored_energy(p, s, t)
    return abs((given - taken) - (stored - s.stored_at_start)), max(scale, max(stored, s.stored_at_start))


@inlined
def _size(done: Works, total: float) -> float:
    """Return a total and the magnitudes of the works, added one by one."""
    return total + abs(done.drive) + abs(done.external) + abs(done.friction) + abs(done.damper) + abs(done.contact)


@inlined
def _book_throughput(s: State, amount: float) -> None:
    s.sums.throughput, s.lost.throughput = _added(s.sums.throughput, s.lost.throughput, amount)


@inlined
def _added(total: float, lost: float, amount: float) -> tuple[float, float]:
    """Return a sum, and what rounding has lost of it, after adding an amount."""
    after = total + amount
    return after, lost + ((total - after) + amount if abs(total) >= abs(amount) else (amount - after) + total)
