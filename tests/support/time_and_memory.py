# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Time and memory that reading something small may take."""

import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """Raise TimeoutError when what is done takes longer; in the main thread only."""
    before = signal.signal(signal.SIGALRM, _ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def limit_memory(megabytes: int) -> None:
    """Let this process have so much more memory than it has now, and no more: beyond it is a MemoryError."""
    with open('/proc/self/statm', encoding='ascii') as file:
        pages = int(file.read().split()[0])
    most = pages * resource.getpagesize() + (megabytes << 20)
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _ring(signum: int, frame: FrameType | None) -> NoReturn:
    raise TimeoutError('it takes too long')
