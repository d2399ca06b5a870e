# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Rights that a process starts with, and how the kernel schedules its threads."""

import ctypes
import os
import resource
import signal
import threading
from pathlib import Path

import pytest

_PR_CAPBSET_DROP = 24
_IPC_LOCK, _SYS_NICE, _SYS_RESOURCE = 14, 23, 24


def may_use_fifo() -> bool:
    """Return whether a thread of this process may have SCHED_FIFO."""
    granted: list[bool] = []

    def ask() -> None:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
            granted.append(True)
        except OSError:
            pass

    thread = threading.Thread(target=ask)
    thread.start()
    thread.join()
    return bool(granted)


needs_fifo = pytest.mark.skipif(not may_use_fifo(), reason='this machine does not grant SCHED_FIFO')


def start_without_rights() -> None:
    """Let a child process start as a user without rights does: for `prepare`; it takes an `exec`."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for limit, value in ((resource.RLIMIT_RTPRIO, 0), (resource.RLIMIT_MEMLOCK, 1 << 20)):
        resource.setrlimit(limit, (value, value))
    libc = ctypes.CDLL(None)
    for capability in (_IPC_LOCK, _SYS_NICE, _SYS_RESOURCE):
        libc.prctl(_PR_CAPBSET_DROP, capability, 0, 0, 0)


def policies(pid: int) -> dict[int, tuple[int, int]]:
    """Return policy and real-time priority of each thread of a process, by its id."""
    found = {}
    for task in Path(f'/proc/{pid}/task').iterdir():
        fields = (task / 'stat').read_text().rpartition(')')[2].split()
        found[int(task.name)] = int(fields[38]), int(fields[37])
    return found


def name_of(pid: int, thread: int) -> str:
    """Return the name of a thread."""
    return Path(f'/proc/{pid}/task/{thread}/comm').read_text().strip()
