# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The figures whose derivatives can be taken, by their names.

* event.10.time: the tenth event of any kind; any field of an event in place of `time`
* stick.10.time: the tenth arrest; so for each kind of event
* position@0.5: a sample 0.5 s from the start; any number of a sample in place of `position`
* period, amplitude, stick_share, peak_speed, break_away_force: of the limit cycle
"""

import math
import re
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..core.errors import InputError, suggestion
from ..core.types import Event, EventKind, Sample
from ..figures.catalogue import unit_of
from ..figures.cycles import Round, round_figures
from ..figures.rounds import break_aways
from .trace import LONGEST_TRACE, Trace

_OF_EVENTS = ('time', *Event._fields[Event._fields.index('position'):])
_OF_SAMPLES = Sample._fields[Sample._fields.index('position'):]
_KINDS = {kind.name.lower(): kind for kind in EventKind}
_MOST = 10_000    # the last event that can be asked for
_FORM = ('event.N.FIELD, KIND.N.FIELD, FIELD@TIME, or one of ' + ', '.join(Round._fields))
_FIX = 'for example event.10.time, stick.3.position, position@0.5 or period (docs/sensitivities.md)'


@dataclass(frozen=True)
class EventFigure:
    """A `field` of the event `number` (from 1) of a kind, or of all."""

    name: str
    unit: str
    kind: EventKind | None
    number: int
    field: str
    time: float | None = None

    def pinned(self, trace: Trace) -> 'EventFigure':
        """Return itself; raises InputError where there are too few events."""
        if self._place(trace) is None:
            found = sum(self.kind in (None, event.kind) for event in trace.events)
            raise InputError('figure', self.name, f'of an event that this scene has; it has {found} of these within '
                             f'{trace.end:g} s', 'ask for an earlier one')
        return self

    def is_in(self, trace: Trace) -> bool:
        """Whether a run has the event."""
        return self._place(trace) is not None

    def extent(self, trace: Trace) -> tuple[int, int]:
        """Return the events up to it."""
        place = self._place(trace)
        return 0, len(trace.events) if place is None else place + 1

    def value(self, trace: Trace) -> float:
        """Return the field."""
        place = self._place(trace)
        return math.nan if place is None else float(getattr(trace.events[place], self.field))

    def _place(self, trace: Trace) -> int | None:
        if self.kind is None:
            return self.number - 1 if self.number <= len(trace.events) else None
        left = self.number
        for place, event in enumerate(trace.events):
            left -= event.kind == self.kind
            if left == 0:
                return place
        return None


@dataclass(frozen=True)
class SampleFigure:
    """A `field` of the sample at a `time`, s."""

    name: str
    unit: str
    field: str
    time: float

    def pinned(self, trace: Trace) -> 'SampleFigure':
        """Return itself."""
        return self

    def is_in(self, trace: Trace) -> bool:
        """Whether a run goes as far."""
        return trace.end >= self.time

    def extent(self, trace: Trace) -> tuple[int, int]:
        """Return the events up to its time."""
        return 0, sum(event.time <= self.time for event in trace.events)

    def value(self, trace: Trace) -> float:
        """Return the field."""
        row = int(np.searchsorted(trace.times, self.time))
        return float(trace.rows[row, Sample._fields.index(self.field)])


@dataclass(frozen=True)
class CycleFigure:
    """A figure of the limit cycle: of the round with this `index`, once it repeats."""

    name: str
    unit: str
    index: int | None = None
    size: int = 1
    time: float | None = None

    def pinned(self, trace: Trace) -> 'CycleFigure':
        """Return the figure of the last round; raises InputError where rounds do not repeat."""
        settled = trace.settled
        if settled is None:
            rounds = max(len(break_aways(trace.events)) - 1, 0)
            raise InputError('figure', self.name, 'of a limit cycle; this scene has '
                             f'{f"{rounds} rounds of stick-slip" if rounds else "no stick-slip"} within '
                             f'{trace.end:.4g} s' + (', none of which repeats the one before' if rounds else ''),
                             'take figures of events or samples, as event.10.time or position@0.5')
        return replace(self, index=settled.number, size=settled.size)

    def is_in(self, trace: Trace) -> bool:
        """Whether a run has the round; before it is known which, whether rounds repeat."""
        if self.index is None:
            return trace.settled is not None
        return len(break_aways(trace.events)) > self.index + 1

    def extent(self, trace: Trace) -> tuple[int, int]:
        """Return the events of the rounds that repeat."""
        places = break_aways(trace.events)
        assert self.index is not None
        if not self.is_in(trace):
            return len(trace.events), len(trace.events)
        return places[self.index + 1 - self.size], places[self.index + 1] + 1

    def value(self, trace: Trace) -> float:
        """Return the figure."""
        if not self.is_in(trace):
            return math.nan
        assert self.index is not None
        first, last = break_aways(trace.events)[self.index:self.index + 2]
        return float(getattr(round_figures(trace.events[first:last + 1]), self.name))


# One number of a run.  `time` is when a sample must be taken for it, s; `pinned` is the same figure in other runs as in
# this; `is_in` says whether a run is long enough for it, and `extent` which events decide it.
Figure = EventFigure | SampleFigure | CycleFigure


def figure_of(name: Any) -> Figure:
    """Return the figure of a name; raises InputError."""
    text = name.strip() if isinstance(name, str) else ''
    if text in Round._fields:
        return CycleFigure(text, unit_of(text))
    if sampled := re.fullmatch(r'(\w+)@(\S+)', text):
        return _sample_figure(text, sampled[1], sampled[2])
    if counted := re.fullmatch(r'(\w+)\.(\d{1,9})\.(\w+)', text):
        return _event_figure(text, *counted.groups())
    raise InputError('figure', name, _FORM, suggestion(text, Round._fields, _FIX))


def _event_figure(text: str, kind: str, number: str, field: str) -> EventFigure:
    if kind != 'event' and kind not in _KINDS:
        raise InputError('figure', text, 'of an event, or of one of the kinds ' + ', '.join(_KINDS),
                         suggestion(kind, ['event', *_KINDS], _FIX))
    if field not in _OF_EVENTS:
        raise InputError('figure', text, 'one of the fields ' + ', '.join(_OF_EVENTS),
                         suggestion(field, _OF_EVENTS, _FIX))
    if not 1 <= int(number) <= _MOST:
        raise InputError('figure', text, f'of an event from 1 to {_MOST}', 'count from 1')
    return EventFigure(text, unit_of(field), _KINDS.get(kind), int(number), field)


def _sample_figure(text: str, field: str, time: str) -> SampleFigure:
    if field not in _OF_SAMPLES:
        raise InputError('figure', text, 'one of the numbers ' + ', '.join(_OF_SAMPLES),
                         suggestion(field, _OF_SAMPLES, _FIX))
    try:
        seconds = float(time)
    except ValueError:
        seconds = math.nan
    if not 0.0 <= seconds <= LONGEST_TRACE:
        raise InputError('figure', text, f'at a time from 0 to {LONGEST_TRACE:g} s', 'for example position@0.5')
    return SampleFigure(text, unit_of(field), field, seconds)


def described(event: Event) -> str:
    """Return an event in words: its kind and direction."""
    return event.kind.name.lower() + (' forwards' if event.direction > 0 else ' backwards' if event.direction < 0
                                      else '')
