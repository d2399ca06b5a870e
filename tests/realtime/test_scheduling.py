# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the kernel grants the step thread, without ROS."""

import os
import resource
import threading
from collections.abc import Callable

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.realtime import scheduling
from stickslip_sim.realtime.core_share import STRETCH, CoreShare
from stickslip_sim.realtime.scheduling import Scheduling, StepThread
from tests.support.fake_clock import FakeClock
from tests.support.rights import needs_fifo


def in_a_thread(work: Callable[[], None]) -> None:
    thread = threading.Thread(target=work)
    thread.start()
    thread.join()


def test_nothing_wanted_leaves_all_as_it_is() -> None:
    step_thread = StepThread(Scheduling())
    seen: list[tuple[int, set[int]]] = []

    def look() -> None:
        step_thread.enter()
        seen.append((os.sched_getscheduler(0), os.sched_getaffinity(0)))

    in_a_thread(look)
    assert (step_thread.granted, step_thread.missing, step_thread.is_fifo) == ('', [], False)
    assert seen == [(os.SCHED_OTHER, os.sched_getaffinity(0))]


@needs_fifo
def test_the_step_thread_gets_the_priority_and_what_it_starts_gets_none() -> None:
    core = min(os.sched_getaffinity(0))
    step_thread = StepThread(Scheduling(thread_priority=7, cpu_affinity=(core,)))
    seen: list[tuple[int, int, set[int]]] = []

    def look() -> None:
        seen.append((os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK, os.sched_getparam(0).sched_priority,
                     os.sched_getaffinity(0)))

    def run() -> None:
        step_thread.enter()
        look()
        in_a_thread(look)    # one that the step thread starts

    in_a_thread(run)
    assert step_thread.missing == []
    assert step_thread.granted == f'SCHED_FIFO 7, core {core}'
    assert seen == [(os.SCHED_FIFO, 7, {core}), (os.SCHED_OTHER, 0, {core})]
    assert os.sched_getscheduler(0) == os.SCHED_OTHER


def test_a_core_that_the_machine_has_not_is_refused() -> None:
    with pytest.raises(InputError, match='cpu_affinity = 100000 is refused: must be of the cores of this machine'):
        StepThread(Scheduling(cpu_affinity=(0, 100_000)))


def test_what_is_not_granted_is_said_with_its_fix(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, 'sched_setscheduler', refuse)
    monkeypatch.setattr(resource, 'getrlimit', lambda limit: (0, 0))
    monkeypatch.setattr(scheduling, 'raise_soft', lambda limit: float('inf'))
    step_thread = StepThread(Scheduling(thread_priority=50, lock_memory=False), lambda capability: False)
    assert (step_thread.granted, step_thread.is_fifo) == ('', False)
    assert step_thread.missing == [
        'SCHED_FIFO 50 is not granted: RLIMIT_RTPRIO is 0, and CAP_SYS_NICE is missing; grant it in limits.conf'
        ' (rtprio 99), or with docker --cap-add=sys_nice --ulimit rtprio=99 (docs/realtime.md)']
    with pytest.raises(InputError, match='require_real_time = True is refused: must be false, or all that is wanted'):
        StepThread(Scheduling(thread_priority=50, require_real_time=True), lambda capability: False)


def test_capable_but_refused_names_the_control_group(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, 'sched_setscheduler', refuse)
    assert 'cpu.rt_runtime_us' in StepThread(Scheduling(thread_priority=50), lambda capability: True).missing[0]


def test_a_kernel_without_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(38, 'Function not implemented')

    monkeypatch.setattr(os, 'sched_setscheduler', refuse)
    assert 'this kernel has none' in StepThread(Scheduling(thread_priority=50)).missing[0]


def test_a_limit_that_would_kill_is_not_run_into(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scheduling, 'raise_soft', lambda limit: 1000 if limit == resource.RLIMIT_RTTIME else 0)
    step_thread = StepThread(Scheduling(thread_priority=50))
    assert 'RLIMIT_RTTIME would kill the process' in step_thread.missing[0]
    assert not step_thread.is_fifo


def test_memory_is_not_locked_under_a_limit_that_later_growth_would_meet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('stickslip_sim.realtime.rights.raise_soft', lambda limit: 1 << 20)
    assert StepThread(Scheduling(lock_memory=True), lambda capability: False).missing == [
        'memory is not locked: RLIMIT_MEMLOCK is 1024 KiB, and CAP_IPC_LOCK is missing; grant it in limits.conf'
        ' (memlock unlimited), or with docker --cap-add=ipc_lock --ulimit memlock=-1 (docs/realtime.md)']


def test_a_loop_without_a_wait_rests_now_and_then() -> None:
    clock = FakeClock()
    share, begin = CoreShare(clock), clock.now()
    share.waited(begin)
    share.worked(begin + STRETCH)
    assert clock.now() == begin
    share.worked(begin + STRETCH + 1)
    rested = clock.now()
    assert rested == begin + 2_000_000
    share.worked(rested + STRETCH)    # the rest is counted on the clock of the steps, too
    assert clock.now() == rested
