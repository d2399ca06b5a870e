# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The events by brute force (`../brute.c`): small steps in long double, compiled when first asked for.

How far a list can be compared says a second run whose data are off by 1e-12 of each number: where the two part, or a
graze or a flat root has made the first doubtful, rounding decides, and not the solver that is judged.

Under a normal force that varies smoothly a motion is not linear, and `guards` cannot follow it.  There the brute force
goes from the state that each event reports to the next, and rounding of that state is carried along by four more
motions, each with one of its numbers moved.
"""

import ctypes
import math
import os
import subprocess
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from stickslip_sim.axis import CompliantContact, Friction
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import InputProfile, constant
from stickslip_sim.core.types import Event, EventKind, Mode
from stickslip_sim.friction import StaticLawKind
from stickslip_sim.proof.axes import Parts
from stickslip_sim.proof.judges import Find
from tests.support.scatter import factor_of, law_of_stick

from ..case import Run, Undecided, borders
from .motion import EPSILON, MARGIN, Long, Tables, axis_at, inputs_from, static
from .nodes import Node, elsewhere, guard_met, impossible, nodes, not_met, passed
from .reference import rounded_data
from .segments import FORCES

_SOURCE = Path(__file__).parent.parent / 'brute.c'
_KINDS = (EventKind.BREAKAWAY, EventKind.COAST, EventKind.ACCELERATE, EventKind.DECELERATE, EventKind.STICK,
          EventKind.REVERSE, EventKind.KNOT, EventKind.YIELD)
_LAWS = (StaticLawKind.CONSTANT, StaticLawKind.EXPONENTIAL, StaticLawKind.KATO, StaticLawKind.HYPERBOLIC,
         StaticLawKind.LOGARITHMIC)
_STEPS = 10.0         # in the time in which something changes
_MOST = 100_000       # events
_OFF = 1e-12          # of each number of the data in the second run
_UNFELT = 1e-9        # s of a second, of the duration: what is nearer in time is the same
_MORE = 10.0          # times what the second run is off
_PARTED = 1e-4        # of the duration
_STICKS = 1000        # that have a factor of their own
_MOMENT = 1e-9        # of the duration: a coast that short is one by rounding


def _fields(kind: Any, *names: str) -> list[tuple[str, Any]]:
    """Return the fields of one kind for a structure of ctypes."""
    return [(name, kind) for name in names]


_INT, _DOUBLE, _DOUBLES = ctypes.c_int, ctypes.c_double, ctypes.POINTER(ctypes.c_double)


class _Profile(ctypes.Structure):
    _fields_ = _fields(_INT, 'pieces', 'sinusoids') + _fields(
        _DOUBLES, 'start', 'value', 'rate', 'amplitude', 'frequency', 'phase')


class _Side(ctypes.Structure):
    _fields_ = _fields(_INT, 'law', 'breakpoints', 'fractions') + _fields(
        _DOUBLE, 'initial', 'limit', 'time_constant', 'exponent', 'delay', 'end_slope') + _fields(
        _DOUBLES, 'speeds', 'coefficients', 'psi_speeds', 'psi')


class _Problem(ctypes.Structure):
    _fields_ = _fields(
        _DOUBLE, 'mass', 'stiffness', 'damping', 'feed_damping', 'contact_stiffness', 'contact_damping') + _fields(
        _INT, 'compliant', 'undeflected', 'by_drive') + _fields(
        _DOUBLE, 'velocity', 'rest_time', 'stretch', 'deflection', 'duration', 'steps') + _fields(
        _Side * 2, 'sides') + _fields(_Profile, 'drive', 'force', 'normal') + _fields(_INT, 'sticks') + _fields(
        _DOUBLES, 'factors')


class _Row(ctypes.Structure):
    _fields_ = _fields(_DOUBLE, 'time', 'kind', 'mode', 'direction', 'velocity', 'doubtful')


class _Segment(ctypes.Structure):
    _fields_ = _fields(_INT, 'mode', 'direction', 'stick') + _fields(
        _DOUBLE, 'second', 'fraction', 'length', 'stretch', 'velocity', 'deflection', 'excess', 'rest_time'
        ) + _fields(_DOUBLE * 4, 'noise') + _fields(_DOUBLE, 'rounding', 'margin')


class _Verdict(ctypes.Structure):
    _fields_ = _fields(_DOUBLE * 2, 'below', 'time', 'bound', 'last', 'last_bound') + _fields(
        _DOUBLE, 'stretch', 'velocity', 'stretch_bound', 'velocity_bound')


class BruteEvent(NamedTuple):
    """An event; `is_doubtful` from the first graze, or flat root, on that rounding may decide."""

    time: float        # s
    kind: EventKind
    mode: Mode
    direction: int
    velocity: float    # m/s
    is_doubtful: bool


def brute_force(parts: Parts) -> list[BruteEvent]:
    """Return the events of a run; raises Undecided where they do not end."""
    rows = (_Row * _MOST)()
    count = _program().brute_force(ctypes.byref(_problem(parts)), rows, _MOST)
    if not 0 <= count < _MOST:
        raise Undecided('the events or the steps of the brute force do not end')
    return [BruteEvent(row.time, _KINDS[int(row.kind)], Mode(int(row.mode)), int(row.direction), row.velocity,
                       bool(row.doubtful)) for row in rows[:count]]


def judge(run: Run) -> None:
    """Compare the events of a run; raises Find, or Undecided where nothing can be compared."""
    compare(run.parts, run.events)


def compare(parts: Parts, events: Sequence[Event]) -> int:
    """Return how many events agree, up to where rounding decides; raises Find, or Undecided where that is none."""
    duration, moment = parts.duration, _MOMENT * parts.duration
    try:
        moved_parts = rounded_data(parts, 1, _OFF)
    except InputError:
        raise Undecided('its data have no order but for rounding') from None
    right, other, seen = (plain(one, moment) for one in (
        brute_force(parts), brute_force(moved_parts), [_brief(event) for event in events]))
    for k in range(max(len(right), len(other), len(seen))):
        a, b = (one[k] if k < len(one) else None for one in (right, other))
        moved = abs(a.time - b.time) if a is not None and b is not None and _alike(a, b) else math.inf
        if moved > _PARTED * duration or (a is not None and a.is_doubtful) or (a is None) != (b is None):
            if k == 0:
                raise Undecided('rounding of the data changes the first event')
            return k
        c = seen[k] if k < len(seen) else None
        is_same = a is not None and c is not None and _alike(a, c) and abs(
            a.time - c.time) <= _UNFELT * duration + _MORE * moved
        if not is_same and _is_at_a_jump(parts, a, c):
            return k
        if a is None or c is None:
            wanted, found = (one.kind.name + f' at {one.time!r} s' if one else 'none' for one in (a, c))
            late = next(one.time for one in (a, c) if one is not None)
            if late > duration * (1.0 - _UNFELT):
                return k
            raise Find(f'event {k} is {found} and not {wanted}')
        if not is_same:
            raise Find(f'event {k} is {c.kind.name} ({c.direction:+d}) at {c.time!r} s and not {a.kind.name} '
                       f'({a.direction:+d}) at {a.time!r} s; moved by {moved:.3g} s where data are off by {_OFF:g}')
    return len(right)


def _is_at_a_jump(parts: Parts, *events: BruteEvent | None) -> bool:
    """Return whether one of these falls on the start, or on the border of two pieces: rounding says on which side."""
    return any(abs(event.time - border) <= _OFF * border for event in events if event is not None
               for border in (0.0, *borders(parts)))


def _alike(a: BruteEvent, b: BruteEvent) -> bool:
    return (a.kind, a.direction) == (b.kind, b.direction)


def _brief(event: Event) -> BruteEvent:
    return BruteEvent(event.time, event.kind, event.mode, event.direction, event.velocity, False)


def plain(events: Sequence[BruteEvent], moment: float) -> list[BruteEvent]:
    """Return the events without coasts of a moment, which rounding makes: after a break-away, or as the excess ends."""
    kept: list[BruteEvent] = []
    for event in events:
        last = kept[-1] if kept and event.time - kept[-1].time <= moment else None
        if last is not None and event.kind == EventKind.DECELERATE and last.kind == EventKind.COAST:
            kept.pop()
        if not (last is not None and event.kind == EventKind.ACCELERATE and last.kind == EventKind.BREAKAWAY):
            kept.append(event)
    return kept


def is_linear(run: Run) -> bool:
    """Whether the normal force is constant but for jumps, and no contact yields."""
    load = run.parts.load
    return load is None or (load.is_stepwise and all(event.mode != Mode.YIELDING for event in run.events))


def wrong_guards(run: Run) -> list[str]:
    """Return what is wrong with the guards of a run, in the order of time; MARGIN times rounding is a find."""
    given = _problem(run.parts)
    return [text for begin, end in pairwise(list(nodes(run, Tables(run.parts.axis))))
            for text in _wrong(run.parts, given, begin, end)]


def _wrong(parts: Parts, given: _Problem, begin: Node, end: Node) -> Iterator[str]:
    length = (end.at.second - begin.at.second) + (end.at.fraction - begin.at.fraction)
    if length <= 0.0:
        return
    segment, verdict = _segment(parts, begin, length), _Verdict()
    if _program().follow_segment(ctypes.byref(given), ctypes.byref(segment), ctypes.byref(verdict)):
        return   # it takes too many steps
    for k in range(2):
        if verdict.below[k] > verdict.bound[k]:
            yield passed(begin, end, k, verdict.below[k], verdict.bound[k], verdict.time[k], length - verdict.time[k])
    yield from _ends_elsewhere(parts, begin, end, segment, verdict)
    if end.event is not None and not end.new_force:
        yield from _missed(parts, begin, end, length, verdict)


def _segment(parts: Parts, begin: Node, length: float) -> _Segment:
    forces = _forces(parts, begin)
    stiffness = parts.axis.drive_stiffness
    contact = parts.axis.contact.stiffness if isinstance(parts.axis.contact, CompliantContact) else math.inf
    noise = (FORCES * forces / stiffness if stiffness > 0.0 else 0.0, 2.0 * EPSILON * abs(begin.velocity),
             FORCES * forces / contact, float(begin.excess_noise))
    stick = begin.stick if parts.axis.friction.static.scatter else 0
    return _Segment(begin.mode, begin.direction, stick, begin.at.second, begin.at.fraction, length,
                    _stretch(parts, begin), begin.velocity, begin.deflection, float(begin.excess), begin.rest_time,
                    (ctypes.c_double * 4)(*noise), FORCES, MARGIN)


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
        if not abs(found - wanted) <= MARGIN * bound:
            yield elsewhere(begin, end, name, found, wanted, MARGIN * bound)


def _missed(parts: Parts, begin: Node, end: Node, length: float, verdict: _Verdict) -> Iterator[str]:
    event = end.event
    assert event is not None
    if begin.mode == Mode.STICK:
        met = (0 if _sign(parts, event) > 0.0 else 1) if event.kind in (EventKind.BREAKAWAY, EventKind.YIELD) else None
        yield from _wrong_limit(parts, begin, end, length)
    else:
        met = guard_met(begin.mode, event.kind)
    if met is None:
        yield impossible(begin, end)
    elif not abs(verdict.last[met]) <= verdict.last_bound[met]:
        yield not_met(begin, end, verdict.last[met], verdict.last_bound[met])


def _sign(parts: Parts, event: Event) -> float:
    """Return the sign of the force that ends a stick.

    The force of a contact reaches a limit of 0 in the direction of the slip, that of the drive (−0.0 is one) by itself.
    """
    contact = parts.axis.contact
    by_drive = isinstance(contact, CompliantContact) and contact.ends_by_drive
    return math.copysign(1.0, event.friction_force or (event.friction_force if by_drive else event.direction))


def _wrong_limit(parts: Parts, begin: Node, end: Node, length: float) -> Iterator[str]:
    event = end.event
    assert event is not None
    side = _sign(parts, event)
    law = law_of_stick(parts.axis.friction.along(side), begin.stick)
    value, growth = static(law, [Long(begin.rest_time) + Long(length)])
    if abs(event.static_coefficient - value[0]) > 1e-12 * value[0] + MARGIN * 1e-15 * growth[0]:
        yield f'mu_s at {end.label} is {event.static_coefficient!r} and not {float(value[0])!r}'
    normal = axis_at(parts, end.at).normal_force
    if abs(event.friction_force - side * normal * event.static_coefficient) > 1e-12 * parts.heaviest.normal_force:
        yield f'the limit at {end.label} is {event.friction_force!r} N under a normal force of {normal!r} N'


@cache
def _program() -> ctypes.CDLL:
    """Return the program, compiled for this process."""
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / 'brute.so'
        subprocess.run([os.environ.get('CC', 'cc'), '-O2', '-std=c11', '-shared', '-fPIC', '-o', made, _SOURCE, '-lm'],
                       check=True)
        return ctypes.CDLL(str(made))


def _problem(parts: Parts) -> _Problem:
    """Return what the program takes."""
    axis, initial = parts.axis, parts.initial
    contact = axis.contact if isinstance(axis.contact, CompliantContact) else None
    normal = parts.load.plus(axis.normal_force) if parts.load else constant(axis.normal_force)
    inputs = [_profile(profile, parts.duration) for profile in (parts.drive, parts.force, normal)]
    sides = (_Side * 2)(_side(axis.friction), _side(axis.friction.backward or axis.friction))
    return _Problem(
        axis.mass, axis.drive_stiffness, axis.drive_damping, axis.feed_share * axis.drive_damping,
        contact.stiffness if contact else 0.0, contact.damping if contact else 0.0, contact is not None,
        contact is not None and contact.undeflected, contact is None or contact.ends_by_drive, initial.velocity,
        initial.rest_time, initial.stretch, initial.deflection, parts.duration, _STEPS, sides, *inputs,
        *_factors(parts))


def _factors(parts: Parts) -> tuple[int, 'ctypes.Array[ctypes.c_double]']:
    scatter = parts.axis.friction.static.scatter
    factors = [1.0] if scatter is None else [factor_of(scatter, stick) for stick in range(_STICKS)]
    return len(factors), _numbers(factors)


def _side(friction: Friction) -> _Side:
    static, kinetic, excess = friction.static, friction.kinetic, friction.excess
    return _Side(_LAWS.index(static.kind), len(kinetic.velocities), len(excess.velocities) if excess else 0,
                 static.initial, static.limit, static.time_constant, static.exponent, static.delay, kinetic.end_slope,
                 _numbers(kinetic.velocities), _numbers(kinetic.coefficients),
                 _numbers(excess.velocities if excess else ()), _numbers(excess.fractions if excess else ()))


def _profile(profile: InputProfile, duration: float) -> _Profile:
    """Return its pieces up to the end, turn after turn, and its sinusoids."""
    turns = math.floor(duration / profile.period) + 1 if profile.period < math.inf else 1
    starts = [turn * profile.period + start if turn else start for turn in range(turns) for start in profile.starts]
    return _Profile(len(starts), len(profile.sinusoids), _numbers(starts), _numbers(profile.values * turns),
                    _numbers(profile.rates * turns), *map(_numbers, zip(*profile.sinusoids)))


def _numbers(values: Iterable[float]) -> 'ctypes.Array[ctypes.c_double]':
    found = tuple(values)
    return (ctypes.c_double * len(found))(*found)
