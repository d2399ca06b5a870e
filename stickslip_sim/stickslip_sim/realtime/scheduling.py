# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How the kernel treats the step thread: its priority, its cores, and its memory; in the words of ros2_control.

What is not granted is said in one line, and the loop goes on without it.  The other threads of the process get the
priority below: each of them (recorder, executor, middleware) at times holds what the steps need, the interpreter or a
lock of the middleware, and without a priority it could wait for a core meanwhile, and the steps for it.
"""

import ctypes
import os
import resource
import signal
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from ..core.errors import InputError

# What this process may ask of the kernel: limits raised as far as they go, capabilities, and how to get more.

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


_MCL_CURRENT, _MCL_FUTURE = 1, 2
_LEAST_RTTIME = 200_000     # µs: twice the longest stretch without a wait (core_share)


class Scheduling(NamedTuple):
    """What is wanted; 0, nothing and no cores leave things as they are."""

    thread_priority: int = 0              # SCHED_FIFO, 1 to 99
    lock_memory: bool = False
    cpu_affinity: tuple[int, ...] = ()
    require_real_time: bool = False       # refuse to start without all that is wanted


class StepThread:
    """Asks the kernel for what is wanted; `granted` says in words what is in force, `missing` what is not and why.

    `is_capable` says whether the process has a capability.  Raises InputError on cores that the machine does not have,
    and with `require_real_time` when anything is missing.
    """

    def __init__(self, wanted: Scheduling, is_capable: Callable[[int], bool] = has_capability) -> None:
        self.missing: list[str] = []
        self.granted = ''
        self.is_fifo = False
        self._wanted, self._is_capable = wanted, is_capable
        self._give_notice: Callable[[str], None] = lambda text: None
        self._check_cores(wanted.cpu_affinity)
        if wanted.lock_memory:
            self.missing += filter(None, [_lock_memory(is_capable)])
        self._is_locked = wanted.lock_memory and not self.missing
        trial = threading.Thread(target=self._trial, name='trial')
        trial.start()
        trial.join()
        if wanted.require_real_time and self.missing:
            raise InputError('require_real_time', True, 'false, or all that is wanted granted', '; '.join(self.missing))

    def enter(self) -> None:
        """Take what was granted; for the step thread itself, at its start."""
        self._take()

    def lead(self, give_notice: Callable[[str], None]) -> None:
        """Put the threads that there are, and those that they start, next to the step thread; for the main thread.

        When the kernel says that real-time CPU time has been used for too long, all give it up, with a notice.
        """
        self._give_notice = give_notice
        if self.is_fifo:
            signal.signal(signal.SIGXCPU, lambda *_: self._give_up())
            _schedule_all(os.SCHED_FIFO, max(self._wanted.thread_priority - 1, 1))

    def _check_cores(self, cores: Sequence[int]) -> None:
        there = _cores_of_the_machine()
        if absent := [core for core in cores if core not in there]:
            raise InputError('cpu_affinity', absent[0] if len(absent) == 1 else absent,
                             f'of the cores of this machine, 0 to {max(there)}', 'choose one of these')

    def _trial(self) -> None:
        """Try in a thread of its own what the step thread will do."""
        self.missing += self._take()

    def _take(self) -> list[str]:
        """Let the calling thread have what is wanted; return what it does not get."""
        wanted, missing, granted = self._wanted, [], []
        if wanted.thread_priority:
            missing.append(_take_priority(wanted.thread_priority, self._is_capable))
            self.is_fifo = not missing[-1]
            granted += [f'SCHED_FIFO {wanted.thread_priority}'] if self.is_fifo else []
        if self._is_locked:
            granted.append('memory locked')
        if wanted.cpu_affinity:
            missing.append(_take_cores(wanted.cpu_affinity))
            granted += [] if missing[-1] else [_words(wanted.cpu_affinity)]
        self.granted = ', '.join(granted)
        return [text for text in missing if text]

    def _give_up(self) -> None:
        _schedule_all(os.SCHED_OTHER, 0)
        self.is_fifo = False
        text = 'SCHED_FIFO is given up: the kernel sent SIGXCPU, its limit on real-time CPU time (RLIMIT_RTTIME)'
        self.granted = ', '.join(['SCHED_FIFO lost', *self.granted.split(', ')[1:]])
        self.missing.append(text)
        self._give_notice(text)


def _schedule_all(policy: int, priority: int) -> None:
    """Let the kernel schedule all threads of this process so."""
    for thread in os.listdir('/proc/self/task'):
        with suppress(OSError):    # it has ended
            os.sched_setscheduler(int(thread), policy, os.sched_param(priority))


def _take_priority(priority: int, is_capable: Callable[[int], bool]) -> str:
    """Put the calling thread under SCHED_FIFO; return why not, or an empty text."""
    if raise_soft(resource.RLIMIT_RTTIME) < _LEAST_RTTIME:
        return (f'SCHED_FIFO {priority} is not used: RLIMIT_RTTIME would kill the process; let its hard limit be at'
                f' least {_LEAST_RTTIME} us (ulimit -H -R, LimitRTTIME of systemd)')
    with suppress(OSError, ValueError):
        raise_soft(resource.RLIMIT_RTPRIO)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
    except PermissionError:
        return no_priority(priority, is_capable)
    except (AttributeError, OSError) as error:
        return f'SCHED_FIFO {priority} is not granted: {error}; this kernel has none'
    return ''


def _take_cores(cores: Sequence[int]) -> str:
    """Bind the calling thread to cores; return why not, or an empty text."""
    with suppress(OSError):
        os.sched_setaffinity(0, cores)
    if os.sched_getaffinity(0) == set(cores):
        return ''
    return (f'{_words(cores)} is not granted: this process may use {sorted(os.sched_getaffinity(0))}; let its cpuset'
            ' have it (docker --cpuset-cpus, AllowedCPUs of systemd)')


def _lock_memory(is_capable: Callable[[int], bool]) -> str:
    """Keep all memory in RAM, now and later; return why not, or an empty text."""
    try:
        missing = short_of_memory(is_capable)
        if missing:
            return missing
        libc = ctypes.CDLL(None, use_errno=True)
        if libc.mlockall(_MCL_CURRENT | _MCL_FUTURE):
            return f'memory is not locked: {os.strerror(ctypes.get_errno())}; free some, or leave lock_memory off'
    except (AttributeError, OSError) as error:
        return f'memory is not locked: {error}; this system has no mlockall'
    return ''


def _cores_of_the_machine() -> set[int]:
    return set(range(os.cpu_count() or 1)) | os.sched_getaffinity(0)


def _words(cores: Sequence[int]) -> str:
    return f'core{"s" if len(cores) > 1 else ""} {", ".join(map(str, cores))}'
