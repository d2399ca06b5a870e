# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The multiplier of the limit cycle: by how much a small disturbance is larger, one group of rounds later.

At an arrest the slider stands still, its rest time is 0 and the deflection of a compliant contact is that of kinetic
friction, or 0; under constant inputs all that is left of the state is the stretch of the drive spring.  So the map from
arrest to arrest is one of numbers, and its slope at the limit cycle is the only multiplier: disturbances die out where
it is between −1 and 1, with changing sign below 0, and at once where it is 0.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..axis import CompliantContact, InitialState
from ..core.errors import SolverError
from ..core.types import Event, EventKind, Mode
from ..figures.rounds import break_aways
from ..figures.slips import elapsed
from ..scene import Scene
from ..study.points import works_in_batches
from .moved_number import CENTRAL
from .trace import Trace

_SHORTEST = 1e-2   # s, the first look
_STEP = 1e-5       # of the change of stretch in a slip


@dataclass(frozen=True)
class Multiplier:
    """The multiplier of a limit cycle of so many `rounds`, of `period` s altogether, and its error.

    NaN where there is none; `note` says why.
    """

    value: float
    error: float
    rounds: int
    period: float
    note: str = ''

    @property
    def time_constant(self) -> float:
        """The time in which disturbances fall to 1/e, s: 0 where they vanish at once, negative where they grow."""
        size = abs(self.value)
        return 0.0 if size == 0.0 else math.inf if size == 1.0 else -self.period / math.log(size)


def multiplier_of(scene: Scene) -> Multiplier:
    """Return the multiplier of the limit cycle that a scene ends in, by differences of the map from arrest to arrest.

    Raises SolverError when the solver gives up.
    """
    if not works_in_batches(scene):
        return _none('its inputs are not constant, or it has faults')
    trace = Trace(scene)
    if not trace.extend_until(lambda run: run.settled is not None, _SHORTEST):
        return _none('no limit cycle was found')
    settled = trace.settled
    assert settled is not None
    places = break_aways(trace.events)
    first, last = places[settled.number + 1 - settled.size], places[settled.number + 1]
    arrest = _last_arrest(trace.events[:first])
    return _slope(scene, arrest, trace.events[first:last + 1], settled.size)


def _slope(scene: Scene, arrest: Event, group: list[Event], size: int) -> Multiplier:
    """Return the multiplier by what follows an arrest: the `group` of events from break-away to break-away."""
    begin = _stretch(scene, arrest)
    count = sum(map(_is_arrest, group))
    period = elapsed(group[0], group[-1])
    stretches = [_stretch(scene, event) for event in group]
    way = max(stretches) - min(stretches)
    found = []
    for offset in CENTRAL.offsets:
        events = _events_from(scene, arrest, begin + _STEP * offset * way, count, 2.0 * period)
        if [_kind(event) for event in events] != [_kind(event) for event in group[:len(events)]]:
            return _none('the sequence of events changes beside the limit cycle', size, period)
        found.append(_stretch(scene, events[-1]))
    if not abs(found[1] + found[2] - 2.0 * _stretch(scene, _last_arrest(group))) <= _STEP * way:
        return _none('more than the stretch of the spring is left of the state at an arrest', size, period)
    value, error = CENTRAL.derivative(np.array(found), _STEP * way, abs(begin), max(map(abs, stretches)))
    return Multiplier(float(value), float(error), size, period)


def _events_from(scene: Scene, arrest: Event, stretch: float, count: int, duration: float) -> list[Event]:
    """Return the events from an arrest with another stretch up to the arrest number `count`; fewer where they end."""
    trace = Trace(replace(scene, initial=InitialState(0.0, 0.0, 0.0, stretch, _deflection(scene, arrest))))
    trace.extend(duration)
    places = [k for k, event in enumerate(trace.events) if _is_arrest(event)]
    if len(places) < count:
        raise SolverError('a limit cycle is not found again from its own arrest: please report the scene')
    return trace.events[:places[count - 1] + 1]


def _deflection(scene: Scene, arrest: Event) -> float:
    """Return the deflection of the contact as a stick begins, m."""
    contact = scene.axis.contact
    if not isinstance(contact, CompliantContact) or contact.undeflected:
        return 0.0
    held = scene.axis.normal_force * scene.axis.friction.kinetic.coefficients[0]
    return arrest.direction * held / contact.stiffness


def _last_arrest(events: Sequence[Event]) -> Event:
    return next(event for event in reversed(events) if _is_arrest(event))


def _is_arrest(event: Event) -> bool:
    return event.kind == EventKind.STICK


def _kind(event: Event) -> tuple[EventKind, Mode, int]:
    return event.kind, event.mode, event.direction


def _stretch(scene: Scene, event: Event) -> float:
    """Return the stretch of the drive spring at an event, m."""
    axis = scene.axis
    damping = axis.drive_damping - axis.slideway_damping
    return (event.drive_force - damping * (scene.drive.values[0] - event.velocity)) / axis.drive_stiffness


def _none(note: str, size: int = 0, period: float = math.nan) -> Multiplier:
    return Multiplier(math.nan, math.nan, size, period, note)
