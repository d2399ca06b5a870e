# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `replay_node`."""

import sys
from collections.abc import Sequence

from .process.stop_signals import Signals


def main(args: Sequence[str] | None = None) -> int:
    """Run to the end of the recording, or until SIGINT or SIGTERM; return the exit code as sim_node does."""
    signals = Signals()
    from .process.program import live
    from .replay.replay_program import PROGRAM
    return live(sys.argv[1:] if args is None else args, signals, PROGRAM)


if __name__ == '__main__':
    sys.exit(main())
