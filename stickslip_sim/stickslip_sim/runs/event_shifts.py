# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How far apart the events of two runs are, as long as they are the same ones."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..core.types import Event, EventKind

MOMENT = 1e-6   # s; a coast this short after a break-away hangs on the last remains of a contact's ring-down
_OF_A_CYCLE = (EventKind.BREAKAWAY, EventKind.STICK, EventKind.REVERSE)


class Shift(NamedTuple):
    """The largest distances of an event from that of the other run, s and m, up to the time `until`, s."""

    time: float
    position: float
    until: float


def shift_between(events: Sequence[Event], others: Sequence[Event], duration: float) -> Shift:
    """Return how far two runs are apart up to the last time at which both have had the same events."""
    count = _same(events, others)
    rest = [event.time for run in (events, others) for event in run[count:count + 1]]
    until = min(rest, default=duration)
    while count and max(events[count - 1].time, others[count - 1].time) > until:   # one run has it, the other not yet
        count -= 1
        until = min(events[count].time, others[count].time)
    pairs = list(zip(events[:count], others))
    return Shift(max((_apart(a, b) for a, b in pairs), default=0.0),
                 max((abs(a.position - b.position) for a, b in pairs), default=0.0), until)


def lasting(events: Sequence[Event]) -> list[Event]:
    """Return the events without those that mark the end of a coast of a moment, which rounding may decide."""
    kept: list[Event] = []
    away = -math.inf
    for event in events:
        if event.kind == EventKind.BREAKAWAY:
            away = event.time
        elif event.time - away <= MOMENT:
            continue
        kept.append(event)
    return kept


def _same(events: Sequence[Event], others: Sequence[Event]) -> int:
    """Return how many events, in their order, are the same ones in two runs."""
    for i, (a, b, after_a, after_b) in enumerate(zip(events, others, _next_of_a_kind(events), _next_of_a_kind(others))):
        # a cycle that one run alone has leaves the kinds as they are; what follows is nearer to the event after
        if ((a.kind, a.direction) != (b.kind, b.direction)
                or min(abs(after_a - b.time), abs(after_b - a.time)) < _apart(a, b)):
            return i
    return min(len(events), len(others))


def _apart(event: Event, other: Event) -> float:
    return abs((event.second - other.second) + (event.fraction - other.fraction))


def _next_of_a_kind(events: Sequence[Event]) -> list[float]:
    """Return for each break-away, stop or reversal when the next of its kind and direction comes; else infinity."""
    times: list[float] = []
    coming: dict[tuple[EventKind, int], float] = {}
    for event in reversed(events):
        name = event.kind, event.direction
        times.append(coming.get(name, math.inf))
        if event.kind in _OF_A_CYCLE:
            coming[name] = event.time
    return times[::-1]
