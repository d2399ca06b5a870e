# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How wrong a run is: its events paired with those of the reference; missed, invented, late, and out of place.

What counts are the events at which the slider starts or stops (break-away, stick, reverse), because every solver has
them; the sub-modes of a slip are compared too, apart.  Events of one kind and direction are paired in order, so that
the sum of their distances in time is least; a pair further apart than half the usual distance of such events is none.
"""

import statistics
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from ..core.types import Event, EventKind
from .problem import Outcome

BOUNDARIES = (EventKind.BREAKAWAY, EventKind.STICK, EventKind.REVERSE)
SUB_MODES = (EventKind.COAST, EventKind.ACCELERATE, EventKind.DECELERATE)

_Point = tuple[float, float]   # time s, position m


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
    boundaries = _compare(outcome, truth, BOUNDARIES, duration)
    sub_modes = _compare(outcome, truth, SUB_MODES, duration)
    kinds = [int(kind) for kind in outcome.events[:, 1]]
    return Errors(sum(kind in BOUNDARIES for kind in kinds), sum(e.kind in BOUNDARIES for e in truth.events),
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


def window(want: Sequence[_Point], duration: float) -> float:
    """Return how far apart in time a pair may be, s."""
    gaps = [b[0] - a[0] for a, b in pairwise(want)]
    return 0.5 * statistics.median(gaps) if gaps else duration


def pair(want: Sequence[_Point], got: Sequence[_Point], apart: float) -> list[tuple[_Point, _Point]]:
    """Return the pairs of least total distance in time, in order, none further apart than `apart`."""
    if len(want) == len(got) and all(abs(a[0] - b[0]) <= apart for a, b in zip(want, got)):
        return list(zip(want, got))
    # cost of the best pairing of the rest; leaving one out on either side costs half of `apart`
    alone = 0.5 * apart
    n = len(got)
    rows = [[alone * (n - j) for j in range(n + 1)]]
    for a in reversed(want):
        below, row = rows[-1], [0.0] * (n + 1)
        row[n] = below[n] + alone
        for j in range(n - 1, -1, -1):
            row[j] = min(below[j] + alone, row[j + 1] + alone, below[j + 1] + abs(a[0] - got[j][0]))
        rows.append(row)
    rows.reverse()
    return _walk(want, got, rows, apart, alone)


def _walk(want: Sequence[_Point], got: Sequence[_Point], rows: list[list[float]], apart: float,
          alone: float) -> list[tuple[_Point, _Point]]:
    """Follow the cheapest way through the table of costs."""
    pairs, i, j = [], 0, 0
    while i < len(want) and j < len(got):
        distance = abs(want[i][0] - got[j][0])
        if distance <= apart and rows[i][j] == rows[i + 1][j + 1] + distance:
            pairs.append((want[i], got[j]))
            i, j = i + 1, j + 1
        elif rows[i][j] == rows[i + 1][j] + alone:
            i += 1
        else:
            j += 1
    return pairs
