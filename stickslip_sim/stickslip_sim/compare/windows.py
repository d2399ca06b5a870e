# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Which parts of a run are worth a picture."""

import math
from collections.abc import Iterable

import numpy as np

from ..core.types import EventKind
from ..plots.paper_panels import RANGED, DrawnMotion, Stretch
from ..plots.side_by_side import ALIKE
from ..runs import Run
from ..runs.samples import joined
from .drawn import before_events, complete_slips, least_and_most, within

_CYCLES = 5                    # that show how the motion begins
_IN_ORBIT = 30                 # that show where it goes
_BEFORE, _AFTER = 0.25, 0.75   # of a slip's duration: what is shown of the sticks around it
_BEGINNING = 0.1               # of a slip without an end: what is shown


def drawn_motion(run: Run) -> DrawnMotion:
    """Return what is drawn of a run: its first cycles, its last complete slip, its last complete cycle."""
    opening, (slip, break_away), orbit, cycle = _opening(run), _slip(run), _orbit(run), _cycle(run)
    begin, end = opening
    beside = begin, begin + ALIKE * (end - begin)   # beside other runs as much of it may be drawn
    drawn = [beside, slip, orbit, *([cycle] if cycle else [])]
    columns = joined([within(run, *stretch) for stretch in _apart([_with_neighbours(run, *each) for each in drawn])])
    ranges = {name: least_and_most(run, quantity) for name, quantity in RANGED.items()}
    return DrawnMotion(columns, opening, slip, break_away, orbit, cycle, ranges)


def _with_neighbours(run: Run, begin: float, end: float) -> Stretch:
    """Return a stretch up to what is drawn just before and just after it."""
    all_times = [source['time'] for source in (before_events(run), run.samples)]
    before = [time[k] for time in all_times if (k := int(np.searchsorted(time, begin, 'right')) - 1) >= 0]
    after = [time[k] for time in all_times if (k := int(np.searchsorted(time, end))) < len(time)]
    return float(max(before, default=begin)), float(min(after, default=end))


def _apart(stretches: Iterable[Stretch]) -> list[Stretch]:
    """Return stretches that cover the same, in the order of time, none of them at another."""
    found: list[Stretch] = []
    for begin, end in sorted(stretches):
        if found and begin <= found[-1][1]:
            begin, end = found[-1][0], max(found.pop()[1], end)
        found.append((begin, end))
    return found


def _opening(run: Run) -> Stretch:
    cycles = run.cycles()
    if not cycles:
        return run.begin, run.end
    last = cycles[min(_CYCLES, len(cycles)) - 1]
    return run.begin, min(last.begin + last.period + _AFTER * last.slip_time, run.end)


def _slip(run: Run) -> tuple[Stretch, float | None]:
    """Return the last slip with a stick after it and its break-away, or how the first slip begins."""
    last = run.cycles()[-1].begin if run.cycles() else math.inf
    complete = [slip for slip in complete_slips(run) if slip[0].time <= last]
    if complete:
        begin, end = complete[-1][0].time, complete[-1][1].time
        length = end - begin
        return (max(begin - _BEFORE * length, run.begin), min(end + _AFTER * length, run.end)), begin
    first = next((event.time for event in run.events if event.kind == EventKind.BREAKAWAY), None)
    if first is None:
        return (run.begin, run.end), None
    return (run.begin, first + _BEGINNING * (run.end - first)), first


def _orbit(run: Run) -> Stretch:
    """Return as many cycles as a picture can show."""
    cycles = run.cycles()
    return run.begin, cycles[_IN_ORBIT].begin if len(cycles) > _IN_ORBIT else run.end


def _cycle(run: Run) -> Stretch | None:
    if not run.cycles():
        return None
    last = run.cycles()[-1]
    return last.begin, last.begin + last.period
