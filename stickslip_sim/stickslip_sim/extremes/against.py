# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Events against the independent reference, event by event."""

from collections.abc import Sequence
from fractions import Fraction

from ..axis import Axis, InitialState
from ..core.input_profile import InputProfile
from ..core.types import Event
from ..figures.distance import first_mismatch
from ..reference import simulate
from ..solvers import Solver
from .outcome import require
from .shared_axes import instant, make

DIGITS = 40


def error_of_run(axis: Axis, initial: InitialState, drive: InputProfile, force: InputProfile, duration: float,
                 solver: Solver) -> float:
    """Return the largest error of the events of a run, in units of its length and its travel.

    Raises Missed when the events are not the same ones.
    """
    events = make(axis, drive, force, initial, solver).advance(instant(duration))
    return error_of_events(events, simulate(axis, initial, drive, force, duration, DIGITS).events, duration)


def error_of_events(events: Sequence[Event], wanted: Sequence[Event], duration: float) -> float:
    """Return the largest error of times over the duration and of positions over the travel; Missed as above."""
    got, want = ([(event.kind.name, event.direction) for event in run] for run in (events, wanted))
    first = first_mismatch(events, wanted)
    require(got == want, f'{len(got)} events instead of {len(want)}; number {first} differs: '
                       f'{got[first:first + 2]} instead of {want[first:first + 2]}')
    start = wanted[0].position if wanted else 0.0
    travel = max((abs(event.position - start) for event in wanted), default=0.0) or 1.0
    return max((max(_distance(e, w) / duration, abs(e.position - w.position) / travel)
                for e, w in zip(events, wanted)), default=0.0)


def _distance(event: Event, other: Event) -> float:
    """Return the seconds between two instants in exact arithmetic."""
    return abs(float(Fraction(event.second) - Fraction(other.second)
                     + (Fraction(event.fraction) - Fraction(other.fraction))))
