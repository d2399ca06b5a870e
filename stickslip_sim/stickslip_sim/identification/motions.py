# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Motions and rests of a slider, found in its measured position: when each motion begins and ends, and where.

The velocity is the slope of parabolas through the readings; their length is the least at which the noise of the slope
is small beside the highest speed.  A motion begins where the slope, on a line through its rise, leaves zero, and ends
where it comes back to it: the noise, which hides the very ends, is passed over.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.input_profile import InputProfile
from ..figures.slips import stretches_of
from .readings import Channel, SensorReadings, travelled

_NOISE, _OF_DRIVE = 0.01, 0.05   # of the highest speed, and of a low one of the drive: so much noise a slope may have
_SLOWEST = 0.05          # quantile of the speeds of the drive
YIELDS = 0.3             # of the speed of the drive: a slider that moves slower rests, on a contact that yields
_SHARE, _NOISES = 0.04, 4.0   # of the highest speed, without a drive; standard deviations
_PEAK = 2.0              # times that: so fast is a motion at its peak
_RINGS_AFTER, _RINGS = 3.0, 0.15   # of a ring: its own duration since the last one; of the way of a slip
_LONG = 0.8              # quantile of the ways: of a slip, not of a ring
_RISE, _FALL = (0.15, 0.6), (0.03, 0.25)   # of the peak: between these a line is laid through the slope
_LOST = 2.0              # standard deviations: a speed that is none
_LONGEST = 0.02          # of the run: so long a parabola may be
SHARES = 0.1, 0.3, 0.5, 0.7, 0.9   # of the way at which a motion is timed


@dataclass(frozen=True)
class MeasuredMotion:
    """A motion from `begin` to `end` (s), from `start` to `stop` (m); `passed`: times (s) at SHARES of the way."""

    begin: float
    end: float
    start: float
    stop: float
    passed: tuple[float, ...]

    @property
    def direction(self) -> float:
        """1 or −1."""
        return 1.0 if self.stop >= self.start else -1.0


class Track(NamedTuple):
    """A position, m, and its slope, m/s, over even times (s); at speeds below `still` (m/s, at each time) it rests.

    `position_noise` and `velocity_noise` are standard deviations.  The slope is that of parabolas through `smoothing`
    readings, 1 where a velocity was measured.  `driven` is the speed of the drive, m/s.
    """

    times: Numbers
    position: Numbers
    velocity: Numbers
    still: Numbers
    position_noise: float
    velocity_noise: float
    smoothing: int
    driven: Numbers


def track_of(measurement: SensorReadings, drive: InputProfile) -> Track:
    """Return position and velocity of the slider as they were measured, each from the other where it was not.

    In a gap of the measurement they are linear.  A slider that rests moves slower than its drive: as the contact
    yields, not at all in one that is rigid.
    """
    count = max(round(float(np.ptp(measurement.times)) / measurement.period), 3) + 1
    times = np.linspace(measurement.times[0], measurement.times[-1], count)
    driven = np.abs(np.gradient(travelled(drive, times), times))
    position, velocity = measurement.channel('position'), measurement.channel('velocity')
    if position is None:
        assert velocity is not None
        speed = np.interp(times, measurement.times, velocity.values)
        noise, smoothing = velocity.resolution, 1
        readings = np.append(0.0, np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(times)))
        place_noise = noise * measurement.period
    else:
        readings, place_noise = np.interp(times, measurement.times, position.values), position.resolution
        speed, noise, smoothing = _slope(readings, measurement.period, place_noise, driven)
        if velocity is not None and velocity.resolution < noise:
            speed, noise, smoothing = np.interp(times, measurement.times, velocity.values), velocity.resolution, 1
    share = YIELDS * driven if driven.any() else np.full(count, _SHARE * float(np.abs(speed).max()))
    return Track(times, readings, speed, np.maximum(share, _NOISES * noise), place_noise, noise, smoothing, driven)


def _slope(readings: Numbers, period: float, resolution: float, driven: Numbers) -> tuple[Numbers, float, int]:
    """Return the slope of readings at even times, and its noise, by parabolas through as few as keep the noise low.

    The last of the three is how many.
    """
    length, slope = 3, slope_of(readings, period, 3)
    most = max(3, int(_LONGEST * len(readings)))
    moving = driven[driven > 0.0]
    slowest = float(np.quantile(moving, _SLOWEST)) if len(moving) else np.inf
    while True:
        noise = resolution * float(np.sqrt(12.0 / (length * (length**2 - 1.0)))) / period
        if noise <= min(_NOISE * float(np.abs(slope).max()), _OF_DRIVE * slowest) or length + 2 > most:
            return np.asarray(slope, dtype=np.float64), noise, length
        length += 2
        slope = slope_of(readings, period, length)


def slope_of(readings: Numbers, period: float, length: int) -> Numbers:
    """Return the slope of readings at even times by parabolas through an odd number of them."""
    if length <= 3:
        return np.asarray(np.gradient(readings, period))
    half = length // 2
    weights = np.arange(half, -half - 1.0, -1.0) / (np.sum(np.arange(-half, half + 1.0)**2) * period)
    return np.convolve(np.pad(readings, half, 'edge'), weights, 'valid')


