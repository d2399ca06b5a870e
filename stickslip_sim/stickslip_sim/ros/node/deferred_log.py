# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Log lines of the step loop, written by the thread of the executor: to write one may take longer than a step."""

from collections import deque
from typing import Any


class DeferredLog:
    """Takes lines from any thread; `write` hands them to `log`, that of a node."""

    def __init__(self, log: Any) -> None:
        self._log = log
        self._lines: deque[tuple[bool, str]] = deque()    # whether it warns, and its text

    def info(self, text: str) -> None:
        """Take a line for information."""
        self._lines.append((False, text))

    def warning(self, text: str) -> None:
        """Take a warning."""
        self._lines.append((True, text))

    def write(self) -> None:
        """Write what has been taken since the last time."""
        for _ in range(len(self._lines)):
            warns, text = self._lines.popleft()
            if warns:
                self._log.warning(text)
            else:    # a line of its own: rclpy refuses to log with two severities from one
                self._log.info(text)
