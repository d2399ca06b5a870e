# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The drive: how it follows what it is told, within its limits.

Its course is made of constants and ramps, so that the motion of the axis stays exact.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..core.input_profile import InputProfile, constant, plain_of, profile_of
from ..core.types import Instant


@dataclass(frozen=True, slots=True)
class DriveLimits:
    """What the drive can do: m/s and m/s²; inf: anything."""

    velocity: float = math.inf
    acceleration: float = math.inf


class Drive:
    """The course of the drive velocity from the present instant on; at first that of the scene."""

    def __init__(self, profile: InputProfile, limits: DriveLimits) -> None:
        self._limits = limits
        self._own = profile               # while nothing was commanded
        self._profile = profile
        self._target: float | None = None
        self._acceleration = math.inf    # with which it makes for it
        self._frozen = False

    @property
    def profile(self) -> InputProfile:
        """What it does: constant, ramps, or the course of the scene."""
        return _STANDSTILL if self._frozen else self._profile

    def can_follow(self, velocity: float, now: Instant) -> bool:
        """Return whether it would take on a velocity at once."""
        within = abs(velocity) <= self._limits.velocity
        return within and (self._limits.acceleration == math.inf or velocity == self._at(now))

    def follow(self, velocity: float, now: Instant, acceleration: float = math.inf) -> None:
        """Make for a velocity (m/s) within the limits, and within `acceleration` (m/s²) if that is lower."""
        target = min(max(velocity, -self._limits.velocity), self._limits.velocity)
        acceleration = min(acceleration, self._limits.acceleration)
        if target == self._target and acceleration == self._acceleration:
            return
        self._target, self._acceleration = target, acceleration
        if not self._frozen:
            self._profile = (_ramp(self._at(now), target, now, acceleration) if acceleration < math.inf
                            else constant(target))

    def freeze(self, frozen: bool, now: Instant) -> None:
        """Stand still at once, or make for the latest target again: from standstill, within the limits."""
        if self._frozen and not frozen:
            self._profile = self._own
            if self._target is not None:
                self._profile = _ramp(0.0, self._target, now, self._acceleration)
        self._frozen = frozen

    def checkpoint(self) -> list[Any]:
        """Return what it does and what it was told, as plain data."""
        return [plain_of(self._profile), self._target, self._acceleration, self._frozen]

    def restore(self, saved: Sequence[Any]) -> None:
        """Go on from a checkpoint."""
        profile, target, acceleration, frozen = saved
        self._profile = profile_of(profile)
        self._target = None if target is None else float(target)
        self._acceleration, self._frozen = float(acceleration), bool(frozen)

    def _at(self, now: Instant) -> float:
        return self.profile.value_at(now.seconds)


_STANDSTILL = constant(0.0)


def _ramp(start: float, target: float, now: Instant, acceleration: float) -> InputProfile:
    begin = now.seconds
    end = begin + abs(target - start) / acceleration
    if not end > begin:
        return constant(target)
    rate = math.copysign(acceleration, target - start)
    if begin == 0.0:
        return InputProfile((0.0, end), (start, target), (rate, 0.0))
    return InputProfile((0.0, begin, end), (start, start, target), (0.0, rate, 0.0))
