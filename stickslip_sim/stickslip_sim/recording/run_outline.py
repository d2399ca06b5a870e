# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A long recorded run looked through once: where it begins and ends, its transitions, what its samples come to."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..bags.topics import FRICTION_FORCE, MODE_EVENT, SLIDER_STATE, Topic
from ..core.arrays import Columns, Numbers
from ..core.errors import RecordingError
from ..core.types import Event, Mode
from ..runs.samples import GATHERED, joined
from ..simulation.step_result import Mark
from .reader import EVENT_FIELDS, Bag

# The states and the friction of the same steps: of columns, or block by block as they stand in a bag.

Pair = tuple[Columns, Columns]   # states, friction


class OutOfOrderError(Exception):
    """What was recorded does not come in the order of its steps: it must be looked at as a whole."""


def of_the_same_steps(states: Columns, friction: Columns) -> Pair:
    """Return the rows of both whose steps are in both, in the order of the steps, each once."""
    if _rise(states) and len(states['step']) == len(friction['step']) and (states['step'] == friction['step']).all():
        return states, friction
    _, rows, others = np.intersect1d(states['step'], friction['step'], return_indices=True)
    return _taken(states, rows), _taken(friction, others)


def paired_blocks(blocks: Iterable[tuple[Topic, Columns]]) -> Iterator[Pair]:
    """Yield what `of_the_same_steps` returns block by block; raises OutOfOrderError where steps do not rise."""
    waiting: dict[Topic, list[Columns]] = {SLIDER_STATE: [], FRICTION_FORCE: []}
    rows, end = dict.fromkeys(waiting, 0), -1
    for topic, block in blocks:
        waiting[topic].append(block)
        rows[topic] += len(block['step'])
        if min(rows.values()) >= GATHERED:
            pair, waiting, end = _split(waiting, end)
            rows = {topic: len(held[0]['step']) for topic, held in waiting.items()}
            yield pair
    if all(rows.values()):
        yield _split(waiting, end)[0]


def _split(waiting: dict[Topic, list[Columns]], after: int) -> tuple[Pair, dict[Topic, list[Columns]], int]:
    """Return the pairs in what waits, all of steps after another; what goes on waiting; the last step of the pairs."""
    columns = {topic: joined(held) for topic, held in waiting.items()}
    if not all(int(held['step'][0]) > after and _rise(held) for held in columns.values()):
        raise OutOfOrderError
    end = min(int(held['step'][-1]) for held in columns.values())
    counts = {topic: int(np.searchsorted(held['step'], end, 'right')) for topic, held in columns.items()}
    states, friction = (_taken(held, slice(counts[topic])) for topic, held in columns.items())
    return (of_the_same_steps(states, friction),
            {topic: [_taken(held, slice(counts[topic], None))] for topic, held in columns.items()}, end)


def _rise(columns: Columns) -> bool:
    return bool((np.diff(columns['step'].astype(np.int64)) > 0).all())


def _taken(columns: Columns, rows: slice | NDArray[np.intp]) -> Columns:
    return {name: column[rows] for name, column in columns.items()}


# What the states of a run come to, block by block.

class StatesSeen:
    """Takes the states of a run, with their `time`, `step`, `mode` and the fields that must be finite."""

    def __init__(self, finite: Sequence[str] = ()) -> None:
        self._finite = finite
        self.count = 0
        self.are_finite = self.rise = True
        self.begin = self.end = math.nan    # s, of the first and of the last
        self.mode = 0                       # of the first
        self._steps = 0, 0                  # of the first and of the last

    def take(self, block: Columns) -> None:
        """Take the next states, at least one."""
        time, steps = block['time'], block['step']
        self.are_finite &= all(bool(np.isfinite(block[name]).all()) for name in self._finite)
        if not self.count:
            self.begin, self.mode, self._steps = float(time[0]), int(block['mode'][0]), (int(steps[0]), 0)
        elif not time[0] > self.end:
            self.rise = False
        self.rise &= bool((np.diff(time) > 0.0).all())
        self.end, self._steps = float(time[-1]), (self._steps[0], int(steps[-1]))
        self.count += len(time)

    @property
    def missing_steps(self) -> int:
        """How many steps have no state between the first and the last that has."""
        return self._steps[1] - self._steps[0] + 1 - self.count


