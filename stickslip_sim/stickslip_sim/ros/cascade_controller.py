# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `cascade_controller`."""

import sys
from collections.abc import Sequence

from .sim_node import Signals


def main(args: Sequence[str] | None = None) -> int:
    """Run until SIGINT or SIGTERM; return the exit code: 0 ended, 1 internal error, 2 refused start."""
    signals = Signals()
    from .controller_program import controller_program
    from .life import live
    program = controller_program('cascade_controller', compensates=False)
    return live(sys.argv[1:] if args is None else args, signals, program)


if __name__ == '__main__':
    sys.exit(main())
