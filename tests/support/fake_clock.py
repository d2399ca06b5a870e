# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A clock for tests of what keeps time, so that nothing waits."""


class FakeClock:
    """Time that passes only when somebody sleeps or says so."""

    def __init__(self) -> None:
        self.time = 5_000_000_000

    def now(self) -> int:
        return self.time

    def sleep(self, seconds: float) -> None:
        self.time += round(seconds * 1e9)
