# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of a run, from its events alone: the cycles of stick-slip, and what they amount to.

A cycle reaches from one break-away to the next.  Between two events the speed has no maximum of its own, so that the
figures are as exact as the events.
"""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from .solvers.exact.cycles import SETTLED
from .words import Event, EventKind, Mode

AVERAGED = 10    # cycles at the end of the run that the means are taken over


class Cycle(NamedTuple):
    """One slip and the stick after it, up to the next break-away.

    A reversal at once ends one slip and begins another; its force is the friction at standstill.
    """

    begin: float                   # s, the break-away
    direction: int                 # of the slip
    rest_time: float               # s, before the break-away
    slip_time: float               # s
    stick_time: float              # s
    period: float                  # s
    slip_travel: float             # m, from break-away to standstill
    jump: float                    # m, from break-away to break-away; differs by the give of a compliant contact
    peak_speed: float              # m/s
    break_away_force: float        # N, |friction| at the break-away
    break_away_drive_force: float  # N
    arrest_drive_force: float      # N, drive force when the slip ends
    static_coefficient: float      # at the break-away


class Span(NamedTuple):
    """A stretch of time in one mode."""

    begin: float  # s
    end: float    # s
    mode: Mode


class Summary(NamedTuple):
    """What a run amounts to."""

    motion: str                  # 'at rest', 'smooth sliding', 'single slip' or 'stick-slip'
    events: dict[EventKind, int]
    cycles: int                  # complete ones
    settled: bool                # the last two periods differ by less than SETTLED
    stick_share: float           # share of the time in stick
    last: Cycle | None
    mean: Cycle | None           # over the last `averaged` cycles
    averaged: int


def cycle_figures(events: Sequence[Event]) -> list[Cycle]:
    """Return the complete cycles of a run, in the order of time; smooth sliding has none."""
    return [_cycle(slip, following[0]) for slip, following in pairwise(_slips(events)) if _is_over(slip)]


def mode_spans(events: Sequence[Event], begin: float, end: float, mode: Mode) -> list[Span]:
    """Return which mode held when, from `begin` to `end` (s); `mode` holds until the first event."""
    spans = []
    for event in events:
        if event.mode != mode and begin < event.time < end:
            spans.append(Span(begin, event.time, mode))
            begin = event.time
        if event.time < end:
            mode = event.mode
    return [*spans, Span(begin, end, mode)]


def summary(events: Sequence[Event], duration: float, start: Mode = Mode.STICK, begin: float = 0.0) -> Summary:
    """Sum up a run of `duration` seconds that began in the mode `start` at the time `begin` (s)."""
    cycles = cycle_figures(events)
    spans = mode_spans(events, begin, begin + duration, start)
    latest = cycles[-AVERAGED:]
    counts = Counter(event.kind for event in events)
    return Summary(
        motion=_motion(events, cycles, start),
        events={kind: counts[kind] for kind in EventKind},
        cycles=len(cycles),
        settled=_is_settled(cycles),
        stick_share=math.fsum(span.end - span.begin for span in spans if span.mode == Mode.STICK) / duration,
        last=cycles[-1] if cycles else None,
        mean=_mean(latest) if latest else None,
        averaged=len(latest))


def _slips(events: Sequence[Event]) -> Iterator[list[Event]]:
    """Yield the events of each slip, from the break-away to the event that ends it or to the last one known."""
    slip: list[Event] = []
    for event in events:
        begins = event.kind == EventKind.REVERSE or (event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK)
        if slip:
            slip.append(event)
        if slip and (begins or event.mode == Mode.STICK):
            yield slip
            slip = []
        if begins:
            slip = [event]
    if slip:
        yield slip


def _is_over(slip: Sequence[Event]) -> bool:
    return len(slip) > 1 and slip[-1].kind in (EventKind.STICK, EventKind.REVERSE)


def _cycle(slip: Sequence[Event], following: Event) -> Cycle:
    first, last = slip[0], slip[-1]
    return Cycle(
        begin=first.time,
        direction=first.direction,
        rest_time=first.rest_time,
        slip_time=_elapsed(first, last),
        stick_time=_elapsed(last, following),
        period=_elapsed(first, following),
        slip_travel=first.direction * (last.position - first.position),
        jump=first.direction * (following.position - first.position),
        peak_speed=max(abs(event.velocity) for event in slip),
        break_away_force=abs(first.friction_force),
        break_away_drive_force=first.drive_force,
        arrest_drive_force=last.drive_force,
        static_coefficient=first.static_coefficient)


def _elapsed(begin: Event, end: Event) -> float:
    return (end.second - begin.second) + (end.fraction - begin.fraction)


def _mean(cycles: Sequence[Cycle]) -> Cycle:
    count = len(cycles)
    _, _, *means = (math.fsum(column) / count for column in zip(*cycles, strict=True))
    directions = {cycle.direction for cycle in cycles}
    return Cycle(cycles[0].begin, directions.pop() if len(directions) == 1 else 0, *means)


def _is_settled(cycles: Sequence[Cycle]) -> bool:
    if len(cycles) < 2:
        return False
    before, last = cycles[-2:]
    return before.direction == last.direction and abs(last.period - before.period) < SETTLED * last.period


def _motion(events: Sequence[Event], cycles: Sequence[Cycle], start: Mode) -> str:
    if cycles:
        return 'stick-slip'
    mode = events[-1].mode if events else start
    if mode != Mode.STICK:
        return 'smooth sliding'
    return 'single slip' if events or start != Mode.STICK else 'at rest'
