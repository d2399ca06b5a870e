# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs as they were measured, as profiles for the engine; and profiles from a later time on."""

import math
from bisect import bisect_right

import numpy as np
from numpy.typing import NDArray

from ..core.input_profile import InputProfile, Sinusoid

Numbers = NDArray[np.float64]

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


def shifted(profile: InputProfile, begin: float, duration: float) -> InputProfile:
    """Return a profile as it is from a time on, s, which becomes 0, for a duration."""
    full = 2.0 * math.pi
    waves = tuple(Sinusoid(one.amplitude, one.frequency, math.fmod(one.phase + full * one.frequency * begin, full))
                  for one in profile.sinusoids)
    if profile.period < math.inf:
        return _unrolled(profile, begin, duration, waves)
    value, rate, _ = profile.pieces_at(begin)
    first, last = bisect_right(profile.starts, begin), bisect_right(profile.starts, begin + duration)
    return InputProfile((0.0, *(start - begin for start in profile.starts[first:last])),
                        (value, *profile.values[first:last]), (rate, *profile.rates[first:last]), sinusoids=waves)


def _unrolled(profile: InputProfile, begin: float, duration: float, waves: tuple[Sinusoid, ...]) -> InputProfile:
    """Return the pieces of a profile that repeats itself, one after the other."""
    starts, values, rates = [], [], []
    time = begin
    while time <= begin + duration:
        value, rate, end = profile.pieces_at(time)
        starts.append(time - begin)
        values.append(value)
        rates.append(rate)
        time = end
    return InputProfile(tuple(starts), tuple(values), tuple(rates), sinusoids=waves)


def travelled(profile: InputProfile, times: Numbers) -> Numbers:
    """Return how far a velocity profile has gone since 0 at each of the times (n,) >= 0 s, m."""
    edges, sums = [0.0], [0.0]
    last = float(times.max(initial=0.0))
    time = 0.0
    pieces = []
    while time <= last:
        value, rate, end = profile.pieces_at(time)
        pieces.append((value, rate))
        length = min(end, last + 1.0) - time
        edges.append(time + length)
        sums.append(sums[-1] + value * length + 0.5 * rate * length * length)
        time = end
    at = np.clip(np.searchsorted(edges, times, 'right') - 1, 0, len(pieces) - 1)
    values, rates = np.array(pieces).T
    since = times - np.array(edges)[at]
    gone = np.array(sums)[at] + values[at] * since + 0.5 * rates[at] * since * since
    for one in profile.sinusoids:
        turn = 2.0 * math.pi * one.frequency
        gone += one.amplitude / turn * (math.cos(one.phase) - np.cos(turn * times + one.phase))
    return np.asarray(gone)
