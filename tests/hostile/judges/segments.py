# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From a run to linear motions: one segment between two neighbouring events, borders of the inputs, or ends.

z = (f, u, y, v, 1, sin and cosine of each sinusoid): f is the force that accelerates the slider, or F_d + F_e where
nothing moves it (a rigid stick, coasting); u its velocity, y its travel, v the drive's velocity without sinusoids.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from stickslip_sim.axis import Axis, CompliantContact
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.proof.axes import Parts
from tests.support.scatter import law_of_stick

from ..case import Run
from .motion import EPSILON, PI, Inputs, Long, Tables, axis_at, force_before, inputs_from, rounding_of, static
from .nodes import ONE, SLIP, WAVE, F, Node, Resistance, U, V, Y, nodes, resistance

FORCES = 16.0 * EPSILON       # of the sum of all forces: what rounding makes of a residual
_UNFELT = 1e-17               # of the sum of all forces: an acceleration that no digit of them shows
LOWER, UPPER = 0, 1           # guards: the first and the second row


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


class _Setting(NamedTuple):
    """What acts in a segment, and the sum of the sizes of all forces in it."""

    parts: Parts
    axis: Axis
    inputs: Inputs
    held: Resistance
    forces: Any
    rounding: Any    # of a residual of these forces

    @property
    def size(self) -> int:
        """Of z."""
        return WAVE + 2 * len(self.inputs.waves)


def segments(run: Run) -> Iterator[Segment]:
    """Return the segments of a run."""
    tables = Tables(run.parts.axis)
    came = 0.0
    for begin, end in pairwise(list(nodes(run, tables))):
        length = (Long(end.at.second) - Long(begin.at.second)) + (Long(end.at.fraction) - Long(begin.at.fraction))
        if length > 0:
            yield _segment(_setting(run.parts, tables, begin, came), begin, end, length)
            came = abs(end.position - begin.position)


def _setting(parts: Parts, tables: Tables, begin: Node, came: float) -> _Setting:
    """Return what acts from a node on; the slider `came` so far (m) to it, and the spring knows that no better."""
    axis, inputs = axis_at(parts, begin.at), inputs_from(parts, begin.at)
    held = resistance(axis, tables.along(begin.direction), begin)
    h, normal = Long(axis.drive_damping), Long(axis.normal_force)
    most = max(side.static.initial for side in axis.friction.sides)
    forces = sum([
        abs(Long(begin.drive_force)), 2 * h * (abs(inputs.velocity) + abs(Long(begin.velocity))),
        abs(inputs.external_force),
        sum((abs(Long(wave.sinusoid.amplitude)) * (1 if wave.is_force else h) for wave in inputs.waves), Long(0)),
        abs(inputs.force.value), abs(held.now) + normal * most * (1 if begin.mode == Mode.STICK else 0.1)])
    return _Setting(parts, axis, inputs, held, forces, FORCES * forces + EPSILON * Long(axis.drive_stiffness)
                    * Long(came) + begin.unbalanced)


def _segment(acting: _Setting, begin: Node, end: Node, length: Any) -> Segment:
    axis, held, m = acting.axis, acting.held, Long(acting.axis.mass)
    h, normal = Long(axis.drive_damping), Long(axis.normal_force)
    fastest = max((2 * PI * Long(wave.sinusoid.frequency) for wave in acting.inputs.waves), default=Long(0))
    omega = np.sqrt((Long(axis.drive_stiffness) + held.stiffness) / m) if held.moves else Long(0)
    gamma = (h + held.damping) / m if held.moves else Long(0)
    ringing = np.sqrt(max(omega * omega - gamma * gamma / 4, Long(0)))
    pace = max(omega, abs(gamma), fastest, 1 / length)
    rates, start, noise, unit = _balanced(_rates(acting), *_start(acting, begin), pace, m)
    e_noise = begin.excess_noise if begin.mode == Mode.ACCELERATING else Long(0)
    drift = float((4 * EPSILON * (h + normal * held.slope_size) + normal * abs(held.psi_slope) * e_noise) / m
                  + 4 * EPSILON * omega)
    slack = np.array([acting.rounding, acting.rounding], dtype=Long)
    if begin.mode in SLIP:
        slack = np.array([_UNFELT * acting.forces, 4 * EPSILON * abs(Long(begin.velocity))], dtype=Long)
    guards = np.stack([_row(held.lower, acting.size), _row(held.upper, acting.size)])
    return Segment(begin, end, length, rates, start, noise, float(pace),
                   float(length * max(ringing, fastest) / (2 * PI)), drift, guards * unit, slack,
                   _outputs(acting) * unit, *_end(acting, begin, end), axis)


