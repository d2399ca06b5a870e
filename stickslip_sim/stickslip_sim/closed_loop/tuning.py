# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Why a loop swings: its linear loops about stick and about slip, beside what the closed loop does with friction."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..controllers.own_controller import Measurement
from ..core.arrays import Numbers
from ..core.errors import ControllerError, InputError
from ..core.time_grid import instants
from ..core.types import Mode, Progress
from ..inputs import SceneOrName, scene_of
from ..scene import Scene, scene_from_values
from .linear_loop import LinearLoop, NotLinearError, check_delays, linear_controller, probe_length
from .loop import ClosedLoopRun, close_loop, measured_scene, steps_between

_DEFAULT_FEED = 1e-3     # m/s, of a scene whose drive stands still
_BAND = 0.25             # of the swing about its middle: no crossing while it stays within
_LASTS = 0.5             # of the swing before: less dies out
_LEAST = 1e-9            # m: less is rounding, or dies out
_SHOWN = 6.0             # periods
_FEWEST = 200            # steps of a run
_WITHOUT: dict[str, dict[str, object]] = {'encoder': {'encoder.resolution': 0.0, 'encoder.noise': 0.0},
                                          'friction': {'axis.normal_force': 0.0}}
PARTS = 'feed', 'hold'
OTHER = 'other'
_Followed = Callable[[Mapping[str, object]], ClosedLoopRun]


class Swing(NamedTuple):
    """What a closed loop goes on doing while its setpoint moves (`feed`) or stands still (`hold`)."""

    during: str
    amplitude: float     # m, half of the way from one extreme to the other about the mean motion
    period: float        # s
    stick_share: float   # of the time
    cause: str           # unstable, friction, encoder, other


@dataclass(frozen=True, eq=False)
class Tuning:
    """A loop about `stick` and about steady `slip`, or why it is not linear there; and its lasting `swings`.

    `feed` (m/s) is the speed of the slip.  `run` follows a setpoint that moves with it for the first half, and then
    holds; `ended` says why the controller ended it too early, and there are no swings then.
    """

    scene: Scene
    controller: str
    feed: float
    rate: float
    loops: Mapping[str, LinearLoop | str]
    swings: list[Swing]
    run: ClosedLoopRun
    ended: str = ''

    @property
    def linear(self) -> dict[str, LinearLoop]:
        """The loops that are linear."""
        return {mode: loop for mode, loop in self.loops.items() if isinstance(loop, LinearLoop)}

    def plot(self, path: Path | str) -> None:
        """Draw Bode diagrams, step response and swing (.png, .pdf or .svg)."""
        from ..plots.tuning import BodeLines, plot_tuning  # matplotlib takes half a second

        lines = {mode: BodeLines(loop.frequencies, loop.slider, loop.open,
                                 loop.step_response if loop.follows_setpoint and loop.is_stable() else None)
                 for mode, loop in self.linear.items()}
        samples, setpoint = self.run.samples, self.run.setpoint['position']
        plot_tuning(lines, (samples['time'], samples['position'] - setpoint, samples['mode'] == Mode.STICK),
                    self._closer, f'{self.controller} on {self.scene.name}', path)

    @property
    def _closer(self) -> tuple[float, float] | None:
        """When the last periods of the largest swing are, s."""
        if not self.swings:
            return None
        swing = max(self.swings, key=lambda one: one.amplitude)
        end = self.run.duration * (0.5 if swing.during == 'feed' else 1.0)
        return end - min(_SHOWN * swing.period, 0.5 * self.run.duration), end


