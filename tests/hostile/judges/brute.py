# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The events by brute force (`../brute/brute.c`): small steps in long double, compiled when first asked for.

How far a list can be compared says a second run whose data are off by 1e-12 of each number: where the two part, or a
graze or a flat root has made the first doubtful, rounding decides, and not the solver that is judged.
"""

import ctypes
import math
import os
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from stickslip_sim.axis import CompliantContact, Friction
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import InputProfile, constant
from stickslip_sim.core.types import Event, EventKind, Mode
from stickslip_sim.friction import StaticLawKind

from ..case import Find, Parts, Run, Undecided, borders
from .rounded_data import rounded_data

_SOURCE = Path(__file__).parent.parent / 'brute' / 'brute.c'
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
_MOMENT = 1e-9        # of the duration: a coast that short is one by rounding


def fields(kind: Any, *names: str) -> list[tuple[str, Any]]:
    """Return the fields of one kind for a structure of ctypes."""
    return [(name, kind) for name in names]


_INT, _DOUBLE, _DOUBLES = ctypes.c_int, ctypes.c_double, ctypes.POINTER(ctypes.c_double)


class _Profile(ctypes.Structure):
    _fields_ = fields(_INT, 'pieces', 'sinusoids') + fields(
        _DOUBLES, 'start', 'value', 'rate', 'amplitude', 'frequency', 'phase')


class _Side(ctypes.Structure):
    _fields_ = fields(_INT, 'law', 'breakpoints', 'fractions') + fields(
        _DOUBLE, 'initial', 'limit', 'time_constant', 'exponent', 'delay', 'end_slope') + fields(
        _DOUBLES, 'speeds', 'coefficients', 'psi_speeds', 'psi')


class Problem(ctypes.Structure):
    """What the program takes."""

    _fields_ = fields(
        _DOUBLE, 'mass', 'stiffness', 'damping', 'feed_damping', 'contact_stiffness', 'contact_damping') + fields(
        _INT, 'compliant', 'undeflected', 'by_drive') + fields(
        _DOUBLE, 'velocity', 'rest_time', 'stretch', 'deflection', 'duration', 'steps') + fields(
        _Side * 2, 'sides') + fields(_Profile, 'drive', 'force', 'normal')


class _Row(ctypes.Structure):
    _fields_ = fields(_DOUBLE, 'time', 'kind', 'mode', 'direction', 'velocity', 'doubtful')


class BruteEvent(NamedTuple):
    """An event; `is_doubtful` from the first graze, or flat root, on that rounding may decide."""

    time: float        # s
    kind: EventKind
    mode: Mode
    direction: int
    velocity: float    # m/s
    is_doubtful: bool


def brute_force(parts: Parts, steps: float = _STEPS) -> list[BruteEvent]:
    """Return the events of a run; raises Undecided where they do not end."""
    rows = (_Row * _MOST)()
    count = program().brute_force(ctypes.byref(problem(parts, steps)), rows, _MOST)
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
    right, other, seen = (_plain(one, moment) for one in (
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


def _plain(events: Sequence[BruteEvent], moment: float) -> list[BruteEvent]:
    """Return the events without a coast of a moment behind a break-away, which rounding of the data makes."""
    return [event for k, event in enumerate(events) if not (
        k and event.kind == EventKind.ACCELERATE and events[k - 1].kind == EventKind.BREAKAWAY
        and event.time - events[k - 1].time <= moment)]


@cache
def program() -> ctypes.CDLL:
    """Return the program, compiled for this process."""
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / 'brute.so'
        subprocess.run([os.environ.get('CC', 'cc'), '-O2', '-std=c11', '-shared', '-fPIC', '-o', made, _SOURCE, '-lm'],
                       check=True)
        return ctypes.CDLL(str(made))


def problem(parts: Parts, steps: float) -> Problem:
    """Return what the program takes; `steps` in the time in which something changes."""
    axis, initial = parts.axis, parts.initial
    contact = axis.contact if isinstance(axis.contact, CompliantContact) else None
    normal = parts.load.plus(axis.normal_force) if parts.load else constant(axis.normal_force)
    inputs = [_profile(profile, parts.duration) for profile in (parts.drive, parts.force, normal)]
    sides = (_Side * 2)(_side(axis.friction), _side(axis.friction.backward or axis.friction))
    return Problem(
        axis.mass, axis.drive_stiffness, axis.drive_damping, axis.feed_share * axis.drive_damping,
        contact.stiffness if contact else 0.0, contact.damping if contact else 0.0, contact is not None,
        contact is not None and contact.undeflected, contact is None or contact.ends_by_drive, initial.velocity,
        initial.rest_time, initial.stretch, initial.deflection, parts.duration, steps, sides, *inputs)


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
