# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Slips by the speed alone, where nothing else is known of a motion.

The slider is taken to slip from where its speed passes a threshold to where it falls below, if the peak between them is
five times as high: what stays below that is noise, or a contact that rings.  Else it is taken to be at rest.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.types import Event, EventKind, Mode
from .run import Columns

SLIP_TIMES = 5.0     # the threshold, which a slip exceeds at its peak
_OF_EVENTS = 'position', 'velocity', 'drive_position', 'drive_force', 'friction_force'


class SlipRows(NamedTuple):
    """The first row of a slip, the first behind it, that of its peak, and its direction."""

    first: int
    end: int
    peak: int
    direction: int


def slips_of(velocity: NDArray[np.float64], threshold: float) -> Iterator[SlipRows]:
    """Yield the slips in a column of velocities, m/s."""
    ways = np.where(np.abs(velocity) > threshold, np.sign(velocity), 0.0)
    edges = [0, *(np.flatnonzero(np.diff(ways) != 0.0) + 1).tolist(), len(ways)]
    for first, end in pairwise(edges):
        peak = first + int(np.abs(velocity[first:end]).argmax())
        if ways[first] != 0.0 and abs(velocity[peak]) > SLIP_TIMES * threshold:
            yield SlipRows(first, end, peak, int(ways[first]))


def events_of_slips(samples: Columns, threshold: float) -> list[Event]:
    """Return break-away and standstill where the speed passes a threshold, m/s, and between them its peak."""
    found: list[Event] = []
    rested = float(samples['time'][0])
    for first, end, peak, direction in slips_of(samples['velocity'], threshold):
        if first > 0:
            time = _passed(samples, first, threshold)
            found.append(_event(samples, time, EventKind.BREAKAWAY, Mode.ACCELERATING, direction, time - rested))
        found.append(_event(samples, float(samples['time'][peak]), EventKind.DECELERATE, Mode.DECELERATING, direction))
        if end < len(samples['time']):
            rested = _passed(samples, end, threshold)
            found.append(_event(samples, rested, EventKind.STICK, Mode.STICK, direction))
    return found


def _passed(samples: Columns, row: int, threshold: float) -> float:
    """Return when the speed passes a threshold between the row before and this one, s."""
    before, after = samples['time'][row - 1:row + 1].tolist()
    low, high = np.abs(samples['velocity'][row - 1:row + 1]).tolist()
    share = min(max((threshold - low) / (high - low), 0.0), 1.0) if high != low else 1.0
    return float(before + share * (after - before))


def _event(samples: Columns, time: float, kind: EventKind, mode: Mode, direction: int, rest_time: float = np.nan
           ) -> Event:
    position, velocity, drive, force, friction = (float(np.interp(time, samples['time'], samples[name]))
                                                  for name in _OF_EVENTS)
    second = float(np.floor(time))
    return Event(second, time - second, kind, mode, direction, position, velocity, drive, force, friction, np.nan,
                 rest_time)
