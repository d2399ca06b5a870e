# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The time history of a run, whether it was simulated just now or recorded: samples, exact events, and the scene."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.types import Event, EventKind, Mode
from ..runs.offline import Columns
from ..scene import Scene
from ..simulation.cycles import Cycle, Summary, cycle_figures, summary

Numbers = NDArray[np.float64]

_STEADY = 1e-9   # relative: inputs that vary less are constant
_DRAWN = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_force', 'friction_force', 'mode')


class Inputs(NamedTuple):
    """Inputs that do not change."""

    velocity: float   # m/s, of the drive
    force: float      # N


@dataclass(frozen=True)
class History:
    """A run from its first to its last sample.

    `samples` are columns of `types.Sample` and `time`, each just after what happened at its instant; the external force
    may be missing.  `notes` say what a user must know; `is_changed`: parameters were changed while it ran.
    """

    name: str
    source: str
    scene: Scene
    samples: Columns
    events: list[Event]
    notes: tuple[str, ...] = ()
    is_recorded: bool = False
    is_changed: bool = False

    @property
    def begin(self) -> float:
        """Time of the first sample, s."""
        return float(self.samples['time'][0])

    @property
    def end(self) -> float:
        """Time of the last sample, s."""
        return float(self.samples['time'][-1])

    @cached_property
    def summary(self) -> Summary:
        """What the run amounts to."""
        return summary(self.events, self.end - self.begin, Mode(int(self.samples['mode'][0])), self.begin)

    @cached_property
    def cycles(self) -> list[Cycle]:
        """The complete cycles."""
        return cycle_figures(self.events)

    @cached_property
    def applied_force(self) -> Numbers:
        """The external force at the samples, N, from the balance m ẍ = F_d + F_e − F."""
        inertia: Numbers = self.scene.axis.mass * self.samples['acceleration']
        return inertia + self.samples['friction_force'] - self.samples['drive_force']

    @cached_property
    def drawn(self) -> Columns:
        """The samples and the state just before each event, so that corners and jumps are where they are."""
        before = self._before_events()
        times = np.concatenate([before['time'], self.samples['time']])
        order = np.argsort(times, kind='stable')   # at equal times the state before comes first
        return {name: np.concatenate([before[name], self.samples[name]])[order] for name in _DRAWN}

    def within(self, begin: float, end: float) -> Columns:
        """Return `drawn` from `begin` to `end` (s)."""
        inside = rows(self.drawn['time'], begin, end)
        return {name: column[inside] for name, column in self.drawn.items()}

    def steady_inputs(self, begin: float = -math.inf, end: float = math.inf) -> Inputs | None:
        """Return the drive velocity and the external force between two times (s); None when they are not constant."""
        inside = rows(self.samples['time'], begin, end)
        if inside.start >= inside.stop:
            return None
        velocity, force = self.samples['drive_velocity'][inside], self.applied_force[inside]
        scale = max(np.abs(self.samples[name][inside]).max() for name in ('friction_force', 'drive_force'))
        if np.ptp(velocity) > _STEADY * np.abs(velocity).max() or np.ptp(force) > _STEADY * scale:
            return None
        return Inputs(float(velocity[0]), float(np.median(force)) if np.abs(force).max() > _STEADY * scale else 0.0)

    def _before_events(self) -> Columns:
        """Return the state just before each event; the acceleration is that of the balance of forces."""
        events, samples = self.events, self.samples
        columns = {name: np.array([getattr(event, name) for event in events], dtype=np.float64)
                   for name in ('time', 'position', 'velocity', 'drive_position', 'drive_force', 'friction_force')}
        applied = np.interp(columns['time'], samples['time'], self.applied_force)
        columns['acceleration'] = (columns['drive_force'] + applied - columns['friction_force']) / self.scene.axis.mass
        modes = [Mode(int(samples['mode'][0])), *(event.mode for event in events[:-1])][:len(events)]
        columns['mode'] = np.array(modes, dtype=np.float64)
        return columns


def rows(time: Numbers, begin: float, end: float) -> slice:
    """Return the rows from `begin` to `end` (s), both included, of a column of times that rises."""
    return slice(int(np.searchsorted(time, begin)), int(np.searchsorted(time, end, side='right')))


def slips(history: History) -> list[tuple[Event, Event]]:
    """Return where each slip begins and ends that is complete: break-away (or reversal) and standstill."""
    found: list[tuple[Event, Event]] = []
    begin: Event | None = None
    for event in history.events:
        if event.kind in (EventKind.STICK, EventKind.REVERSE) and begin is not None:
            found.append((begin, event))
            begin = None
        if event.kind == EventKind.REVERSE or (event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK):
            begin = event
    return found


def sticks(history: History) -> list[tuple[Event, Event]]:
    """Return where each stick begins and ends that is complete: standstill and the break-away from there."""
    found: list[tuple[Event, Event]] = []
    begin: Event | None = None
    for event in history.events:
        if event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK and begin is not None:
            found.append((begin, event))
            begin = None
        elif event.kind == EventKind.STICK:
            begin = event
    return found
