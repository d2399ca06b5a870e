# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Mirrored, and in other units by powers of two: the same bits."""

import math
import random
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.core.errors import SolverError
from stickslip_sim.core.input_profile import FREQUENCIES, InputProfile
from stickslip_sim.core.types import Event
from stickslip_sim.friction import ExcessTable, KineticTable

from ..case import Find, LastBits, Parts, Run, all_events

_POWERS = (-40, -7, 1, 13, 60)
_TIMES = (-1, -3, -10, -20)
_ROUNDING = 1e-9  # of the duration: times that differ by no more are those of the same events
_LIMIT = 0.999    # s: within the first second a time is one number


def judge(run: Run, rng: random.Random) -> None:
    """Run the mirror image and the scene in other units; raises Find, or LastBits, unless all are the same."""
    parts, events = run.parts, run.events
    k = math.ldexp(1.0, rng.choice(_POWERS))
    _compare('mirrored', _mirrored(parts), (_mirror(e) for e in events))
    _compare(f'mass unit times {k:g}', _mass_unit(parts, k), (
        e._replace(drive_force=k * e.drive_force, friction_force=k * e.friction_force) for e in events))
    _compare(f'length unit times {k:g}', _length_unit(parts, k), (
        e._replace(position=k * e.position, velocity=k * e.velocity, drive_position=k * e.drive_position,
                   drive_force=k * e.drive_force, friction_force=k * e.friction_force) for e in events))
    sinusoids = [w.frequency for profile in parts.inputs for w in profile.sinusoids]
    fast = [t for t in _TIMES if all(math.ldexp(w, -t) < FREQUENCIES[1] for w in sinusoids)]
    if fast:
        _time_unit(parts, events, math.ldexp(1.0, rng.choice(fast)))


def _compare(name: str, image: Parts, wanted: Iterable[Event]) -> None:
    try:
        seen = all_events(image)
    except SolverError as error:
        raise Find(f'{name}: refused: {error}') from None
    wanted = list(wanted)
    first = next((i for i, (a, b) in enumerate(zip(seen, wanted)) if a != b), min(len(seen), len(wanted)))
    if first < max(len(seen), len(wanted)):
        text = ' and not '.join(_brief(events[first]) if first < len(events) else 'none' for events in (seen, wanted))
        raise (LastBits if _alike(seen, wanted, image.duration) else Find)(f'{name}: event {first} is {text}')


def _alike(seen: list[Event], wanted: list[Event], duration: float) -> bool:
    return len(seen) == len(wanted) and all(
        a.kind == b.kind and a.mode == b.mode and abs(a.time - b.time) <= _ROUNDING * duration
        for a, b in zip(seen, wanted))


def _brief(event: Event) -> str:
    return (f'{event.kind.name} to {event.mode.name} at {event.time!r} s, x {event.position!r}, u {event.velocity!r}, '
            f'F_d {event.drive_force!r}')


def _mirrored(parts: Parts) -> Parts:
    initial = InitialState(-parts.initial.position, -parts.initial.velocity, parts.initial.rest_time,
                           -parts.initial.stretch, -parts.initial.deflection)
    axis = replace(parts.axis, friction=parts.axis.friction.mirrored)
    return parts._replace(axis=axis, initial=initial, drive=_scaled(parts.drive, -1.0),
                          force=_scaled(parts.force, -1.0))


def _mirror(event: Event) -> Event:
    return event._replace(direction=-event.direction, position=-event.position, velocity=-event.velocity,
                          drive_position=-event.drive_position, drive_force=-event.drive_force,
                          friction_force=-event.friction_force)


def _mass_unit(parts: Parts, k: float) -> Parts:
    axis = replace(_stiffened(parts.axis, k, k), mass=k * parts.axis.mass, normal_force=k * parts.axis.normal_force)
    return parts._replace(axis=axis, force=_scaled(parts.force, k), load=parts.load and _scaled(parts.load, k))


def _length_unit(parts: Parts, k: float) -> Parts:
    axis = replace(_faster(parts.axis, k), normal_force=k * parts.axis.normal_force)
    initial = replace(parts.initial, **{name: k * getattr(parts.initial, name)
                                        for name in ('position', 'velocity', 'stretch', 'deflection')})
    return parts._replace(axis=axis, initial=initial, drive=_scaled(parts.drive, k), force=_scaled(parts.force, k),
                          load=parts.load and _scaled(parts.load, k))


def _time_unit(parts: Parts, events: Sequence[Event], k: float) -> None:
    end = min(parts.duration, _LIMIT)
    axis = _faster(_stiffened(parts.axis, 1.0 / (k * k), 1.0 / k), 1.0 / k)
    axis = replace(axis, normal_force=axis.normal_force / (k * k), friction=_slower(axis.friction, k))
    initial = replace(parts.initial, velocity=parts.initial.velocity / k, rest_time=k * parts.initial.rest_time)
    image = Parts(axis, initial, _quicker(parts.drive, k, 1.0 / k), _quicker(parts.force, k, 1.0 / (k * k)), k * end,
                  parts.load and _quicker(parts.load, k, 1.0 / (k * k)))
    _compare(f'time unit times {k:g}', image, (
        e._replace(fraction=k * e.fraction, velocity=e.velocity / k, drive_force=e.drive_force / (k * k),
                   friction_force=e.friction_force / (k * k), rest_time=k * e.rest_time)
        for e in events if e.time <= end))


def _stiffened(axis: Axis, stiffer: float, damper: float) -> Axis:
    contact = axis.contact
    if isinstance(contact, CompliantContact):
        contact = replace(contact, stiffness=stiffer * contact.stiffness, damping=damper * contact.damping)
    return replace(axis, drive_stiffness=stiffer * axis.drive_stiffness, drive_damping=damper * axis.drive_damping,
                   contact=contact)


def _faster(axis: Axis, k: float) -> Axis:
    return replace(axis, friction=_faster_friction(axis.friction, k))


def _faster_friction(friction: Friction, k: float) -> Friction:
    kinetic, excess = friction.kinetic, friction.excess
    kinetic = KineticTable(tuple(k * v for v in kinetic.velocities), kinetic.coefficients, kinetic.end_slope / k)
    if excess is not None:
        excess = ExcessTable(tuple(k * v for v in excess.velocities), excess.fractions)
    return replace(friction, kinetic=kinetic, excess=excess,
                   backward=friction.backward and _faster_friction(friction.backward, k))


def _slower(friction: Friction, k: float) -> Friction:
    static = replace(friction.static, time_constant=k * friction.static.time_constant, delay=k * friction.static.delay)
    return replace(friction, static=static, backward=friction.backward and _slower(friction.backward, k))


def _scaled(profile: InputProfile, factor: float) -> InputProfile:
    return _mapped(profile, lambda t: t, factor, factor, 1.0, profile.period)


def _quicker(profile: InputProfile, k: float, factor: float) -> InputProfile:
    return _mapped(profile, lambda t: k * t, factor, factor / k, 1.0 / k, k * profile.period)


def _mapped(profile: InputProfile, time: Callable[[float], float], value: float, rate: float, frequency: float,
            period: float) -> InputProfile:
    return InputProfile(tuple(time(t) for t in profile.starts), tuple(value * x for x in profile.values),
                  tuple(rate * x for x in profile.rates), period,
                  tuple(w._replace(amplitude=value * w.amplitude, frequency=frequency * w.frequency)
                        for w in profile.sinusoids))
