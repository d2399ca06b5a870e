# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The positioning moves that a controller follows: out, dwell, back, dwell, for ever."""

import math
from dataclasses import dataclass
from typing import NamedTuple


class Setpoint(NamedTuple):
    """Where the slider should be, and how fast."""

    position: float  # m
    velocity: float  # m/s



@dataclass(frozen=True, slots=True)
class Moves:
    """Moves of `travel` (m, > 0) at `feed` (m/s, > 0), with `acceleration` (m/s², > 0) and `dwell` (s, >= 0) at rest.

    The speed over time is a trapezoid; where the travel is too short for the feed, a triangle.  With 10 mm/s these are
    the moves of the scene `positioning`.
    """

    travel: float = 0.002
    feed: float = 0.0005
    acceleration: float = 0.08
    dwell: float = 0.875

    @property
    def peak(self) -> float:
        """The speed that is reached, m/s."""
        return min(self.feed, math.sqrt(self.travel * self.acceleration))

    @property
    def duration(self) -> float:
        """How long one move takes, s."""
        return self.travel / self.peak + self.peak / self.acceleration

    @property
    def period(self) -> float:
        """How long a move out and back takes with both dwells, s."""
        return 2.0 * (self.duration + self.dwell)

    def at(self, time: float) -> Setpoint:
        """Return the setpoint at `time` >= 0 s; position 0 is where the moves begin."""
        elapsed = math.fmod(time, self.period)
        half = 0.5 * self.period
        if elapsed < half:
            return self._stroke(elapsed)
        back = self._stroke(elapsed - half)
        return Setpoint(self.travel - back.position, -back.velocity)

    def _stroke(self, elapsed: float) -> Setpoint:
        left = self.duration - elapsed
        if left <= 0.0:
            return Setpoint(self.travel, 0.0)
        ramp = self.peak / self.acceleration
        if elapsed < ramp:
            return Setpoint(0.5 * self.acceleration * elapsed * elapsed, self.acceleration * elapsed)
        if left < ramp:
            return Setpoint(self.travel - 0.5 * self.acceleration * left * left, self.acceleration * left)
        return Setpoint(self.peak * (elapsed - 0.5 * ramp), self.peak)