def tune(controller: Callable[[float, Measurement], Any], scene: SceneOrName, feed: float | None = None,
         rate: float | None = None, duration: float = 20.0, progress: Progress = None) -> Tuning:
    """Return the linear loops of a controller about stick and steady slip at `feed` m/s, and what makes it swing.

    The controller, its `rate` and the scene are those of `close_loop`.  It is asked along the steady motions with small
    signals; then it follows a setpoint for `duration` s that moves with `feed`, and holds for the second half.  `feed`
    is by default the largest velocity of the scene's drive.

    Raises ControllerError on a controller that raises or answers what is no command, InputError on all else that is
    wrong.
    """
    scene = measured_scene(scene_of(scene))
    every = steps_between(rate, scene.time.rate)
    feed = max(map(abs, scene.drive.values)) or _DEFAULT_FEED if feed is None else feed
    if not 0.0 < abs(feed) <= scene.command.max_velocity:
        raise InputError('feed', feed, f'within ±{scene.command.max_velocity:g} m/s (command.max_velocity), not 0',
                         'give the speed of the setpoint')
    if duration * scene.time.rate < _FEWEST:
        raise InputError('duration', duration, f'at least {_FEWEST} steps ({_FEWEST / scene.time.rate:g} s)',
                         'simulate many periods of the oscillation')
    check_delays(scene)
    loops = {'stick': _loop(controller, scene, None, every), 'slip': _loop(controller, scene, feed, every)}

    def followed(changes: Mapping[str, object], said: Progress = None) -> ClosedLoopRun:
        changed = replace(scene_from_values({**scene.values, **changes}, scene.summary), sources=scene.sources)
        return close_loop(controller, changed if changes else scene, duration, rate,
                          lambda time: (feed * min(time, 0.5 * duration), feed if time < 0.5 * duration else 0.0), said)

    ended, swings = '', []
    try:
        run = followed({}, progress)
        swings = _explained(_swings(run), loops.values(), followed)
    except ControllerError as error:
        if error.run is None:
            raise
        run, ended = error.run, str(error)
    return Tuning(scene, run.controller, feed, scene.time.rate / every, loops, swings, run, ended)


def _loop(controller: Callable[[float, Measurement], Any], scene: Scene, speed: float | None,
          every: int) -> LinearLoop | str:
    """Return the linear loop about a steady motion, or why there is none."""
    at = instants(scene.time.step * every, 0, probe_length())
    times = at.seconds + at.fractions
    try:
        found = linear_controller(controller, times, _steady(scene, speed, times))
    except NotLinearError as reason:
        return str(reason)
    return LinearLoop(scene, speed, every, found)


def _steady(scene: Scene, speed: float | None, times: Numbers) -> Numbers:
    """Return what is measured at times, and the setpoint, where all moves with a speed, or rests without load."""
    rows = np.zeros((len(times), 7))
    if speed is None:
        return rows
    axis = scene.axis
    force = math.copysign(scene.normal_force.value_at(0.0) * axis.friction.along(speed).kinetic.coefficient(abs(speed)),
                          speed)
    stretch = (force + (axis.slideway_damping * speed)) / axis.drive_stiffness if axis.drive_stiffness else 0.0
    rows[:, 1::2] = speed
    rows[:, [0, 2, 5]] = speed * times[:, None]
    rows[:, [3, 6]] = speed
    rows[:, 2] += stretch
    rows[:, 4], rows[:, 5] = force, speed * times
    return rows


def _swings(run: ClosedLoopRun) -> list[Swing]:
    return [swing for during in PARTS if (swing := _swing(run, during))]


def _explained(swings: list[Swing], loops: Iterable[LinearLoop | str], followed: _Followed) -> list[Swing]:
    """Return swings with their causes: an unstable loop, or that without which less than half of a swing is left."""
    if any(isinstance(loop, LinearLoop) and not loop.is_stable() for loop in loops):
        return [swing._replace(cause='unstable') for swing in swings]
    for cause, changes in _WITHOUT.items():
        if any(swing.cause == OTHER for swing in swings):
            try:
                left = {swing.during: swing.amplitude for swing in _swings(followed(changes))}
            except ControllerError:
                continue    # it does not even follow without that
            swings = [swing._replace(cause=cause) if swing.cause == OTHER
                      and left.get(swing.during, 0.0) < _LASTS * swing.amplitude else swing for swing in swings]
    return swings


def _swing(run: ClosedLoopRun, during: str) -> Swing | None:
    """Return the swing about the mean motion in the second half of a part of a run, None where none lasts."""
    samples = run.samples
    count = len(samples['time']) // 4
    first = count * (1 if during == 'feed' else 3)
    times, positions = (samples[name][first:first + count] for name in ('time', 'position'))
    off = positions - np.polyval(np.polyfit(times - times[0], positions, 1), times - times[0])
    middle, size = 0.5 * (off.max() + off.min()), float(np.ptp(off))
    if size < 2.0 * _LEAST or np.ptp(off[count // 2:]) < _LASTS * np.ptp(off[:count // 2]):
        return None
    sides = np.sign(off - middle) * (np.abs(off - middle) > 0.5 * _BAND * size)
    known = np.flatnonzero(sides)
    rises = times[known[1:]][np.diff(sides[known]) > 0.0]
    if len(rises) < 2:
        return None
    sticks = samples['mode'][first:first + count] == Mode.STICK
    return Swing(during, 0.5 * size, float(rises[-1] - rises[0]) / (len(rises) - 1), float(sticks.mean()), OTHER)
