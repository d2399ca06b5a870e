# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Deadlines: absolute, exact, caught up within bounds; what the kernel grants the step thread; lateness."""

import json
import os
import resource
import subprocess
import sys
import threading
from collections.abc import Callable
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.hil.bare_loop import Lateness
from benchmarks.hil.yardstick import kernel_figures
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.realtime import scheduling
from stickslip_sim.realtime.pacing import STRETCH, CoreShare, Pacer
from stickslip_sim.realtime.scheduling import Scheduling, StepThread
from tests.support.rights import needs_fifo
from tests.support.rigs import FakeClock

MS = 1_000_000


@pytest.fixture
def clock() -> FakeClock:
    return FakeClock()


def make(clock: FakeClock, rate: float = 1000.0, factor: float = 1.0) -> Pacer:
    pacer = Pacer(Grid(rate), factor, clock)
    pacer.restart(0)
    return pacer


def run(pacer: Pacer, steps: range) -> list[int]:
    """Make steps that take no time; return how late each began."""
    lateness = []
    for step in steps:
        while not pacer.wait(step):
            pass
        lateness.append(pacer.begin(step)[1])
    return lateness


class TestGrid:
    @given(st.floats(1.0, 2e4), st.integers(0, 10**12))
    def test_nothing_accumulates(self, rate: float, step: int) -> None:
        instant = Grid(rate).instant(step)
        exact = step / Fraction(repr(rate))
        assert instant.second == exact // 1 or instant.fraction == 1.0
        assert abs(Fraction(instant.second) + Fraction(instant.fraction) - exact) <= Fraction(2) ** -53


class TestPacer:
    def test_steps_begin_when_they_are_due(self, clock: FakeClock) -> None:
        pacer, begin = make(clock), clock.time
        assert run(pacer, range(5000)) == [0] * 5000
        assert clock.time - begin == 4999 * MS
        assert (pacer.counters.overruns, pacer.counters.caught_up) == (0, 1)    # step 0 is due at once

    def test_factor(self, clock: FakeClock) -> None:
        pacer, begin = make(clock, factor=4.0), clock.time
        run(pacer, range(1001))
        assert clock.time - begin == 250 * MS

    def test_a_stall_is_caught_up(self, clock: FakeClock) -> None:
        pacer = make(clock)
        run(pacer, range(10))
        clock.time += 20 * MS
        late = run(pacer, range(10, 40))
        assert late == [19 * MS - k * MS for k in range(20)] + [0] * 10
        assert pacer.counters.caught_up == 1 + 20
        assert pacer.counters.overruns == 18
        assert pacer.counters.skips == 0

    def test_a_long_stall_is_given_up(self, clock: FakeClock) -> None:
        pacer = make(clock)
        run(pacer, range(10))
        clock.time += 3_001 * MS
        assert run(pacer, range(10, 13)) == [3_000 * MS, 0, 0]
        assert (pacer.counters.skips, pacer.counters.skipped) == (1, 3_000 * MS)

    def test_a_slow_axis_may_be_two_periods_late(self, clock: FakeClock) -> None:
        pacer = make(clock, rate=1.0)
        run(pacer, range(2))
        clock.time += 2_500 * MS
        run(pacer, range(2, 4))
        assert pacer.counters.skips == 0

    def test_waiting_is_short_enough_to_be_stopped(self, clock: FakeClock) -> None:
        pacer, begin = make(clock, rate=1.0), clock.time
        assert not pacer.wait(1)
        assert clock.time - begin <= 50 * MS


def test_the_delay_is_that_of_pauses_and_of_time_given_up(clock: FakeClock) -> None:
    pacer = make(clock)
    run(pacer, range(100))
    assert pacer.delay == 0
    clock.time += 200 * MS
    run(pacer, range(100, 400))
    assert pacer.delay == 0    # it was caught up
    clock.time += 3000 * MS
    run(pacer, range(400, 500))
    assert 2900 * MS < pacer.delay < 3000 * MS
    given_up = pacer.delay
    clock.time += 5000 * MS    # a pause
    pacer.restart(500)
    run(pacer, range(500, 600))
    assert pacer.delay - given_up == 5000 * MS - MS
    pacer.restart(0)
    assert pacer.delay == 0


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


