# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run cut where its slips begin: each part has a slip and the stick after it, and is small however long the run."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core.types import Event, EventKind, Mode
from ..runs import Columns, Run
from ..runs.reduced import ReducedWindow
from ..runs.samples import MOST_HELD, joined
from ..scene import Scene

APPLIED = 'applied_force'   # the external force as the balance of forces has it
SEEN = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force',
        'friction_force', 'mode', APPLIED)


@dataclass(frozen=True)
class RunPart:
    """A part of a run from `begin` to `end` (s); its samples have one more on either side.

    When it `is_closed`, the last of its events is the first of the next part.
    """

    scene: Scene
    begin: float
    end: float
    is_closed: bool
    events: Sequence[Event]
    before: Columns    # the state just before each event
    samples: Columns   # SEEN, and perhaps more


class PartCutter:
    """Cuts a run into parts; `before` are the states before its events, known up to the samples that are taken."""

    def __init__(self, run: Run, before: Columns) -> None:
        self._scene, self._events, self._before = run.scene, run.events, before
        self._spans = _spans(run)
        self._span = next(self._spans)
        self._held: Columns = {}                  # samples, from one before the part under way on
        self._long: ReducedWindow | None = None   # takes them in its place where they are many

    def take(self, block: Columns) -> Iterator[RunPart]:
        """Take the next samples; yield the parts that end before the last of them."""
        self._held = joined([self._held, block]) if self._held else block
        if self._long:
            self._long.take(block)
        while self._span.is_closed and self._span.end < block['time'][-1]:
            yield self.under_way
            self._span, self._long = next(self._spans), None
        first = int(np.searchsorted(self._held['time'], self._span.begin))
        if not self._long and len(self._held['time']) - first > MOST_HELD:
            self._long = ReducedWindow(self._span.begin, self._span.end, SEEN, is_whole_first=True)
            self._long.take(self._held)
        self._held = _rows(self._held, slice(-1 if self._long else max(first - 1, 0), None))

    @property
    def under_way(self) -> RunPart:
        """The part under way, as far as its samples were taken."""
        first, last, begin, end, is_closed = self._span
        if self._long:
            samples = self._long.columns
        else:
            samples = _rows(self._held, slice(max(int(np.searchsorted(self._held['time'], begin)) - 1, 0),
                                              int(np.searchsorted(self._held['time'], end, 'right')) + 1))
        return RunPart(self._scene, begin, end, is_closed, self._events[first:last],
                       _rows(self._before, slice(first, last)), samples)


def begins_slip(event: Event) -> bool:
    """Return whether a slip begins here: at a break-away, or where the direction reverses at once."""
    return event.kind == EventKind.REVERSE or (event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK)


class _Span(NamedTuple):
    """The events of a part, from the first to the one behind the last, and its time, s."""

    first: int
    last: int
    begin: float
    end: float
    is_closed: bool


def _spans(run: Run) -> Iterator[_Span]:
    """Yield the parts of a run, from its start to its end."""
    first, begin = 0, run.begin
    for k, event in enumerate(run.events):
        if begins_slip(event):
            yield _Span(first, k + 1, begin, event.time, True)
            first, begin = k, event.time
    yield _Span(first, len(run.events), begin, run.end, False)


def _rows(columns: Columns, rows: slice) -> Columns:
    return {name: column[rows] for name, column in columns.items()}
