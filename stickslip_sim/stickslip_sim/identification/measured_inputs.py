# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs as they were measured, as profiles for the engine; and profiles from a later time on."""

import math
from bisect import bisect_right
from collections import deque

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from ..core.arrays import Numbers
from ..core.input_profile import InputProfile, Sinusoid

_Place = tuple[float, float]   # s, m

_ROOM = 1.02       # of the resolution: rounding must not bend a straight way
_STRAIGHT = 1e-9   # of the range: a point so near the line between its neighbours says nothing


def profile_through(times: Numbers, values: Numbers, held: bool = False) -> InputProfile:
    """Return the profile that is linear between measured values, or `held` from each to the next.

    It is constant before the first and after the last; straight parts of it are one piece.
    """
    rates = np.zeros(len(times)) if held else np.append(np.diff(values) / np.diff(times), 0.0)
    small = _STRAIGHT * max(float(np.abs(values).max()), 1e-300)
    goes_on = np.abs(values[:-1] + rates[:-1] * np.diff(times) - values[1:]) <= small
    same = np.abs(np.diff(rates)) * np.append(np.diff(times)[1:], 1.0) <= small
    new = np.append(True, ~(goes_on & same))
    starts = times[new]
    starts[0] = 0.0
    if times[0] > 0.0 and rates[0] != 0.0:
        return InputProfile((0.0, *times[new].tolist()), (float(values[0]), *values[new].tolist()),
                            (0.0, *rates[new].tolist()))
    return InputProfile(tuple(starts.tolist()), tuple(values[new].tolist()), tuple(rates[new].tolist()))


def velocity_within(times: Numbers, places: Numbers, half: float) -> InputProfile:
    """Return the velocity of a drive from measured places (m), each right within `half` (m).

    Differences of the readings of an encoder are none of its axis: one step up in 1 ms, none in the next.  The shortest
    way within its resolution is straight where the axis may have moved evenly, and turns as seldom as it can (Davies
    and Kovac 2001).  It cuts the corners of the true way; so the line that turns at the same times and is nearest to
    the readings, by least squares, is taken.
    """
    turns = _turns_within(times, places, half)
    edges = times[turns]
    part = np.clip(np.searchsorted(edges, times, 'right') - 1, 0, len(edges) - 2)
    share = (times - edges[part]) / (edges[part + 1] - edges[part])
    bands = np.zeros((2, len(edges)))     # of the normal equations of a line with given turns
    np.add.at(bands[1], part, (1.0 - share)**2)
    np.add.at(bands[1], part + 1, share**2)
    np.add.at(bands[0], part + 1, share * (1.0 - share))
    right = np.bincount(part, (1.0 - share) * places, len(edges)) + np.bincount(part + 1, share * places, len(edges))
    way = solveh_banded(bands, right)
    velocities = np.diff(way) / np.diff(edges)
    return InputProfile((0.0, *edges[1:-1].tolist()), tuple(velocities.tolist()), (0.0,) * len(velocities))


def _turns_within(times: Numbers, places: Numbers, half: float) -> NDArray[np.intp]:
    """Return the rows at which the shortest way turns, the first and the last row with them."""
    way = [(float(times[0]), float(places[0]))]
    above, below = deque(way), deque(way)
    last = len(times) - 1
    for k, (time, place) in enumerate(zip(times[1:].tolist(), places[1:].tolist()), 1):
        room = _ROOM * half if k < last else 0.0
        _pull(above, below, (time, place + room), 1.0, way)
        _pull(below, above, (time, place - room), -1.0, way)
    rows: NDArray[np.intp] = np.unique([*np.searchsorted(times, [time for time, _ in way]), last])
    return rows


def _pull(own: deque[_Place], other: deque[_Place], place: _Place, side: float, way: list[_Place]) -> None:
    """Stretch one side of the room for the way to a new place; it turns where the other side bars the straight line.

    Both sides begin where the way ends so far.
    """
    while len(own) > 1 and side * (_slope(own[-1], place) - _slope(own[-2], own[-1])) <= 0.0:
        own.pop()
    own.append(place)
    while len(own) == 2 and len(other) > 1 and side * (_slope(own[0], place) - _slope(other[0], other[1])) < 0.0:
        other.popleft()
        way.append(other[0])
        own[0] = other[0]


def _slope(one: _Place, other: _Place) -> float:
    return (other[1] - one[1]) / (other[0] - one[0])


def shifted(profile: InputProfile, begin: float, duration: float) -> InputProfile:
    """Return a profile as it is from a time on, s, which becomes 0, for a duration."""
    full = 2.0 * math.pi
    sinusoids = tuple(Sinusoid(one.amplitude, one.frequency, math.fmod(one.phase + full * one.frequency * begin, full))
                  for one in profile.sinusoids)
    if profile.period < math.inf:
        return _unrolled(profile, begin, duration, sinusoids)
    value, rate, _ = profile.pieces_at(begin)
    first, last = bisect_right(profile.starts, begin), bisect_right(profile.starts, begin + duration)
    return InputProfile((0.0, *(start - begin for start in profile.starts[first:last])),
                        (value, *profile.values[first:last]), (rate, *profile.rates[first:last]), sinusoids=sinusoids)


def _unrolled(profile: InputProfile, begin: float, duration: float, sinusoids: tuple[Sinusoid, ...]) -> InputProfile:
    """Return the pieces of a profile that repeats itself, one after the other."""
    starts, values, rates = [], [], []
    time = begin
    while time <= begin + duration:
        value, rate, end = profile.pieces_at(time)
        starts.append(time - begin)
        values.append(value)
        rates.append(rate)
        time = end
    return InputProfile(tuple(starts), tuple(values), tuple(rates), sinusoids=sinusoids)


def travelled(profile: InputProfile, times: Numbers) -> Numbers:
    """Return how far a velocity profile has gone since 0 at each of the times (n,) >= 0 s, m."""
    last = float(times.max(initial=0.0))
    way = profile if profile.period == math.inf else _unrolled(profile, 0.0, last, ())
    starts, values, rates = map(np.array, (way.starts, way.values, way.rates))
    lengths = np.diff(starts)
    sums = np.append(0.0, np.cumsum((values[:-1] + 0.5 * rates[:-1] * lengths) * lengths))
    at = np.searchsorted(starts, times, 'right') - 1
    since = times - starts[at]
    gone = sums[at] + (values[at] + 0.5 * rates[at] * since) * since
    for one in profile.sinusoids:
        turn = 2.0 * math.pi * one.frequency
        gone += one.amplitude / turn * (math.cos(one.phase) - np.cos(turn * times + one.phase))
    return np.asarray(gone)
