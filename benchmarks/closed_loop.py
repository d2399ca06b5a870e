"""A controller and the exact engine in lock-step, and the figures of what it does."""

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

from stickslip_sim.axis import Axis, InitialState
from stickslip_sim.control import AT_REST, Controller, Measured, Moves, Setpoint
from stickslip_sim.courses import constant
from stickslip_sim.pacing import Grid
from stickslip_sim.simulator import Simulator
from stickslip_sim.words import Event, EventKind, Sample

RATE = 1000.0   # steps a second


@dataclass(frozen=True, slots=True)
class Run:
    """What a controller did with an axis: one setpoint, sample and command for each step, and all events."""

    moves: Moves
    setpoints: list[Setpoint]
    samples: list[Sample]
    commands: list[float]  # m/s
    events: list[Event]


class Figures(NamedTuple):
    """One period of the moves, out and back."""

    sticks: int             # from the begin of a move until it slows down
    largest_error: float    # m, of the position while the setpoint moves
    slowest: float          # m/s, along the move in the second half of its constant feed
    fastest: float          # m/s, there
    overshoot: float        # m, beyond the end of a move
    end_error: float        # m, at the end of a dwell


def measured(sample: Sample) -> Measured:
    """Return what ideal encoders say."""
    return Measured(sample.position, sample.velocity, sample.drive_position, sample.drive_velocity)


def close_loop(axis: Axis, controller: Controller, moves: Moves, duration: float, delay: int = 0) -> Run:
    """Let a controller drive an axis from prolonged rest for `duration` s.

    The command made from the state after step n holds over step n + 1, or as many steps later as `delay` says.
    """
    simulator = Simulator(axis, InitialState(), constant(0.0), constant(0.0))
    grid = Grid(RATE)
    memory = AT_REST
    run = Run(moves, [], [], [], [])
    waiting = deque([0.0] * delay)
    for step in range(round(duration * RATE)):
        sample, setpoint = simulator.sample(), moves.at(step / RATE)
        memory, command = controller.step(memory, setpoint, measured(sample), 1.0 / RATE)
        waiting.append(command.velocity)
        simulator.command_velocity(waiting.popleft())
        run.setpoints.append(setpoint)
        run.samples.append(sample)
        run.commands.append(command.velocity)
        run.events.extend(simulator.advance(grid.instant(step + 1)))
    return run


def figures(run: Run) -> Figures:
    """Return the figures of a run that lasts one period of its moves."""
    moves, half = run.moves, 0.5 * run.moves.period
    steady = moves.duration - moves.peak / moves.acceleration
    ways = [1.0 if sample.time < half else -1.0 for sample in run.samples]
    errors = [setpoint.position - sample.position for setpoint, sample in zip(run.setpoints, run.samples)]
    speeds = [way * sample.velocity for way, sample in zip(ways, run.samples)
              if 0.5 * moves.duration < math.fmod(sample.time, half) < steady]
    moving = [setpoint.velocity != 0.0 for setpoint in run.setpoints]
    return Figures(
        sticks=sum(event.kind == EventKind.STICK and math.fmod(event.time, half) < steady for event in run.events),
        largest_error=max(abs(error) for error, moves_on in zip(errors, moving) if moves_on),
        slowest=min(speeds),
        fastest=max(speeds),
        overshoot=max(-way * error for way, error, moves_on in zip(ways, errors, moving) if not moves_on),
        end_error=max(abs(errors[round(half * RATE) - 1]), abs(errors[-1])))
