# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What was seen of an axis: its state at the samples, block by block, its transitions at their exact times."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.types import Event, Mode
from ..runs import Columns
from ..runs.samples import gathered


class Reference(NamedTuple):
    """A commanded position, linear between (times[i], positions[i]) and held before the first and after the last."""

    times: tuple[float, ...]       # s, rising
    positions: tuple[float, ...]   # m

    def at(self, times: Numbers) -> Numbers:
        """Return the commanded positions."""
        return np.interp(times, self.times, self.positions)

    def later(self, delay: float) -> 'Reference':
        """Return the same reference, `delay` (s) later."""
        return Reference(tuple(time + delay for time in self.times), self.positions)


class Points(NamedTuple):
    """The slider at the samples and at the transitions, in the order of time."""

    time: Numbers       # s
    position: Numbers   # m
    velocity: Numbers   # m/s


class MotionBlock(NamedTuple):
    """Some of the samples, one after the other; `points` are those and the transitions among them and before."""

    time: Numbers        # s, rising
    position: Numbers    # m, slider
    commanded: Numbers   # m, the drive or a reference
    points: Points

    @property
    def following_error(self) -> Numbers:
        """Commanded less actual position at the samples, m."""
        return self.commanded - self.position

    def cut(self, begin: float, end: float) -> 'MotionBlock':
        """Return the part from `begin` to `end` (s), both included."""
        of_samples, of_points = _rows(self.time, begin, end), _rows(self.points.time, begin, end)
        return MotionBlock(self.time[of_samples], self.position[of_samples], self.commanded[of_samples],
                           Points(*(column[of_points] for column in self.points)))


@dataclass(frozen=True)
class MotionSpan:
    """The transitions of the axis from `begin` to `end` (s); `mode` holds from `begin` until the first of them."""

    begin: float
    end: float
    mode: Mode
    events: Sequence[Event]  # without those of kind knot

    def cut(self, begin: float, end: float) -> 'MotionSpan':
        """Return the part from `begin` to `end` (s), both included."""
        before = [event for event in self.events if event.time < begin]
        return MotionSpan(begin, end, before[-1].mode if before else self.mode,
                          [event for event in self.events if begin <= event.time <= end])


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
    done = 0
    for block in gathered(states):
        time = block['time']
        upto = int(np.searchsorted(times, time[-1], 'right'))
        points = _points(block, times[done:upto], [events[k] for k in first[done:upto]])
        yield MotionBlock(time, block['position'], block['drive_position'] if reference is None else reference.at(time),
                          points)
        done = upto
    none = np.empty(0)
    late = [events[k] for k in first[done:]]
    yield MotionBlock(none, none, none, _points(dict.fromkeys(Points._fields, none), times[done:], late))


def _points(block: Columns, times: Numbers, events: Sequence[Event]) -> Points:
    """Return samples, and the transitions at these times, no two of them at one."""
    places = np.searchsorted(block['time'], times)
    is_new = ~np.isin(times, block['time'])    # a sample at that time comes first
    between = [event for event, new in zip(events, is_new) if new]
    return Points(*(np.insert(block[name], places[is_new], [getattr(event, name) for event in between])
                    for name in Points._fields))


def _rows(time: Numbers, begin: float, end: float) -> slice:
    return slice(int(np.searchsorted(time, begin, 'left')), int(np.searchsorted(time, end, 'right')))
