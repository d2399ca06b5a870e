# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every guard between two neighbouring events under a normal force that varies smoothly, and the state at the second.

As `guards`, whose linear motions know a constant normal force: here the motion is that of the brute force
(`../brute/brute.c`) from the state that an event reports on, and rounding of that state is carried along by four more
motions, each with one of its numbers moved.
"""

import ctypes
import math
from collections.abc import Iterator
from itertools import pairwise

from stickslip_sim.axis import CompliantContact
from stickslip_sim.core.types import Event, EventKind, Mode

from ..case import Parts, Run
from .brute import Problem, fields, problem, program
from .extended import EPSILON, Long
from .friction import Tables, static
from .guards import MARGIN
from .inputs import axis_at, inputs_from
from .nodes import Node, nodes
from .segments import FORCES

_NAMES = {Mode.STICK: ('the static limit', 'the static limit backwards'),
          Mode.COASTING: ('the lower branch', 'the upper branch'),
          Mode.YIELDING: ('where the contact holds', 'where the slider turns'),
          Mode.ACCELERATING: ('the zero of the acceleration', 'the next breakpoint'),
          Mode.DECELERATING: ('the zero of the acceleration', 'the next breakpoint or standstill')}
_MET = {(Mode.COASTING, EventKind.ACCELERATE): 1, (Mode.COASTING, EventKind.DECELERATE): 0,
        (Mode.YIELDING, EventKind.STICK): 0, (Mode.YIELDING, EventKind.BREAKAWAY): 1,
        (Mode.ACCELERATING, EventKind.KNOT): 1, (Mode.DECELERATING, EventKind.KNOT): 1,
        (Mode.DECELERATING, EventKind.STICK): 1, (Mode.DECELERATING, EventKind.REVERSE): 1}
_TURNS = frozenset({EventKind.COAST, EventKind.ACCELERATE, EventKind.DECELERATE})


class _Segment(ctypes.Structure):
    _fields_ = fields(ctypes.c_int, 'mode', 'direction') + fields(
        ctypes.c_double, 'second', 'fraction', 'length', 'stretch', 'velocity', 'deflection', 'excess', 'rest_time'
        ) + fields(ctypes.c_double * 4, 'noise') + fields(ctypes.c_double, 'rounding', 'margin')


class _Verdict(ctypes.Structure):
    _fields_ = fields(ctypes.c_double * 2, 'below', 'time', 'bound', 'last', 'last_bound') + fields(
        ctypes.c_double, 'stretch', 'velocity', 'stretch_bound', 'velocity_bound')


def is_for(run: Run) -> bool:
    """Whether the normal force varies but for jumps, or a contact yields, which `guards` does not know."""
    load = run.parts.load
    return load is not None and (not load.is_stepwise or any(event.mode == Mode.YIELDING for event in run.events))


def judge(run: Run, margin: float = MARGIN) -> list[str]:
    """Return what is wrong with a run, in the order of time; `margin` times rounding is a find."""
    given = problem(run.parts, 10.0)
    return [text for begin, end in pairwise(list(nodes(run, Tables(run.parts.axis))))
            for text in _wrong(run.parts, given, begin, end, margin)]


def _wrong(parts: Parts, given: Problem, begin: Node, end: Node, margin: float) -> Iterator[str]:
    length = (end.at.second - begin.at.second) + (end.at.fraction - begin.at.fraction)
    if length <= 0.0:
        return
    segment, verdict = _segment(parts, begin, length, margin), _Verdict()
    if program().follow_segment(ctypes.byref(given), ctypes.byref(segment), ctypes.byref(verdict)):
        return   # it takes too many steps
    for k in range(2):
        if verdict.below[k] > verdict.bound[k]:
            yield (f'{_NAMES[begin.mode][k]} was passed by {verdict.below[k]:.6g} (bound {verdict.bound[k]:.3g}) '
                   f'{verdict.time[k]!r} s after {begin.label}, {begin.mode.name}, and '
                   f'{length - verdict.time[k]:.3g} s before {end.label}')
    yield from _ends_elsewhere(parts, begin, end, segment, verdict)
    if end.event is not None and not end.new_force:
        yield from _missed(parts, begin, end, length, verdict)


def _segment(parts: Parts, begin: Node, length: float, margin: float) -> _Segment:
    forces = _forces(parts, begin)
    stiffness = parts.axis.drive_stiffness
    contact = parts.axis.contact.stiffness if isinstance(parts.axis.contact, CompliantContact) else math.inf
    noise = (FORCES * forces / stiffness if stiffness > 0.0 else 0.0, 2.0 * EPSILON * abs(begin.velocity),
             FORCES * forces / contact, float(begin.excess_noise))
    return _Segment(begin.mode, begin.direction, begin.at.second, begin.at.fraction, length, _stretch(parts, begin),
                    begin.velocity, begin.deflection, float(begin.excess), begin.rest_time,
                    (ctypes.c_double * 4)(*noise), FORCES, margin)


def _stretch(parts: Parts, node: Node) -> float:
    axis = parts.axis
    if axis.drive_stiffness == 0.0:
        return 0.0
    damper = Long(axis.feed_share * axis.drive_damping)
    feed = inputs_from(parts, node.at).velocity
    return float((Long(node.drive_force) - damper * (feed - Long(node.velocity))) / Long(axis.drive_stiffness))


def _forces(parts: Parts, node: Node) -> float:
    """Return the sum of the sizes of all forces."""
    axis, inputs = axis_at(parts, node.at), inputs_from(parts, node.at)
    most = max(side.static.initial for side in axis.friction.sides)
    return float(abs(node.drive_force) + 2 * axis.drive_damping * (abs(inputs.velocity) + abs(node.velocity))
                 + abs(inputs.external_force) + parts.heaviest.normal_force * most)


def _ends_elsewhere(parts: Parts, begin: Node, end: Node, segment: _Segment, verdict: _Verdict) -> Iterator[str]:
    pairs = [('velocity', end.velocity, verdict.velocity, verdict.velocity_bound + 4.0 * EPSILON * abs(end.velocity))]
    if parts.axis.drive_stiffness > 0.0 and end.event is not None and not end.new_force:
        late = FORCES * _forces(parts, end) / parts.axis.drive_stiffness
        pairs.append(('stretch', _stretch(parts, end), segment.stretch + verdict.stretch,
                      verdict.stretch_bound + late))
    for name, found, wanted, bound in pairs:
        if not abs(found - wanted) <= segment.margin * bound:
            yield (f'{name} at {end.label} is {found!r} and not {wanted!r} (bound {segment.margin * bound:.3g}; from '
                   f'{begin.label}, {begin.mode.name})')


def _missed(parts: Parts, begin: Node, end: Node, length: float, verdict: _Verdict) -> Iterator[str]:
    event = end.event
    assert event is not None
    if begin.mode == Mode.STICK:
        met = (0 if _side(parts, event) > 0.0 else 1) if event.kind in (EventKind.BREAKAWAY, EventKind.YIELD) else None
        yield from _wrong_limit(parts, begin, end, length)
    elif begin.mode in (Mode.ACCELERATING, Mode.DECELERATING) and event.kind in _TURNS:
        met = 0
    else:
        met = _MET.get((begin.mode, event.kind))
    if met is None:
        yield f'{end.label} cannot follow {begin.mode.name}'
    elif not abs(verdict.last[met]) <= verdict.last_bound[met]:
        yield (f'{end.label} comes where its guard is {verdict.last[met]:.6g} and not 0 (bound '
               f'{verdict.last_bound[met]:.3g}; from {begin.label}, {begin.mode.name})')


def _side(parts: Parts, event: Event) -> float:
    """Return the sign of the force that ends a stick.

    The force of a contact reaches a limit of 0 in the direction of the slip, that of the drive (−0.0 is one) by itself.
    """
    contact = parts.axis.contact
    by_drive = isinstance(contact, CompliantContact) and contact.ends_by_drive
    return math.copysign(1.0, event.friction_force or (event.friction_force if by_drive else event.direction))


def _wrong_limit(parts: Parts, begin: Node, end: Node, length: float) -> Iterator[str]:
    event = end.event
    assert event is not None
    side = _side(parts, event)
    value, growth = static(parts.axis.friction.along(side).static, [Long(begin.rest_time) + Long(length)])
    if abs(event.static_coefficient - value[0]) > 1e-12 * value[0] + MARGIN * 1e-15 * growth[0]:
        yield f'mu_s at {end.label} is {event.static_coefficient!r} and not {float(value[0])!r}'
    normal = axis_at(parts, end.at).normal_force
    if abs(event.friction_force - side * normal * event.static_coefficient) > 1e-12 * parts.heaviest.normal_force:
        yield f'the limit at {end.label} is {event.friction_force!r} N under a normal force of {normal!r} N'
