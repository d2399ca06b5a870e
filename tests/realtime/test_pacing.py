# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Deadlines: absolute, exact, caught up within bounds.  The clock is a fake; nothing waits."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stickslip_sim.core.time_grid import Grid
from stickslip_sim.realtime.pacing import Pacer
from tests.support.fake_clock import FakeClock

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
    @pytest.mark.parametrize(('rate', 'step', 'expected'), [
        (1000.0, 0, (0.0, 0.0)), (1000.0, 1, (0.0, 0.001)), (1000.0, 1000, (1.0, 0.0)), (1000.0, 1234, (1.0, 0.234)),
        (333.3, 3333, (10.0, 0.0)), (0.1, 1, (10.0, 0.0)), (3.0, 2, (0.0, 2 / 3)),
    ])
    def test_instants(self, rate: float, step: int, expected: tuple[float, float]) -> None:
        assert tuple(Grid(rate).instant(step)) == expected

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