def _start(acting: _Setting, begin: Node) -> tuple[Any, Any]:
    """Return z at the node, and what rounding may have done to it."""
    start, noise = np.zeros(acting.size, dtype=Long), np.zeros(acting.size, dtype=Long)
    start[F], noise[F] = _start_force(acting, begin)
    u, v = Long(begin.velocity), acting.inputs.drive.value
    start[U], noise[U] = u, 2 * EPSILON * abs(u)
    start[V], noise[V] = v, 2 * EPSILON * (abs(v) + rounding_of(acting.parts.drive, begin.at.seconds))
    start[ONE], noise[ONE] = Long(1), 4 * EPSILON
    for at, wave in zip(range(WAVE, acting.size, 2), acting.inputs.waves):
        start[at], start[at + 1] = wave.sine, wave.cosine
        noise[at] = noise[at + 1] = 8 * EPSILON
    return start, noise


def _start_force(acting: _Setting, begin: Node) -> tuple[Any, Any]:
    """Return f at the node and its rounding: less than that of the sum where the event itself says what f is."""
    held, noise = acting.held, acting.rounding
    braked = Long(acting.axis.slideway_damping) * Long(begin.velocity)   # no part of the drive's force
    net = Long(begin.drive_force) - braked + acting.inputs.external_force
    force = net - held.now if held.moves else net
    event = begin.event
    if event is None or begin.new_force or begin.mode not in SLIP:
        return force, noise
    if event.kind in (EventKind.ACCELERATE, EventKind.DECELERATE):
        return Long(0), Long(0)
    if event.kind != EventKind.BREAKAWAY:
        return force, noise
    if isinstance(acting.axis.contact, CompliantContact):   # begins as it swung; the spring is a difference of ways
        return force, noise + EPSILON * Long(acting.axis.drive_stiffness) * abs(Long(begin.position))
    if acting.axis.friction.along(begin.direction).excess is not None:
        return Long(0), Long(0)
    normal = Long(acting.axis.normal_force)
    drop = Long(event.static_coefficient) - held.coefficient
    return Long(begin.direction) * normal * drop, 4 * EPSILON * normal * held.coefficient


def _rates(acting: _Setting) -> Any:
    """Return A."""
    axis, held, inputs = acting.axis, acting.held, acting.inputs
    m, c, h = Long(axis.mass), Long(axis.drive_stiffness), Long(axis.drive_damping)
    feed = h * Long(axis.feed_share)
    rates = np.zeros((acting.size, acting.size), dtype=Long)
    rates[F, V], rates[F, U], rates[F, ONE] = c, -c, feed * inputs.drive.rate + inputs.force.rate
    if held.moves:
        rates[F, U] = -(c + held.stiffness)
        rates[F, F] = -(h + held.damping) / m
        rates[U, F] = 1 / m
    rates[Y, U] = 1
    rates[V, ONE] = inputs.drive.rate
    for at, wave in zip(range(WAVE, acting.size, 2), inputs.waves):
        w, amplitude = 2 * PI * Long(wave.sinusoid.frequency), Long(wave.sinusoid.amplitude)
        rates[at, at + 1], rates[at + 1, at] = w, -w
        rates[F, at] += 0 if wave.is_force else c * amplitude
        rates[F, at + 1] += w * amplitude * (1 if wave.is_force else feed)
    return rates


def _outputs(acting: _Setting) -> Any:
    """Return the rows of velocity, travel and drive force."""
    held = acting.held
    outputs = np.zeros((3, acting.size), dtype=Long)
    outputs[0, U] = outputs[1, Y] = outputs[2, F] = 1
    braked = Long(acting.axis.slideway_damping)
    outputs[2, U], outputs[2, Y], outputs[2, ONE] = held.damping + braked, held.stiffness, held.offset
    return outputs


def _end(acting: _Setting, begin: Node, end: Node) -> tuple[Any, Any]:
    """Return the outputs as the engine has them at the end, and their rounding."""
    force = force_before(acting.parts, begin.at, end.at, has_jumped=end.event is None or end.new_force)
    wanted = np.array([Long(end.velocity), Long(end.position) - Long(begin.position),
                       Long(end.drive_force) + force], dtype=Long)
    late = acting.rounding + FORCES * (abs(Long(end.drive_force)) + abs(force) + 2 * Long(
        acting.axis.drive_damping) * abs(Long(end.velocity)))
    return wanted, np.array([4 * EPSILON * abs(wanted[0]), 4 * EPSILON * (
        abs(Long(end.position)) + abs(Long(begin.position))), late], dtype=Long)


def _row(entries: Mapping[int, Any], size: int) -> Any:
    row = np.zeros(size, dtype=Long)
    for at, value in entries.items():
        row[at] = value
    return row


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


def limit_along(segment: Segment, times: Any, side: float) -> tuple[Any, Any]:
    """Return N mu_s against a force of this sign, and its rate, at times after the start of a stick."""
    values, rates = static(law_of_stick(segment.axis.friction.along(side), segment.begin.stick),
                           Long(segment.begin.rest_time) + times)
    return Long(segment.axis.normal_force) * values, Long(segment.axis.normal_force) * rates
