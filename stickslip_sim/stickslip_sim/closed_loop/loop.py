# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The loop itself: step, measure, ask, command, as a node in lock-step does it; its run and its setpoint."""

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import repeat
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ..check.limits import Limits, load_limits, outcomes_of
from ..check.report import Checked
from ..controllers import Moves, Setpoint
from ..controllers.own_controller import Measurement, OwnController, raised
from ..core.arrays import Columns, Numbers
from ..core.errors import ControllerError, InputError, SolverError
from ..core.time_grid import Instants, decimal, instants
from ..core.types import Event, Instant, Mode, Progress, Sample, tuple_of
from ..figures.cycles import summary
from ..inputs import SceneOrName, scene_of
from ..inputs.csv_table import CsvTable, column_of
from ..inputs.units import LENGTHS, TIMES
from ..realtime.commands import Watchdog
from ..recording.messages import slider_joint
from ..recording.offline_bag import NO_ORDERS, Orders, write_steps
from ..recording.run import RunFacts
from ..runs import SimulatedRun
from ..runs.run import normal_force_of
from ..runs.samples import MOST_IN_MEMORY, HeldSamples
from ..runs.simulated import CostMeter, columns_of_rows, receipt_of
from ..scene import Scene, scene_from_values
from ..scene.schema import MOST_POINTS
from ..simulation import Measured, Rig, RigEvent
from ..simulation.step_result import Mark, TimedRigEvent, marks_of_events

_NOTHING = Measured(0.0, 0.0, 0.0, 0.0)    # before the first measurement


class LoopRecord:
    """What came of the steps so far; `start` is the mode at the start."""

    def __init__(self, start: Mode) -> None:
        self.start = start
        self.rows: list[bytes] = []                                        # the numbers of samples
        self.measured: list[tuple[float, ...] | None] = []   # plain tuples: the garbage collector drops them
        self.commands: list[tuple[int, float | None, float | None]] = []   # step from which on, m/s, N
        self.events: list[tuple[int, Event]] = []                          # step into which it fell
        self.rig_events: list[tuple[int, RigEvent]] = []

    def note(self, step: int, events: list[Event], rig_events: list[RigEvent]) -> None:
        """Take what happened in a step, and to the rig at its start."""
        self.events += [(step, event) for event in events]
        self.rig_events += [(step, event) for event in rig_events]


@dataclass(frozen=True, eq=False, repr=False)
class ClosedLoopRun(SimulatedRun):
    """A run whose drive followed a controller.

    `told` is what was measured at each step; a setpoint, if there is one, is known at each step.
    """

    told: Sequence[tuple[float, ...] | None] = ()
    orders: Orders = NO_ORDERS
    controller: str = ''
    is_commanded: ClassVar[bool] = True

    @classmethod
    def of(cls, scene: Scene, record: LoopRecord, rig: Rig, controller: str, every: int, wanted: Numbers | None,
           cost: tuple[float, float]) -> 'ClosedLoopRun':
        """Return the run of a rig that was made so far, with what it cost (CPU and wall time, s)."""
        columns = columns_of_rows(np.frombuffer(b''.join(record.rows)).reshape(-1, len(Sample._fields)))
        time, simulator, events = columns['time'], rig.simulator, [event for _, event in record.events]
        end = max(float(time[-1]), float(scene.time.step))
        figures = summary(events, end, record.start)
        receipt = receipt_of(scene, end, float(scene.time.step), figures, simulator.root_iterations,
                             simulator.sample(), simulator.energy, *cost)
        receipt['controller'] = {'name': controller, 'rate': scene.time.rate / every}
        receipt['commands'] = {'received': len(record.commands), **{
            name: getattr(rig.counts, name) for name in ('refused', 'lost', 'limited', 'timed_out')}}
        orders = Orders(record.commands, record.events, record.rig_events)
        return cls(scene, end, None, events, HeldSamples({**columns, **normal_force_of(scene, time)}), figures, receipt,
                   setpoint=setpoint_columns(time, wanted), orders=orders, controller=controller, told=record.measured)

    @property
    def source(self) -> str:
        """Which controller drove it, and for how long."""
        return f'simulated for {self.duration:g} s with {self.controller} in the loop'

    @cached_property
    def measured(self) -> Columns:
        """What was measured at each step, by the fields of Measurement; where it was lost, what was measured before."""
        lost = np.array([one is None for one in self.told])
        latest = np.maximum.accumulate(np.where(lost, 0, np.arange(len(lost))))
        rows = np.array([one or _NOTHING for one in self.told], dtype=np.float64)[latest]
        return {'time': self.samples['time'], **{name: rows[:, i] for i, name in enumerate(Measured._fields)},
                'drive_force': self.samples['drive_force'], 'is_lost': lost}

    @property
    def commands(self) -> Columns:
        """The velocities that were ordered, each at the start of the first step in which it holds."""
        (steps, velocities), _ = self.orders.commanded()
        return {'time': self.samples['time'][steps - 1], 'velocity': velocities}

    @property
    def marks(self) -> list[Mark]:
        """When faults were in force, and commands lost, limited or missing."""
        times = self.samples['time']
        return marks_of_events((TimedRigEvent(float(times[max(step - 1, 0)]), event.kind, event.id,
                                              event.fault.kind if event.fault else '', event.number)
                                for step, event in self.orders.rig_events), self.begin, self.end)

    def check(self, limits: Limits | str | os.PathLike[str]) -> Checked:
        """Return the outcome of each limit in a file (docs/check.md), `passed` for all; raises InputError."""
        limits = limits if isinstance(limits, Limits) else load_limits(os.fspath(limits))
        return Checked(self.name, self, outcomes_of(limits, self))

    def save(self, folder: Path | str) -> None:
        """Record the run as a bag, that of a node in lock-step with this controller.

        Raises RecordingError; a folder that exists is not touched, one that was begun vanishes on an error.
        """
        write_steps(folder, RunFacts.of(self.scene), self.samples, self.orders, self.receipt, self.setpoint,
                    slider_joint(self.scene.joint_prefix))


