# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `compensating_controller`."""

import sys
from collections.abc import Sequence

from .process.stop_signals import Signals


def main(args: Sequence[str] | None = None) -> int:
    """Run until SIGINT or SIGTERM; return the exit code: 0 ended, 1 internal error, 2 refused start."""
    signals = Signals()
    from .controllers.controller_program import controller_program
    from .process.program import live
    program = controller_program('compensating_controller', compensates=True)
    return live(sys.argv[1:] if args is None else args, signals, program)


if __name__ == '__main__':
    sys.exit(main())
