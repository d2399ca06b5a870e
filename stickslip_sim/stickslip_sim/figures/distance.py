# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How far apart two runs are.  Four meanings for their lists of events, each written once.

* `pair`: least cost.  Lists that may have missed and invented events are paired so that the sum of distances is least.
* `shift_between`: common prefix.  The largest shift up to where the runs part; a cycle that one run alone has is seen
  although it leaves the kinds of the events as they are.
* `first_mismatch`: the first pair of another kind or direction; up to there events are compared one by one.
* `first_difference`: equality to the bit.

And by figures, relative to their size: `distance_between` runs, `cycle_difference` of two cycles.
"""

import math
import statistics
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from ..core.types import Event, EventKind, Sample
from .catalogue import COMPARED, label_of
from .cycles import AVERAGED, Cycle, cycle_figures, mean_cycle, summary
from .slips import elapsed

MOMENT = 1e-6   # s; a coast this short after a break-away hangs on the last remains of a contact's ring-down
CYCLE_EVENTS = (EventKind.BREAKAWAY, EventKind.STICK, EventKind.REVERSE)   # where the slider starts or stops

Point = tuple[float, float]   # time s, position m


class Shift(NamedTuple):
    """The largest distances of an event from that of the other run, s and m, up to the time `until`, s."""

    time: float
    position: float
    until: float


def seconds_between(event: Event, other: Event) -> float:
    """Return the distance in time of two events, s, without losing digits late in a run."""
    return abs(elapsed(event, other))


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


def first_difference(events: Sequence[object], others: Sequence[object]) -> int | None:
    """Return the index of the first event that is not the same to the bit, or missing in one list; None if none is."""
    first = next((i for i, (a, b) in enumerate(zip(events, others)) if a != b), min(len(events), len(others)))
    return first if first < max(len(events), len(others)) else None


def first_mismatch(events: Sequence[Event], others: Sequence[Event]) -> int:
    """Return the index of the first pair of another kind or direction, or that of the end of the shorter list."""
    return next((i for i, (a, b) in enumerate(zip(events, others)) if (a.kind, a.direction) != (b.kind, b.direction)),
                min(len(events), len(others)))


def event_difference(events: Sequence[Event], others: Sequence[Event], duration: float) -> float:
    """Return the largest shift of an event, or the time that is left once the events differ, over the duration.

    They differ from the first pair on that is of another kind or direction, or from the first event without a partner.
    """
    common = first_mismatch(events, others)
    shift = max((seconds_between(a, b) for a, b in zip(events[:common], others)), default=0.0)
    parted = [run[common].time for run in (events, others) if len(run) > common]
    return max(shift, duration - min(parted) if parted else 0.0) / duration


def shift_between(events: Sequence[Event], others: Sequence[Event], duration: float) -> Shift:
    """Return how far two runs are apart up to the last time at which both have had the same events."""
    count = _same(events, others)
    rest = [event.time for run in (events, others) for event in run[count:count + 1]]
    until = min(rest, default=duration)
    while count and max(events[count - 1].time, others[count - 1].time) > until:   # one run has it, the other not yet
        count -= 1
        until = min(events[count].time, others[count].time)
    pairs = list(zip(events[:count], others))
    return Shift(max((seconds_between(a, b) for a, b in pairs), default=0.0),
                 max((abs(a.position - b.position) for a, b in pairs), default=0.0), until)


def _same(events: Sequence[Event], others: Sequence[Event]) -> int:
    """Return how many events, in their order, are the same ones in two runs."""
    common = first_mismatch(events, others)
    for i, (a, b, after_a, after_b) in enumerate(zip(events[:common], others, _next_of_a_kind(events),
                                                     _next_of_a_kind(others))):
        # a cycle that one run alone has leaves the kinds as they are; what follows is nearer to the event after
        if min(abs(after_a - b.time), abs(after_b - a.time)) < seconds_between(a, b):
            return i
    return common


def _next_of_a_kind(events: Sequence[Event]) -> list[float]:
    """Return for each break-away, stop or reversal when the next of its kind and direction comes; else infinity."""
    times: list[float] = []
    coming: dict[tuple[EventKind, int], float] = {}
    for event in reversed(events):
        name = event.kind, event.direction
        times.append(coming.get(name, math.inf))
        if event.kind in CYCLE_EVENTS:
            coming[name] = event.time
    return times[::-1]


def window(want: Sequence[Point], duration: float) -> float:
    """Return how far apart in time a pair may be, s: half the usual distance of such events."""
    gaps = [b[0] - a[0] for a, b in pairwise(want)]
    return 0.5 * statistics.median(gaps) if gaps else duration


def pair(want: Sequence[Point], got: Sequence[Point], apart: float) -> list[tuple[Point, Point]]:
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


def _walk(want: Sequence[Point], got: Sequence[Point], rows: list[list[float]], apart: float,
          alone: float) -> list[tuple[Point, Point]]:
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


# By figures: cycle figures relative to themselves, the share of stick and the times of events to the duration, the
# position at the end to the travel; so one tolerance fits all.

ANOTHER_MOTION = 'kind of motion'


def cycle_difference(one: Cycle, other: Cycle) -> float:
    """Return the largest relative difference of two cycles in any of the figures COMPARED."""
    pairs = [(getattr(one, name), getattr(other, name)) for name in COMPARED]
    return max(abs(b - a) / max(abs(a), abs(b)) if a != b else 0.0 for a, b in pairs)


class RunFigures(NamedTuple):
    """The compared figures of a run: `events` are where slips begin and end; positions in m, `duration` in s."""

    motion: str
    duration: float
    events: list[Event]
    cycles: list[Cycle]
    peak_speed: float          # m/s, of the whole run; 0 without a slip, even if the contact drifts
    break_away_force: float    # N, of the first break-away; 0 without one
    stick_share: float
    end_position: float
    travel: float              # of slider or drive, whichever goes further


class Distance(NamedTuple):
    """By how much runs differ: relative, by figure; those that do not exist in either run are left out."""

    by_figure: Mapping[str, float]

    @property
    def largest(self) -> float:
        """The largest relative difference; infinite when the motion is of another kind."""
        return max(self.by_figure.values())

    @property
    def figure(self) -> str:
        """The figure that differs most."""
        return max(self.by_figure, key=lambda name: self.by_figure[name])


def run_figures(events: Sequence[Event], duration: float, start: Sample, end: Sample) -> RunFigures:
    """Return the figures of a run of `duration` s from its events and its first and last sample."""
    outline = summary(events, duration, start.mode)
    boundaries = [event for event in events if event.kind in CYCLE_EVENTS]
    slips = [event for event in boundaries if event.kind == EventKind.BREAKAWAY]
    points: list[Event | Sample] = [start, *events, end]
    return RunFigures(
        outline.motion, duration, boundaries, cycle_figures(events),
        peak_speed=max(abs(point.velocity) for point in points) if outline.motion != 'at rest' else 0.0,
        break_away_force=abs(slips[0].friction_force) if slips else 0.0,
        stick_share=outline.stick_share,
        end_position=end.position,
        travel=max(_range([point.position for point in points]), _range([point.drive_position for point in points])))


def distance_between(reference: RunFigures, other: RunFigures) -> Distance:
    """Compare a run with the reference, of the same duration."""
    if other.motion != reference.motion:
        return Distance({ANOTHER_MOTION: math.inf})
    found = {'event times': event_difference(reference.events, other.events, reference.duration),
             label_of('stick_share'): abs(other.stick_share - reference.stick_share)}
    if reference.travel > 0.0:
        found['end position'] = abs(other.end_position - reference.end_position) / reference.travel
    for name, (a, b) in _pairs(reference, other).items():
        if a != 0.0:
            found[name] = abs(b - a) / abs(a)
    return Distance(found)


def _pairs(reference: RunFigures, other: RunFigures) -> dict[str, tuple[float, float]]:
    """Return figures of both; cycles by their means over the last ones that both runs have."""
    common = min(len(reference.cycles), len(other.cycles))
    if common == 0:
        return {label_of(name): (getattr(reference, name), getattr(other, name)) for name in COMPARED[2:]}
    latest = slice(max(0, common - AVERAGED), common)
    means = [mean_cycle(run.cycles[latest]) for run in (reference, other)]
    return {label_of(name): (getattr(means[0], name), getattr(means[1], name)) for name in COMPARED}


def _range(values: Sequence[float]) -> float:
    return max(values) - min(values)