def motions_of(track: Track) -> list[MeasuredMotion]:
    """Return the motions between rests, in the order of time; one that is cut off by the run is left out."""
    found: list[MeasuredMotion] = []
    for first, end, peak, direction in stretches_of(track.velocity, track.still):
        if first == 0 or end >= len(track.velocity) or abs(track.velocity[peak]) < _PEAK * track.still[peak]:
            continue
        motion = _motion(track, first, end, peak, float(direction))
        if motion is not None and (not found or motion.begin > found[-1].end):
            found.append(motion)
    return _without_rings(found)


def _without_rings(motions: Sequence[MeasuredMotion]) -> list[MeasuredMotion]:
    """Return motions without those of a contact that rings after a slip.

    Rings follow each other at once, and are short beside the slip before them.  That may be a long way with the drive,
    beside which slips are short too: then they are compared with the ways of others.
    """
    if not motions:
        return []
    usual = float(np.quantile([abs(motion.stop - motion.start) for motion in motions], _LONG))
    found = [motions[0]]
    for before, motion in pairwise(motions):
        way = min(abs(found[-1].stop - found[-1].start), usual)
        if motion.begin - before.end >= _RINGS_AFTER * (motion.end - motion.begin) \
                or abs(motion.stop - motion.start) >= _RINGS * way:
            found.append(motion)
    return found


def stops_of(track: Track) -> Numbers:
    """Return when the slider comes to a stop, or turns, s: where its speed leaves what a motion has, and is lost."""
    moves = np.abs(track.velocity) > track.still
    found = []
    for row in np.flatnonzero(moves[:-1] & ~moves[1:]):
        after = np.sign(track.velocity[row]) * track.velocity[row:] <= _LOST * track.velocity_noise
        if after.any():
            found.append(track.times[row + int(after.argmax())])
    turns = moves[:-1] & moves[1:] & (track.velocity[:-1] * track.velocity[1:] < 0.0)
    return np.sort(np.array([*found, *track.times[:-1][turns]]))


