# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The drive: how it follows its commands, within its limits.

Its profile is made of constants and ramps, so that the motion of the axis stays exact.
"""

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..core.input_profile import Input, InputProfile, plain_of, profile_of
from ..core.types import Instant
from .faults import Effect
from .random_stream import Stream, restore, state_of, stream


@dataclass(frozen=True, slots=True)
class DriveLimits:
    """What the drive can do: m/s and m/s²; inf: anything."""

    velocity: float = math.inf
    acceleration: float = math.inf


class Drive:
    """The profile of the drive velocity from the present instant on; at first that of the scene.

    `period` (s) is how long a command holds at least: that of the steps.
    """

    def __init__(self, profile: InputProfile, limits: DriveLimits, period: float) -> None:
        self._limits = limits
        self._within_reach = limits.acceleration * period * _ROUNDED_UP   # m/s: what it can gain or lose in a step
        self._own = profile               # while nothing was commanded
        self._profile: Input = profile
        self._target: float | None = None
        self._acceleration = math.inf    # with which it makes for it
        self._frozen = False

    @property
    def profile(self) -> Input:
        """What it does: a velocity that holds, m/s, ramps, or the input profile of the scene."""
        return _STANDSTILL if self._frozen else self._profile

    def follow(self, velocity: float, now: Instant, acceleration: float = math.inf) -> bool:
        """Make for a velocity (m/s) within the limits, and within `acceleration` (m/s²) if that is lower.

        Returns whether the limits let it have that velocity by the end of the step; those of a frozen drive do.
        """
        fastest = self._limits.velocity
        is_followed = is_within = -fastest <= velocity <= fastest
        target = velocity if is_within else math.copysign(fastest, velocity)
        if self._within_reach != math.inf:
            is_followed = is_within and (self._frozen or abs(velocity - self._at(now)) <= self._within_reach)
            acceleration = min(acceleration, self._limits.acceleration)
        if target != self._target or acceleration != self._acceleration:
            self._target, self._acceleration = target, acceleration
            if not self._frozen:
                self._profile = (target if acceleration == math.inf
                                 else _ramp(self._at(now), target, now, acceleration))
        return is_followed

    def freeze(self, frozen: bool, now: Instant) -> None:
        """Stand still at once, or make for the latest target again: from standstill, within the limits."""
        if self._frozen and not frozen:
            self._profile = self._own
            if self._target is not None:
                self._profile = _ramp(0.0, self._target, now, self._acceleration)
        self._frozen = frozen

    def checkpoint(self) -> list[Any]:
        """Return what it does and what it was commanded, as plain data."""
        return [plain_of(self._profile), self._target, self._acceleration, self._frozen]

    def restore(self, saved: Sequence[Any]) -> None:
        """Go on from a checkpoint."""
        profile, target, acceleration, frozen = saved
        self._profile = profile_of(profile)
        self._target = None if target is None else float(target)
        self._acceleration, self._frozen = float(acceleration), bool(frozen)

    def _at(self, now: Instant) -> float:
        profile = self.profile
        return profile.value_at(now.seconds) if isinstance(profile, InputProfile) else profile + 0.0    # never −0.0


_STANDSTILL = 0.0
_ROUNDED_UP = 1.0 + 1e-9


def _ramp(start: float, target: float, now: Instant, acceleration: float) -> Input:
    begin = now.seconds
    end = begin + abs(target - start) / acceleration
    if not end > begin:
        return target
    rate = math.copysign(acceleration, target - start)
    if begin == 0.0:
        return InputProfile((0.0, end), (start, target), (rate, 0.0))
    return InputProfile((0.0, begin, end), (start, start, target), (0.0, rate, 0.0))


# The command channel of drive velocities: it loses or delays them when a fault says so.

class CommandChannel:
    """Takes commands in and lets them out, before the same step without a fault."""

    def __init__(self, seed: int) -> None:
        self._stream = stream(seed, Stream.LOSS)
        self.under_way: deque[tuple[int, float]] = deque()    # step of arrival, velocity

    def put(self, velocity: float, step: int, effect: Effect) -> bool:
        """Send a command before a step; return whether it gets through.  Those that it overtakes never arrive."""
        if effect.command_kept < 1.0 and self._stream.random_sample() >= effect.command_kept:
            return False
        arrival = step + effect.command_delay
        while self.under_way and self.under_way[-1][0] >= arrival:
            self.under_way.pop()
        self.under_way.append((arrival, velocity))
        return True

    def checkpoint(self) -> list[Any]:
        """Return what is under way and the random numbers to come, as plain data."""
        return [[list(command) for command in self.under_way], state_of(self._stream)]

    def restore(self, saved: Sequence[Any]) -> None:
        """Go on from a checkpoint."""
        under_way, stream = saved
        self.under_way = deque((int(step), float(velocity)) for step, velocity in under_way)
        restore(self._stream, stream)

    def take(self, step: int) -> float | None:
        """Return the latest command that has arrived before a step, None without a new one."""
        arrived = None
        while self.under_way and self.under_way[0][0] <= step:
            arrived = self.under_way.popleft()[1]
        return arrived