_STATE = 'time', 'step', 'drive_position', 'drive_force', 'mode'
_FRICTION = 'step', 'force'


class RunOutline(NamedTuple):
    """A run from its first sample to its last; `events` are those up to its last state."""

    begin: float           # s
    end: float             # s
    mode: Mode             # of the first sample
    samples: int
    missing_steps: int     # without a state, between the first and the last that has
    largest_force: float   # N, friction or drive
    events: list[Event] | None   # None: not of one topic


def outline_of(bag: Bag) -> RunOutline | None:
    """Look through a bag once; None when what is in it comes in no order.

    Raises RecordingError when a topic is missing, or it has fewer than 2 samples, or some of no run.
    """
    states, drive, samples = StatesSeen(), _DriveAtEvents(), _SamplesSeen()
    transitions: list[Columns] = []
    events = {MODE_EVENT: EVENT_FIELDS} if list(bag.topics.values()).count(MODE_EVENT.type) == 1 else {}

    def of_steps(blocks: Iterable[tuple[Topic, Columns]]) -> Iterator[tuple[Topic, Columns]]:
        for topic, block in blocks:
            if topic is MODE_EVENT:
                transitions.append(block)
                drive.take_events(block['time'])
                continue
            if topic is SLIDER_STATE and len(block['time']):
                states.take(block)
                drive.take_states(block)
            yield topic, block

    try:
        for pair in paired_blocks(of_steps(bag.blocks_of({**events, SLIDER_STATE: _STATE, FRICTION_FORCE: _FRICTION}))):
            samples.take(*pair)
        if not states.rise:
            return None
        positions = drive.found()
    except OutOfOrderError:
        return None
    check_samples(bag, samples.count, samples.rise, samples.modes)
    found = [event._replace(drive_position=position)
             for event, position in zip(bag.events_in(joined(transitions)), positions.tolist())
             if states.begin <= event.time <= states.end] if events else None
    return RunOutline(samples.begin, samples.end, Mode(samples.mode), samples.count, states.missing_steps,
                      samples.largest_force, found)


def check_samples(bag: Bag, count: int, rise: bool, modes: Iterable[float]) -> None:
    """Raise RecordingError unless samples are those of a run: at least 2, one after the other, in known modes."""
    if count < 2:
        raise RecordingError(f'{bag.path}: {count} states with their friction force; a run has at least 2')
    if not rise or not set(modes) <= set(Mode):
        raise RecordingError(f'{bag.path}: its steps are out of order or in unknown modes')


class _SamplesSeen:
    """Takes the steps of which state and friction were recorded."""

    def __init__(self) -> None:
        self.count, self.rise, self.mode = 0, True, 0
        self.begin = self.end = -np.inf
        self.largest_force = 0.0
        self.modes: set[int] = set()

    def take(self, states: Columns, friction: Columns) -> None:
        """Take the next of them."""
        time = states['time']
        if not len(time):
            return
        if not self.count:
            self.begin, self.mode = float(time[0]), int(states['mode'][0])
        elif not time[0] > self.end:
            self.rise = False
        self.rise &= bool((np.diff(time) > 0.0).all())
        self.end = float(time[-1])
        self.count += len(time)
        self.modes |= set(np.unique(states['mode']).tolist())
        self.largest_force = max(self.largest_force, float(np.abs(friction['force']).max()),
                                 float(np.abs(states['drive_force']).max()))


