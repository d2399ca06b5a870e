# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The automaton in multiple precision: the same events, within what rounding of the data may change."""

import math
import zlib
from collections.abc import Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any

from stickslip_sim.axis import CompliantContact
from stickslip_sim.core.errors import InputError, SolverError
from stickslip_sim.core.input_profile import InputProfile
from stickslip_sim.core.types import Event, EventKind
from stickslip_sim.figures.distance import first_mismatch
from stickslip_sim.proof.axes import Parts
from stickslip_sim.proof.judges import Find, error_of_events
from stickslip_sim.proof.transforms import scaled_profile
from stickslip_sim.reference import simulate
from tests.support.time_and_memory import within

from ..case import Run, Undecided

_DIGITS, _MORE_DIGITS = 30, 45   # the second where the first disagree: forces may lie 25 decades apart
_MOST_EVENTS, _MOST_CONFIRMED = 20, 60
_PATIENCE = 20.0      # s
_ERROR = 1e-11        # of the run's length and travel
_UNKNOWN = 2.2e-16    # of two ways, in their difference
_ROOT = 6e-8           # of rounding, four times: to which a double root is right
_ROUNDING = 1e-13     # of the data: what it changes, no double can be blamed for
_OTHERS = 1e300       # in place of an error: the events are not the same ones
_ROUNDINGS = 4        # of each number of the data by itself, see `rounded_data`
_SIZE = 1e-14            # of each number: 90 times what a double rounds, for the sums along 20 events
_GIVEN = {'fractions'}  # shares of one whole, which are 1 and 0


def judge(run: Run) -> None:
    """Compare the first events; raises Find, or Undecided where rounding of the data changes as much."""
    compare(run.parts, run.events, _MOST_EVENTS)


def compare(parts: Parts, events: Sequence[Event], most: int, patience: float = _PATIENCE) -> None:
    """Compare up to `most` events with the reference, as `judge`."""
    if len(events) > most:
        parts = parts._replace(duration=0.5 * (events[most - 1].time + events[most].time))
        events = [event for event in events if event.time <= parts.duration]
    try:
        with within(patience):
            _compare(parts, events)
    except TimeoutError:
        raise Undecided('the reference takes too long') from None
    except SolverError as error:
        raise Undecided(f'the reference gives up: {error}') from None


def _compare(parts: Parts, events: Sequence[Event]) -> None:
    wanted = _events(parts)
    error, text = _error(events, wanted, parts.duration)
    if error > _ERROR:
        wanted = _events(parts, _MORE_DIGITS)
        error, text = _error(events, wanted, parts.duration)
    if error <= _ERROR:
        return
    if _is_rounding_of_data(parts, events, wanted):
        raise Undecided('rounding of the data changes as much, up to the first event that is off')
    if _slides_steadily(parts, events, wanted):
        raise Undecided('it slides steadily within rounding')
    if _stops_softly(events, wanted, parts):
        raise Undecided('it comes to rest with no acceleration left: a double root is right to the root of rounding')
    if _touches(events, wanted, parts):
        raise Undecided('the reference breaks away for a moment at a touch: `touch` judges these')
    if _turns_on_a_breakpoint(events, wanted):
        raise Undecided('its speed peaks on a breakpoint of the table: a double root is right to the root of rounding')
    axis = parts.axis
    for sign in (1.0, -1.0):
        off = sign * _ROUNDING
        other = parts._replace(drive=scaled_profile(parts.drive, 1.0 + off),
                               load=parts.load and scaled_profile(parts.load, 1.0 + 0.7 * off),
                               axis=replace(axis, mass=axis.mass * (1.0 + off),
                                            drive_stiffness=axis.drive_stiffness * (1.0 - off),
                                            drive_damping=axis.drive_damping * (1.0 + off),
                                            normal_force=axis.normal_force * (1.0 + 0.7 * off)))
        if _error(_events(other), wanted, parts.duration)[0] >= error:
            raise Undecided('rounding of the data changes as much')
    raise Find(text)


