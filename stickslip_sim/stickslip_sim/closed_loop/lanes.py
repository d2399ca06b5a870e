# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Closed loops side by side, one lane an axis: a controller on arrays is asked for all of them in one call.

The compiled unit brings all axes through a step; encoders are read on arrays.  Each lane has the bits of the loop that
it is alone.  A point that fails, and each of a call that raises, is run alone for its reason.
"""

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..axis import pack
from ..controllers.own_controller import Command, Measurement
from ..core.arrays import Numbers
from ..core.errors import ControllerError, InputError
from ..core.types import Mode, Sample, tuple_of
from ..figures.cycles import summary
from ..recording.offline_bag import Orders
from ..runs.samples import HeldSamples
from ..runs.simulated import columns_of_rows
from ..scene import Scene
from ..simulation.random_stream import Stream, stream
from ..simulation.solved_axis import events_in
from ..solvers import exact
from .loop import ClosedLoopRun, as_setpoints, setpoint_columns

if TYPE_CHECKING:
    from .study import Attempt, LoopStudy

_TABLE = 64                  # events of a lane in a step; with more it is run alone
_MOST_LANES = 1000
_MOST_BYTES = 100_000_000    # of the samples that are kept for the limits
_SIZE = len(Sample._fields)


def check_lanes(scene: Scene) -> None:
    """Raise InputError on a scene whose rig is not run side by side."""
    rig, force = scene.rig, scene.force
    for name, found, is_fine in (
            ('solver.name', scene.solver.name, scene.solver.name == 'exact'),
            ('faults.kinds', [fault.kind for fault in rig.faults], not rig.faults),
            ('command.timeout', scene.command.timeout, not scene.command.timeout),
            ('command.acceleration_limit', rig.limits.acceleration, rig.limits.acceleration == math.inf),
            ('normal_load', 'a course', scene.normal_load is None),
            ('drive.course', 'sinusoids', not scene.drive.sinusoids),
            ('force.course', 'one that varies', not force.sinusoids and len(force.starts) == 1
             and force.rates == (0.0,) and force.period == math.inf)):
        if not is_fine:
            raise InputError(name, found, 'omitted for a vectorized controller: exact solver, constant force, no '
                             'faults, no time-out, no limit of acceleration', 'leave vectorized out')


def most_lanes(study: 'LoopStudy') -> int:
    """Return how many points are run side by side, so that memory is bounded."""
    if study.limits is None:
        return _MOST_LANES
    return max(1, min(_MOST_LANES, _MOST_BYTES // (len(study.times.seconds) * _SIZE * 8)))


class OneLane:
    """A controller on arrays, asked for a single axis."""

    def __init__(self, controller: Any) -> None:
        self._controller = controller
        self.__name__ = str(getattr(controller, '__name__', type(controller).__name__))
        if hasattr(controller, 'reset'):
            self.reset = controller.reset

    def __call__(self, t: float, measured: Measurement) -> Any:
        """Return its answer as numbers."""
        *numbers, is_lost, setpoint = measured
        lanes = tuple_of(Measurement, (*(np.array([number]) for number in numbers), np.array([is_lost]), setpoint))
        answer = self._controller(t, lanes)
        if isinstance(answer, Command):
            return Command(*map(_only, answer))
        return _only(answer)


def _only(answer: Any) -> Any:
    return answer.item() if isinstance(answer, np.ndarray) and answer.size == 1 else answer


def attempts(study: 'LoopStudy', points: Numbers) -> 'Iterator[Attempt]':
    """Yield what comes of points."""
    scenes = [_scene_or_none(study, point) for point in points]
    chosen = [i for i, scene in enumerate(scenes) if scene is not None]
    found: dict[int, Attempt | None] = {}
    if chosen:
        lanes = _Lanes(study, points[chosen], [scene for scene in scenes if scene is not None])
        found = dict(zip(chosen, lanes.attempts()))
    for i, point in enumerate(points):
        yield found.get(i) or study.attempt(point)


def _scene_or_none(study: 'LoopStudy', point: Numbers) -> Scene | None:
    try:
        scene = study.scene_at(point)
        check_lanes(scene)
    except InputError:
        return None
    return scene


class _Lanes:
    """Axes that go through the same steps."""

    def __init__(self, study: 'LoopStudy', points: Numbers, scenes: Sequence[Scene]) -> None:
        records = exact.SOLVER.records
        self._study, self._scenes, self._times = study, scenes, study.times
        count, steps = len(scenes), len(study.times.seconds)
        self._controller = study.made({**study.fixed, **study.gains_of(list(points.T.copy()))}, is_alone=False)
        self._none = records.Sinusoids([])
        self._axes = [records.Parameters(pack(scene.axis)) for scene in scenes]
        self._states = [records.State() for _ in scenes]
        self._tables = [records.Events(_TABLE) for _ in scenes]
        self._alive = np.ones(count, dtype=np.uint8)
        self._counts = np.zeros(count, dtype=np.int64)
        self._told = np.zeros((len(Measurement._fields) - 2, count))
        self._history = None if study.limits is None else np.zeros((count, steps, _SIZE))
        self._positions = np.zeros((steps, count))
        self._events: list[list[Any]] = [[] for _ in scenes]
        self._encoders = _Encoders(scenes)
        self._velocities: Numbers = np.zeros(count)
        self._forces: Numbers = np.array([scene.force.value_at(0.0) for scene in scenes])
        self._limits = [np.array([getattr(scene.command, f'max_{name}') for scene in scenes])
                        for name in Command._fields]
        fastest = np.array([scene.rig.limits.velocity for scene in scenes])
        self._fastest = fastest if np.isfinite(fastest).any() else None
        self._starts: list[Mode] = []

    def attempts(self) -> 'Iterator[Attempt | None]':
        """Yield what comes of each axis; None for one that has to be run alone."""
        try:
            if hasattr(self._controller, 'reset'):
                self._ask(self._controller.reset)
            self._make_steps()
        except _RaisedError:
            self._alive[:] = 0
        for i, alive in enumerate(self._alive.tolist()):
            yield self._attempt(i) if alive and self._is_sound(i) else None

    def _ask(self, function: Any, *arguments: Any) -> Any:
        try:
            return function(*arguments)
        except Exception:   # whose point is at fault shows alone
            raise _RaisedError from None

    def _start(self) -> None:
        for i, (scene, axis, state) in enumerate(zip(self._scenes, self._axes, self._states)):
            piece, initial = scene.drive.piece_at(0.0), scene.initial
            state.accounting = 1.0
            rows = exact.start(axis, state, initial.position, initial.velocity, initial.rest_time, initial.stretch,
                               initial.deflection, piece.value, piece.rate, float(self._forces[i]), 0.0, self._none,
                               self._tables[i], 0)
            self._events[i] += events_in(self._tables[i], rows)
            self._starts.append(Mode(int(state.mode)))

    def _make_steps(self) -> None:
        study, times, told = self._study, self._times, self._told
        seconds, fractions = times.seconds.tolist(), times.fractions.tolist()
        now = (times.seconds + times.fractions).tolist()
        setpoints = as_setpoints(study.setpoint, len(now))
        never = np.zeros(len(self._alive), dtype=bool)
        self._start()
        last, is_commanded = len(now) - 1, False
        for step, (time, setpoint) in enumerate(zip(now, setpoints)):
            before = max(step - 1, 0)
            if exact.step_axes(self._axes, self._states, self._tables, seconds[before], fractions[before],
                               seconds[step], fractions[step], self._velocities, self._forces, is_commanded,
                               self._none, self._alive, self._counts, told, self._history, step):
                for i in np.flatnonzero(self._counts).tolist() if self._history is not None else ():
                    self._events[i] += events_in(self._tables[i], int(self._counts[i]))
            self._positions[step] = told[0]
            measured = self._encoders.read(told)
            is_commanded = step % study.every == 0 and step < last
            if is_commanded:    # with a copy: a controller may keep what it is told
                self._order(self._ask(self._controller, time, tuple_of(Measurement, (
                    *measured, told[4].copy(), never, setpoint))))

    def _order(self, answer: Any) -> None:
        given = answer if isinstance(answer, Command) else Command(answer)
        for name, value, limit in zip(Command._fields, given, self._limits):
            if value is None and (name == 'force' or isinstance(answer, Command)):
                continue
            numbers: Numbers = _one_of_each(name, value, len(limit))
            is_fine = np.abs(numbers) <= limit
            if not is_fine.all():    # the loop alone says what is wrong
                self._alive[~is_fine] = 0
                numbers = np.where(is_fine, numbers, 0.0)
            if name == 'force':
                self._forces = numbers + 0.0    # no -0.0, as alone
            elif self._fastest is None:
                self._velocities = numbers + 0.0
            else:
                self._velocities = np.clip(numbers, -self._fastest, self._fastest) + 0.0

    def _is_sound(self, i: int) -> bool:
        end = map(float, (self._times.seconds[-1], self._times.fractions[-1]))
        return bool(exact.is_sound(self._axes[i], self._states[i], *end))

    def _attempt(self, i: int) -> 'Attempt':
        study, scene, events = self._study, self._scenes[i], self._events[i]
        if self._history is None:
            return study.judged(None, self._positions[:, i])
        columns = columns_of_rows(self._history[i])
        time = columns['time']
        begin = float(time[-1])
        orders = Orders([(1, float(self._velocities[i]), None)], [], [])
        return study.judged(ClosedLoopRun(
            scene, begin, None, events, HeldSamples(columns), summary(events, begin, self._starts[i]), {},
            setpoint=setpoint_columns(time, study.setpoint), orders=orders))


def _one_of_each(name: str, value: Any, count: int) -> Numbers:
    """Return what was answered for each axis; raises ControllerError."""
    try:
        numbers: Numbers = np.asarray(value, dtype=np.float64)
        return numbers if numbers.shape == (count,) else np.broadcast_to(numbers, (count,))
    except (TypeError, ValueError):
        raise ControllerError(f'{name} of a vectorized controller is of shape {np.shape(value)}; must be an array of '
                              f'shape ({count},) or a number; return one of each axis') from None


class _RaisedError(Exception):
    """A controller did."""


class _Encoders:
    """The encoders of all axes, as `simulation.encoder` has those of one: rows of slider and drive, a column a lane."""

    def __init__(self, scenes: Sequence[Scene]) -> None:
        settings, rig = [scene.rig.encoder for scene in scenes], scenes[0].rig
        self._are_ideal = np.array([one.is_ideal for one in settings])
        self._are_mixed = bool(self._are_ideal.any())
        self._resolution, self._offset, self._noise = (np.array([getattr(one, name) for one in settings]) + 0.0
                                                       for name in ('resolution', 'offset', 'noise'))
        self._are_exact = self._resolution == 0.0
        self._step = np.where(self._are_exact, 1.0, self._resolution)
        self._delays = np.array([scene.rig.encoder_delay_steps for scene in scenes])
        self._most_steps, self._lanes = int(self._delays.max()), np.arange(len(scenes))
        self._steps, self._per_second = (rig.encoder.velocity_steps, scenes[0].time.rate / rig.encoder.velocity_steps)
        self._streams = ([stream(rig.seed, purpose) for purpose in (Stream.SLIDER_NOISE, Stream.DRIVE_NOISE)]
                         if self._noise.any() else [])
        self._positions: list[Numbers] = []
        self._readings: list[Numbers] = []

    def read(self, truth: Numbers) -> list[Numbers]:
        """Return both positions and velocities, in the order of a Measurement; `truth`, what is so, changes later."""
        if self._are_mixed:
            truth = truth.copy()
            if self._are_ideal.all():
                return list(truth[:4])
        reading = self._counted(self._delayed(truth[0:4:2]))
        self._readings.append(reading)    # before the first all were as that
        del self._readings[:-self._steps - 1]
        slider, drive = zip(reading, (reading - self._readings[0]) * self._per_second)
        read = [*slider, *drive]
        return [np.where(self._are_ideal, *pair) for pair in zip(truth, read)] if self._are_mixed else read

    def _delayed(self, positions: Numbers) -> Numbers:
        if not self._most_steps:
            return positions
        self._positions.append(positions.copy())
        del self._positions[:-self._most_steps - 1]
        at = np.maximum(len(self._positions) - 1 - self._delays, 0)
        found: Numbers = np.array(self._positions)[at, :, self._lanes]
        return found.T

    def _counted(self, positions: Numbers) -> Numbers:
        reading: Numbers = positions + self._offset    # which is not -0.0: nor is the sum, as alone
        if self._streams:
            noise = np.array([[one.standard_normal()] for one in self._streams])
            reading += np.where(self._noise > 0.0, self._noise * noise, 0.0)
        counts: Numbers = reading / self._step
        counts += 0.5
        np.floor(counts, out=counts)
        counts *= self._step
        np.copyto(counts, reading, where=self._are_exact)
        return counts
