# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a check takes from a run: its motion, its first command, the verdict on its timing, what is missing of it."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core.errors import RecordingError, one_line
from ..core.types import EventKind, Mode
from ..recording import MeasuredRun, RecordedRun
from ..recording.bag import METADATA
from ..recording.topics import DRIVE_VELOCITY
from ..runs import Columns, Run
from ..runs.kept import kept
from .observed_motion import ObservedMotion

_STATE_FIELDS = ('time', 'position', 'velocity', 'drive_position', 'mode')
_NANOSECOND = 1e-9


@dataclass(frozen=True)
class Timing:
    """What a node says of its own timing; `valid` is None when there was no clock to be kept."""

    valid: bool | None
    verdict: str


class KnownCommands(NamedTuple):
    """What is known of the drive velocities that came: from when on the first one holds, s; None: none came."""

    first: float | None


@kept
def observed_motion(run: Run) -> ObservedMotion:
    """Return the motion of a run with samples, of a recorded one as far as its states go; raises RecordingError."""
    states = _checked_states(run) if isinstance(run, RecordedRun) else run.states
    time = states['time']
    begin, end = (float(time[0]), float(time[-1])) if run.is_recorded else (run.begin, run.end)
    return ObservedMotion(begin, end, Mode(int(states['mode'][0])), time, states['position'], states['velocity'],
                          states['drive_position'], [event for event in run.events if event.kind != EventKind.KNOT])


def timing_of(run: Run) -> Timing | None:
    """Return the verdict of the node on its timing; None without one."""
    if not run.is_complete:
        return Timing(False, 'the run has no end, no verdict')
    try:
        timing = run.receipt.get('timing')
    except RecordingError:   # an attachment of somebody else
        return None
    if not isinstance(timing, dict):
        return None
    valid = None if timing.get('valid') is None else timing['valid'] is True
    return Timing(valid, one_line(str(timing.get('verdict', ''))))


@kept
def commands_of(run: Run) -> KnownCommands | None:
    """Return what is known of the commands of a run that a node recorded; None of any other run."""
    if not isinstance(run, RecordedRun) or run.bag.metadata.get(METADATA, {}).get('origin') != 'node':
        return None
    topic = run.bag.name_of(DRIVE_VELOCITY)
    first = next(run.bag.messages([topic]), None) if run.bag.counts[topic] else None
    time = run.state_columns(['time'])['time']
    if first is None or not len(time):
        return KnownCommands(None)
    at = np.searchsorted(time, first.log_time * _NANOSECOND - _NANOSECOND)   # the state that it found
    return KnownCommands(float(time[at]) if at < len(time) else None)


def gaps_in(run: Run) -> Iterator[str]:
    """Yield what is missing of a run, for people."""
    if not run.is_complete:
        yield f'the recording has no end: checked up to t = {observed_motion(run).end:.6g} s'
    if lost := run.missing_steps:
        yield f'{lost} of {lost + len(observed_motion(run).time)} steps are missing in the recording'


def unmeasured(run: Run) -> tuple[str, ...]:
    """Return what of a state was not measured, in a run that was imported."""
    if not isinstance(run, MeasuredRun):
        return ()
    return tuple(name for name in ('position', 'drive_position') if name not in run.measured)


def _checked_states(run: RecordedRun) -> Columns:
    """Return what is looked at of the states; raises RecordingError unless they are those of one run."""
    states = run.state_columns([*_STATE_FIELDS, 'step'])    # the steps are for `missing_steps`
    if not len(states['time']):
        raise RecordingError(f'{run.bag.path}: no state of the axis in it; nothing can be checked')
    unknown = unmeasured(run)
    if not all(np.isfinite(states[name]).all() for name in _STATE_FIELDS if name not in unknown):
        raise RecordingError(f'{run.bag.path}: states that are no finite numbers; nothing can be checked')
    if not (np.diff(states['time']) > 0.0).all():
        raise RecordingError(f'{run.bag.path}: time goes back in it; give a recording of one run')
    return states
