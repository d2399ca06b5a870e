# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `health`: whether an axis is well, for what watches over containers and services."""

import sys
from collections.abc import Sequence

from .process.stop_signals import Signals


def main(args: Sequence[str] | None = None) -> int:
    """Ask once; return the exit code: 0 well, 1 unwell or not there, 2 refused start."""
    signals = Signals()
    from .diagnostics.health_program import PROGRAM
    from .process.program import live
    return live(sys.argv[1:] if args is None else args, signals, PROGRAM)


if __name__ == '__main__':
    sys.exit(main())
