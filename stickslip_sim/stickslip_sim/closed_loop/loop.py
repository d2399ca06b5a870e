# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The loop itself: step, measure, ask, command; as a node in lock-step does it, but without a node."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from ..controllers.own_controller import Measurement, OwnController
from ..core.arrays import Numbers
from ..core.errors import ControllerError, InputError, SolverError
from ..core.time_grid import Instants, decimal, instants
from ..core.types import Instant, Progress, tuple_of
from ..inputs import SceneOrName, scene_of
from ..realtime.commands import Watchdog
from ..runs.samples import MOST_IN_MEMORY
from ..runs.simulated import CostMeter
from ..scene import Scene, scene_from_values
from ..simulation import Measured
from .run import ClosedLoopRun, LoopRecord
from .setpoint import Given, as_setpoints, setpoints_at

_REPORTED_EVERY = 1000   # steps
_ROUNDED = 1e-6          # steps, that a duration may be off by: 0.1 + 0.2 s


def close_loop(controller: Callable[[float, Measurement], Any], scene: SceneOrName, duration: float,
               rate: float | None = None, setpoint: Given | None = None, progress: Progress = None) -> ClosedLoopRun:
    """Let a controller drive the axis of a scene, with its rig, for `duration` s; return the run.

    `controller(t, measured)` is asked after each step, or `rate` times a second, with the time (s) and a measurement.
    Its answer, a velocity of the drive (m/s) or a Command, holds from the next step on; a further delay is the scene's.
    An optional `controller.reset()` is called first.  `setpoint` is a function of time that returns a position (m) or
    position and velocity, Moves, arrays (times, positions) or a CSV file with the columns time and position.

    The encoders are read, and time moves in lock-step, whatever the scene says.  Raises ControllerError on a controller
    that raises or answers what is no command, SolverError when the solver gives up: `error.run` is what was made until
    then.  Raises InputError on all else that is wrong.
    """
    scene = measured_scene(scene_of(scene))
    times = steps_of(scene, duration)
    own = own_controller(controller, scene)
    every = steps_between(rate, scene.time.rate)
    wanted = None if setpoint is None else setpoints_at(setpoint, times.seconds + times.fractions)
    return run_loop(own, scene, every, times, wanted, progress)


def steps_of(scene: Scene, duration: float) -> Instants:
    """Return the times of the steps of a run; raises InputError."""
    step, most = scene.time.step, (MOST_IN_MEMORY - 1) * scene.time.step
    allowed = f'{float(step):g} to {float(most):g} s, a whole number of steps of {float(step):g} s'
    if not step <= duration <= most:
        raise InputError('duration', duration, allowed, 'give the seconds to simulate')
    steps = decimal(float(duration)) / step
    if abs(steps - round(steps)) > _ROUNDED:
        raise InputError('duration', duration, allowed, f'for example {float(round(steps) * step):.12g}')
    return instants(step, 0, round(steps) + 1)


def own_controller(controller: object, scene: Scene) -> OwnController:
    """Return a controller with the limits of a scene; raises InputError."""
    return OwnController(controller, (scene.command.max_velocity, scene.command.max_force))


def run_loop(own: OwnController, scene: Scene, every: int, times: Instants, wanted: Numbers | None,
             progress: Progress = None) -> ClosedLoopRun:
    """Return the run of a measured scene at its steps, with setpoints at each; raises as `close_loop` does."""
    own.reset()
    return _Loop(own, scene, every, times, wanted).run(progress)


def measured_scene(scene: Scene) -> Scene:
    """Return the scene with its encoders read and in lock-step, as a node has to have it for the same run."""
    changes: dict[str, object] = {'joint_interface.enabled': True, 'time.mode': 'lockstep', 'time.factor': 1.0}
    if all(scene.values[name] == value for name, value in changes.items()):
        return scene
    return replace(scene_from_values({**scene.values, **changes}, scene.summary), sources=scene.sources)


def steps_between(rate: float | None, of_rig: float) -> int:
    """Return how many steps of the rig there are in one of the controller."""
    if rate is None:
        return 1
    allowed, fix = f'time.rate ({of_rig:g} Hz) divided by a whole number', 'or change time.rate of the scene'
    if not 0.0 < rate <= of_rig:
        raise InputError('rate', rate, allowed, f'{of_rig:g} asks after each step')
    steps = decimal(of_rig) / decimal(float(rate))
    if steps.denominator != 1:
        near = round(steps)
        exact = [k for k in range(max(near - 50, 1), near + 50) if decimal(of_rig / k) * k == decimal(of_rig)]
        nearest = of_rig / min(exact, key=lambda k: abs(k - steps), default=1)
        raise InputError('rate', rate, allowed, f'for example {nearest!r}, {fix}')
    return int(steps)


class _Loop:
    """A run under way."""

    def __init__(self, own: OwnController, scene: Scene, every: int, times: Instants, wanted: Numbers | None) -> None:
        self._own, self._scene, self._every = own, scene, every
        self._rig = scene.make_rig()
        self._watchdog = Watchdog(scene.command.timeout)
        self._times, self._wanted = times, wanted
        self._record = LoopRecord(self._rig.simulator.sample().mode)

    def run(self, progress: Progress) -> ClosedLoopRun:
        """Make all steps."""
        cost = CostMeter()
        try:
            self._make_steps(progress)
        except (ControllerError, SolverError) as error:
            if isinstance(error, ControllerError) and self._rig.step >= 0:
                error.run = self._made(cost)
            raise
        self._rig.simulator.require_sound()
        return self._made(cost)

    def _make_steps(self, progress: Progress) -> None:
        own, record, rig, every = self._own, self._record, self._rig, self._every
        ask, limit, make_row = own.ask, self._scene.command.max_velocity, rig.make_row
        take_row, measure, order = record.rows.append, record.measured.append, record.commands.append
        watchdog, now = self._watchdog if self._watchdog.is_on else None, self._times.nanoseconds().tolist()
        times: list[float] = (self._times.seconds + self._times.fractions).tolist()
        setpoints = as_setpoints(self._wanted, len(times))
        last = len(times) - 1
        velocity = force = None
        held = Measured(0.0, 0.0, 0.0, 0.0)
        ends = [tuple_of(Instant, end) for end in zip(self._times.seconds.tolist(), self._times.fractions.tolist())]
        for step, (time, end, setpoint) in enumerate(zip(times, ends, setpoints)):
            if watchdog is not None and (silence := watchdog.silence(rig.counts.heard, now[max(step - 1, 0)])):
                rig.time_out(silence)
            row, measured, events, rig_events = make_row(velocity, force, end)
            take_row(row.tobytes())
            if events or rig_events:
                record.note(step, events, rig_events)
            measure(measured)
            held = measured or held
            velocity = force = None
            if step % every == 0 and step < last:
                try:
                    answer = ask(time, tuple_of(Measurement, (*held, row.drive_force, measured is None, setpoint)))
                except Exception as error:
                    own.failed(error, step, time, setpoint is None)
                if type(answer) is float and -limit <= answer <= limit:
                    velocity = answer
                else:
                    velocity, force = own.command(answer, step, time)
                order((step + 1, velocity, force))
            if progress and step % _REPORTED_EVERY == 0:
                progress(step / last)

    def _made(self, cost: CostMeter) -> ClosedLoopRun:
        return ClosedLoopRun.of(self._scene, self._record, self._rig, self._own.name, self._every, self._wanted,
                                cost.so_far())
