# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From a run to linear motions: one segment between two neighbouring events, borders of the inputs, or ends.

z = (f, u, y, v, 1, sin and cosine of each sinusoid): f is the force that accelerates the slider, or F_d + F_e where
nothing moves it (a rigid stick, coasting); u its velocity, y its travel, v the drive's velocity without sinusoids.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from stickslip_sim.axis import Axis, CompliantContact
from stickslip_sim.core.input_profile import InputProfile, Piece
from stickslip_sim.core.types import Event, EventKind, Instant, Mode, Sample

from ..case import Parts, Run, borders, instant
from .friction import Tables, static

Long = np.longdouble
EPSILON = 2.0 ** -52
FORCES = 16.0 * EPSILON       # of the sum of all forces: what rounding makes of a residual
F, U, Y, V, ONE, WAVE = range(6)
_UNFELT = 1e-17               # of the sum of all forces: an acceleration that no digit of them shows
LOWER, UPPER = 0, 1           # guards: the first and the second row


@dataclass
class Node:
    """The state at an event or border, with the mode after it."""

    at: Instant
    event: Event | None
    mode: Mode
    direction: int
    position: float
    velocity: float
    drive_force: float
    deflection: float
    rest_time: float
    excess: Any
    excess_noise: Any
    new_force: bool     # an input may have jumped at this instant

    @property
    def label(self) -> str:
        """What stands here, for people."""
        return f'{self.event.kind.name} at {self.at.seconds!r} s' if self.event else f'state at {self.at.seconds!r} s'


@dataclass
class Segment:
    """A linear motion from one node to the next, with its guards."""

    begin: Node
    end: Node
    length: Any
    rates: Any          # A of z′ = A z
    start: Any
    noise: Any          # what rounding may have done to the start
    pace: float         # bound on the size of eigenvalues and input frequencies, 1/s
    swings: float       # periods of the fastest oscillation in it
    drift: float        # relative error of the eigenvalues by rounded parameters, 1/s
    guards: Any         # (2, d) rows; a guard is row · z (+ N mu_s in stick), never negative
    slack: Any          # (2,) rounding of the guards
    outputs: Any        # (3, d) rows: velocity, travel, drive force less what inputs add
    wanted: Any         # (3,) as the engine has it
    spread: Any         # (3,) rounding of that
    axis: Axis


def segments(run: Run) -> Iterator[Segment]:
    """Return the segments of a run."""
    parts, tables = run.parts, Tables(run.parts.axis)
    nodes = list(_nodes(run, tables))
    came = 0.0
    for begin, end in pairwise(nodes):
        length = (Long(end.at.second) - Long(begin.at.second)) + (Long(end.at.fraction) - Long(begin.at.fraction))
        if length > 0:
            yield _segment(parts, tables, begin, end, length, came)
            came = abs(end.position - begin.position)


def _nodes(run: Run, tables: Tables) -> Iterator[Node]:
    parts = run.parts
    jumps = {Instant(0.0, 0.0)}
    for border in borders(parts):     # the end, too: an input may jump there
        jumps.add(instant(border))
    excess = Long(0), Long(0)
    stretches = [(run.at_start, run.start), *run.stretches]
    for events, sample in stretches:
        for event in events:
            excess = _excess(event, excess, tables)
            yield _node_of_event(event, *excess, event.instant in jumps, parts)
        yield _node_of_sample(sample, *excess)


def _excess(event: Event, excess: tuple[Any, Any], tables: Tables) -> tuple[Any, Any]:
    """Return E from this event on, and its rounding."""
    if event.kind not in (EventKind.BREAKAWAY, EventKind.REVERSE):
        return excess
    speed, table = abs(event.velocity), tables.along(event.direction)
    segment = table.segment(speed, True)
    psi, coefficient = table.psi(segment).of(Long(speed)), table.kinetic(segment).of(Long(speed))
    limit = Long(event.static_coefficient)
    if not (table.has_branches and psi > 0 and limit >= coefficient):
        return Long(0), Long(0)
    return (limit - coefficient) / psi, 4 * EPSILON * (4 * (limit - coefficient) + limit + abs(
        table.kinetic(segment).slope * speed)) / psi + EPSILON * (limit - coefficient) * abs(
            table.psi(segment).slope * speed) / (psi * psi)