def _is_rounding_of_data(parts: Parts, events: Sequence[Event], wanted: Sequence[Event]) -> bool:
    """Whether the reference itself is off as much, up to the first event that is, with data that are off by rounding.

    Each number then has an error of its own, as in doubles: what coasts in a thin band of friction, or meets a limit at
    the instant at which its input turns, shows nothing where all data are scaled together.  What is no event of the
    reference at all has to be one then, at its time.
    """
    last = _first_off(events, wanted, parts.duration) + 1
    found, right = events[:last], wanted[:last]
    error = _error(found, right, parts.duration)[0]
    for salt in range(_ROUNDINGS):
        try:
            other = _events(rounded_data(parts, salt))[:last]
        except InputError:
            continue
        if error <= _error(other, right, parts.duration)[0] < _OTHERS:
            return True
        if error == _OTHERS and _error(found, other, parts.duration)[0] <= _ERROR:
            return True
    return False


def _first_off(events: Sequence[Event], wanted: Sequence[Event], duration: float) -> int:
    for k in range(min(len(events), len(wanted))):
        if _error(events[:k + 1], wanted[:k + 1], duration)[0] > _ERROR:
            return k
    return min(len(events), len(wanted))


def _slides_steadily(parts: Parts, events: Sequence[Event], wanted: Sequence[Event]) -> bool:
    """Whether all that differs comes at the drive's velocity, but for rounding of the fastest speed of the run."""
    k = next((i for i, (a, b) in enumerate(zip(events, wanted)) if a.kind != b.kind
              or abs(a.time - b.time) > _ERROR * parts.duration), min(len(events), len(wanted)))
    rest = [*events[k:], *wanted[k:]]
    fastest = max([abs(parts.initial.velocity), *(abs(event.velocity) for event in events)])
    return bool(rest) and all(abs(event.velocity - parts.drive.value_at(event.time)) <= 1e-14 * fastest
                              for event in rest)


def _stops_softly(events: Sequence[Event], wanted: Sequence[Event], parts: Parts) -> bool:
    """Whether what is first off comes to rest with the forces in balance: there the speed has a double root.

    With the force R that is left and its rate R′ = c v + h v̇ + Ḟ_e ∓ Ṅ mu_k the speed is (R t + R′ t²/2)/m beside
    the event.  If it is off by δ and R² <= 2 m δ |R′|, its root is off by 2 τ at most, τ = √(2 m δ/|R′|), or is none:
    doubles do not say whether the slider turns, stops or goes on.  δ is four roundings of the fastest speed, and what
    the spring gives to a swing: its stretch is the difference of two ways, and R known no better than they are.
    """
    k, axis = _first_off(events, wanted, parts.duration), parts.axis
    if k >= len(events):
        return False
    event = events[k]
    spring = _UNKNOWN * axis.drive_stiffness * (abs(event.position) + abs(event.drive_position))
    unknown = 4.0 * _UNKNOWN * max(abs(before.velocity) for before in events[:k + 1])
    if spring > 0.0:
        unknown += spring / math.sqrt(axis.drive_stiffness * axis.mass)
    left = abs(event.drive_force + parts.force.value_at(event.time) - event.friction_force)
    pressed = _rate_at(parts.load, event.time) if parts.load else 0.0
    rate = abs(axis.drive_stiffness * parts.drive.value_at(event.time) + _rate_at(parts.force, event.time)
               - event.direction * pressed * axis.friction.along(event.direction).kinetic.coefficients[0]
               + axis.feed_share * axis.drive_damping * _rate_at(parts.drive, event.time))
    room = 2.0 * axis.mass * unknown
    if max(abs(event.velocity), abs(wanted[k].velocity) if k < len(wanted) else 0.0) > unknown:
        return False
    if max(left - spring, 0.0) ** 2 > room * rate:
        return False
    off = abs((wanted[k].time if k < len(wanted) else parts.duration) - event.time)
    return off ** 2 * rate <= 4.0 * room


