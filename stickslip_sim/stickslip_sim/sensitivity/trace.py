# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run that goes on only as far as its figures need, with the sequence of its events."""

from collections.abc import Callable, Sequence

import numpy as np

from ..core.arrays import Numbers
from ..core.time_grid import Instants
from ..core.types import Event, Instant, Sample
from ..figures.rounds import Settled, settled_round
from ..scene import Scene

EventKey = tuple[int, int, int]   # kind, mode and direction of an event

LONGEST_TRACE = 1e6        # s
_MOST_EVENTS = 50_000
_SAME = 1e-10   # relative: rounds that repeat


class Trace:
    """The `events` of a scene from 0 to `end` (s), and the samples `rows` (times, fields of `Sample`).

    The run goes on when it is asked to; raises SolverError when the solver gives up.  `times` (s) rise.
    """

    def __init__(self, scene: Scene, times: Numbers | None = None) -> None:
        self.times = np.empty(0) if times is None else times
        self.rows = np.empty((len(self.times), len(Sample._fields)))
        self.events: list[Event] = []
        self.sequence: list[EventKey] = []
        self.end = 0.0
        self._rig = scene.make_rig()
        if len(self.times):
            seconds = np.floor(self.times)
            self._take(self._rig.take_samples(Instants(seconds, self.times - seconds), self.rows))
            self.end = float(self.times[-1])

    def extend(self, end: float) -> None:
        """Go on to a time, s, unless the run is there."""
        if end <= self.end:
            return
        second = float(np.floor(end))
        self._take(self._rig.advance(Instant(second, end - second)))
        self._rig.simulator.require_sound()
        self.end = end

    def extend_until(self, is_enough: Callable[['Trace'], bool], least: float) -> bool:
        """Go on to `least` s, then twice as long, and so on until it is enough; return whether it is."""
        self.extend(least)
        while not is_enough(self):
            if self.end >= LONGEST_TRACE or len(self.events) >= _MOST_EVENTS:
                return False
            self.extend(min(2.0 * self.end, LONGEST_TRACE))
        return True

    @property
    def settled(self) -> Settled | None:
        """The last round, once it repeats another to _SAME; None while it does not."""
        return settled_round(self.events, _SAME)

    def _take(self, events: Sequence[Event]) -> None:
        self.events += events
        self.sequence += [(event.kind, event.mode, event.direction) for event in events]
