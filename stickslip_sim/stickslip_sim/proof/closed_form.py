# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Linear motions and break-away instants in closed form, in mpmath's arithmetic: the figures are measured against them.

`error_of_chain` checks a run event by event, each from the state that the one before reports: for contacts so stiff, or
sliders so light, that the reference would go through billions of swings.

m x″ + D x′ + K x = q(t) from rest is x = Σ Δ_i G_(k+1)(t − t_i)/m, where q's k-th derivative jumps by Δ_i at t_i, and
G_k is the k-fold integral of the impulse response (exp(λ₁t) − exp(λ₂t))/(λ₁ − λ₂).
"""

import math
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from mpmath import exp, factorial, findroot, fsum, mpc, mpf, sqrt, workdps

from ..axis import Axis, CompliantContact
from ..core.types import Event, EventKind, Mode
from ..friction import StaticLaw
from ..reference.statics import StaticLaw as ReferenceLaw
from .judges import require

CLOSED_FORM_DIGITS = 50
Number = Any   # mpf
_BESIDE = 1e-9   # a peak that is beyond the limit by less is left to the time of the event
_PEAKS = 200_000


class Jump(NamedTuple):
    """The `order`-th derivative of the load q jumps by `size` at `time`."""

    time: Number
    order: int
    size: Number


class LinearMode:
    """m x″ + D x′ + K x = q; arguments are the doubles that they are."""

    def __init__(self, mass: Number, damping: Number, stiffness: Number) -> None:
        with workdps(CLOSED_FORM_DIGITS):
            self.mass = mpf(mass)
            gamma = mpf(damping) / (2 * self.mass)
            root = sqrt(mpc(gamma * gamma - mpf(stiffness) / self.mass))
            if root == 0:   # critical to the last bit: 1e-22 beside it is the same to 22 digits
                root = mpc((abs(gamma) or 1) * mpf(10) ** -22)
            self._rates = (-gamma + root, -gamma - root)

    def integral(self, order: int, t: Number) -> Number:
        """Return G_order(t); order −1 is g′."""
        with workdps(CLOSED_FORM_DIGITS):
            one, two = (_integrated(rate, order, mpf(t)) for rate in self._rates)
            return ((one - two) / (self._rates[0] - self._rates[1])).real

    def growth(self, t: Number) -> Number:
        """Return by how much the size of a free motion has grown or shrunk at t."""
        with workdps(CLOSED_FORM_DIGITS):
            return exp(max(rate.real for rate in self._rates) * t)

    def response(self, jumps: Iterable[Jump], t: Number) -> tuple[Number, Number]:
        """Return x and x′ at t, from rest at 0."""
        with workdps(CLOSED_FORM_DIGITS):
            past = [(t - jump.time, jump) for jump in jumps if jump.time < t]
            x = fsum(jump.size * self.integral(jump.order + 1, since) for since, jump in past) / self.mass
            u = fsum(jump.size * self.integral(jump.order, since) for since, jump in past) / self.mass
            return x, u


def exact_contact_force(axis: Axis, jumps: list[Jump]) -> Callable[[Number], Number]:
    """Return F_c(t) of a compliant stick from rest, under the load q = c s + h v + F_e."""
    contact = axis.contact
    assert isinstance(contact, CompliantContact)
    mode = LinearMode(axis.mass, mpf(axis.drive_damping) + mpf(contact.damping),
                      mpf(axis.drive_stiffness) + mpf(contact.stiffness))

    def force(t: Number) -> Number:
        x, u = mode.response(jumps, t)
        return contact.stiffness * x + contact.damping * u

    return force


def exact_static_coefficient(law: StaticLaw, rest: Number) -> Number:
    """Return mu_s after a rest time, by the formulas of the reference."""
    with workdps(CLOSED_FORM_DIGITS):
        numbers = map(mpf, (law.initial, law.limit, law.time_constant, law.exponent, law.delay))
        return ReferenceLaw(law.kind.name.lower(), *numbers).value(mpf(rest))


def root_near(function: Callable[[Number], Number], low: Number, high: Number) -> Number:
    """Return the root between two instants of opposite sign."""
    with workdps(CLOSED_FORM_DIGITS):
        return findroot(function, (mpf(low), mpf(high)), solver='anderson', tol=mpf(10) ** -60, verify=False)


def exact(second: float, fraction: float) -> Number:
    """Return the instant of an event without rounding."""
    with workdps(CLOSED_FORM_DIGITS):
        time = Fraction(second) + Fraction(fraction)
        return mpf(time.numerator) / time.denominator


def _integrated(rate: Number, order: int, t: Number) -> Number:
    """Return the `order`-fold integral of exp(rate t) from 0; −1 is its derivative."""
    if order < 0:
        return rate * exp(rate * t)
    if rate == 0:
        return t ** order / factorial(order)
    if abs(rate * t) < mpf(10) ** -4:   # the difference below would lose digits
        return fsum(rate ** k * t ** (k + order) / factorial(k + order) for k in range(12))
    return (exp(rate * t) - fsum((rate * t) ** k / factorial(k) for k in range(order))) / rate ** order


class _Point(NamedTuple):
    """The state after an event; `excess` is E of the slip, `rest` the rest time at that event."""

    time: Number
    mode: Mode
    direction: int
    position: Number
    velocity: Number
    stretch: Number
    deflection: Number
    excess: Number
    rest: Number


class _Motion(NamedTuple):
    """y, y′ and y″ since a point, and the forces."""

    travel: Number
    velocity: Number
    acceleration: Number
    applied: Number
    contact: Number


def error_of_chain(axis: Axis, drive: float, events: Sequence[Event], duration: float) -> float:
    """Return the largest error of time over the duration and of position over the travel; raises Find on a miss.

    Of a compliant contact under a constant drive (m/s) without force, with the exponential static law.  Times: the
    guard of the event over its rate; positions: the closed form of the mode.
    """
    require(len(events) > 1, 'no events')
    with workdps(CLOSED_FORM_DIGITS):
        zero = mpf(0)
        point = _Point(zero, Mode.STICK, 0, zero, zero, zero, zero, zero, mpf('inf'))
        travel, worst = max(abs(event.position) for event in events), 0.0
        for event in events:
            t = exact(*event.instant) - point.time
            motion = _motion(axis, drive, point, t)
            wrong = abs(point.position + motion.travel - mpf(event.position)) / travel
            late = abs(_lateness(axis, drive, point, event, t)) / duration
            worst = max(worst, float(wrong), float(late))
            if event.kind == EventKind.BREAKAWAY and isinstance(axis.contact, CompliantContact):
                _check_no_peak_before(axis, drive, point, float(t))
            point = _after(axis, point, event)
    return worst


def _after(axis: Axis, before: _Point, event: Event) -> _Point:
    """Return the state with which the motion goes on."""
    friction, velocity = axis.friction, mpf(event.velocity)
    excess, rest, deflection = before.excess, mpf(0), mpf(0)
    if event.kind in (EventKind.BREAKAWAY, EventKind.REVERSE):
        coefficient, _, psi, _ = _line(axis, abs(velocity), up=True)
        at = exact_static_coefficient(friction.static, mpf(event.rest_time))
        excess = (at - coefficient) / psi if psi > 0 and at >= coefficient else mpf(0)
    if event.mode == Mode.STICK and isinstance(axis.contact, CompliantContact):
        deflection = (event.direction * mpf(axis.normal_force) * mpf(friction.kinetic.coefficients[0])
                      / mpf(axis.contact.stiffness))
    return _Point(exact(*event.instant), event.mode, event.direction, mpf(event.position), velocity,
                  mpf(event.drive_position) - mpf(event.position), deflection, excess, rest)


def _line(axis: Axis, speed: Number, *, up: bool) -> tuple[Number, Number, Number, Number]:
    """Return mu_k, its slope, psi and its slope at a speed, on the segment that goes up or down from there."""
    table, excess = axis.friction.kinetic, axis.friction.excess
    assert excess is not None
    assert table.velocities == excess.velocities
    top = mpf(table.velocities[-1])
    if speed > top or (up and speed == top):
        return mpf(table.coefficients[-1]), mpf(0), mpf(0), mpf(0)
    slope = (mpf(table.coefficients[-1]) - mpf(table.coefficients[0])) / top
    return mpf(table.coefficients[0]) + slope * speed, slope, 1 - speed / top, -1 / top


def _motion(axis: Axis, drive: float, point: _Point, t: Number) -> _Motion:
    """Return the motion of the mode at t after a point."""
    c, h, m, v = mpf(axis.drive_stiffness), mpf(axis.drive_damping), mpf(axis.mass), mpf(drive)
    contact = axis.contact
    assert isinstance(contact, CompliantContact)
    if point.mode == Mode.COASTING:
        travel, u, a = point.velocity * t, point.velocity, mpf(0)
    else:
        stiffness, damping, load = c, h, c * point.stretch + h * v
        if point.mode == Mode.STICK:
            stiffness, damping = c + mpf(contact.stiffness), h + mpf(contact.damping)
            load -= mpf(contact.stiffness) * point.deflection
        else:
            speed = abs(point.velocity)
            coefficient, slope, psi, fall = _line(axis, speed, up=point.mode == Mode.ACCELERATING)
            if point.mode == Mode.ACCELERATING:
                coefficient, slope = coefficient + point.excess * psi, slope + point.excess * fall
            damping += mpf(axis.normal_force) * slope
            load -= point.direction * mpf(axis.normal_force) * (coefficient - slope * speed)
        mode = LinearMode(m, damping, stiffness)
        rates, pull = [mode.integral(order, t) for order in (-1, 0, 1, 2)], c * v
        travel = point.velocity * rates[1] + (load * rates[2] + pull * rates[3]) / m
        u = point.velocity * rates[0] + (load * rates[1] + pull * rates[2]) / m
        a = (load + pull * t - stiffness * travel - damping * u) / m
    applied = c * (point.stretch + v * t - travel) + h * (v - u)
    held = mpf(contact.stiffness) * (point.deflection + travel) + mpf(contact.damping) * u
    return _Motion(travel, u, a, applied, held)


def _lateness(axis: Axis, drive: float, point: _Point, event: Event, t: Number) -> Number:
    """Return how far t is from the root of the event's guard, to first order."""
    small = max(t, mpf(10) ** -12) * mpf(10) ** -20
    value, beside = (_guard(axis, drive, point, event, at) for at in (t, t + small))
    return value * small / (beside - value) if beside != value else mpf(0)


