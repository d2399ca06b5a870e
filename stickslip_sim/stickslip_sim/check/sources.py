# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Motions to check: those of a recorded run, and those of a simulation."""

import os
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import RecordingError, RecordingWarning, one_line
from ..core.types import EventKind, Mode
from ..recording import Run, columns_of, events_of, read_run
from ..recording.topics import SLIDER_STATE
from ..runs.offline import Trajectory
from .observed_motion import Motion

_STATE_FIELDS = ('step', 'time', 'position', 'velocity', 'drive_position', 'mode')


@dataclass(frozen=True)
class Timing:
    """What a node says of its own timing."""

    valid: bool
    verdict: str


@dataclass(frozen=True)
class Evidence:
    """A motion, where it came from, and what else is known of the run."""

    name: str
    motion: Motion
    timing: Timing | None = None    # None: no verdict, for no clock was to be kept
    is_complete: bool = True
    notes: tuple[str, ...] = ()     # for people: what is missing


def simulated(run: Trajectory) -> Evidence:
    """Return the motion of an offline run with samples."""
    columns = run.samples
    motion = Motion(
        0.0, run.duration, Mode(int(columns['mode'][0])), columns['time'], columns['position'], columns['velocity'],
        columns['drive_position'], [event for event in run.events if event.kind != EventKind.KNOT])
    return Evidence(run.scene.name, motion)


def recorded(path: str) -> Evidence:
    """Return the motion in a run folder or an MCAP file, as far as it goes; raises RecordingError."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RecordingWarning)   # told by the notes
        run = read_run(path)
    columns = columns_of(run, SLIDER_STATE, _STATE_FIELDS)
    _check_states(run, columns)
    time = columns['time']
    motion = Motion(float(time[0]), float(time[-1]), Mode(int(columns['mode'][0])), time, columns['position'],
                    columns['velocity'], columns['drive_position'], events_of(run))
    return Evidence(one_line(Path(os.path.abspath(path)).name), motion, _timing(run), run.is_complete,
                    tuple(_notes(run, columns)))


def _check_states(run: Run, columns: Mapping[str, NDArray[Any]]) -> None:
    """Raise RecordingError unless these are states of one run."""
    if not len(columns['time']):
        raise RecordingError(f'{run.path}: no state of the axis in it; nothing can be checked')
    if not all(np.isfinite(column).all() for column in columns.values()):
        raise RecordingError(f'{run.path}: states that are no finite numbers; nothing can be checked')
    if not (np.diff(columns['time']) > 0.0).all():
        raise RecordingError(f'{run.path}: time goes back in it; give a recording of one run')


def _notes(run: Run, columns: Mapping[str, NDArray[Any]]) -> Iterator[str]:
    """Yield what is missing."""
    count = len(columns['time'])
    if not run.is_complete:
        yield f'the recording has no end: checked up to t = {columns["time"][-1]:.6g} s'
    if lost := int(columns['step'][-1]) - int(columns['step'][0]) + 1 - count:
        yield f'{lost} of {lost + count} steps are missing in the recording'


def _timing(run: Run) -> Timing | None:
    if not run.is_complete:
        return Timing(False, 'the run has no end, no verdict')
    try:
        timing = run.receipt.get('timing')
    except RecordingError:   # an attachment of somebody else
        return None
    if not isinstance(timing, dict) or timing.get('valid') is None:   # None: not in real time
        return None
    return Timing(timing['valid'] is True, one_line(str(timing.get('verdict', ''))))