def _node_of_event(event: Event, excess: Any, excess_noise: Any, jumped: bool, parts: Parts) -> Node:
    axis = _axis_at(parts, event.instant)
    contact, kinetic = axis.contact, axis.friction.along(event.direction).kinetic
    deflection = 0.0
    if isinstance(contact, CompliantContact) and event.mode == Mode.STICK:
        deflection = event.direction * axis.normal_force * kinetic.coefficients[0] / contact.stiffness
    return Node(event.instant, event, event.mode, event.direction, event.position, event.velocity, event.drive_force,
                deflection, 0.0, excess, excess_noise, jumped)


def _node_of_sample(sample: Sample, excess: Any, excess_noise: Any) -> Node:
    return Node(sample.instant, None, sample.mode, sample.direction, sample.position, sample.velocity,
                sample.drive_force, sample.contact_deflection, sample.rest_time, excess,
                excess_noise, True)


def _segment(parts: Parts, tables: Tables, begin: Node, end: Node, length: Any, came: float) -> Segment:
    """Return the segment; the slider `came` so far (m) in the one before, and the spring knows that no better."""
    axis, table = _axis_at(parts, begin.at), tables.along(begin.direction)
    m, c, h, normal = (Long(x) for x in (axis.mass, axis.drive_stiffness, axis.drive_damping, axis.normal_force))
    sinusoids = [(w, 0) for w in parts.drive.sinusoids] + [(w, 1) for w in parts.force.sinusoids]
    d = WAVE + 2 * len(sinusoids)
    drive, force = _piece(parts.drive, begin.at), _piece(parts.force, begin.at)
    v, v_rate = Long(drive.value) + Long(drive.rate) * (_long(begin.at) - Long(drive.start)), Long(drive.rate)
    f, f_rate = Long(force.value) + Long(force.rate) * (_long(begin.at) - Long(force.start)), Long(force.rate)
    contact = axis.contact if isinstance(axis.contact, CompliantContact) else None
    mode, sigma, u = begin.mode, Long(begin.direction), Long(begin.velocity)
    moves = mode in (Mode.ACCELERATING, Mode.DECELERATING) or (mode == Mode.STICK and contact is not None)
    stiff, damper, slope_size = c, h, Long(0)
    segment = 0
    speed = abs(float(u))
    lower, upper = np.zeros(d, dtype=Long), np.zeros(d, dtype=Long)
    friction, friction_slope = Long(0), Long(0)      # of the slip: σ N (μ + b (w − w₀))
    if mode in (Mode.ACCELERATING, Mode.DECELERATING):
        rising = mode == Mode.ACCELERATING
        segment = table.segment(speed, rising)
        kinetic, psi = table.kinetic(segment), table.psi(segment)
        friction, friction_slope = kinetic.of(Long(speed)), kinetic.slope
        slope_size = abs(kinetic.slope)
        if rising:
            friction += begin.excess * psi.of(Long(speed))
            friction_slope += begin.excess * psi.slope
            slope_size += 4 * abs(begin.excess * psi.slope)
        damper = h + normal * friction_slope
        way = sigma if rising else -sigma
        lower[F] = way
        upper[U] = -way
        if rising:
            upper[ONE] = table.breakpoints[segment + 1] if segment + 1 < len(table.breakpoints) else Long('inf')
        else:
            upper[ONE] = -Long(table.breakpoints[segment])
    elif mode == Mode.COASTING:
        segment = table.segment(speed, True)
        friction = table.kinetic(segment).of(Long(speed))
        band = normal * begin.excess * table.psi(segment).of(Long(speed))
        lower[F], lower[ONE] = sigma, -normal * friction
        upper[F], upper[ONE] = -sigma, normal * friction + band
    elif contact is not None:
        stiff = c + Long(contact.stiffness)
        damper = h + Long(contact.damping)
        slope_size = Long(contact.damping)
        lower[U], lower[Y], lower[ONE] = -contact.damping, -contact.stiffness, -(
            Long(contact.stiffness) * Long(begin.deflection))
        upper[:] = -lower
    else:
        lower[F], upper[F] = -1, 1

    sines = [_phase(w.frequency, w.phase, begin.at) for w, _ in sinusoids]
    v_now = v + sum((Long(w.amplitude) * s for (w, k), (s, _) in zip(sinusoids, sines) if k == 0), Long(0))
    f_now = f + sum((Long(w.amplitude) * s for (w, k), (s, _) in zip(sinusoids, sines) if k == 1), Long(0))
    net = Long(begin.drive_force) + f_now
    sizes = [abs(Long(begin.drive_force)), 2 * h * (abs(v_now) + abs(u)), abs(f_now),
             sum((abs(Long(w.amplitude)) * (h if k == 0 else 1) for w, k in sinusoids), Long(0)), abs(f)]
    held = Long(0)
    if contact is not None and mode == Mode.STICK:
        held = Long(contact.stiffness) * Long(begin.deflection) + Long(contact.damping) * u
    against = held if mode == Mode.STICK else sigma * normal * friction
    most = max(side.static.initial for side in axis.friction.sides)
    sizes.append(abs(against) + normal * most * (1 if mode == Mode.STICK else 0.1))
    rounding = FORCES * sum(sizes) + EPSILON * c * Long(came)
    start = np.zeros(d, dtype=Long)
    noise = np.zeros(d, dtype=Long)
    start[F], noise[F] = (net - against if moves else net), rounding
    kind = begin.event.kind if begin.event else None
    if not begin.new_force and mode in (Mode.ACCELERATING, Mode.DECELERATING):
        if kind in (EventKind.ACCELERATE, EventKind.DECELERATE):
            start[F] = noise[F] = Long(0)
        elif kind == EventKind.BREAKAWAY and contact is None:
            event = begin.event
            assert event is not None
            drop = Long(event.static_coefficient) - friction
            start[F], noise[F] = sigma * normal * drop, 4 * EPSILON * normal * friction
            if table.has_branches:
                start[F] = noise[F] = Long(0)
        elif kind == EventKind.BREAKAWAY:   # begins as it swung; the spring is the difference of two ways
            noise[F] += EPSILON * c * abs(Long(begin.position))
    start[U], noise[U] = u, 2 * EPSILON * abs(u)
    start[V], noise[V] = v, 2 * EPSILON * (abs(v) + _size(parts.drive, begin.at.seconds))
    start[ONE], noise[ONE] = Long(1), 4 * EPSILON

    rates = np.zeros((d, d), dtype=Long)
    rates[F, V], rates[F, U], rates[F, ONE] = c, -c, h * v_rate + f_rate
    if moves:
        rates[F, U] = -stiff
        rates[F, F] = -damper / m
        rates[U, F] = 1 / m
    rates[Y, U] = 1
    rates[V, ONE] = v_rate
    fastest = Long(0)
    for k, ((sinusoid, which), (sine, cosine)) in enumerate(zip(sinusoids, sines)):
        w, amplitude = 2 * _PI * Long(sinusoid.frequency), Long(sinusoid.amplitude)
        at = WAVE + 2 * k
        rates[at, at + 1], rates[at + 1, at] = w, -w
        rates[F, at] += c * amplitude if which == 0 else 0
        rates[F, at + 1] += w * amplitude * (h if which == 0 else 1)
        start[at], start[at + 1] = sine, cosine
        noise[at] = noise[at + 1] = 8 * EPSILON
        fastest = max(fastest, w)
    omega = np.sqrt(stiff / m) if moves else Long(0)
    gamma = damper / m if moves else Long(0)
    ringing = np.sqrt(max(omega * omega - gamma * gamma / 4, Long(0)))
    pace = max(omega, abs(gamma), fastest, 1 / length)
    rates, start, noise, unit = _balanced(rates, start, noise, pace, m)

    outputs = np.zeros((3, d), dtype=Long)
    outputs[0, U] = outputs[1, Y] = outputs[2, F] = 1
    end_force = _force_at(parts, begin, end)
    add = Long(0)
    if mode in (Mode.ACCELERATING, Mode.DECELERATING):
        outputs[2, U] = normal * friction_slope
        add = sigma * normal * (friction - friction_slope * abs(u))
    elif contact is not None and mode == Mode.STICK:
        outputs[2, U], outputs[2, Y] = contact.damping, contact.stiffness
        add = Long(contact.stiffness) * Long(begin.deflection)
    outputs[2, ONE] = add
    wanted = np.array([Long(end.velocity), Long(end.position) - Long(begin.position),
                       Long(end.drive_force) + end_force], dtype=Long)
    late = rounding + FORCES * (abs(Long(end.drive_force)) + abs(end_force) + 2 * h * abs(Long(end.velocity)))
    spread = np.array([4 * EPSILON * abs(wanted[0]), 4 * EPSILON * (abs(Long(end.position))
                                                                   + abs(Long(begin.position))), late], dtype=Long)
    slack = np.array([rounding, rounding], dtype=Long)
    if mode in (Mode.ACCELERATING, Mode.DECELERATING):
        slack = np.array([_UNFELT * sum(sizes), 4 * EPSILON * abs(u)], dtype=Long)
    e_noise = begin.excess_noise if mode == Mode.ACCELERATING else Long(0)
    drift = float((4 * EPSILON * (h + normal * slope_size) + normal * abs(table.psi(segment).slope) * e_noise) / m
                  + 4 * EPSILON * omega)
    return Segment(begin, end, length, rates, start, noise, float(pace),
                   float(length * max(ringing, fastest) / (2 * _PI)), drift, np.stack([lower, upper]) * unit, slack,
                   outputs * unit, wanted, spread, axis)