_KINDS = 'a function of time, Moves, arrays (times, positions), or a CSV file with the columns time and position'
_NAMES = (('time', 't'), TIMES), (('position', 'x'), LENGTHS)
Given = Callable[[float], object] | Moves | tuple[Any, Any] | str | os.PathLike[str]


def setpoints_at(given: Given, times: Numbers) -> Numbers:
    """Return position (m) and velocity (m/s) at times as columns.

    Where only positions are given, the velocity is that of the way to the next of these times.  Raises InputError.
    """
    if isinstance(given, str | os.PathLike):
        columns = [column_of(Path(given), *names, 'setpoint') for names in _NAMES]
        table = CsvTable('setpoint', Path(given), columns, MOST_POINTS)
        found = _interpolated(table.columns[0], table.columns[1], times)
    elif isinstance(given, Moves) or callable(given):
        found = _called(given.at if isinstance(given, Moves) else given, times)
    else:
        found = _interpolated(*_arrays(given), times)
    if found.ndim == 1:
        speeds = np.diff(found) / np.diff(times)
        found = np.stack([found, np.append(speeds, speeds[-1:])], axis=1)
    return found


def _called(function: Callable[[float], object], times: Numbers) -> Numbers:
    answers: list[Any] = []
    for time in times.tolist():
        try:
            answers.append(function(time))
        except Exception as error:
            raise InputError(f'setpoint({time:g})', raised(error), 'a position, m', 'correct the function') from None
    try:
        found = np.array(answers, dtype=np.float64)
        if found.shape in ((len(times),), (len(times), 2)) and np.isfinite(found).all():
            return found
    except (TypeError, ValueError):
        pass
    time, answer = next((time, answer) for time, answer in zip(times.tolist(), answers)
                        if not _is_setpoint(answer, np.shape(answers[0])))
    raise InputError(f'setpoint({time:g})', answer, 'a finite position, m, or (position, velocity)',
                     'return the same kind at each time')


def _is_setpoint(answer: Any, shape: tuple[int, ...]) -> bool:
    try:
        row = np.array(answer, dtype=np.float64)
    except (TypeError, ValueError):
        return False
    return row.shape == shape and shape in ((), (2,)) and bool(np.isfinite(row).all())


def _arrays(given: object) -> tuple[Numbers, Numbers]:
    try:
        times, positions = (np.asarray(part, dtype=np.float64) for part in given)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        raise InputError('setpoint', given, _KINDS, 'give one of these') from None
    if times.ndim != 1 or times.shape != positions.shape or not len(times):
        raise InputError('setpoint', f'arrays of shapes {times.shape} and {positions.shape}',
                         'times and positions, one as many as the other', 'give (times, positions)')
    for name, values in (('times', times), ('positions', positions)):
        for row in np.flatnonzero(~np.isfinite(values))[:1].tolist():
            raise InputError(f'setpoint {name}[{row}]', float(values[row]), 'finite', 'correct it')
    return times, positions


def _interpolated(times: Numbers, positions: Numbers, wanted: Numbers) -> Numbers:
    for row in np.flatnonzero(np.diff(times) <= 0.0)[:1].tolist():
        raise InputError(f'setpoint times[{row + 1}]', float(times[row + 1]), f'after the one before it, '
                         f'{float(times[row])!r} s', 'sort the rows by time and drop duplicates')
    begin, end = float(times[0]), float(times[-1])
    if begin > 0.0 or end < wanted[-1]:
        raise InputError('setpoint', f'{begin:g} to {end:g} s', f'from 0 to the end of the run, {wanted[-1]:g} s',
                         'let it hold to the end, or make the run shorter')
    return np.interp(wanted, times, positions)


def setpoint_columns(times: Numbers, setpoint: Numbers | None) -> Columns:
    """Return the setpoint of a run, with a row a step, as its columns at these times (s)."""
    return {} if setpoint is None else {'time': times, 'position': setpoint[:len(times), 0],
                                        'velocity': setpoint[:len(times), 1]}


def as_setpoints(columns: Numbers | None, count: int) -> Iterator[Setpoint | None]:
    """Return them one by one, None where there is none."""
    return repeat(None, count) if columns is None else map(tuple_of, repeat(Setpoint), zip(*columns.T.tolist()))


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
        ends = map(tuple_of, repeat(Instant), zip(self._times.seconds.tolist(), self._times.fractions.tolist()))
        for step, (time, end, setpoint) in enumerate(zip(times, ends, setpoints)):
            if watchdog is not None and (silence := watchdog.silence(rig.counts.heard, now[max(step - 1, 0)])):
                rig.time_out(silence)
            row, measured, events, rig_events = make_row(velocity, force, end)
            take_row(row.tobytes())
            if events or rig_events:
                record.note(step, events, rig_events)
            if measured is None:
                measure(None)
            else:
                held = measured
                measure(tuple(measured))
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
