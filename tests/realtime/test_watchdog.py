# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The watchdog: on the steady clock in real time, on simulation time elsewhere, and not for the loop's own faults."""

import math
from collections.abc import Callable, Iterable, Mapping

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.inputs import load_scene
from stickslip_sim.realtime.commands import CommandSlot, Watchdog
from stickslip_sim.realtime.pacing import Pacer, StepClock, Unpaced
from stickslip_sim.realtime.step_loop import StepLoop
from stickslip_sim.simulation import RigEventKind, StepResult
from tests.support.rigs import FakeClock, make, rig_events_of
from tests.support.waiting import wait_for

MS = 1_000_000
TIMEOUT = 0.1

Act = Callable[['WatchedLoop'], object]


class WatchedLoop:
    """A loop whose clock is a fake; acts happen when a step was made, so before the next one."""

    def __init__(self, mode: str = 'realtime', timeout: float = TIMEOUT, rate: float = 1000.0) -> None:
        grid, self.clock = Grid(rate), FakeClock()
        paced = Pacer(grid, clock=self.clock, watches_steady=mode == 'realtime')
        step_clock: StepClock = Unpaced(grid) if mode == 'lockstep' else paced
        self.slots = CommandSlot('velocity', 'm/s', 1.0), CommandSlot('force', 'N', 1.0)
        self.rig = make(rate=rate)
        self.results: list[StepResult] = []
        self.loop = StepLoop(self.rig, step_clock, self.slots, [self._take], Watchdog(timeout), mode == 'lockstep')

    def command(self) -> None:
        self.slots[0].offer(0.01, self.clock.now())

    def stall(self, milliseconds: int) -> None:
        """Let time pass while the loop stands."""
        self.clock.time += milliseconds * MS

    def run(self, steps: int, acts: Mapping[int, Act]) -> list[int]:
        """Make steps; return those before which silence was reported."""
        self._acts, self._last = acts, steps
        self.loop.start()
        if self.loop.by_request:
            wait_for(lambda: self.loop.step == 0, 'the start')
            assert self.loop.at_boundary(lambda: self.loop.run_steps(steps, None, None, lambda: False))
        wait_for(lambda: self.loop.step >= steps or self.loop.crash, 'the steps')
        self.loop.stop()
        assert self.loop.crash is None
        return [step for step, kind in rig_events_of(self.results) if kind == RigEventKind.COMMAND_TIMEOUT]

    def _take(self, result: StepResult) -> None:
        self.results.append(result)
        if result.step in self._acts:
            self._acts[result.step](self)
        if result.step == self._last:
            self.loop.paused = True


def command(watched: WatchedLoop) -> None:
    watched.command()


def stall(milliseconds: int) -> Act:
    return lambda watched: watched.stall(milliseconds)


MODES = ('realtime', 'lockstep', 'free_run')


class TestSilence:
    @pytest.mark.parametrize('mode', MODES)
    def test_is_reported_at_the_first_step_that_begins_too_late(self, mode: str) -> None:
        watched = WatchedLoop(mode)
        assert watched.run(400, {9: command}) == [111]      # step 10 begins at 9 ms, step 111 at 110 ms
        event = next(event for result in watched.results for event in result.rig_events)
        assert event.value == pytest.approx(0.101, abs=1e-12)
        assert 'no drive velocity for 0.101 s: the latest is held' in event.text
        assert watched.rig.counts.timed_out == 1

    @pytest.mark.parametrize('mode', MODES)
    def test_is_reported_again_only_after_a_command(self, mode: str) -> None:
        watched = WatchedLoop(mode)
        assert watched.run(900, {9: command, 599: command}) == [111, 701]
        assert [kind for _, kind in rig_events_of(watched.results)] == [
            RigEventKind.COMMAND_TIMEOUT, RigEventKind.COMMAND_RESUMED, RigEventKind.COMMAND_TIMEOUT]

    @pytest.mark.parametrize('mode', MODES)
    @pytest.mark.parametrize(('commanded', 'timeout', 'silences'), [
        (range(9, 400, 100), TIMEOUT, []),    # just the time-out
        (range(9, 300, 101), TIMEOUT, [111, 212, 313]),    # a step more
        ((), TIMEOUT, []), ((9,), 0.0, []),    # it begins with the first command, and is off
    ])
    def test_is_what_lasts_longer_than_the_timeout(self, mode: str, commanded: Iterable[int], timeout: float,
                                                   silences: list[int]) -> None:
        assert WatchedLoop(mode, timeout).run(380, dict.fromkeys(commanded, command)) == silences

    @pytest.mark.parametrize(('rate', 'timeout', 'step'), [(10.0, 0.3, 14), (20_000.0, 0.001, 31), (3.0, 1.0, 14)])
    def test_at_other_rates(self, rate: float, timeout: float, step: int) -> None:
        assert WatchedLoop('lockstep', timeout, rate).run(50, {9: command}) == [step]

    def test_refused_commands_are_none(self) -> None:
        def bad(watched: WatchedLoop) -> None:
            watched.slots[0].offer(math.nan, watched.clock.now())

        assert WatchedLoop().run(300, {9: command, 50: bad, 80: bad}) == [111]


