# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run checked event by event in 50 digits: each from the state that the one before reports.

For contacts so stiff, or sliders so light, that the reference would go through billions of swings.  Under a constant
drive without force, with the exponential static law.  Times: the guard of
the event over its rate; positions: the closed form of the mode.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from mpmath import mpf, workdps

from ..axis import Axis, CompliantContact
from ..core.types import Event, EventKind, Mode
from .closed_form import CLOSED_FORM_DIGITS, LinearMode, Number, exact, exact_static_coefficient
from .outcome import require

_BESIDE = 1e-9   # a peak that is beyond the limit by less is left to the time of the event
_PEAKS = 200_000


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
    """Return the largest error of time over the duration and of position over the travel; raises Missed on a miss."""
    require(len(events) > 1, 'no events')
    with workdps(CLOSED_FORM_DIGITS):
        zero = mpf(0)
        point = _Point(zero, Mode.STICK, 0, zero, zero, zero, zero, zero, mpf('inf'))
        travel, worst = max(abs(event.position) for event in events), 0.0
        for event in events:
            t = exact(event.second, event.fraction) - point.time
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
    return _Point(exact(event.second, event.fraction), event.mode, event.direction, mpf(event.position), velocity,
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
    """Raise Missed when a swing of the contact force reached the limit before the break-away at `end`.

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
