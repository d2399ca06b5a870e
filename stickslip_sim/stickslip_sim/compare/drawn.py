# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a comparison looks at in a run: the samples with the state before each event, the inputs, slips and sticks."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.types import Event, EventKind, Mode
from ..runs import Columns, Run
from ..runs.kept import kept

Numbers = NDArray[np.float64]

_STEADY = 1e-9   # relative: inputs that vary less are constant
_DRAWN = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_force', 'friction_force', 'mode')


class SteadyInputs(NamedTuple):
    """Inputs that do not change."""

    velocity: float   # m/s, of the drive
    force: float      # N


@kept
def external_force(run: Run) -> Numbers:
    """Return the external force at the samples, N, from the balance m ẍ = F_d + F_e − F."""
    inertia: Numbers = run.scene.axis.mass * run.samples['acceleration']
    return inertia + run.samples['friction_force'] - run.samples['drive_force']


def within(run: Run, begin: float, end: float) -> Columns:
    """Return the samples from `begin` to `end` (s), and the state just before each event there.

    So corners and jumps are where they are.
    """
    before = before_events(run)
    parts = [{name: source[name][rows(source['time'], begin, end)] for name in _DRAWN}
             for source in (before, run.samples)]
    order = np.argsort(np.concatenate([part['time'] for part in parts]), kind='stable')   # at equal times the state
    return {name: np.concatenate([part[name] for part in parts])[order] for name in _DRAWN}   # before comes first


def least_and_most(run: Run, quantity: Callable[[Columns], Numbers]) -> tuple[float, float]:
    """Return the lowest and the highest value of a quantity at all that `within` takes from."""
    values = [quantity(source) for source in (before_events(run), run.samples) if len(source['time'])]
    return min(float(each.min()) for each in values), max(float(each.max()) for each in values)


def steady_inputs(run: Run, begin: float = -math.inf, end: float = math.inf) -> SteadyInputs | None:
    """Return the drive velocity and the external force between two times (s); None when they are not constant."""
    samples = run.samples
    inside = rows(samples['time'], begin, end)
    if inside.start >= inside.stop:
        return None
    velocity, force = samples['drive_velocity'][inside], external_force(run)[inside]
    scale = max(np.abs(samples[name][inside]).max() for name in ('friction_force', 'drive_force'))
    if np.ptp(velocity) > _STEADY * np.abs(velocity).max() or np.ptp(force) > _STEADY * scale:
        return None
    return SteadyInputs(float(velocity[0]), float(np.median(force)) if np.abs(force).max() > _STEADY * scale else 0.0)


def rows(time: Numbers, begin: float, end: float) -> slice:
    """Return the rows from `begin` to `end` (s), both included, of a column of times that rises."""
    return slice(int(np.searchsorted(time, begin)), int(np.searchsorted(time, end, side='right')))


def complete_slips(run: Run) -> list[tuple[Event, Event]]:
    """Return where each slip begins and ends that is complete: break-away (or reversal) and standstill."""
    found: list[tuple[Event, Event]] = []
    begin: Event | None = None
    for event in run.events:
        if event.kind in (EventKind.STICK, EventKind.REVERSE) and begin is not None:
            found.append((begin, event))
            begin = None
        if event.kind == EventKind.REVERSE or (event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK):
            begin = event
    return found


def complete_sticks(run: Run) -> list[tuple[Event, Event]]:
    """Return where each stick begins and ends that is complete: standstill and the break-away from there."""
    found: list[tuple[Event, Event]] = []
    begin: Event | None = None
    for event in run.events:
        if event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK and begin is not None:
            found.append((begin, event))
            begin = None
        elif event.kind == EventKind.STICK:
            begin = event
    return found


@kept
def before_events(run: Run) -> Columns:
    """Return the state just before each event; the acceleration is that of the balance of forces."""
    events, samples = run.events, run.samples
    columns = {name: np.array([getattr(event, name) for event in events], dtype=np.float64)
               for name in ('time', 'position', 'velocity', 'drive_position', 'drive_force', 'friction_force')}
    applied = np.interp(columns['time'], samples['time'], external_force(run))
    columns['acceleration'] = (columns['drive_force'] + applied - columns['friction_force']) / run.scene.axis.mass
    modes = [Mode(int(samples['mode'][0])), *(event.mode for event in events[:-1])][:len(events)]
    columns['mode'] = np.array(modes, dtype=np.float64)
    return columns