class TestStalls:
    """A loop that stood still itself does not cry wolf; and its stall does not keep it from crying."""

    @pytest.mark.parametrize('stalled', [50, 200, 450, 700, 5000])
    @pytest.mark.parametrize('mode', MODES)
    def test_with_commands_that_wait_to_be_heard(self, mode: str, stalled: int) -> None:
        every_20_steps: dict[int, Act] = dict.fromkeys(range(9, 2000, 20), command)
        acts = {**every_20_steps, 1000: stall(stalled)}
        assert WatchedLoop(mode).run(2000, acts) == []

    @pytest.mark.parametrize('stalled', [50, 200, 450, 700, 5000])
    def test_a_controller_that_died_before_is_noticed_after(self, stalled: int) -> None:
        (step,) = WatchedLoop().run(2000, {9: command, 30: stall(stalled)})
        assert 31 < step <= 111 + min(stalled, 500) + 1      # what is caught up does not count

    def test_short_ones_all_the_time(self) -> None:
        acts: dict[int, Act] = {9: command}
        for step in range(10, 2000, 10):
            acts[step] = stall(3)
        (step,) = WatchedLoop().run(2000, acts)
        assert 111 <= step <= 200

    @pytest.mark.parametrize('stalled', [200, 700, 5000])
    def test_do_not_move_a_time_out_in_simulation_time(self, stalled: int) -> None:
        assert WatchedLoop('free_run').run(300, {9: command, 30: stall(stalled), 90: stall(stalled)}) == [111]


class TestPause:
    def test_is_no_silence(self) -> None:
        def pause(watched: WatchedLoop) -> None:
            watched.loop.pause(True)
            watched.stall(10_000)
            watched.loop.pause(False)

        assert WatchedLoop().run(300, {9: command, 60: pause}) == [112]    # step 61 is made at once, without its period

    def test_steps_on_request_in_a_pause_are_none_either(self) -> None:
        watched = WatchedLoop()
        watched.run(50, {9: command})
        other = StepLoop(watched.rig, Pacer(Grid(1000.0), clock=watched.clock), watched.slots, [watched.results.append],
                         Watchdog(TIMEOUT))
        other.paused = True
        other.start()
        for _ in range(3):
            watched.stall(500)
            assert other.at_boundary(lambda: other.run_steps(200, None, None, lambda: False))
        other.stop()
        assert other.step == 650
        assert rig_events_of(watched.results) == []


def test_a_reset_forgets_the_commands() -> None:
    watched = WatchedLoop('lockstep')
    again = StepLoop(watched.rig, Unpaced(Grid(1000.0)), watched.slots, [watched.results.append], Watchdog(TIMEOUT),
                     True)
    again.start()
    assert again.at_boundary(lambda: again.run_steps(50, 0.01, None, lambda: False))
    assert again.at_boundary(again.restart)
    assert again.at_boundary(lambda: again.run_steps(300, None, None, lambda: False))
    again.stop()
    assert again.step == 300
    assert rig_events_of(watched.results) == []


@pytest.mark.parametrize(('timeout', 'is_refused'), [(0.0, False), (0.001, False), (0.0009, True), (1e-12, True),
                                                     (-1.0, True), (math.nan, True)])
def test_a_timeout_below_a_step_is_refused(timeout: float, is_refused: bool) -> None:
    if is_refused:
        with pytest.raises(InputError, match=r'command\.timeout'):
            load_scene('paper_fig8', {'command.timeout': timeout})
    else:
        assert load_scene('paper_fig8', {'command.timeout': timeout}).command.timeout == timeout