def _guard(axis: Axis, drive: float, point: _Point, event: Event, t: Number) -> Number:
    """Return the quantity that vanishes at an event of this kind."""
    motion, normal = _motion(axis, drive, point, t), mpf(axis.normal_force)
    if event.kind == EventKind.BREAKAWAY:
        side = 1 if event.friction_force > 0.0 else -1
        return side * motion.contact - normal * exact_static_coefficient(axis.friction.static, point.rest + t)
    if event.kind == EventKind.STICK:
        return motion.velocity
    if event.kind == EventKind.KNOT:
        return abs(motion.velocity) - mpf(axis.friction.kinetic.velocities[-1])
    if point.mode != Mode.COASTING:
        return motion.acceleration
    coefficient, _, psi, _ = _line(axis, abs(point.velocity), up=True)
    upper = coefficient + (point.excess * psi if event.kind == EventKind.ACCELERATE else 0)
    return point.direction * motion.applied - normal * upper


def _check_no_peak_before(axis: Axis, drive: float, point: _Point, end: float) -> None:
    """Raise Find when a swing of the contact force reached the limit before the break-away at `end`.

    In doubles, at up to _PEAKS instants a twentieth of a swing apart over the last swings before it.
    """
    contact = axis.contact
    assert isinstance(contact, CompliantContact)
    stiffness = axis.drive_stiffness + contact.stiffness
    gamma = 0.5 * (axis.drive_damping + contact.damping) / axis.mass
    frequency = stiffness / axis.mass - gamma * gamma
    if frequency <= 0.0:
        return   # it drifts up to the limit once
    nu, drift = math.sqrt(frequency), axis.drive_stiffness * drive / stiffness
    step = 0.05 * 2.0 * math.pi / nu
    t = np.arange(max(0.0, end - _PEAKS * step), end - 5.0 * step, step)
    start = float(_motion(axis, drive, point, mpf(0)).acceleration)
    # y″ is a free motion: y = steady + drift t + (free part), all from y″(0) and y″′(0)
    jerk = (axis.drive_stiffness * drive - stiffness * float(point.velocity)) / axis.mass - 2.0 * gamma * start
    decay, sine, cosine = np.exp(-gamma * t), np.sin(nu * t), np.cos(nu * t)
    acceleration = decay * (start * cosine + (jerk + gamma * start) / nu * sine)
    slope = decay * (jerk * cosine - (gamma * jerk + (frequency + gamma * gamma) * start) / nu * sine)
    omega2 = frequency + gamma * gamma
    velocity = drift - (slope + 2.0 * gamma * acceleration) / omega2
    load = axis.drive_stiffness * (float(point.stretch) + drive * t) + axis.drive_damping * drive
    shared = contact.stiffness / stiffness
    travel = (load - axis.mass * acceleration - 2.0 * gamma * axis.mass * velocity) / stiffness
    held = (contact.stiffness * (float(point.deflection) * (1.0 - shared) + travel) + contact.damping * velocity)
    law = axis.friction.static
    limits = law.limit - (law.limit - law.initial) * np.exp(-(float(point.rest) + t) / law.time_constant)
    require(np.all(np.abs(held) <= axis.normal_force * limits * (1.0 + _BESIDE)), 'the limit was reached before')
