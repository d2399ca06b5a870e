# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Slips: in the events of a run, and by the speed alone where nothing else is known of a motion.

By its speed the slider is taken to slip from where that passes a threshold to where it falls below, if the peak between
is five times as high: what stays below that is noise, or a contact that rings.  Else it is taken to be at rest.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..core.arrays import Columns, Numbers
from ..core.types import Event, EventKind, Mode

SLIP_TIMES = 5.0     # the threshold, which a slip exceeds at its peak
_OF_EVENTS = 'position', 'velocity', 'drive_position', 'drive_force', 'friction_force'


def breaks_away(event: Event) -> bool:
    """Return whether the slider breaks away here, and moves."""
    return event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK


def begins_slip(event: Event) -> bool:
    """Return whether a slip begins here: at a break-away, or where the direction reverses at once."""
    return event.kind == EventKind.REVERSE or breaks_away(event)


def elapsed(begin: Event, end: Event) -> float:
    """Return the seconds between two events, without losing digits late in a run."""
    return (end.second - begin.second) + (end.fraction - begin.fraction)


def complete_slips(events: Sequence[Event]) -> list[tuple[Event, Event]]:
    """Return where each slip begins and ends that is complete: break-away (or reversal) and standstill."""
    found: list[tuple[Event, Event]] = []
    begin: Event | None = None
    for event in events:
        if event.kind in (EventKind.STICK, EventKind.REVERSE) and begin is not None:
            found.append((begin, event))
            begin = None
        if begins_slip(event):
            begin = event
    return found


def complete_sticks(events: Sequence[Event]) -> list[tuple[Event, Event]]:
    """Return where each stick begins and ends that is complete: standstill, or the end of a yield, and the break-away.

    A stick that ends as its contact yields is none.
    """
    found: list[tuple[Event, Event]] = []
    begin: Event | None = None
    for event in events:
        if breaks_away(event) and begin is not None:
            found.append((begin, event))
            begin = None
        elif event.kind in (EventKind.STICK, EventKind.YIELD):
            begin = event if event.kind == EventKind.STICK else None
    return found


class SlipRows(NamedTuple):
    """The first row of a slip, the first behind it, that of its peak, and its direction."""

    first: int
    end: int
    peak: int
    direction: int


def slips_of(velocity: Numbers, threshold: float) -> Iterator[SlipRows]:
    """Yield the slips in a column of velocities, m/s."""
    return (rows for rows in stretches_of(velocity, threshold) if abs(velocity[rows.peak]) > SLIP_TIMES * threshold)


def stretches_of(velocity: Numbers, threshold: float | Numbers) -> Iterator[SlipRows]:
    """Yield the stretches of one sign in a column of velocities, where they pass a threshold, one or one a row, m/s."""
    ways = (velocity > threshold).astype(np.int8) - (velocity < -threshold)   # small, of ten million
    edges = [0, *(np.flatnonzero(np.diff(ways)) + 1).tolist(), len(ways)]
    for first, end in pairwise(edges):
        if ways[first]:
            part, way = velocity[first:end], int(ways[first])
            yield SlipRows(first, end, first + int(part.argmax() if way > 0 else part.argmin()), way)


def events_of_slips(samples: Columns, threshold: float) -> list[Event]:
    """Return break-away and standstill where the speed passes a threshold, m/s, and between them its peak."""
    found: list[Event] = []
    rested = float(samples['time'][0])
    for first, end, peak, direction in slips_of(samples['velocity'], threshold):
        if first > 0:
            time = _passed(samples, first, threshold)
            found.append(_event(samples, time, EventKind.BREAKAWAY, Mode.ACCELERATING, direction, time - rested))
        found.append(_event(samples, float(samples['time'][peak]), EventKind.DECELERATE, Mode.DECELERATING, direction))
        if end < len(samples['time']):
            rested = _passed(samples, end, threshold)
            found.append(_event(samples, rested, EventKind.STICK, Mode.STICK, direction))
    return found


def _passed(samples: Columns, row: int, threshold: float) -> float:
    """Return when the speed passes a threshold between the row before and this one, s."""
    before, after = samples['time'][row - 1:row + 1].tolist()
    low, high = np.abs(samples['velocity'][row - 1:row + 1]).tolist()
    share = min(max((threshold - low) / (high - low), 0.0), 1.0) if high != low else 1.0
    return float(before + share * (after - before))


def _event(samples: Columns, time: float, kind: EventKind, mode: Mode, direction: int, rest_time: float = np.nan
           ) -> Event:
    row = int(np.searchsorted(samples['time'], time))
    near = slice(max(row - 1, 0), row + 1)
    position, velocity, drive, force, friction = (float(np.interp(time, samples['time'][near], samples[name][near]))
                                                  for name in _OF_EVENTS)
    second = float(np.floor(time))
    return Event(second, time - second, kind, mode, direction, position, velocity, drive, force, friction, np.nan,
                 rest_time)
