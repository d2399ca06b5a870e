# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a check takes from a run: its motion, its first command, the verdict on its timing, what is missing of it."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..bags.bag import METADATA
from ..bags.topics import DRIVE_VELOCITY, MODE_EVENT, SLIDER_STATE
from ..core.arrays import Columns, Flags, Numbers
from ..core.errors import RecordingError, one_line
from ..core.types import Event, EventKind, Mode
from ..figures.control import MotionBlock, MotionSpan, Points, held
from ..recording import MeasuredRun, RecordedRun
from ..recording.reader import EVENT_FIELDS
from ..recording.run_outline import StatesSeen
from ..runs import Run, SimulatedRun
from ..runs.run import STANDS, kept
from ..runs.samples import gathered, joined

# What was seen of an axis: its state at the samples, block by block, its transitions at their exact times.

class Reference(NamedTuple):
    """A commanded position, linear between (times[i], positions[i]) and held before the first and after the last."""

    times: Sequence[float] | Numbers       # s, rising
    positions: Sequence[float] | Numbers   # m

    def at(self, times: Numbers) -> Numbers:
        """Return the commanded positions."""
        return np.interp(times, self.times, self.positions)

    def later(self, delay: float) -> 'Reference':
        """Return the same reference, `delay` (s) later."""
        return Reference(tuple(time + delay for time in self.times), self.positions)


@dataclass(frozen=True)
class ObservedMotion(MotionSpan):
    """The same of all of a run, and how many samples it has."""

    states: int
    missing_steps: int   # between the first and the last of them


def motion_blocks(states: Iterable[Columns], events: Sequence[Event], reference: Reference | None
                  ) -> Iterator[MotionBlock]:
    """Yield a motion block by block; `commanded` is the drive without a reference.

    Between two points next to each other the motion is smooth.  What comes after the last sample has a block itself.
    """
    times, first = np.unique([event.time for event in events], return_index=True)
    done, follower = 0, _Follower()
    for block in gathered(states):
        time = block['time']
        upto = int(np.searchsorted(times, time[-1], 'right'))
        points = _points(block, times[done:upto], [events[k] for k in first[done:upto]])
        commanded = block['drive_position'] if reference is None else reference.at(time)
        followed = follower.follow(time, commanded, block['drive_velocity'])
        yield MotionBlock(time, block['position'], commanded, *followed, points)
        done = upto
    none, no = np.empty(0), np.empty(0, np.bool_)
    late = _points(dict.fromkeys(Points._fields, none), times[done:], [events[k] for k in first[done:]])
    yield MotionBlock(none, none, none, no, none, none, none, late)


class _Follower:
    """Follows the command from block to block."""

    def __init__(self) -> None:
        self._last: tuple[Numbers, ...] = ()
        self._way = 0.0

    def follow(self, time: Numbers, commanded: Numbers, command: Numbers
               ) -> tuple[Flags, Numbers, Numbers, Numbers]:
        """Return the columns from `has_moved` to `rate`."""
        before = self._last or (time[:1], commanded[:1], command[:1])
        steps = [np.diff(column, prepend=last) for column, last in zip((time, commanded, command), before)]
        has_moved = np.abs(steps[1]) > STANDS
        way = held(has_moved, np.sign(steps[1]), self._way)
        rate = np.divide(steps[2], steps[0], out=np.zeros(len(time)), where=steps[0] > 0.0)
        self._last, self._way = (time[-1:], commanded[-1:], command[-1:]), float(way[-1])
        return has_moved, way, command, rate


def _points(block: Columns, times: Numbers, events: Sequence[Event]) -> Points:
    """Return samples, and the transitions at these times, no two of them at one."""
    places = np.searchsorted(block['time'], times)
    is_new = ~np.isin(times, block['time'])    # a sample at that time comes first
    between = [event for event, new in zip(events, is_new) if new]
    return Points(*(np.insert(block[name], places[is_new], [getattr(event, name) for event in between])
                    for name in Points._fields))


_SEEN = ('time', 'position', 'velocity', 'drive_position', 'mode')
_STATE_FIELDS = (*_SEEN, 'drive_velocity')
_SEEN_FIELDS = (*_SEEN, 'step')   # the steps are for `missing_steps`
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
    if isinstance(run, RecordedRun):
        return run.state_blocks(_STATE_FIELDS)
    return ({name: column for name, column in block.items() if name in _STATE_FIELDS}
            for block in run.sample_blocks())


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


def setpoint_of(run: Run) -> Reference | None:
    """Return the setpoint of a run as a reference; None without one."""
    wanted = run.setpoint
    return Reference(wanted['time'], wanted['position']) if wanted else None


@kept
def commands_of(run: Run) -> KnownCommands | None:
    """Return what is known of the commands of a run that took some: a node's or a closed loop's; None of any other."""
    if isinstance(run, SimulatedRun) and run.is_commanded:
        ordered = run.commands['time']
        return KnownCommands(float(ordered[0]) if len(ordered) else None)
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


def first_command_of(run: Run) -> float | None:
    """Return from when on the first drive velocity holds, s; None where none is known."""
    commands = commands_of(run)
    return commands.first if commands else None


def gaps_in(run: Run) -> Iterator[str]:
    """Yield what is missing of a run, for people."""
    if not run.is_complete:
        yield f'the recording has no end: checked up to t = {observed_motion(run).end:.6g} s'
    motion = observed_motion(run)
    if lost := motion.missing_steps:
        yield f'{lost} of {lost + motion.states} steps are missing in the recording'


def unmeasured(run: Run, needed: Sequence[str] = ('position', 'drive_position')) -> tuple[str, ...]:
    """Return which of the columns of a state were not measured, in a run that was imported."""
    return tuple(name for name in needed if isinstance(run, MeasuredRun) and name not in run.measured)


def _recorded_motion(run: RecordedRun) -> ObservedMotion:
    """Look once through what was recorded; raises RecordingError unless it is that of one run."""
    unknown = unmeasured(run)
    states = StatesSeen([name for name in _SEEN if name not in unknown])
    events = _taken(run, states)
    if not states.count:
        raise RecordingError(f'{run.bag.path}: no state of the axis; nothing can be checked')
    if not states.are_finite:
        raise RecordingError(f'{run.bag.path}: states with non-finite numbers; nothing can be checked')
    if not states.rise:
        raise RecordingError(f'{run.bag.path}: its time goes backwards; give a recording of one run')
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