@pytest.fixture
def _no_fifo(monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    def refuse(*_: object) -> None:
        raise request.param

    monkeypatch.setattr(os, 'sched_setscheduler', refuse)
    monkeypatch.setattr(resource, 'getrlimit', lambda limit: (0, 0))
    monkeypatch.setattr(scheduling, 'raise_soft', lambda limit: float('inf'))


@pytest.mark.usefixtures('_no_fifo')
@pytest.mark.parametrize(('_no_fifo', 'is_capable', 'reported'), [
    (PermissionError(), False, 'SCHED_FIFO 50 is not granted: RLIMIT_RTPRIO is 0, and CAP_SYS_NICE is missing; grant it'
     ' in limits.conf (rtprio 99), or with docker --cap-add=sys_nice --ulimit rtprio=99 (docs/realtime.md)'),
    (PermissionError(), True, 'cpu.rt_runtime_us'),    # the control group
    (OSError(38, 'Function not implemented'), True, 'this kernel has none'),
], indirect=['_no_fifo'])
def test_what_is_not_granted_is_said_with_its_fix(is_capable: bool, reported: str) -> None:
    step_thread = StepThread(Scheduling(thread_priority=50), lambda capability: is_capable)
    (missing,) = step_thread.missing
    assert reported in missing
    assert (step_thread.granted, step_thread.is_fifo) == ('', False)
    with pytest.raises(InputError, match='require_real_time = True is refused: must be false, or all that is wanted'):
        StepThread(Scheduling(thread_priority=50, require_real_time=True), lambda capability: is_capable)


def test_a_limit_that_would_kill_is_not_run_into(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scheduling, 'raise_soft', lambda limit: 1000 if limit == resource.RLIMIT_RTTIME else 0)
    step_thread = StepThread(Scheduling(thread_priority=50))
    assert 'RLIMIT_RTTIME would kill the process' in step_thread.missing[0]
    assert not step_thread.is_fifo


def test_memory_is_not_locked_under_a_limit_that_later_growth_would_meet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('stickslip_sim.realtime.scheduling.raise_soft', lambda limit: 1 << 20)
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


def test_a_histogram_of_cyclictest_as_lateness() -> None:
    thread = {'histogram': {'10': 90, '20': 8, '1500': 1}, 'cycles': 100, 'min': 10, 'max': 25_000, 'avg': 12.0}
    figures = kernel_figures(thread, period=1e-3)
    assert figures['lateness_p50'] == pytest.approx(10e-6)
    assert figures['lateness_p99'] == pytest.approx(1500e-6)
    assert figures['lateness_max'] == pytest.approx(25e-3)    # beyond the histogram
    assert figures['overruns'] == pytest.approx(0.02)


def test_lateness_in_figures() -> None:
    lateness = Lateness()
    for value in (1000, 3000, 2000):
        lateness.add(value)
    lateness.overruns = 1
    figures = lateness.figures()
    assert figures['lateness_p50'] == pytest.approx(2e-6)
    assert figures['lateness_max'] == pytest.approx(3e-6)
    assert figures['overruns'] == pytest.approx(1 / 3)


def test_the_bare_loop_makes_its_steps() -> None:
    done = subprocess.run([sys.executable, '-m', 'benchmarks.hil.bare_loop', '--rate', '500', '--seconds', '0.2'],
                          check=True, capture_output=True, text=True)
    figures = json.loads(done.stdout)
    assert 0.0 < figures['lateness_p50'] <= figures['lateness_p99'] <= figures['lateness_max']
