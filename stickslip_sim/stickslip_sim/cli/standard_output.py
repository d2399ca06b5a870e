# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The standard output of the tool: written whole, or its end said in one line.  The process may have none (closed)."""

import errno
import io
import os
import sys

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
