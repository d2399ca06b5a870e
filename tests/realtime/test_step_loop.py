# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The step loop without ROS: order within a step, commands, pausing, stepping on request, a solver that gives up."""

import math
from collections.abc import Iterator

import pytest

from stickslip_sim.axis import InitialState
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.realtime.commands import CommandSlot, Watchdog
from stickslip_sim.realtime.pacing import Pacer, Unpaced
from stickslip_sim.realtime.step_loop import StepLoop
from stickslip_sim.simulation import Rig, StepResult
from stickslip_sim.simulation.rig import RigSettings
from stickslip_sim.solvers import Solver, exact
from tests.support.axes import COMPLIANT, make, paper_axis
from tests.support.rigs import FakeClock, tired_after
from tests.support.rigs import make as make_rig
from tests.support.waiting import wait_for

RATE = 1000.0


def slots() -> tuple[CommandSlot, CommandSlot]:
    return CommandSlot('velocity', 'm/s', 1.0), CommandSlot('force', 'N', 1e5)


class QuickLoop:
    """A loop that runs 20 times faster than time, and keeps what it hands out."""

    def __init__(self, solver: Solver = exact.SOLVER, by_request: bool = False,
                 pacer: Pacer | None = None) -> None:
        self.slots = slots()
        self.results: list[StepResult] = []
        grid = Grid(RATE)
        rig = Rig(paper_axis(COMPLIANT), InitialState(), constant(0.002), constant(0.0), solver, grid, RigSettings())
        self.loop = StepLoop(rig, pacer or Pacer(grid, 20.0), self.slots, [self.results.append], Watchdog(0.0),
                             by_request)

    def reach(self, step: int) -> None:
        wait_for(lambda: self.loop.step >= step, f'step {step}')


@pytest.fixture
def quick() -> Iterator[QuickLoop]:
    quick = QuickLoop()
    yield quick
    quick.loop.stop()
    assert quick.loop.crash is None


def test_what_prepares_the_start_delays_no_step() -> None:
    clock = FakeClock()
    pacer, begin = Pacer(Grid(RATE), 1.0, clock), clock.now()
    quick = QuickLoop(pacer=pacer)
    quick.loop.start(20_000_000, lambda: clock.sleep(0.015))
    quick.reach(3)
    quick.loop.stop()
    assert pacer.due(0) == begin + 20_000_000
    assert (pacer.counters.overruns, pacer.counters.caught_up) == (0, 0)


def test_a_command_holds_over_the_step_that_is_made_next(quick: QuickLoop) -> None:
    quick.loop.start()
    quick.reach(10)
    assert quick.slots[0].offer(0.004, 1) == ''
    quick.reach(quick.loop.step + 50)
    quick.loop.stop()
    (step,) = (result.step for result in quick.results if result.velocity == 0.004)
    velocities = [result.sample.drive_velocity for result in quick.results]
    assert velocities[step - 1:step + 1] == [0.002, 0.004]


def test_steps_and_events_are_those_of_the_simulator_under_the_same_commands(quick: QuickLoop) -> None:
    quick.loop.start()
    for velocity, force in ((0.01, 0.0), (-0.003, 500.0), (0.0, -900.0)):
        quick.reach(quick.loop.step + 211)
        quick.slots[0].offer(velocity, 1)
        quick.slots[1].offer(force, 1)
    quick.reach(quick.loop.step + 211)
    quick.loop.stop()
    commands = [value for result in quick.results for value in (result.velocity, result.force)]
    assert len([value for value in commands if value is not None]) == 6
    again, grid = make(paper_axis(COMPLIANT), 0.002), Grid(RATE)
    for result in quick.results:
        if result.velocity is not None:
            again.command_drive(result.velocity)
        if result.force is not None:
            again.command_force(result.force)
        assert again.advance(grid.instant(result.step)) == [*result.events]
        assert again.sample() == result.sample
        begin, end = (grid.instant(step).seconds for step in (max(result.step - 1, 0), result.step))
        assert all(begin <= event.time <= end for event in result.events)    # at the begin: by a command
    assert [result.step for result in quick.results] == list(range(quick.loop.step + 1))
    assert sum(len(result.events) for result in quick.results) > 5


