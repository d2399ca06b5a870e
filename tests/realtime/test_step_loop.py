# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The step loop without ROS: order within a step, commands, pausing, stepping on request, a solver that gives up."""

import math
from collections.abc import Iterator

import pytest

from stickslip_sim.axis import InitialState
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.core.types import Instant
from stickslip_sim.realtime.command_slot import CommandSlot
from stickslip_sim.realtime.pacing import Pacer, Unpaced
from stickslip_sim.realtime.step_loop import StepLoop
from stickslip_sim.realtime.watchdog import Watchdog
from stickslip_sim.rig import Rig, StepResult
from stickslip_sim.rig.settings import RigSettings
from stickslip_sim.solvers import Solver, exact
from tests.support.axes import COMPLIANT, make, paper_axis
from tests.support.fake_clock import FakeClock
from tests.support.rigs import make as make_rig
from tests.support.rigs import tired_after
from tests.support.waiting import wait_for

RATE = 1000.0


def slots() -> tuple[CommandSlot, CommandSlot]:
    return CommandSlot('velocity', 'm/s', 1.0), CommandSlot('force', 'N', 1e5)


class Bench:
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
def bench() -> Iterator[Bench]:
    bench = Bench()
    yield bench
    bench.loop.stop()
    assert bench.loop.crash is None


def test_steps_and_events_are_those_of_the_simulator(bench: Bench) -> None:
    bench.loop.start()
    bench.reach(2000)
    bench.loop.stop()
    assert [result.step for result in bench.results] == list(range(bench.loop.step + 1))
    other = make(paper_axis(COMPLIANT), 0.002)
    events = other.advance(Instant(2.0, 0.0))
    assert [event for result in bench.results for event in result.events][:len(events)] == events
    assert all(result.step == math.ceil(event.time * RATE) for result in bench.results for event in result.events)
    assert bench.results[2000].sample == other.sample()


def test_what_prepares_the_start_delays_no_step() -> None:
    clock = FakeClock()
    pacer, begin = Pacer(Grid(RATE), 1.0, clock), clock.now()
    bench = Bench(pacer=pacer)
    bench.loop.start(20_000_000, lambda: clock.sleep(0.015))
    bench.reach(3)
    bench.loop.stop()
    assert pacer.due(0) == begin + 20_000_000
    assert (pacer.counters.overruns, pacer.counters.caught_up) == (0, 0)


def test_a_command_holds_over_the_step_that_is_made_next(bench: Bench) -> None:
    bench.loop.start()
    bench.reach(10)
    assert bench.slots[0].offer(0.004, 1) == ''
    bench.reach(bench.loop.step + 50)
    bench.loop.stop()
    (step,) = (result.step for result in bench.results if result.velocity == 0.004)
    velocities = [result.sample.drive_velocity for result in bench.results]
    assert velocities[step - 1:step + 1] == [0.002, 0.004]


def test_a_run_can_be_repeated_from_its_commands(bench: Bench) -> None:
    bench.loop.start()
    for velocity, force in ((0.01, 0.0), (-0.003, 500.0), (0.0, -900.0)):
        bench.reach(bench.loop.step + 211)
        bench.slots[0].offer(velocity, 1)
        bench.slots[1].offer(force, 1)
    bench.reach(bench.loop.step + 211)
    bench.loop.stop()
    commands = [value for result in bench.results for value in (result.velocity, result.force)]
    assert len([value for value in commands if value is not None]) == 6
    again, grid = make(paper_axis(COMPLIANT), 0.002), Grid(RATE)
    for result in bench.results:
        if result.velocity is not None:
            again.command_drive(result.velocity)
        if result.force is not None:
            again.command_force(result.force)
        again.advance(grid.instant(result.step))
        assert again.sample() == result.sample


def test_pause_and_restart(bench: Bench) -> None:
    bench.loop.start()
    bench.reach(100)
    assert bench.loop.at_boundary(lambda: bench.loop.pause(True))
    step = bench.loop.step
    assert bench.loop.at_boundary(lambda: None)
    assert bench.loop.step == step
    assert bench.loop.at_boundary(lambda: bench.loop.pause(False))
    bench.reach(step + 50)
    count = len(bench.results)
    assert bench.loop.at_boundary(bench.loop.restart)
    bench.reach(20)
    bench.loop.stop()
    second = next(i for i in range(step, count + 5) if bench.results[i].step == 0)
    assert bench.results[second:second + 20] == bench.results[:20]


def test_steps_on_request() -> None:
    bench = Bench(by_request=True)
    bench.loop.start()
    bench.reach(0)
    assert bench.loop.at_boundary(lambda: bench.loop.run_steps(7, 0.004, None, lambda: False))
    assert (bench.loop.step, bench.results[-1].sample.drive_velocity) == (7, 0.004)
    assert bench.loop.at_boundary(lambda: bench.loop.run_steps(3, None, None, lambda: bench.loop.step == 9))
    bench.loop.stop()
    assert [result.step for result in bench.results] == list(range(10))


def test_a_solver_that_gives_up_stops_time_not_the_thread() -> None:
    bench = Bench(tired_after(0.05))
    bench.loop.start()
    wait_for(lambda: bench.loop.failure, 'the failure')
    assert bench.loop.step == 50
    assert 'time hardly goes on' in bench.loop.failure
    assert bench.loop.at_boundary(bench.loop.restart)
    wait_for(lambda: len(bench.results) > 80, 'steps after the restart')
    bench.loop.stop()


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