def _motion(track: Track, first: int, end: int, peak: int, direction: float) -> MeasuredMotion | None:
    times, velocity = track.times, direction * track.velocity
    least = _NOISES * track.velocity_noise / velocity[peak]
    begin = _zero_of_line(times, velocity, peak, first, -1, _RISE)
    stop = _zero_of_line(times, velocity, peak, end - 1, 1, (max(_FALL[0], least), max(_FALL[1], 3.0 * least)))
    if not begin < stop:
        return None
    start_row, stop_row = np.searchsorted(times, [begin, stop])
    margin = max(2, (end - first) // 10)
    before = track.position[max(start_row - margin, 0):start_row + 1]
    after = track.position[max(stop_row - 1, 0):stop_row + margin]
    x0, x1 = float(np.median(before)), _extreme(after, direction, track.position_noise)
    way = direction * (x1 - x0)
    if way <= 0.0:
        return None
    path = np.maximum.accumulate(direction * (track.position[first - 1:end + 1] - x0)) / way
    passed = tuple(float(_crossing(times[first - 1:end + 1], path, share)) for share in SHARES)
    if not np.isfinite(passed).all():
        return None
    return MeasuredMotion(begin, stop, x0, x1, passed)


def _zero_of_line(times: Numbers, velocity: Numbers, peak: int, edge: int, step: int, shares: tuple[float, float]
                  ) -> float:
    """Return where a line through the flank of a speed, from its peak to an edge of the motion, is zero, s.

    The line is laid through the outermost part that lies between two `shares` of the peak.
    """
    low, high = (share * velocity[peak] for share in shares)
    rows = np.arange(peak, min(edge + 2 * step, len(velocity)), step)
    upper = rows[:int(np.argmax(velocity[rows] < low)) or len(rows)]
    above = np.flatnonzero(velocity[upper] > high)
    inside = upper[int(above[-1]) + 1 if len(above) else 0:]
    if len(inside) < 2:
        return float(times[edge])
    slope, offset = np.polyfit(times[inside] - times[edge], velocity[inside], 1)
    return float(times[edge] - offset / slope) if slope * step < 0.0 else float(times[edge])


def _extreme(readings: Numbers, direction: float, noise: float) -> float:
    """Return the furthest of a few readings, less what noise adds to the furthest of so many."""
    furthest = direction * float((direction * readings).max())
    near = readings[np.abs(readings - furthest) <= 4.0 * noise]
    return float(near.mean())


def _crossing(times: Numbers, path: Numbers, share: float) -> float:
    row = int(np.searchsorted(path, share))
    if not 0 < row < len(path):
        return float('nan')
    return float(times[row - 1] + (share - path[row - 1]) / (path[row] - path[row - 1])
                 * (times[row] - times[row - 1]))


# The rests of a slider: after which of its measured motions it stands still, but for what its contact yields.

_SHORT_REST = 0.2             # of a motion: what is shorter is no rest
_FIRST_HALF = 0.0, 0.5
_MIDDLE = 0.25, 0.75     # of a rest: between these the slider stands still,
_FOLLOWS = 0.4           # or goes less than this share of the way of the drive, as a compliant contact lets it,
_UNUSUAL = 2.0           # and less than so many times its share in the median
_REST_NOISES = 4.0            # standard deviations of a position
_FEWEST = 10             # readings: after a shorter rest no break-away is seen


class _Rest(NamedTuple):
    """The rest after a motion; in its middle the slider has `gone` so far while the drive went `driven`, m."""

    motion: MeasuredMotion
    gone: float
    driven: float


def ends_in_rest(motions: Sequence[MeasuredMotion], track: Track, drive: InputProfile) -> tuple[MeasuredMotion, ...]:
    """Return the motions that end in a rest: not those that only slow down, or go on with the drive.

    How far a slider at rest goes with its drive is the same share in all rests of an axis, about.
    """
    ends = [*(motion.begin for motion in motions[1:]), float(track.times[-1])]
    rests = [_Rest(motion, *_gone(motion.end, end, track, drive)) for motion, end in zip(motions, ends)
             if end - motion.end >= _SHORT_REST * (motion.end - motion.begin)]
    noise = _REST_NOISES * track.position_noise
    rests = [rest for rest in rests if rest.gone <= _FOLLOWS * rest.driven + noise]
    shares = [rest.gone / rest.driven for rest in rests if rest.driven > 0.0]
    usual = _UNUSUAL * float(np.median(shares)) if shares else 0.0
    return tuple(rest.motion for rest in rests if rest.gone <= usual * rest.driven + noise)


def has_break_away(motions: Sequence[MeasuredMotion], track: Track, drive: InputProfile) -> bool:
    """Return whether one of the motions begins from a rest that was measured, so that it shows static friction.

    The slider stands still in the middle of it, or in its first half: where a slow motion begins is found too late.
    """
    shortest = _FEWEST * float(track.times[1] - track.times[0])
    ends = [float(track.times[0]), *(motion.end for motion in motions)]
    gaps = [(end, motion.begin) for end, motion in zip(ends, motions) if motion.begin - end >= shortest]
    gone = [_gone(*gap, track, drive, part) for gap in gaps for part in (_MIDDLE, _FIRST_HALF)]
    return any(own <= _FOLLOWS * driven + _REST_NOISES * track.position_noise for own, driven in gone)


def _gone(begin: float, end: float, track: Track, drive: InputProfile, part: tuple[float, float] = _MIDDLE
          ) -> tuple[float, float]:
    """Return how far slider and drive go in a part of a rest, m."""
    ends = begin + np.array(part) * (end - begin)
    return (float(abs(np.diff(np.interp(ends, track.times, track.position))[0])),
            float(abs(np.diff(travelled(drive, ends))[0])))


# Rests that are still in the readings themselves, from which the slider breaks away.

_STILL, _COUNTS, _SIGMAS = 10, 1.01, 6.0   # readings in a row, within so many counts, or standard deviations


class StillRest(NamedTuple):
    """The rest before a motion: from row `since` on, still from `first` on, and up to the row `last` at a `place`."""

    since: int
    first: int
    last: int
    place: float


def still_rests(measurement: SensorReadings, motions: Sequence[MeasuredMotion]
                ) -> tuple[list[StillRest | None], list[int]]:
    """Return the rest before each motion, None where its position shows none, and the row where a rest follows it.

    A motion that no rest follows ends with the run.
    """
    channel, times = measurement.channel('position'), measurement.times
    if channel is None or len(times) <= _STILL:
        return [None] * len(motions), [len(times)] * len(motions)
    spans = np.ptp(np.lib.stride_tricks.sliding_window_view(channel.values, _STILL), axis=1)
    still = spans <= max(_COUNTS * channel.quantum, _SIGMAS * channel.resolution)
    found: list[StillRest | None] = []
    ends = []
    for before, motion in zip((None, *motions), motions):
        since, moved, over = np.searchsorted(times, (0.0 if before is None else before.end, motion.passed[0],
                                                     motion.passed[-1])).tolist()
        rests = since + np.flatnonzero(still[since:max(moved - _STILL + 1, since)])
        after = over + np.flatnonzero(still[over:])
        found.append(_still_rest(channel, since, int(rests[-1])) if len(rests) else None)
        ends.append(int(after[0]) if len(after) else len(times))
    return found, ends


def _still_rest(channel: Channel, since: int, first: int) -> StillRest:
    readings = channel.values[first:first + _STILL]
    place = float(np.median(readings))
    there = np.flatnonzero(np.abs(readings - place) <= max(0.5 * channel.quantum, _LOST * channel.resolution))
    return StillRest(since, first, first + int(there[-1] if len(there) else _STILL - 1), place)
