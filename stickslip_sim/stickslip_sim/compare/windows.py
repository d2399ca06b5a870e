# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Which parts of a run are worth a picture."""

import math

from ..core.types import EventKind
from ..plots.paper_panels import DrawnMotion, Stretch
from ..runs import Run
from .drawn import complete_slips, drawn_columns

_CYCLES = 5                    # that show how the motion begins
_IN_ORBIT = 30                 # that show where it goes
_BEFORE, _AFTER = 0.25, 0.75   # of a slip's duration: what is shown of the sticks around it
_BEGINNING = 0.1               # of a slip without an end: what is shown


def drawn_motion(run: Run) -> DrawnMotion:
    """Return what is drawn of a run: its first cycles, its last complete slip, its last complete cycle."""
    slip, break_away = _slip(run)
    return DrawnMotion(drawn_columns(run), _opening(run), slip, break_away, _orbit(run), _cycle(run))


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
