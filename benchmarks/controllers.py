# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The two example controllers on the axis of the scene `positioning`: tables and picture of docs/controllers.md.

    python3 -m benchmarks.controllers

Everything is measured with the exact engine at 1 kHz, and is the same on every machine.
"""

import math
import pathlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import NamedTuple

import stickslip_sim as stickslip
from stickslip_sim.closed_loop import ClosedLoopRun
from stickslip_sim.controllers import BranchCompensation, Cascade, Controller, Following, MoveProgress, Moves, Setpoint
from stickslip_sim.controllers.own_controller import Measurement
from stickslip_sim.core.time_grid import NANOSECONDS
from stickslip_sim.core.types import Event, EventKind, Sample
from stickslip_sim.inputs import load_scene
from stickslip_sim.simulation import Measured

from .page import replace_generated

PAGE = pathlib.Path('docs/controllers.md')
PICTURE = pathlib.Path('docs/images/controllers.png')
AXIS = load_scene('positioning').axis
MOVES = [Moves(travel, feed) for travel, feed in
         ((0.0005, 0.0001), (0.001, 0.0002), (0.002, 0.0005), (0.002, 0.001), (0.005, 0.002), (0.01, 0.01))]
SLOW_FEED = Moves()
DELAYS = (2, 3)
RESOLUTIONS = (1e-7, 1e-6)   # m
GAINS = (4.0, 8.0, 16.0)
WRONG = (('normal force 20 % less', 0.8, 1.0), ('normal force 20 % more', 1.2, 1.0),
         ('drive stiffness 20 % less', 1.0, 0.8), ('drive stiffness 20 % more', 1.0, 1.2))
_MICRO, _MILLI = 1e6, 1e3
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


def controllers(gains: Cascade | None = None) -> dict[str, Controller]:
    """Return both controllers, with the same gains."""
    gains = gains or Cascade()
    return {'cascade': Controller(gains), 'compensated': Controller(gains, BranchCompensation(AXIS))}


def measure(moves: Moves, delay: int = 0, gains: Cascade | None = None, changes: Mapping[str, object] | None = None
            ) -> dict[str, Figures]:
    """Return the figures of one period of the moves with both controllers; their model stays AXIS."""
    return {name: figures(close_loop(controller, moves, moves.period, delay, changes))
            for name, controller in controllers(gains).items()}


def most_delay(gains: Cascade) -> int | None:
    """Return the largest delay, in steps, at which the loop of the cascade is stable without friction."""
    free = load_scene('positioning', {'axis.normal_force': 0.0})
    found = stickslip.tune(Follower(Controller(gains), SLOW_FEED), free, SLOW_FEED.feed, duration=1.0)
    return found.linear['slip'].largest_delay


def by_feed() -> Iterator[str]:
    """Yield the table over the feed."""
    yield from _head('move', 'sticks', 'largest error / µm', 'speed at constant feed / mm/s', 'overshoot / µm')
    for moves in MOVES:
        pair = [*measure(moves).values()]
        yield _row(f'{moves.travel * _MILLI:g} mm at {moves.feed * _MILLI:g} mm/s', _pair(its.sticks for its in pair),
                   _pair(f'{its.largest_error * _MICRO:.0f}' for its in pair), _pair(map(_speeds, pair)),
                   _pair(f'{its.overshoot * _MICRO:.0f}' for its in pair))


def by_condition() -> Iterator[str]:
    """Yield the table over gain, delay, resolution of the encoders, and what the model gets wrong."""
    yield from _head('changed', 'sticks', 'largest error / µm')
    damping = AXIS.drive_damping / (2.0 * (AXIS.drive_stiffness * AXIS.mass) ** 0.5)
    for gain in GAINS:
        gains = Cascade(velocity_gain=gain)
        yield _brief(f'K_p = {gain:g} ({damping * (1.0 + gain) ** 0.5:.2f}, {most_delay(gains)} steps)', gains=gains)
    for delay in DELAYS:
        yield _brief(f'commands {delay} steps late', delay)
    for resolution in RESOLUTIONS:
        yield _brief(f'encoders of {resolution * _MICRO:g} µm', changes={'encoder.resolution': resolution})
    yield from by_model()


def by_model() -> Iterator[str]:
    """Yield the rows over what the model gets wrong."""
    for name, force, stiffness in WRONG:
        yield _brief(name, changes={'axis.normal_force': force * AXIS.normal_force,
                                    'axis.drive_stiffness': stiffness * AXIS.drive_stiffness})


SECTIONS: dict[str, Callable[[], Iterator[str]]] = {
    'From low to full feed': by_feed,
    'Gain, delay, encoders and a wrong model, at 0.2 mm/s': by_condition,
}


def main() -> None:
    """Replace the generated part of the page, and the picture."""
    text = '\n\n'.join(f'### {heading}\n\n' + '\n'.join(table()) for heading, table in SECTIONS.items())
    replace_generated(PAGE, f'{text}\n')
    stickslip.plot_runs({name: loop_run(Follower(each, SLOW_FEED), SLOW_FEED, SLOW_FEED.period)
                         for name, each in controllers().items()}, PICTURE, columns=True)
    print(f'written: {PICTURE}')


def _head(*cells: str) -> tuple[str, str]:
    return _row(*cells), _row(*['---'] * len(cells))


def _row(*cells: object) -> str:
    return f'| {" | ".join(map(str, cells))} |'


def _pair(of_each: Iterable[object]) -> str:
    """Return what the cascade did, and with compensation."""
    return ' → '.join(map(str, of_each))


def _speeds(its: Figures) -> str:
    return f'{its.slowest * _MILLI:.2f} to {its.fastest * _MILLI:.2f}'


def _brief(name: str, delay: int = 0, gains: Cascade | None = None, changes: Mapping[str, object] | None = None
           ) -> str:
    """Return a row with the figures of both controllers at the feed at which both come to their limits."""
    pair = [*measure(MOVES[1], delay, gains, changes).values()]
    return _row(name, _pair(its.sticks for its in pair), _pair(f'{its.largest_error * _MICRO:.0f}' for its in pair))


if __name__ == '__main__':
    main()
