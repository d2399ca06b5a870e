# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Notices that commands stop coming."""

import math

from ..core.time_grid import NANOSECONDS


class Watchdog:
    """Is asked before each step, from the first command on; `timeout` in s, 0: never."""

    def __init__(self, timeout: float) -> None:
        self._timeout = math.ceil(timeout * NANOSECONDS)
        self.forget()

    @property
    def is_on(self) -> bool:
        """Whether there is a time-out at all."""
        return self._timeout > 0

    def forget(self) -> None:
        """Begin anew, as if no command had come."""
        self._heard = self._since = self._before = 0
        self._is_stale = False

    def silence(self, heard: int, now: int) -> float:
        """Return how long nothing came, s, when that has just become too long, else 0.

        `heard` counts the commands up to now, ns: what it counts anew came with the step before.
        """
        if heard != self._heard:
            self._heard, self._since, self._is_stale = heard, self._before, False
        self._before = now
        silence = now - self._since
        if self._is_stale or not heard or not self.is_on or silence <= self._timeout:
            return 0.0
        self._is_stale = True
        return silence / NANOSECONDS