def test_pause_and_restart(quick: QuickLoop) -> None:
    quick.loop.start()
    quick.reach(100)
    assert quick.loop.at_boundary(lambda: quick.loop.pause(True))
    step = quick.loop.step
    assert quick.loop.at_boundary(lambda: None)
    assert quick.loop.step == step
    assert quick.loop.at_boundary(lambda: quick.loop.pause(False))
    quick.reach(step + 50)
    count = len(quick.results)
    assert quick.loop.at_boundary(quick.loop.restart)
    quick.reach(20)
    quick.loop.stop()
    second = next(i for i in range(step, count + 5) if quick.results[i].step == 0)
    assert quick.results[second:second + 20] == quick.results[:20]


def test_steps_on_request() -> None:
    quick = QuickLoop(by_request=True)
    quick.loop.start()
    quick.reach(0)
    assert quick.loop.at_boundary(lambda: quick.loop.run_steps(7, 0.004, None, lambda: False))
    assert (quick.loop.step, quick.results[-1].sample.drive_velocity) == (7, 0.004)
    assert quick.loop.at_boundary(lambda: quick.loop.run_steps(3, None, None, lambda: quick.loop.step == 9))
    quick.loop.stop()
    assert [result.step for result in quick.results] == list(range(10))


def test_a_solver_that_gives_up_stops_time_not_the_thread() -> None:
    quick = QuickLoop(tired_after(0.05))
    quick.loop.start()
    wait_for(lambda: quick.loop.failure, 'the failure')
    assert quick.loop.step == 50
    assert 'time hardly advances' in quick.loop.failure
    assert quick.loop.at_boundary(quick.loop.restart)
    wait_for(lambda: len(quick.results) > 80, 'steps after the restart')
    quick.loop.stop()


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf, 1.0000001, -2.0])
def test_a_bad_command_leaves_the_one_before(value: float) -> None:
    slot = CommandSlot('velocity', 'm/s', 1.0)
    assert slot.offer(1.0, 7) == ''
    refusal = slot.offer(value, 8)
    assert refusal == (f'velocity = {value!r} is refused: must be finite and within ±1.0 m/s;'
                       ' the previous command stays')
    assert (slot.received, slot.refused, slot.latest) == (2, 1, (1.0, 7))


def test_the_loop_makes_step_0_before_it_hears_requests() -> None:
    results: list[StepResult] = []
    loop = StepLoop(make_rig(), Unpaced(Grid(1000.0)), slots(), [results.append], Watchdog(0.0), by_request=True)
    loop.start()
    counts: list[int] = []

    def step_twice() -> None:
        counts.append(len(loop.run_steps(2, None, None, lambda: False)))

    def restart() -> None:
        loop.restart()
        loop.request(step_twice)    # as one that came meanwhile

    for _ in range(20):
        assert loop.at_boundary(restart)
        assert loop.at_boundary(lambda: None)
    loop.stop()
    assert counts == [2] * 20
    assert [result.step for result in results][-3:] == [0, 1, 2]


def test_a_paused_loop_that_is_reset_has_its_start() -> None:
    results: list[StepResult] = []
    loop = StepLoop(make_rig(), Unpaced(Grid(1000.0)), slots(), [results.append], Watchdog(0.0))
    loop.paused = True
    loop.start()
    wait_for(lambda: loop.step == 0, 'the start')
    assert loop.at_boundary(lambda: loop.run_steps(10, None, None, lambda: False))
    assert loop.at_boundary(loop.restart)
    wait_for(lambda: loop.step == 0, 'the start again')
    loop.stop()
    assert [result.step for result in results] == [*range(11), 0]


def test_what_has_arrived_is_heard_before_each_step_but_the_start() -> None:
    results: list[StepResult] = []
    waiting = [0.003]
    velocity, force = slots()

    def hear() -> None:
        while waiting:
            velocity.offer(waiting.pop(), 1)

    loop = StepLoop(make_rig(), Unpaced(Grid(1000.0)), (velocity, force), [results.append], Watchdog(0.0),
                    by_request=True, hear=hear)
    loop.start()
    wait_for(lambda: loop.step == 0, 'the start')
    assert results[0].velocity is None
    waiting.append(0.004)
    assert loop.at_boundary(lambda: loop.run_steps(2, None, None, lambda: False))
    assert [result.velocity for result in results[1:]] == [0.004, None]
    waiting.append(0.005)    # an order goes before what arrived earlier
    assert loop.at_boundary(lambda: loop.run_steps(1, 0.006, None, lambda: False))
    assert results[-1].velocity == 0.006
    waiting.append(0.007)    # a reset forgets it
    assert loop.at_boundary(loop.restart)
    assert loop.at_boundary(lambda: loop.run_steps(2, None, None, lambda: False))
    loop.stop()
    assert [result.velocity for result in results[-2:]] == [None, None]
    assert velocity.received == 0
