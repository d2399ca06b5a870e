# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The time of a recording on the steady clock: at any rate, stopped and continued."""

import math
from threading import Lock

from ...core.time_grid import NANOSECONDS
from ...realtime.pacing import Clock, SteadyClock


class Timeline:
    """Says what time it is in a recording, ns; safe between threads.

    Every instant is reckoned from one time on the steady clock, so that no lateness adds up.
    """

    def __init__(self, rate: float, is_paused: bool = False, clock: Clock | None = None) -> None:
        self._clock: Clock = clock or SteadyClock()
        self._lock = Lock()
        self._rate, self._is_paused = rate, is_paused
        self._time, self._since = 0, self._clock.now()

    @property
    def is_paused(self) -> bool:
        """Whether time stands still."""
        return self._is_paused

    def now(self) -> int:
        """Return the time in the recording, ns."""
        with self._lock:
            return self._now()

    def left(self, time: int) -> float:
        """Return in how many seconds of the steady clock a time comes; inf while time stands still."""
        with self._lock:
            return math.inf if self._is_paused else (time - self._now()) / (self._rate * NANOSECONDS)

    def move(self, time: int) -> None:
        """Let it be this time now."""
        with self._lock:
            self._time, self._since = time, self._clock.now()

    def pause(self, paused: bool) -> None:
        """Let time stand still, or go on from where it stands."""
        with self._lock:
            self._time, self._since = self._now(), self._clock.now()
            self._is_paused = paused

    def change_rate(self, rate: float) -> None:
        """Let time go on at another rate: seconds of the recording per second."""
        with self._lock:
            self._time, self._since = self._now(), self._clock.now()
            self._rate = rate

    def _now(self) -> int:
        if self._is_paused:
            return self._time
        return self._time + round((self._clock.now() - self._since) * self._rate)
