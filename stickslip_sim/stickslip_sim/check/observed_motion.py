# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What was seen of an axis: its state at the samples, its transitions at their exact times."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import InputError
from ..core.types import Event, Mode

Numbers = NDArray[np.float64]


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


@dataclass(frozen=True)
class ObservedMotion:
    """The axis from `begin` to `end` (s); `mode` holds from `begin` until the first event."""

    begin: float
    end: float
    mode: Mode
    time: Numbers            # s, of the samples, rising
    position: Numbers        # m, slider
    velocity: Numbers        # m/s, slider
    commanded: Numbers       # m, the drive or a reference
    events: Sequence[Event]  # without those of kind knot

    @property
    def following_error(self) -> Numbers:
        """Commanded less actual position at the samples, m."""
        return self.commanded - self.position

    @cached_property
    def points(self) -> Points:
        """The slider at samples and transitions; between two of them its motion is smooth."""
        times, first = np.unique([event.time for event in self.events], return_index=True)
        places = np.searchsorted(self.time, times)
        new = self.time[np.minimum(places, len(self.time) - 1)] != times    # a sample at that time comes first
        between = [self.events[k] for k in first[new]]
        return Points(*(np.insert(samples, places[new], [getattr(event, name) for event in between])
                        for name, samples in (('time', self.time), ('position', self.position),
                                              ('velocity', self.velocity))))

    def following(self, reference: Reference) -> 'ObservedMotion':
        """Return the same motion as an answer to a reference instead of the drive."""
        return replace(self, commanded=reference.at(self.time))

    def cut(self, begin: float, end: float) -> 'ObservedMotion':
        """Return the part from `begin` to `end` (s), both included; raises InputError when no sample falls in it."""
        kept = slice(np.searchsorted(self.time, begin, 'left'), np.searchsorted(self.time, end, 'right'))
        if not self.time[kept].size:
            raise InputError('window', [begin, end], 'long enough for one sample', 'make it longer')
        before = [event for event in self.events if event.time < begin]
        return ObservedMotion(begin, end, before[-1].mode if before else self.mode, self.time[kept],
                              self.position[kept], self.velocity[kept], self.commanded[kept],
                              [event for event in self.events if begin <= event.time <= end])
