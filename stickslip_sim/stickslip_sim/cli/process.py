# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and SIGTERM end the tool, but not within an import: its module may make an error of its own of it (numpy).

The third Ctrl-C ends it where it is: code of a user may take the others for errors of its own.
"""

import errno
import io
import os
import signal
import sys
from types import FrameType

_TERMINATED = 143
_INTERRUPTED = 130
_LATER = 0.01    # s
_MOST = 3        # Ctrl-C
_given: list[int] = []    # Ctrl-C so far


def listen() -> None:
    """Take both; Ctrl-C not where the process that started this one ignores it."""
    signal.signal(signal.SIGTERM, _end)
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _end)


def _end(signum: int, frame: FrameType | None) -> None:
    if signum == signal.SIGINT:
        _given.append(signum)
        if len(_given) >= _MOST:
            os.write(2, b'stickslip: interrupted\n')
            os._exit(_INTERRUPTED)
    _end_later(signum, frame)


def _end_later(signum: int, frame: FrameType | None) -> None:
    """End it, once no import is under way."""
    if _imports(frame):
        signal.signal(signal.SIGALRM, lambda _, later: _end_later(signum, later))
        signal.setitimer(signal.ITIMER_REAL, _LATER)
    elif signum == signal.SIGINT:
        raise KeyboardInterrupt
    else:
        sys.exit(_TERMINATED)


def _imports(frame: FrameType | None) -> bool:
    while frame is not None and frame.f_globals.get('__name__') != 'importlib._bootstrap':
        frame = frame.f_back
    return frame is not None


# The standard output of the tool: written whole, or its end said in one line.  The process may have none (closed).

_UNWRITABLE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF, errno.EPIPE, errno.EAGAIN,
               errno.ECONNRESET, errno.ENOTCONN, errno.ETIMEDOUT)


def buffer() -> None:
    """Let what is written be written whole: unbuffered (PYTHONUNBUFFERED), Python drops what a write leaves over."""
    out = sys.stdout
    if out is not None and isinstance(getattr(out, 'buffer', None), io.RawIOBase):
        sys.stdout = io.TextIOWrapper(io.BufferedWriter(out.buffer), out.encoding, out.errors, line_buffering=True)


def flush() -> None:
    """Write what still waits; raises OSError."""
    if sys.stdout is not None:
        sys.stdout.flush()


def give_up() -> None:
    """Drop the rest: Python would fail to write it at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def is_its(error: Exception) -> bool:
    """Return whether standard output failed; a file that fails is refused by its name (`files`)."""
    return isinstance(error, OSError) and error.filename is None and error.errno in _UNWRITABLE
