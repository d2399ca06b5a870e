# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and SIGTERM end the tool, but not within an import: its module may make an error of its own of it (numpy)."""

import signal
import sys
from types import FrameType

_TERMINATED = 143
_LATER = 0.01    # s


def listen() -> None:
    """Take both; Ctrl-C not where the process that started this one ignores it."""
    signal.signal(signal.SIGTERM, _end)
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _end)


def _end(signum: int, frame: FrameType | None) -> None:
    if _imports(frame):
        signal.signal(signal.SIGALRM, lambda _, later: _end(signum, later))
        signal.setitimer(signal.ITIMER_REAL, _LATER)
    elif signum == signal.SIGINT:
        raise KeyboardInterrupt
    else:
        sys.exit(_TERMINATED)


def _imports(frame: FrameType | None) -> bool:
    while frame is not None and frame.f_globals.get('__name__') != 'importlib._bootstrap':
        frame = frame.f_back
    return frame is not None
