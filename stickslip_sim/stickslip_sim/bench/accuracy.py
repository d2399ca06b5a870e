# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How wrong a run is: its events paired with those of the reference; missed, invented, late, and out of place.

What counts are the events at which the slider starts or stops (break-away, stick, reverse), because every solver has
them; the sub-modes of a slip are compared too, apart.  Events of one kind and direction are paired in order, so that
the sum of their distances in time is least; a pair further apart than half the usual distance of such events is none.
"""

from collections.abc import Sequence
from typing import NamedTuple

from ..core.types import Event, EventKind
from ..figures.distance import CYCLE_EVENTS, pair, window
from .problem import Outcome

SUB_MODES = (EventKind.COAST, EventKind.ACCELERATE, EventKind.DECELERATE)


class Errors(NamedTuple):
    """Of one run against the reference; times in s, positions in m, the worst over the pairs."""

    events: int
    reference_events: int
    missed: int
    invented: int
    time: float
    position: float
    end_position: float
    sub_modes_missed: int
    sub_modes_invented: int
    sub_modes_time: float


class Truth(NamedTuple):
    """The result of the reference: events, and the position at the end, m."""

    events: list[Event]
    position: float


class _Pairing(NamedTuple):
    missed: int
    invented: int
    time: float
    position: float


def errors_of(outcome: Outcome, truth: Truth, duration: float) -> Errors:
    """Compare a run of `duration` seconds with the reference."""
    boundaries = _compare(outcome, truth, CYCLE_EVENTS, duration)
    sub_modes = _compare(outcome, truth, SUB_MODES, duration)
    kinds = [int(kind) for kind in outcome.events[:, 1]]
    return Errors(sum(kind in CYCLE_EVENTS for kind in kinds), sum(e.kind in CYCLE_EVENTS for e in truth.events),
                  boundaries.missed, boundaries.invented, boundaries.time, boundaries.position,
                  abs(outcome.position - truth.position), sub_modes.missed, sub_modes.invented, sub_modes.time)


def _compare(outcome: Outcome, truth: Truth, kinds: Sequence[EventKind], duration: float) -> _Pairing:
    missed = invented = 0
    time = position = 0.0
    for kind in kinds:
        for direction in (-1, 1):
            want = [(e.time, e.position) for e in truth.events if e.kind == kind and e.direction == direction]
            got = [(row[0], row[3]) for row in outcome.events.tolist() if row[1] == kind and row[2] == direction]
            pairs = pair(want, got, window(want, duration))
            missed += len(want) - len(pairs)
            invented += len(got) - len(pairs)
            time = max([time, *(abs(a[0] - b[0]) for a, b in pairs)])
            position = max([position, *(abs(a[1] - b[1]) for a, b in pairs)])
    return _Pairing(missed, invented, time, position)
