# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Which parts of a run are worth a picture."""

import math
from typing import NamedTuple

from ..core.types import EventKind
from ..plots.paper_panels import DrawnSpan
from ..plots.side_by_side import ALIKE
from ..runs import Run
from .drawn import complete_slips

_CYCLES = 5                    # that show how the motion begins
_IN_ORBIT = 30                 # that show where it goes
_BEFORE, _AFTER = 0.25, 0.75   # of a slip's duration: what is shown of the sticks around it
_BEGINNING = 0.1               # of a slip without an end: what is shown


class DrawnStretches(NamedTuple):
    """What is drawn of a run: its first cycles, its last complete slip, its last complete cycle (DrawnMotion)."""

    opening: DrawnSpan
    slip: DrawnSpan
    break_away: float | None
    orbit: DrawnSpan
    cycle: DrawnSpan | None

    @property
    def all(self) -> list[DrawnSpan]:
        """All stretches of which the samples are needed: beside other runs more of the opening may be drawn."""
        begin, end = self.opening
        beside = begin, begin + ALIKE * (end - begin)
        return [beside, self.slip, self.orbit, *([self.cycle] if self.cycle else [])]


def drawn_stretches(run: Run) -> DrawnStretches:
    """Return what is drawn of a run."""
    return DrawnStretches(_opening(run), *_slip(run), _orbit(run), _cycle(run))


def _opening(run: Run) -> DrawnSpan:
    cycles = run.cycles()
    if not cycles:
        return run.begin, run.end
    last = cycles[min(_CYCLES, len(cycles)) - 1]
    return run.begin, min(last.begin + last.period + _AFTER * last.slip_time, run.end)


def _slip(run: Run) -> tuple[DrawnSpan, float | None]:
    """Return the last slip with a stick after it and its break-away, or how the first slip begins."""
    last = run.cycles()[-1].begin if run.cycles() else math.inf
    complete = [slip for slip in complete_slips(run.events) if slip[0].time <= last]
    if complete:
        begin, end = complete[-1][0].time, complete[-1][1].time
        length = end - begin
        return (max(begin - _BEFORE * length, run.begin), min(end + _AFTER * length, run.end)), begin
    first = next((event.time for event in run.events if event.kind == EventKind.BREAKAWAY), None)
    if first is None:
        return (run.begin, run.end), None
    return (run.begin, first + _BEGINNING * (run.end - first)), first


def _orbit(run: Run) -> DrawnSpan:
    """Return as many cycles as a picture can show."""
    cycles = run.cycles()
    return run.begin, cycles[_IN_ORBIT].begin if len(cycles) > _IN_ORBIT else run.end


def _cycle(run: Run) -> DrawnSpan | None:
    if not run.cycles():
        return None
    last = run.cycles()[-1]
    return last.begin, last.begin + last.period
