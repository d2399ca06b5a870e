# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Which parts of a run are worth a picture."""

import math

from ..core.types import EventKind
from ..plots.paper_panels import DrawnMotion, Stretch
from .history import History, slips

_CYCLES = 5                    # that show how the motion begins
_IN_ORBIT = 30                 # that show where it goes
_BEFORE, _AFTER = 0.25, 0.75   # of a slip's duration: what is shown of the sticks around it
_BEGINNING = 0.1               # of a slip without an end: what is shown


def motion_of(history: History) -> DrawnMotion:
    """Return what is drawn of a run: its first cycles, its last complete slip, its last complete cycle."""
    slip, break_away = _slip(history)
    return DrawnMotion(history.drawn, _opening(history), slip, break_away, _orbit(history), _cycle(history))


def _opening(history: History) -> Stretch:
    cycles = history.cycles
    if not cycles:
        return history.begin, history.end
    last = cycles[min(_CYCLES, len(cycles)) - 1]
    return history.begin, min(last.begin + last.period + _AFTER * last.slip_time, history.end)


def _slip(history: History) -> tuple[Stretch, float | None]:
    """Return the last slip with a stick after it and its break-away, or how the first slip begins."""
    last = history.cycles[-1].begin if history.cycles else math.inf
    complete = [slip for slip in slips(history) if slip[0].time <= last]
    if complete:
        begin, end = complete[-1][0].time, complete[-1][1].time
        length = end - begin
        return (max(begin - _BEFORE * length, history.begin), min(end + _AFTER * length, history.end)), begin
    first = next((event.time for event in history.events if event.kind == EventKind.BREAKAWAY), None)
    if first is None:
        return (history.begin, history.end), None
    return (history.begin, first + _BEGINNING * (history.end - first)), first


def _orbit(history: History) -> Stretch:
    """Return as many cycles as a picture can show."""
    cycles = history.cycles
    return history.begin, cycles[_IN_ORBIT].begin if len(cycles) > _IN_ORBIT else history.end


def _cycle(history: History) -> Stretch | None:
    if not history.cycles:
        return None
    last = history.cycles[-1]
    return last.begin, last.begin + last.period
