# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""SIGINT, SIGTERM and SIGHUP, taken before anything that takes long is imported."""

import os
import signal

TYPE_CHECKING = False    # as in the package: `typing` is not imported before it is needed
if TYPE_CHECKING:
    from .standstill import Standstill

_TAKEN = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Signals:
    """Takes the signals that end a program: they cut the start short, and end the run at the next look at `stop`.

    SIGHUP, of a terminal that was closed, only where it was not ignored, as under nohup.  Where no handler of a signal
    can run any more, `standstill` ends the process.
    """

    standstill: 'Standstill'

    def __init__(self) -> None:
        self.stop = False
        self.is_starting = True
        for number in _TAKEN:
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:
                signal.signal(number, self._take)

    @staticmethod
    def ignore() -> None:
        """Take no more of them: all is closed, and Python, on its way out, would let the next one kill the process."""
        for number in _TAKEN:
            signal.signal(number, signal.SIG_IGN)

    def _take(self, *_: object) -> None:
        self.stop = True
        if self.is_starting:
            # Nothing is open yet that an end would have to close.  An exception would not do: imports take most of this
            # time, and some of them (of compiled code, and in destructors) swallow one that is raised in a handler.
            os._exit(0)
