# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run cut where its slips begin: each part has a slip and the stick after it, and is small however long the run."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core.arrays import Columns, Numbers
from ..core.types import Event
from ..figures.slips import begins_slip
from ..runs import Run
from ..runs.samples import MOST_HELD, ReducedWindow, joined
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


# What is read off a part of a run: its rows, and its inputs where they are constant.

DRAWN = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_force', 'friction_force', 'mode')
_STEADY = 1e-9   # relative: inputs that vary less are constant


class SteadyInputs(NamedTuple):
    """Inputs that do not change."""

    velocity: float   # m/s, of the drive
    force: float      # N


class InputsSeen:
    """Takes samples with APPLIED block by block, and says whether the inputs were constant."""

    def __init__(self) -> None:
        self._velocity, self._force = [math.inf, -math.inf], [math.inf, -math.inf]   # the least, the most
        self._scale = 0.0                 # N
        self._first = math.nan            # m/s
        self._medians: list[float] = []   # N, of the blocks

    def take(self, samples: Columns, inside: slice) -> None:
        """Take some rows of samples, at least one."""
        velocity, force = samples['drive_velocity'][inside], samples[APPLIED][inside]
        if not self._medians:
            self._first = float(velocity[0])
        for seen, values in ((self._velocity, velocity), (self._force, force)):
            seen[:] = min(seen[0], float(values.min())), max(seen[1], float(values.max()))
        self._scale = max(self._scale, *(float(np.abs(samples[name][inside]).max())
                                         for name in ('friction_force', 'drive_force')))
        self._medians.append(float(np.median(force)))

    @property
    def steady(self) -> SteadyInputs | None:
        """The inputs; None when they were not constant."""
        (slowest, fastest), (least, most), allowed = self._velocity, self._force, _STEADY * self._scale
        if fastest - slowest > _STEADY * max(abs(slowest), abs(fastest)) or most - least > allowed:
            return None
        acts = max(abs(least), abs(most)) > allowed
        return SteadyInputs(self._first, float(np.median(self._medians)) if acts else 0.0)


def within(part: RunPart, begin: float, end: float) -> Columns:
    """Return the samples from `begin` to `end` (s), and the state just before each event there.

    So corners and jumps are where they are.
    """
    return in_order(*({name: source[name][rows(source['time'], begin, end)] for name in DRAWN}
                      for source in (part.before, part.samples)))


def in_order(before: Columns, samples: Columns) -> Columns:
    """Return states before events and samples in the order of time; at equal times the state before comes first."""
    order = np.argsort(np.concatenate([before['time'], samples['time']]), kind='stable')
    return {name: np.concatenate([before[name], samples[name]])[order] for name in DRAWN}


def steady_inputs(part: RunPart, begin: float, end: float) -> SteadyInputs | None:
    """Return the drive velocity and the external force between two times (s); None when they are not constant.

    So it is under a normal load, which is no part of the axis.
    """
    if part.scene.normal_load is not None:
        return None
    inside = rows(part.samples['time'], begin, end)
    if inside.start >= inside.stop:
        return None
    seen = InputsSeen()
    seen.take(part.samples, inside)
    return seen.steady


def rows(time: Numbers, begin: float, end: float) -> slice:
    """Return the rows from `begin` to `end` (s), both included, of a column of times that rises."""
    return slice(int(np.searchsorted(time, begin)), int(np.searchsorted(time, end, side='right')))
