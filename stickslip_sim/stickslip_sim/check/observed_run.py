# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a check takes from a run: its motion, its first command, the verdict on its timing, what is missing of it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core.errors import RecordingError, one_line
from ..core.types import Event, EventKind, Mode
from ..recording import MeasuredRun, RecordedRun
from ..recording.bag import METADATA
from ..recording.reader import EVENT_FIELDS
from ..recording.states_seen import StatesSeen
from ..recording.topics import DRIVE_VELOCITY, MODE_EVENT, SLIDER_STATE
from ..runs import Columns, Run
from ..runs.kept import kept
from ..runs.samples import joined
from .observed_motion import ObservedMotion

_STATE_FIELDS = ('time', 'position', 'velocity', 'drive_position', 'mode')
_SEEN_FIELDS = (*_STATE_FIELDS, 'step')   # the steps are for `missing_steps`
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
    if isinstance(run, RecordedRun):
        return _recorded_motion(run)
    states, start = 0, Mode.STICK
    for block in run.sample_blocks():
        start = start if states else Mode(int(block['mode'][0]))
        states += len(block['time'])
    return ObservedMotion(run.begin, run.end, start, _seen(run.events), states, 0)


def states_of(run: Run) -> Iterator[Columns]:
    """Yield what is looked at of the states of a run block by block."""
    return run.state_blocks(_STATE_FIELDS) if isinstance(run, RecordedRun) else run.sample_blocks()


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
    stamps = (block['log_time'] for _, block in run.bag.blocks_of({DRIVE_VELOCITY: ['log_time']}))
    first = next((int(stamp[0]) for stamp in stamps if len(stamp)), None)
    if first is None:
        return KnownCommands(None)
    found = first * _NANOSECOND - _NANOSECOND   # s, about when the state was that it found
    times = (block['time'] for block in run.state_blocks(['time']))
    return KnownCommands(next((float(time[np.searchsorted(time, found)]) for time in times
                               if len(time) and time[-1] >= found), None))


def gaps_in(run: Run) -> Iterator[str]:
    """Yield what is missing of a run, for people."""
    if not run.is_complete:
        yield f'the recording has no end: checked up to t = {observed_motion(run).end:.6g} s'
    motion = observed_motion(run)
    if lost := motion.missing_steps:
        yield f'{lost} of {lost + motion.states} steps are missing in the recording'


def unmeasured(run: Run) -> tuple[str, ...]:
    """Return what of a state was not measured, in a run that was imported."""
    if not isinstance(run, MeasuredRun):
        return ()
    return tuple(name for name in ('position', 'drive_position') if name not in run.measured)


def _recorded_motion(run: RecordedRun) -> ObservedMotion:
    """Look once through what was recorded; raises RecordingError unless it is that of one run."""
    unknown = unmeasured(run)
    states = StatesSeen([name for name in _STATE_FIELDS if name not in unknown])
    events = _taken(run, states)
    if not states.count:
        raise RecordingError(f'{run.bag.path}: no state of the axis in it; nothing can be checked')
    if not states.are_finite:
        raise RecordingError(f'{run.bag.path}: states that are no finite numbers; nothing can be checked')
    if not states.rise:
        raise RecordingError(f'{run.bag.path}: time goes back in it; give a recording of one run')
    begin, end = states.begin, states.end
    seen = _seen([event for event in events if begin <= event.time <= end])
    return ObservedMotion(begin, end, Mode(states.mode), seen, states.count, states.missing_steps)


def _taken(run: RecordedRun, states: StatesSeen) -> list[Event]:
    """Take the states block by block; return the transitions."""
    if isinstance(run, MeasuredRun):
        states.take(run.state_columns(_SEEN_FIELDS))
        return run.events
    transitions = []
    for topic, block in run.bag.blocks_of({SLIDER_STATE: _SEEN_FIELDS, MODE_EVENT: EVENT_FIELDS}):
        if topic is MODE_EVENT:
            transitions.append(block)
        elif len(block['time']):
            states.take(block)
    return run.bag.events_in(joined(transitions))


def _seen(events: Sequence[Event]) -> list[Event]:
    """Return the transitions that are ones of the motion."""
    return [event for event in events if event.kind != EventKind.KNOT]
