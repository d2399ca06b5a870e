# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of the engine against the automaton in multiple precision, event by event."""

from collections.abc import Sequence
from dataclasses import replace

from stickslip_sim.core.errors import SolverError
from stickslip_sim.core.types import Event
from stickslip_sim.extremes.against import error_of_events
from stickslip_sim.extremes.outcome import Missed
from stickslip_sim.extremes.shared_axes import instant
from stickslip_sim.reference import simulate

from .engine import simulator
from .made_up_axes import Case

_DIGITS = 30
_MOST_EVENTS = 25     # the judge is a hundred thousand times slower than the engine
_ERROR = 1e-11        # of the run's length and travel
_ROUNDING = 1e-13     # of the data: what it changes, no double can be blamed for


def equals_the_reference(case: Case) -> None:
    """Compare the first events; raises AssertionError unless data that differ by rounding differ as much."""
    try:
        events = simulator(case).advance(instant(case.duration))
    except SolverError:
        return
    if len(events) > _MOST_EVENTS:
        case = case._replace(duration=0.5 * (events[_MOST_EVENTS - 1].time + events[_MOST_EVENTS].time))
        events = [event for event in events if event.time <= case.duration]
    wanted = _reference(case)
    error = _error(events, wanted, case.duration)
    if error > _ERROR:
        axis = case.axis
        other = case._replace(axis=replace(axis, mass=axis.mass * (1.0 + _ROUNDING),
                                           drive_stiffness=axis.drive_stiffness * (1.0 - _ROUNDING),
                                           normal_force=axis.normal_force * (1.0 + _ROUNDING)))
        assert error <= _error(_reference(other), wanted, case.duration), (error, events, wanted)


def _reference(case: Case) -> Sequence[Event]:
    return simulate(case.axis, case.initial, case.drive, case.force, case.duration, _DIGITS).events


def _error(events: Sequence[Event], wanted: Sequence[Event], duration: float) -> float:
    try:
        return error_of_events(events, wanted, duration)
    except Missed:
        return 1.0
