# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motions of a slider between two rests, found in its measured position: when each begins and ends, and where.

The velocity is the slope of parabolas through the readings; their length is the least at which the noise of the slope
is small beside the highest speed.  A motion begins where the slope, on a line through its rise, leaves zero, and ends
where it comes back to it: the noise, which hides the very ends, is passed over.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from ..runs.slips import slips_of
from .readings import SensorReadings

Numbers = NDArray[np.float64]

_NOISE = 0.01            # of the highest speed: so much noise a slope may have
_SHARE, _NOISES = 0.04, 4.0   # a motion is faster than this share of the highest speed, and so many deviations
_RISE, _FALL = (0.15, 0.6), (0.03, 0.25)   # of the peak: between these a line is laid through the slope
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
    """A position, m, and its slope, m/s, over times (s), with the standard deviations of both."""

    times: Numbers
    position: Numbers
    velocity: Numbers
    position_noise: float
    velocity_noise: float


def track_of(measurement: SensorReadings) -> Track:
    """Return position and velocity of the slider as they were measured, each from the other where it was not.

    They are at even times; in a gap of the measurement they are linear.
    """
    count = max(round(float(np.ptp(measurement.times)) / measurement.period), 3) + 1
    times = np.linspace(measurement.times[0], measurement.times[-1], count)
    position, velocity = measurement.channel('position'), measurement.channel('velocity')
    if position is None:
        assert velocity is not None
        speed = np.interp(times, measurement.times, velocity.values)
        gone = np.append(0.0, np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(times)))
        return Track(times, gone, speed, velocity.resolution * measurement.period, velocity.resolution)
    readings = np.interp(times, measurement.times, position.values)
    length, slope = 3, np.gradient(readings, times)
    most = max(3, int(_LONGEST * count))
    while True:
        noise = position.resolution * (12.0 / (length * (length**2 - 1.0)))**0.5 / measurement.period
        if noise <= _NOISE * float(np.abs(slope).max()) or length + 2 > most:
            break
        length += 2
        slope = savgol_filter(readings, length, 2, deriv=1, delta=measurement.period)
    if velocity is not None and velocity.resolution < noise:
        slope, noise = np.interp(times, measurement.times, velocity.values), velocity.resolution
    return Track(times, readings, np.asarray(slope, dtype=np.float64), position.resolution, noise)


def motions_of(track: Track) -> list[MeasuredMotion]:
    """Return the motions between rests, in the order of time; one that is cut off by the run is left out."""
    speed = np.abs(track.velocity)
    threshold = max(_SHARE * float(speed.max()), _NOISES * track.velocity_noise)
    found: list[MeasuredMotion] = []
    for rows in slips_of(track.velocity, threshold):
        if rows.first == 0 or rows.end >= len(track.times):
            continue
        motion = _motion(track, rows.first, rows.end, rows.peak, float(rows.direction))
        if motion is not None and (not found or motion.begin > found[-1].end):
            found.append(motion)
    return found


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
