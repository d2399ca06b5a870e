# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a picture of a run is drawn from."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.types import Event, EventKind, Mode
from ..rig.marks import Mark

_INPUTS = ('drive_velocity', 'external_force', 'normal_force')
_OF_EVENTS = ('position', 'velocity', 'drive_position', 'drive_force', 'friction_force')


class TimeWindow(NamedTuple):
    """A part of a run, s."""

    begin: float
    end: float


class DrawnRun(NamedTuple):
    """A run as it is drawn, SI units; the first line of `title` is the heading.

    `motion`: columns of samples and of the states before events, in the order of time; `inputs`: `time`,
    `drive_velocity`, `external_force`, and `normal_force` where it varies; `commands`: `time` and `velocity` as they
    were taken, both empty where none is known; `modes`: when each began, and which.
    """

    title: str
    motion: Mapping[str, Numbers]
    inputs: Mapping[str, Numbers]
    commands: Mapping[str, Numbers]
    modes: tuple[Numbers, Numbers]
    break_aways: tuple[Numbers, Numbers]   # s, N: times and friction forces
    event_times: Numbers
    marks: Sequence[Mark]


def drawn_run(title: str, samples: Mapping[str, Numbers], events: Sequence[Event], commands: Mapping[str, Numbers],
              marks: Sequence[Mark]) -> DrawnRun:
    """Return a run as it is drawn, from its samples (columns named as in `types.Sample`, and `time`) and events.

    A drive that never exerts a force, as of an axis without a spring, is none.
    """
    if not np.any(samples['drive_force']):
        none = np.full(len(samples['time']), np.nan)
        samples = {**samples, 'drive_position': none, 'drive_velocity': none, 'drive_force': none}
        events = [event._replace(drive_position=np.nan, drive_force=np.nan) for event in events]
    times = np.array([event.time for event in events], dtype=np.float64)
    breaks = [event for event in events if event.kind == EventKind.BREAKAWAY and math.isfinite(event.friction_force)]
    modes = np.array([samples['mode'][0], *(event.mode for event in events)], dtype=np.float64)
    return DrawnRun(
        title, _with_events(samples, events, times),
        {name: samples[name] for name in ('time', *_INPUTS) if name in samples}, commands,
        (np.concatenate([samples['time'][:1], times]), modes),
        (np.array([event.time for event in breaks]), np.array([event.friction_force for event in breaks])),
        times, marks)


def mode_shares(modes: tuple[Numbers, Numbers], edges: Numbers) -> dict[Mode, Numbers]:
    """Return the share of each mode in the time between adjacent edges (s)."""
    starts, which = modes
    ends = np.append(starts[1:], max(edges[-1], starts[-1]))
    shares = {}
    for mode in Mode:
        spent = np.concatenate([[0.0], np.cumsum(np.where(which == mode, ends - starts, 0.0))])
        shares[mode] = np.diff(np.interp(edges, np.append(starts, ends[-1]), spent)) / np.diff(edges)
    return shares


def _with_events(samples: Mapping[str, Numbers], events: Sequence[Event], times: Numbers) -> dict[str, Numbers]:
    """Return columns with the states at the events between the samples, each before the sample of its time."""
    places = np.searchsorted(samples['time'], times)
    columns = {'time': np.insert(samples['time'], places, times)}
    for name in _OF_EVENTS:
        columns[name] = np.insert(samples[name], places, [getattr(event, name) for event in events])
    return columns