class _DriveAtEvents:
    """Finds where the drive is at each transition, between the states; both come block by block, about in order."""

    def __init__(self) -> None:
        self._held: list[Columns] = []
        self._rows = 0
        self._is_cut = False       # states before those that are held were forgotten
        self._waiting: NDArray[np.float64] = np.empty(0)
        self._found: list[NDArray[np.float64]] = []

    def take_events(self, times: NDArray[np.float64]) -> None:
        """Take the times of the next transitions, s."""
        self._waiting = np.append(self._waiting, times)

    def take_states(self, block: Columns) -> None:
        """Take the next states."""
        self._held.append({name: block[name] for name in ('time', 'drive_position')})
        self._rows += len(block['time'])
        if self._rows > 2 * GATHERED:
            self._settle()

    def found(self) -> NDArray[np.float64]:
        """Return the positions at the transitions up to the last state, m; raises OutOfOrderError."""
        if self._held:
            self._settle()
        return np.concatenate([*self._found, np.empty(0)])

    def _settle(self) -> None:
        """Find what can be found; a later transition may come before the last of the states, but not by many."""
        states = joined(self._held)
        time, waiting = states['time'], self._waiting
        if (np.diff(waiting) < 0.0).any() or (self._is_cut and len(waiting) and waiting[0] < time[0]):
            raise OutOfOrderError
        count = int(np.searchsorted(waiting, time[-1], 'right'))
        self._found.append(np.interp(waiting[:count], time, states['drive_position']))
        self._waiting = waiting[count:]
        self._is_cut |= len(time) > GATHERED
        self._held = [{name: column[-GATHERED:] for name, column in states.items()}]
        self._rows = len(self._held[0]['time'])


# Where the machine, or who commanded, was late in a run of the node: what looks like a bad controller and is none.

_USUAL = 5.0      # median intervals: longer is a gap between commands
_FEWEST = 20      # intervals of which one is usual
_LONGEST = 100_000   # steps: longer ones count as that
LATE_FIELDS = 'step', 'steps', 'lateness_max', 'overruns'


def late_marks(timing: Mapping[str, Numbers], rate: float, limit: float) -> list[Mark]:
    """Return the windows of the timing reports (LATE_FIELDS) in which a step was later than a limit, s."""
    late = timing['lateness_max'] > limit
    if not late.any():
        return []
    label = f'late ≤ {1e3 * timing["lateness_max"][late].max():.3g} ms'
    return [Mark(max(step - steps, 0.0) / rate, step / rate, label, int(overruns), is_of_host=True)
            for step, steps, overruns in zip(*(timing[name][late].astype(np.float64).tolist()
                                               for name in ('step', 'steps', 'overruns')))]


def gap_marks(blocks: Iterable[Columns], rate: float, limit: float) -> list[Mark]:
    """Return where no command came for longer than a limit (s) and several times as long as is usual in the run.

    Their times (s) come in blocks.
    """
    latest: Numbers = np.empty(0)
    counts = np.zeros(_LONGEST + 1, dtype=np.int64)   # of intervals, by their steps
    longer: list[tuple[float, float]] = []
    for block in blocks:
        times = np.append(latest, block['time'])
        latest, intervals = times[-1:], np.diff(times)
        counts += np.bincount(np.rint(np.minimum(intervals * rate, _LONGEST)).astype(np.int64), minlength=_LONGEST + 1)
        places = np.flatnonzero(intervals > limit)
        longer += zip(times[places].tolist(), times[places + 1].tolist())
    if counts.sum() < _FEWEST:
        return []
    usual = int(np.searchsorted(np.cumsum(counts), 0.5 * counts.sum())) / rate
    gaps = [(begin, end) for begin, end in longer if end - begin > _USUAL * usual]
    longest = max((end - begin for begin, end in gaps), default=0.0)
    return [Mark(begin, end, f'gaps ≤ {1e3 * longest:.3g} ms', is_of_host=True) for begin, end in gaps]
