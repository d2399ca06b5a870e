# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The rounds of stick-slip in a run, from one break-away out of stick to the next, and whether they repeat."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from ..core.types import Event, EventKind, Mode
from ..simulation.cycles import cycle_figures
from .trace import Trace

SAME = 1e-10       # relative difference of rounds that repeat
MOST_IN_GROUP = 8


class Round(NamedTuple):
    """The figures of a round; names and meanings are those of a study (docs/maps.md)."""

    period: float             # s
    amplitude: float          # m, travel of its longest slip
    stick_share: float
    peak_speed: float         # m/s
    break_away_force: float   # N


ROUND_UNITS = Round('s', 'm', '', 'm/s', 'N')   # type: ignore[arg-type]


class Settled(NamedTuple):
    """The `number` of a round, from 0, that repeats the one `size` rounds before it."""

    number: int
    size: int


def break_aways(events: Sequence[Event]) -> list[int]:
    """Return the places of the break-aways out of stick; each begins a round, and ends the one before."""
    return [k for k, event in enumerate(events) if event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK]


def round_figures(events: Sequence[Event]) -> Round:
    """Return the figures of the events of one round, both break-aways among them."""
    cycles = cycle_figures(events)
    first, last = events[0], events[-1]
    period = (last.second - first.second) + (last.fraction - first.fraction)
    return Round(period, max(cycle.slip_travel for cycle in cycles), cycles[-1].stick_time / period,
                 max(cycle.peak_speed for cycle in cycles), abs(first.friction_force))


def settled_round(trace: Trace) -> Settled | None:
    """Return the last round, and after how many it comes again; None while it does not."""
    places = break_aways(trace.events)
    kept = places[-2 * MOST_IN_GROUP - 1:]
    ends = [trace.events[place] for place in kept]
    periods = [(b.second - a.second) + (b.fraction - a.fraction) for a, b in pairwise(ends)]
    for size in range(1, len(periods) // 2 + 1):
        pairs = [(len(periods) - k, len(periods) - k - size) for k in range(1, size + 1)]
        if all(_is_close(periods[a], periods[b]) and _is_close(ends[a + 1].drive_force, ends[b + 1].drive_force)
               for a, b in pairs):
            return Settled(len(places) - 2, size)
    return None


def _is_close(a: float, b: float) -> bool:
    return abs(a - b) <= SAME * abs(a)
