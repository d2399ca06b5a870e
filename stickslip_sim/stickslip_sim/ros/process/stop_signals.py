# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""SIGINT and SIGTERM, taken before anything that takes long is imported."""

import os
import signal

TYPE_CHECKING = False    # as in the package: `typing` is not imported before it is needed
if TYPE_CHECKING:
    from .standstill import Standstill


class Signals:
    """Takes SIGINT and SIGTERM: they cut the start short, and end the run at the next look at `stop`.

    Where no handler of a signal can run any more, `standstill` ends the process.
    """

    standstill: 'Standstill'

    def __init__(self) -> None:
        self.stop = False
        self.is_starting = True
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._take)

    @staticmethod
    def ignore() -> None:
        """Take no more of them: all is closed, and Python, on its way out, would let the next one kill the process."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)

    def _take(self, *_: object) -> None:
        self.stop = True
        if self.is_starting:    # nothing is open yet; compiling may take long, and swallows exceptions
            os._exit(0)
