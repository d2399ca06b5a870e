# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One look through a run, sample by sample, for all that is said and drawn of it.

However long it is, its samples pass by in blocks; what remains is small.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from ..core.arrays import Numbers
from ..core.types import Mode
from ..plots.paper_panels import RANGED
from ..runs import Columns, Run
from ..runs.reduced import ReducedWindows
from .drawn import DRAWN, InputsSeen, SteadyInputs
from .run_part import APPLIED, SEEN, PartCutter, RunPart
from .windows import drawn_stretches

Watch = Callable[[RunPart], Any]

_OF_EVENTS = 'time', 'position', 'velocity', 'drive_position', 'drive_force', 'friction_force'


class RunLook(NamedTuple):
    """What a look through a run left."""

    first: dict[str, float]                    # sample, with APPLIED
    steady: SteadyInputs | None                # of all of it; None under a load, which is no part of the axis
    before: Columns                            # the state just before each event
    ranges: Mapping[str, tuple[float, float]]  # the lowest and the highest value of RANGED
    drawn: Columns                             # samples of the stretches that are drawn
    found: Mapping[str, list[Any]]             # what each watch found of each part


_LOOKS: WeakKeyDictionary[Run, RunLook] = WeakKeyDictionary()


def look_at(run: Run) -> RunLook:
    """Return what a look through a run left: the one with watches where there was one."""
    return _LOOKS[run] if run in _LOOKS else watched(run, {})


def watched(run: Run, watches: Mapping[str, Watch]) -> RunLook:
    """Look through a run with watches by their names, each for every part of it."""
    before, inputs, ranges = _BeforeEvents(run), InputsSeen(), _Ranges()
    cutter, drawn = PartCutter(run, before.columns), ReducedWindows(drawn_stretches(run).all, DRAWN)
    found: dict[str, list[Any]] = {name: [] for name in watches}
    first: dict[str, float] = {}
    mass = run.scene.axis.mass
    for columns in run.sample_blocks():
        applied = mass * columns['acceleration'] + columns['friction_force'] - columns['drive_force']
        applied += run.scene.axis.slideway_damping * columns['velocity']
        block = {name: applied if name == APPLIED else columns[name] for name in SEEN}
        first = first or {name: float(column[0]) for name, column in {**columns, APPLIED: applied}.items()}
        before.take(block)
        inputs.take(block, slice(None))
        ranges.take(block)
        drawn.take(block)
        if watches:
            for part in cutter.take(block):
                _watch(part, watches, found)
    before.finish()
    ranges.take(before.columns)
    if watches:
        _watch(cutter.under_way, watches, found)
    steady = inputs.steady if run.scene.normal_load is None else None
    _LOOKS[run] = RunLook(first, steady, before.columns, ranges.found, drawn.columns, found)
    return _LOOKS[run]


def _watch(part: RunPart, watches: Mapping[str, Watch], found: Mapping[str, list[Any]]) -> None:
    for name, watch in watches.items():
        found[name].append(watch(part))


class _Ranges:
    """Takes columns; `found` are the lowest and the highest value of RANGED in them."""

    def __init__(self) -> None:
        self.found: dict[str, tuple[float, float]] = {}

    def take(self, columns: Columns) -> None:
        for name, quantity in RANGED.items() if len(columns['time']) else ():
            values = quantity(columns)
            low, high = float(values.min()), float(values.max())
            seen = self.found.get(name, (low, high))
            self.found[name] = min(low, seen[0]), max(high, seen[1])


class _BeforeEvents:
    """The states just before the events of a run; their accelerations follow as samples are taken.

    Those are of the balance of forces: the external force is taken to be linear between samples.
    """

    def __init__(self, run: Run) -> None:
        events = run.events
        self.columns: Columns = {name: np.array([getattr(event, name) for event in events], dtype=np.float64)
                                 for name in _OF_EVENTS}
        self.columns['acceleration'] = np.full(len(events), np.nan)
        self.columns['mode'] = np.array([Mode.STICK, *(event.mode for event in events[:-1])][:len(events)],
                                        dtype=np.float64)
        self._mass, self._damping = run.scene.axis.mass, run.scene.axis.slideway_damping
        self._done = 0
        self._latest: tuple[list[float], list[float]] = [], []   # the last sample: its time and its external force

    def take(self, block: Columns) -> None:
        """Take the next samples with APPLIED."""
        time, applied = block['time'], block[APPLIED]
        if not self._latest[0]:
            self.columns['mode'][:1] = block['mode'][0]
        end = int(np.searchsorted(self.columns['time'], time[-1], 'right'))
        self._fill(end, np.concatenate([self._latest[0], time]), np.concatenate([self._latest[1], applied]))
        self._latest = [float(time[-1])], [float(applied[-1])]

    def finish(self) -> None:
        """Take what comes behind the last sample to be as there."""
        self._fill(len(self.columns['time']), *map(np.array, self._latest))

    def _fill(self, end: int, time: Numbers, applied: Numbers) -> None:
        events = slice(self._done, end)
        at_events = np.interp(self.columns['time'][events], time, applied)
        force = self.columns['drive_force'][events] + at_events - self.columns['friction_force'][events]
        force -= self._damping * self.columns['velocity'][events]
        self.columns['acceleration'][events] = force / self._mass
        self._done = end
