# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A controller and the exact engine in lock-step, and the figures of what it does."""

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

from stickslip_sim.axis import Axis, InitialState
from stickslip_sim.controllers import Controller, Following, Moves, Setpoint
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.core.types import Event, EventKind, Sample
from stickslip_sim.simulation import Rig
from stickslip_sim.simulation.encoder import EncoderSettings
from stickslip_sim.simulation.rig import RigSettings
from stickslip_sim.solvers import exact

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

    sticks: int             # from the start of a move until it slows down
    largest_error: float    # m, of the position while the setpoint moves
    slowest: float          # m/s, along the move in the second half of its constant feed
    fastest: float          # m/s, there
    overshoot: float        # m, beyond the end of a move
    end_error: float        # m, at the end of a dwell


def close_loop(axis: Axis, controller: Controller, moves: Moves, duration: float, delay: int = 0,
               encoder: EncoderSettings | None = None) -> Run:
    """Let a controller drive an axis from prolonged rest for `duration` s, with ideal encoders unless given others.

    The command made from the state after step n holds over step n + 1, or as many steps later as `delay` says.
    """
    grid = Grid(RATE)
    settings = RigSettings(measures=True, encoder=encoder or EncoderSettings())
    rig = Rig(axis, InitialState(), constant(0.0), constant(0.0), exact.SOLVER, grid, settings)
    following, progress = Following(controller, moves), None
    run = Run(moves, [], [], [], [])
    waiting = deque([0.0] * delay)
    command: float | None = None
    for step in range(round(duration * RATE)):
        result = rig.make_step(command)
        assert result.measured is not None
        answer = following.answer(progress, grid.nanoseconds(step), result.measured)
        progress = answer.progress
        waiting.append(answer.command.velocity)
        command = waiting.popleft()
        run.setpoints.append(answer.setpoint)
        run.samples.append(result.sample)
        run.commands.append(answer.command.velocity)
        run.events.extend(result.events)
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