def _rate_at(profile: InputProfile, time: float) -> float:
    """Return how fast a profile changes at a time, per s."""
    turning = 2.0 * math.pi
    return profile.piece_at(time).rate + sum(
        w.amplitude * turning * w.frequency * math.cos(turning * w.frequency * time + w.phase)
        for w in profile.sinusoids)


def _touches(events: Sequence[Event], wanted: Sequence[Event], parts: Parts) -> bool:
    """Whether the reference alone breaks away where its contact only touches its limit.

    That is for no time at all, or with a speed whose square is rounding beside that of the swing.
    """
    k = first_mismatch(events, wanted)
    if k + 1 >= len(wanted) or (wanted[k].kind, wanted[k + 1].kind) != (EventKind.BREAKAWAY, EventKind.STICK):
        return False
    axis = parts.axis
    soft = axis.drive_stiffness + (axis.contact.stiffness if isinstance(axis.contact, CompliantContact) else 0.0)
    swing = abs(wanted[k].position) * math.sqrt(soft / axis.mass)
    return wanted[k + 1].time - wanted[k].time <= 1e-12 * parts.duration or abs(wanted[k].velocity) <= _ROOT * swing


def _turns_on_a_breakpoint(events: Sequence[Event], wanted: Sequence[Event]) -> bool:
    """Whether what differs first is a breakpoint that is passed, or not, with the forces in balance."""
    k = first_mismatch(events, wanted)
    largest = max([abs(event.drive_force) for event in wanted], default=0.0)
    return any(event.kind == EventKind.KNOT and abs(event.drive_force - event.friction_force) <= _ROOT * largest
               for event in [*events[k:k + 1], *wanted[k:k + 1]])


def _events(parts: Parts, digits: int = _DIGITS) -> Sequence[Event]:
    return simulate(parts.axis, parts.initial, parts.drive, parts.force, parts.duration, digits, parts.load).events


def _error(events: Sequence[Event], wanted: Sequence[Event], duration: float) -> tuple[float, str]:
    try:
        error = error_of_events(events, wanted, duration)
        return error, f'an error of {error:.3g} of the length or the travel'
    except Find as find:
        k = first_mismatch(events, wanted)
        times = [repr(e[k].time) if k < len(e) else 'none' for e in (events, wanted)]
        return _OTHERS, f'{find}; at {times[0]} s instead of {times[1]} s'


def confirm(parts: Parts, patience: float = _PATIENCE) -> str:
    """Return in words what the reference says to the events of a run."""
    try:
        compare(parts, parts.events(), _MOST_CONFIRMED, patience)
    except Find as find:
        return f'the engine is wrong: {find}'
    except (Undecided, SolverError) as error:
        return f'undecided: {error}'
    return f'the first {_MOST_CONFIRMED} events are right'


def rounded_data(parts: Parts, salt: int, size: float = _SIZE) -> Parts:
    """Return the parts with each number moved by its own share of `size`; raises InputError where their order is lost.

    Equal numbers stay equal, and opposite ones opposite, since a scene means that (mu_s(0) = mu_k(0), a drive that
    comes back).  The duration stays.
    """
    return Parts(*(_moved(part, salt, size) for part in parts))._replace(duration=parts.duration)


def _moved(value: Any, salt: int, size: float) -> Any:
    if type(value) is float:
        return value * (1.0 + size * _share(abs(value), salt)) if math.isfinite(value) else value
    if isinstance(value, tuple):
        moved = [_moved(one, salt, size) for one in value]
        return type(value)(*moved) if hasattr(value, '_fields') else tuple(moved)
    if is_dataclass(value) and not isinstance(value, type):
        return replace(value, **{one.name: _moved(getattr(value, one.name), salt, size) for one in fields(value)
                                 if one.name not in _GIVEN})
    return value


def _share(value: float, salt: int) -> float:
    """Return a number between −1 and 1 that any other value has otherwise."""
    return zlib.crc32(f'{salt} {value!r}'.encode()) / 2.0 ** 31 - 1.0
