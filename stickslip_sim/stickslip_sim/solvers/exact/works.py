# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The work of each force along the motion from the segment start, and the energies that are stored.

The works are integrals over the motion that follows from the state at the segment start, and none is the balance
itself: they know nothing of where the engine says that the motion arrives (see `linear.moments`).  Without sinusoids
the inputs are v + v′t and F + F′t, and every work is made from the integrals of x and of x²; x is the variable that a
motion settles in, the slider's velocity in stick, and in slip what the drive is ahead of it, v − ẋ.  Where that is
nearly all of v, little is left for the other one, and few of its digits; then the other one is x: of a slow slider that
slips under a fast drive, and of a contact so weak that it holds little.  `sinusoid_works` adds the sines.
"""

from typing import NamedTuple

from ...axis.codes import COASTING, STICK, YIELDING
from ...axis.forces import feed_damping, ground_damping, is_rigid_stick, slip_friction
from ...axis.layout import Parameters
from ...axis.motion import drive_travel, oscillator_of, travel
from ...axis.rows import EnergyRow
from ...axis.slip_series import moves_by_series, series_deflection
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...linear.moments import moments
from .sinusoid_works import Works, moving_works, panels, still_works

_FEW = 0.05   # of the drive's path: what is left of it with more than one digit less is integrated by itself


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
        if abs(of.travel) < _FEW * abs(path):
            of = _from_slider(p, s, t)
    else:
        of = _from_slider(p, s, t)
        if abs(path - of.travel) < _FEW * abs(path):
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
