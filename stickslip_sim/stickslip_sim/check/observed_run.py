# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a check takes from a run: its motion, the verdict on its timing, and what is missing of it."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..core.errors import RecordingError, one_line
from ..core.types import EventKind, Mode
from ..recording import RecordedRun
from ..runs import Run
from ..runs.kept import kept
from .observed_motion import ObservedMotion

_STATE_FIELDS = ('time', 'position', 'velocity', 'drive_position', 'mode')


@dataclass(frozen=True)
class Timing:
    """What a node says of its own timing."""

    valid: bool
    verdict: str


@kept
def observed_motion(run: Run) -> ObservedMotion:
    """Return the motion of a run with samples, of a recorded one as far as its states go; raises RecordingError."""
    if isinstance(run, RecordedRun):
        _check_states(run)
    states = run.states
    time = states['time']
    begin, end = (float(time[0]), float(time[-1])) if run.is_recorded else (run.begin, run.end)
    return ObservedMotion(begin, end, Mode(int(states['mode'][0])), time, states['position'], states['velocity'],
                          states['drive_position'], [event for event in run.events if event.kind != EventKind.KNOT])


def timing_of(run: Run) -> Timing | None:
    """Return the verdict of the node on its timing; None without one, for no clock was to be kept."""
    if not run.is_complete:
        return Timing(False, 'the run has no end, no verdict')
    try:
        timing = run.receipt.get('timing')
    except RecordingError:   # an attachment of somebody else
        return None
    if not isinstance(timing, dict) or timing.get('valid') is None:   # None: not in real time
        return None
    return Timing(timing['valid'] is True, one_line(str(timing.get('verdict', ''))))


def gaps_in(run: Run) -> Iterator[str]:
    """Yield what is missing of a run, for people."""
    if not run.is_complete:
        yield f'the recording has no end: checked up to t = {observed_motion(run).end:.6g} s'
    if lost := run.missing_steps:
        yield f'{lost} of {lost + len(run.states["time"])} steps are missing in the recording'


def _check_states(run: RecordedRun) -> None:
    """Raise RecordingError unless the states are those of one run."""
    states = run.states
    if not len(states['time']):
        raise RecordingError(f'{run.bag.path}: no state of the axis in it; nothing can be checked')
    if not all(np.isfinite(states[name]).all() for name in _STATE_FIELDS):
        raise RecordingError(f'{run.bag.path}: states that are no finite numbers; nothing can be checked')
    if not (np.diff(states['time']) > 0.0).all():
        raise RecordingError(f'{run.bag.path}: time goes back in it; give a recording of one run')
