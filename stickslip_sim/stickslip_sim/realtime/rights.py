# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What this process may ask of the kernel: limits raised as far as they go, capabilities, and how to get more."""

import resource
from collections.abc import Callable
from pathlib import Path

_SYS_NICE, _IPC_LOCK = 23, 14    # CAP_*, linux/capability.h
_HOW = '{} (docs/realtime.md)'


def raise_soft(limit: int) -> float:
    """Raise a soft limit to its hard one; return what holds, inf for unlimited."""
    soft, hard = resource.getrlimit(limit)
    if soft != hard:
        resource.setrlimit(limit, (hard, hard))
    return float('inf') if hard == resource.RLIM_INFINITY else hard


def has_capability(capability: int) -> bool:
    """Return whether this process has a capability, by its number."""
    try:
        status = Path('/proc/self/status').read_text(encoding='ascii')
    except OSError:
        return False
    mask = next((line.split()[1] for line in status.splitlines() if line.startswith('CapEff')), '0')
    return bool(int(mask, 16) >> capability & 1)


def no_priority(priority: int, is_capable: Callable[[int], bool] = has_capability) -> str:
    """Return what is missing for SCHED_FIFO at a priority that the kernel refused, and how to grant it."""
    limit = resource.getrlimit(resource.RLIMIT_RTPRIO)[1]
    if is_capable(_SYS_NICE) or limit >= priority:
        return _HOW.format(f'SCHED_FIFO {priority} is not granted: the control group of this process has no real-time'
                           ' runtime; give it some: cpu.rt_runtime_us, or docker --cpu-rt-runtime')
    return _HOW.format(f'SCHED_FIFO {priority} is not granted: RLIMIT_RTPRIO is {limit}, and CAP_SYS_NICE is missing;'
                       ' grant it in limits.conf (rtprio 99), or with docker --cap-add=sys_nice --ulimit rtprio=99')


def short_of_memory(is_capable: Callable[[int], bool] = has_capability) -> str:
    """Return what is missing to lock all memory, now and later, and how to grant it; empty when nothing is."""
    limit = raise_soft(resource.RLIMIT_MEMLOCK)
    if limit == float('inf') or is_capable(_IPC_LOCK):
        return ''
    return _HOW.format(f'memory is not locked: RLIMIT_MEMLOCK is {limit / 1024:.0f} KiB, and CAP_IPC_LOCK is missing;'
                       ' grant it in limits.conf (memlock unlimited), or with docker --cap-add=ipc_lock'
                       ' --ulimit memlock=-1')
