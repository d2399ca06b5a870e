# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `sim_node`: takes the signals before anything else, also before the imports that take long."""

import sys
from collections.abc import Sequence

from .process.stop_signals import Signals


def main(args: Sequence[str] | None = None) -> int:
    """Run until SIGINT or SIGTERM; return the exit code: 0 ended, 1 internal error, 2 refused start or broken bag."""
    signals = Signals()
    from .node.axis_program import PROGRAM
    from .process.program import live
    return live(sys.argv[1:] if args is None else args, signals, PROGRAM)


if __name__ == '__main__':
    sys.exit(main())
