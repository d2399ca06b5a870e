# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What is read off a part of a run: its slips and sticks, its rows, its inputs where they are constant."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.types import Event, EventKind
from ..runs import Columns
from .run_part import APPLIED, RunPart, begins_slip

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


def complete_slips(events: Sequence[Event]) -> list[tuple[Event, Event]]:
    """Return where each slip begins and ends that is complete: break-away (or reversal) and standstill."""
    found: list[tuple[Event, Event]] = []
    begin: Event | None = None
    for event in events:
        if event.kind in (EventKind.STICK, EventKind.REVERSE) and begin is not None:
            found.append((begin, event))
            begin = None
        if begins_slip(event):
            begin = event
    return found


def complete_sticks(events: Sequence[Event]) -> list[tuple[Event, Event]]:
    """Return where each stick begins and ends that is complete: standstill, or the end of a yield, and the break-away.

    A stick that ends as its contact yields is none.
    """
    found: list[tuple[Event, Event]] = []
    begin: Event | None = None
    for event in events:
        if event.kind == EventKind.BREAKAWAY and begins_slip(event) and begin is not None:
            found.append((begin, event))
            begin = None
        elif event.kind in (EventKind.STICK, EventKind.YIELD):
            begin = event if event.kind == EventKind.STICK else None
    return found
