# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The controllers of the package in a loop with an axis, and the figures of what they do."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import stickslip_sim as stickslip
from stickslip_sim.closed_loop import ClosedLoopRun
from stickslip_sim.controllers import Controller, Following, MoveProgress, Moves, Setpoint
from stickslip_sim.controllers.own_controller import Measurement
from stickslip_sim.core.time_grid import NANOSECONDS
from stickslip_sim.core.types import Event, EventKind, Sample
from stickslip_sim.simulation import Measured

RATE = 1000.0   # steps a second
_AT_REST = {'drive.course': 'constant', 'drive.velocity': 0.0}


class Run(NamedTuple):
    """What a controller did with an axis: one setpoint, sample and command (m/s) for each step, and all events."""

    moves: Moves
    setpoints: list[Setpoint]
    samples: list[Sample]
    commands: list[float]
    events: list[Event]


class Figures(NamedTuple):
    """One period of the moves, out and back."""

    sticks: int             # from the start of a move until it slows down
    largest_error: float    # m, of the position while the setpoint moves
    slowest: float          # m/s, along the move in the second half of its constant feed
    fastest: float          # m/s, there
    overshoot: float        # m, beyond the end of a move
    end_error: float        # m, at the end of a dwell


class Follower:
    """A controller that follows its moves, and writes down its setpoints."""

    def __init__(self, controller: Controller, moves: Moves) -> None:
        self.setpoints: list[Setpoint] = []
        self._following = Following(controller, moves)
        self._progress: MoveProgress | None = None

    def __call__(self, time: float, measured: Measurement) -> float:
        answer = self._following.answer(self._progress, round(time * NANOSECONDS), Measured(*measured[:4]))
        self._progress = answer.progress
        self.setpoints.append(answer.setpoint)
        return answer.command.velocity


def loop_run(follower: Follower, moves: Moves, duration: float, delay: int = 0,
             changes: Mapping[str, object] | None = None) -> ClosedLoopRun:
    """Let a controller drive the axis of `positioning` from prolonged rest for `duration` s.

    Its commands hold `delay` steps later than from the next step on; `changes` are to parameters of the scene.
    """
    late = {'faults.ids': ['late'], 'faults.kinds': ['command_delay'], 'faults.starts': [0.0],
            'faults.durations': [math.inf], 'faults.values': [delay / RATE]} if delay else {}
    scene = stickslip.load_scene('positioning', {**_AT_REST, **late, **(changes or {})})
    return stickslip.close_loop(follower, scene, round(duration * RATE) / RATE, setpoint=moves)


def close_loop(controller: Controller, moves: Moves, duration: float, delay: int = 0,
               changes: Mapping[str, object] | None = None) -> Run:
    """Return what a controller did in `loop_run`."""
    follower, count = Follower(controller, moves), round(duration * RATE)
    run = loop_run(follower, moves, duration, delay, changes)    # its last state is not answered
    events = [event for event in run.events if event.time <= run.samples['time'][count - 1]]
    return Run(moves, follower.setpoints, [*run.sample_rows()][:count], run.commands['velocity'].tolist(), events)


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