_PI = Long('3.14159265358979323846264338327950288')


def _balanced(rates: Any, start: Any, noise: Any, pace: Any, mass: Any) -> tuple[Any, Any, Any, Any]:
    """Return A, z and its noise in units in which no entry of A is larger than the pace; and the units."""
    unit = np.ones(len(start), dtype=Long)
    unit[F], unit[Y] = mass * pace, 1 / pace
    for j in range(ONE, len(start)):
        size = max(abs(rates[F, j]) / (mass * pace * pace), abs(rates[V, j]) / pace)
        unit[j] = 1 / size if size > 0 else Long(1)
    for j in range(WAVE, len(start), 2):
        unit[j] = unit[j + 1] = min(unit[j], unit[j + 1])
    return rates * unit[None, :] / unit[:, None], start / unit, noise / unit, unit


def _axis_at(parts: Parts, at: Instant) -> Axis:
    """Return the axis with the normal force that holds from an instant on."""
    return parts.axis_under(_piece(parts.load, at).value) if parts.load else parts.axis


def _piece(profile: InputProfile, at: Instant) -> Piece:
    """Return the piece at an instant, which as one double may be a jump that is still to come."""
    piece = profile.piece_at(at.seconds)
    return piece if instant(piece.start) <= at else profile.piece_at(math.nextafter(at.seconds, -math.inf))


