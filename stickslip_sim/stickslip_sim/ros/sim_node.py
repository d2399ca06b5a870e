# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `sim_node`: takes the signals before anything else, also before the imports that take long."""

import os
import signal
import sys
from collections.abc import Sequence


class Signals:
    """Takes SIGINT and SIGTERM: they cut the start short, and end the run at the next look at `stop`."""

    def __init__(self) -> None:
        self.stop = False
        self.is_starting = True
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._take)

    def _take(self, *_: object) -> None:
        self.stop = True
        if self.is_starting:    # nothing is open yet; compiling may take long, and swallows exceptions
            os._exit(0)


def main(args: Sequence[str] | None = None) -> int:
    """Run until SIGINT or SIGTERM; return the exit code: 0 ended, 1 internal error, 2 refused start."""
    signals = Signals()
    from .axis_program import PROGRAM
    from .life import live
    return live(sys.argv[1:] if args is None else args, signals, PROGRAM)


if __name__ == '__main__':
    sys.exit(main())
