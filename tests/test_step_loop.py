"""The step loop without ROS: order within a step, commands, pausing, a solver that gives up."""

import math
from collections.abc import Iterator
from typing import Any

import pytest

from stickslip_sim.commands import CommandSlot
from stickslip_sim.errors import SolverError
from stickslip_sim.pacing import Grid, Pacer
from stickslip_sim.ros.loop import StepLoop
from stickslip_sim.simulator import Simulator
from stickslip_sim.words import Event, Instant, Sample
from tests.axes import COMPLIANT, make, paper_axis
from tests.recorded_runs import wait_for

RATE = 1000.0


class Notes:
    """Keeps what the loop hands out, in order."""

    def __init__(self) -> None:
        self.samples: list[tuple[int, Sample]] = []
        self.events: list[tuple[int, Event]] = []
        self.commands: list[tuple[int, int, int, float]] = []

    def event(self, step: int, event: Event) -> None:
        self.events.append((step, event))

    def sample(self, step: int, sample: Sample) -> None:
        self.samples.append((step, sample))

    def command(self, kind: int, step: int, time_ns: int, value: float) -> None:
        self.commands.append((kind, step, time_ns, value))


class Rig:
    """A loop that runs 20 times faster than time."""

    def __init__(self, simulator: Simulator) -> None:
        self.slots = (CommandSlot('velocity', 'm/s', 1.0), CommandSlot('force', 'N', 1e5))
        self.notes = Notes()
        grid = Grid(RATE)
        self.loop = StepLoop(simulator, grid, Pacer(grid, 20.0), self.slots, self.notes)

    def reach(self, step: int) -> None:
        wait_for(lambda: self.loop.step >= step)


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(make(paper_axis(COMPLIANT), 0.002))
    yield rig
    rig.loop.stop()
    assert rig.loop.crash is None


def test_steps_and_events_are_those_of_the_simulator(rig: Rig) -> None:
    rig.loop.start()
    rig.reach(2000)
    rig.loop.stop()
    assert [step for step, _ in rig.notes.samples] == list(range(rig.loop.step + 1))
    other = make(paper_axis(COMPLIANT), 0.002)
    events = other.advance(Instant(2.0, 0.0))
    assert [event for _, event in rig.notes.events][:len(events)] == events
    assert all(step == math.ceil(event.time * RATE) for step, event in rig.notes.events)
    assert rig.notes.samples[2000][1] == other.sample()


def test_a_command_holds_from_the_next_step_on(rig: Rig) -> None:
    rig.loop.start()
    rig.reach(10)
    assert rig.slots[0].offer(0.004, 1) == ''
    rig.reach(rig.loop.step + 50)
    rig.loop.stop()
    ((kind, step, time_ns, value),) = rig.notes.commands
    assert (kind, time_ns, value) == (0, (step - 1) * 1_000_000, 0.004)
    velocities = [sample.drive_velocity for _, sample in rig.notes.samples]
    assert velocities[step - 1:step + 1] == [0.002, 0.004]


def test_a_run_can_be_repeated_from_its_commands(rig: Rig) -> None:
    rig.loop.start()
    for velocity, force in ((0.01, 0.0), (-0.003, 500.0), (0.0, -900.0)):
        rig.reach(rig.loop.step + 211)
        rig.slots[0].offer(velocity, 1)
        rig.slots[1].offer(force, 1)
    rig.reach(rig.loop.step + 211)
    rig.loop.stop()
    assert len(rig.notes.commands) == 6
    again, grid = make(paper_axis(COMPLIANT), 0.002), Grid(RATE)
    for step, sample in rig.notes.samples:
        again.advance(grid.instant(step))
        assert again.sample() == sample
        for kind, first, _, value in rig.notes.commands:
            if first == step + 1:
                (again.command_velocity, again.command_force)[kind](value)


def test_pause_and_restart(rig: Rig) -> None:
    rig.loop.start()
    rig.reach(100)
    assert rig.loop.at_boundary(lambda: rig.loop.pause(True))
    step = rig.loop.step
    assert rig.loop.at_boundary(lambda: None)
    assert rig.loop.step == step
    assert rig.loop.at_boundary(lambda: rig.loop.pause(False))
    rig.reach(step + 50)
    count = len(rig.notes.samples)
    assert rig.loop.at_boundary(rig.loop.restart)
    rig.reach(20)
    rig.loop.stop()
    second = next(i for i in range(step, count + 5) if rig.notes.samples[i][0] == 0)
    assert rig.notes.samples[second:second + 20] == rig.notes.samples[:20]


class Tired:
    """A simulator that gives up at a time."""

    def __init__(self, simulator: Simulator, at: float) -> None:
        self._simulator, self._at = simulator, at

    def __getattr__(self, name: str) -> Any:
        return getattr(self._simulator, name)

    def advance(self, to: Instant) -> list[Event]:
        if to.seconds > self._at:
            raise SolverError('time hardly goes on')
        return self._simulator.advance(to)


def test_a_solver_that_gives_up_stops_time_not_the_thread() -> None:
    rig = Rig(Tired(make(paper_axis(COMPLIANT), 0.002), 0.05))  # type: ignore[arg-type]
    rig.loop.start()
    wait_for(lambda: rig.loop.failure)
    assert (rig.loop.failure, rig.loop.step) == ('time hardly goes on', 50)
    assert rig.loop.at_boundary(rig.loop.restart)
    wait_for(lambda: len(rig.notes.samples) > 80)
    rig.loop.stop()


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf, 1.0000001, -2.0])
def test_a_bad_command_leaves_the_one_before(value: float) -> None:
    slot = CommandSlot('velocity', 'm/s', 1.0)
    assert slot.offer(1.0, 7) == ''
    refusal = slot.offer(value, 8)
    assert refusal == (f'velocity = {value!r} is refused: must be finite and within ±1.0 m/s;'
                       ' the previous command stays')
    assert (slot.received, slot.refused, slot.latest) == (2, 1, (1.0, 7))
