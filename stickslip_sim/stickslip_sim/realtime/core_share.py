# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Leaves the core to others now and then, where steps at real-time priority follow each other without a wait.

A loop that never waits would keep the threads of the middleware from its core, and the kernel ends a process that goes
beyond RLIMIT_RTTIME without one.
"""

from .pacing import Clock

STRETCH = 50_000_000    # ns of steps without a wait
_REST = 2e-3            # s


class CoreShare:
    """For the thread of the step loop; times are ns on its `clock`."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._since = 0

    def waited(self, now: int) -> None:
        """Note that the loop has waited until now."""
        self._since = now

    def worked(self, now: int) -> None:
        """Wait a little when the loop has worked for too long."""
        if now - self._since > STRETCH:
            self._clock.sleep(_REST)
            self._since = self._clock.now()