def _size(profile: InputProfile, time: float) -> Any:
    """Return a size of all values that a profile had so far: their rounding adds up from piece to piece."""
    return Long(max(abs(value) + abs(rate) * max(time - start, 0.0) for start, value, rate in zip(
        profile.starts, profile.values, profile.rates)))


def _long(at: Instant) -> Any:
    return Long(at.second) + Long(at.fraction)


def _phase(frequency: float, phase: float, at: Instant) -> tuple[Any, Any]:
    turns = np.fmod(Long(frequency) * Long(at.second), 1) + Long(frequency) * Long(at.fraction)
    angle = 2 * _PI * (turns - np.floor(turns)) + Long(phase)
    return np.sin(angle), np.cos(angle)


def _force_at(parts: Parts, begin: Node, end: Node) -> Any:
    """Return F_e at the end of a segment, before anything jumps there."""
    piece = _piece(parts.force, begin.at)
    time = _long(end.at)
    if end.event is None or end.new_force:
        piece = _piece(parts.force, end.at)
    total = Long(piece.value) + Long(piece.rate) * (time - Long(piece.start))
    return total + sum((Long(w.amplitude) * _phase(w.frequency, w.phase, end.at)[0] for w in parts.force.sinusoids),
                       Long(0))


def limit_along(segment: Segment, times: Any, side: float) -> tuple[Any, Any]:
    """Return N mu_s against a force of this sign, and its rate, at times after the start of a stick."""
    values, rates = static(segment.axis.friction.along(side).static, Long(segment.begin.rest_time) + times)
    return Long(segment.axis.normal_force) * values, Long(segment.axis.normal_force) * rates
