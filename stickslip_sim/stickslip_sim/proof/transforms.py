# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes in the mirror and in other units: what each does to the data, and to the events.

With units multiplied by powers of two nothing is rounded anew, so that the events must be the same to the bit.
"""

import math
import random
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

from ..axis import Axis, CompliantContact, Friction
from ..core.input_profile import FREQUENCIES, InputProfile
from ..core.types import Event
from ..friction import ExcessTable, KineticTable
from .axes import Parts

_POWERS = (-40, -7, 1, 13, 60)
_OF_TIME = (-1, -3, -10, -20)
_LIMIT = 0.999   # s: within the first second a time is one number


class Image(NamedTuple):
    """A scene as another one, what becomes of an event, and up to when the original is its original, s."""

    name: str
    parts: Parts
    of_event: Callable[[Event], Event]
    until: float

    def of_events(self, events: list[Event]) -> list[Event]:
        """Return the events that the image must have."""
        return [self.of_event(event) for event in events if event.time <= self.until]


def images(parts: Parts, rng: random.Random) -> Iterator[Image]:
    """Yield the mirror image, and the scene in other units of mass, length and, where its sines allow it, time."""
    k = math.ldexp(1.0, rng.choice(_POWERS))
    yield _mirrored(parts)
    yield _in_mass_unit(parts, k)
    yield _in_length_unit(parts, k)
    sinusoids = [w.frequency for profile in parts.inputs for w in profile.sinusoids]
    slower = [t for t in _OF_TIME if all(math.ldexp(w, -t) < FREQUENCIES[1] for w in sinusoids)]
    if slower:
        yield _in_time_unit(parts, math.ldexp(1.0, rng.choice(slower)))


def _mirrored(parts: Parts) -> Image:
    """Return (x, v, F) → (−x, −v, −F)."""
    start = parts.initial
    initial = replace(start, **{name: -getattr(start, name)
                                for name in ('position', 'velocity', 'stretch', 'deflection')})
    axis = replace(parts.axis, friction=parts.axis.friction.mirrored)
    image = parts._replace(axis=axis, initial=initial, drive=scaled_profile(parts.drive, -1.0),
                           force=scaled_profile(parts.force, -1.0))
    return Image('mirrored', image, lambda e: e._replace(
        direction=-e.direction, position=-e.position, velocity=-e.velocity, drive_position=-e.drive_position,
        drive_force=-e.drive_force, friction_force=-e.friction_force), parts.duration)


def _in_mass_unit(parts: Parts, k: float) -> Image:
    """Return all forces, stiffnesses, dampers and the mass multiplied."""
    axis = replace(_stiffened(parts.axis, k, k), mass=k * parts.axis.mass, normal_force=k * parts.axis.normal_force)
    image = parts._replace(axis=axis, force=scaled_profile(parts.force, k),
                           load=parts.load and scaled_profile(parts.load, k))
    return Image(f'mass unit times {k:g}', image, lambda e: e._replace(
        drive_force=k * e.drive_force, friction_force=k * e.friction_force), parts.duration)


def _in_length_unit(parts: Parts, k: float) -> Image:
    """Return all lengths, speeds and forces multiplied; mass, stiffnesses and dampers stay."""
    start = parts.initial
    initial = replace(start, **{name: k * getattr(start, name)
                                for name in ('position', 'velocity', 'stretch', 'deflection')})
    axis = replace(parts.axis, friction=_faster(parts.axis.friction, k), normal_force=k * parts.axis.normal_force)
    image = parts._replace(axis=axis, initial=initial, drive=scaled_profile(parts.drive, k),
                           force=scaled_profile(parts.force, k), load=parts.load and scaled_profile(parts.load, k))
    return Image(f'length unit times {k:g}', image, lambda e: e._replace(
        position=k * e.position, velocity=k * e.velocity, drive_position=k * e.drive_position,
        drive_force=k * e.drive_force, friction_force=k * e.friction_force), parts.duration)


def _in_time_unit(parts: Parts, k: float) -> Image:
    """Return all times multiplied by k < 1, within the first second: c/k², h/k, v/k, F/k²."""
    until, more = min(parts.duration, _LIMIT), 1.0 / (k * k)
    axis = _stiffened(parts.axis, more, 1.0 / k)
    axis = replace(axis, normal_force=axis.normal_force * more, friction=_slower(_faster(axis.friction, 1.0 / k), k))
    initial = replace(parts.initial, velocity=parts.initial.velocity / k, rest_time=k * parts.initial.rest_time)
    image = Parts(axis, initial, _quicker(parts.drive, k, 1.0 / k), _quicker(parts.force, k, more), k * until,
                  parts.load and _quicker(parts.load, k, more))
    return Image(f'time unit times {k:g}', image, lambda e: e._replace(
        fraction=k * e.fraction, velocity=e.velocity / k, drive_force=e.drive_force * more,
        friction_force=e.friction_force * more, rest_time=k * e.rest_time), until)


def _stiffened(axis: Axis, stiffer: float, damper: float) -> Axis:
    contact = axis.contact
    if isinstance(contact, CompliantContact):
        contact = replace(contact, stiffness=stiffer * contact.stiffness, damping=damper * contact.damping)
    return replace(axis, drive_stiffness=stiffer * axis.drive_stiffness, drive_damping=damper * axis.drive_damping,
                   contact=contact)


def _faster(friction: Friction, k: float) -> Friction:
    """Return friction whose tables have all their speeds multiplied."""
    kinetic, excess = friction.kinetic, friction.excess
    kinetic = KineticTable(tuple(k * v for v in kinetic.velocities), kinetic.coefficients, kinetic.end_slope / k)
    if excess is not None:
        excess = ExcessTable(tuple(k * v for v in excess.velocities), excess.fractions)
    return replace(friction, kinetic=kinetic, excess=excess,
                   backward=friction.backward and _faster(friction.backward, k))


def _slower(friction: Friction, k: float) -> Friction:
    """Return friction whose static law has all its times multiplied."""
    static = replace(friction.static, time_constant=k * friction.static.time_constant, delay=k * friction.static.delay)
    return replace(friction, static=static, backward=friction.backward and _slower(friction.backward, k))


def scaled_profile(profile: InputProfile, factor: float) -> InputProfile:
    """Return the input profile with all its values multiplied."""
    return _quicker(profile, 1.0, factor)


def _quicker(profile: InputProfile, k: float, factor: float) -> InputProfile:
    """Return the input profile with its times multiplied by k, and its values by a factor."""
    return InputProfile(
        tuple(k * t for t in profile.starts), tuple(factor * x for x in profile.values),
        tuple(factor / k * x for x in profile.rates), k * profile.period,
        tuple(w._replace(amplitude=factor * w.amplitude, frequency=w.frequency / k) for w in profile.sinusoids))
