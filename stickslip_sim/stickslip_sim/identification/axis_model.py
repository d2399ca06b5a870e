# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The axis with trial values of its free parameters: what it is, and what it does from a known state on."""

import math
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import replace
from functools import lru_cache
from typing import Any, TypeVar

import numpy as np

from ..axis import Axis, CompliantContact, Friction, InitialState
from ..core.arrays import Numbers
from ..core.errors import InputError, StickslipError
from ..core.input_profile import InputProfile, constant
from ..core.time_grid import Instants
from ..core.types import Event, Instant, Sample
from ..friction import StaticLaw, StaticLawKind
from ..friction.kinetic import MAX_BREAKPOINTS
from ..friction.refine import Breakpoint, shape_table
from ..friction.shapes import Decay, Shape
from ..scene import Scene
from ..scene.build import Dynamics, dynamics_of
from ..scene.schema import backward_name, forward_name
from ..simulation.simulator import Simulator
from ..study.variation import changes_at
from .free_parameters import DELAY, FreeParameter
from .motions import MeasuredMotion
from .readings import OUTPUTS, SensorReadings, drives_directly, instants_of, shifted, travelled

# Friction of trial values: smooth laws by their tables, without a proof of their error; static not below kinetic.
#
# The breakpoints of a table go with the falling part of its law, and so with the trial: a fit with those of the start
# makes up for their error by wrong numbers, and stays there with those of its end.

Breakpoints = tuple[Breakpoint, ...]
_Made = TypeVar('_Made')

_LAW = 'friction.kinetic.'
_EXCESS = 'friction.excess.'
_SMOOTH = 'initial', 'limit', 'stribeck_velocity', 'viscous', 'exponent', 'tolerance'
_DROPPED = frozenset(_LAW + name for name in _SMOOTH)
_FALLEN = 0.01       # as `SmoothKinetic.limit_velocity`


def with_table(values: dict[str, object], shape: Shape, held: Breakpoints | None = None) -> dict[str, object]:
    """Return values of a scene with the table of its smooth kinetic law, of a shape, in place of that.

    The breakpoints are those `held`, if any are.  An exponent among the values goes before that of the shape.  Where
    friction backwards differs it has a table of its own.  Raises InputError where a table takes too many breakpoints.
    """
    forwards = {name: value for name, value in values.items() if forward_name(name) == name}
    changes = {forward_name(name): value for name, value in values.items() if name not in forwards}
    table = _with_table(forwards, shape, held)
    back = _with_table(forwards | changes, shape, held) if changes else table
    return table | {backward_name(name): value for name, value in back.items() if value != table.get(name)}


def _with_table(values: dict[str, object], shape: Shape, held: Breakpoints | None) -> dict[str, object]:
    """Return the same of the values of one direction."""
    initial, limit, scale, viscous = (float(str(values[_LAW + name])) for name in _SMOOTH[:4])
    if _LAW + 'exponent' in values:
        shape = Decay(float(str(values[_LAW + 'exponent'])))
    points = held or breakpoints_of(values, shape)
    table = {name: value for name, value in values.items() if name not in _DROPPED}
    speeds = tuple(scale * z for z, _ in points)
    table[_LAW + 'law'] = 'table'
    table[_LAW + 'velocities'] = speeds
    table[_LAW + 'coefficients'] = (initial, *(limit + (initial - limit) * p + viscous * speed
                                               for speed, (_, p) in zip(speeds[1:], points[1:])))
    table[_LAW + 'end_slope'] = viscous
    end = scale * shape.reach(_FALLEN)
    if values.get('friction.acceleration_dependence'):
        if values.get(_EXCESS + 'law', 'table') != 'table':
            table.setdefault(_EXCESS + 'limit_velocity', end)
        elif _EXCESS + 'velocities' not in values:
            table[_EXCESS + 'velocities'], table[_EXCESS + 'fractions'] = (0.0, end), (1.0, 0.0)
    return table


def breakpoints_of(values: dict[str, object], shape: Shape, coarser: float = 1.0) -> Breakpoints:
    """Return the breakpoints (z, p) of the falling part of a law; raises InputError if they are too many.

    Those of a `coarser` table are for a tolerance so many times as large.
    """
    initial, limit, tolerance = (float(str(values[_LAW + name])) for name in ('initial', 'limit', 'tolerance'))
    return _breakpoints(shape, coarser * tolerance / abs(initial - limit)) if initial != limit else ((0.0, 0.0),)


@lru_cache(maxsize=64)
def _breakpoints(shape: Shape, share: float) -> Breakpoints:
    found = shape_table(shape, share, MAX_BREAKPOINTS)
    if found is None:
        raise InputError('friction.kinetic.tolerance', share, f'large enough for {MAX_BREAKPOINTS} breakpoints',
                         'raise it')
    return tuple(found)


def put_in_order(values: dict[str, object]) -> None:
    """Raise static friction to kinetic friction at rest, and its limit to its start, where values have it lower.

    That of the way back, too, where it is another.
    """
    for name_of in (forward_name, backward_name):
        if name_of is backward_name and all(forward_name(name) == name for name in values):
            return
        kinetic = values.get(name_of(_LAW + 'initial'), values.get(_LAW + 'initial'))
        if kinetic is None:
            name = _LAW + 'coefficients'
            coefficients = values.get(name_of(name), values.get(name))
            assert isinstance(coefficients, tuple)
            kinetic = coefficients[0]
        least = float(str(kinetic))
        for name in (name for name in ('friction.static.initial', 'friction.static.limit') if name in values):
            value = float(str(values.get(name_of(name), values[name])))
            least = max(value, least)
            if least > value:
                values[name_of(name)] = least


OUTPUT_PLACES = {name: Sample._fields.index(name) for name in OUTPUTS}
_TOLERANCE = 'friction.kinetic.tolerance'
_MEAN_LAW = {'friction.static.scatter': 0.0, 'friction.static.scatter_run': 0.0}   # no draw is that of a measured stick
_BELOW = 1.0 - 1e-12   # of what the contact holds: rounding must not break it


class _Latest:
    """The latest of what is costly to make, with its key; a copy begins without it."""

    key: object = None
    made: Any = None

    def __reduce__(self) -> tuple[type['_Latest'], tuple[()]]:
        return _Latest, ()


class AxisModel:
    """What an axis does with trial `values` of its free parameters; the inputs are those that were measured, if any.

    `runs` counts the simulations.  It `is_pushed` when a measured force drives its slider without a spring.
    """

    def __init__(self, scene: Scene, parameters: Sequence[FreeParameter], measurement: SensorReadings) -> None:
        self.scene = scene
        self._sensors = {one.sensor: k for k, one in enumerate(parameters)}
        self._own = [k for k, one in enumerate(parameters) if one.sensor is None]
        self._names = [parameters[k].name for k in self._own]
        self._take_inputs(measurement)
        self._keeps_drive = measurement.drive is not None or not any(name.startswith('drive.') for name in self._names)
        self._keeps_force = not any(one.name.startswith(('force.', 'sensor.external_force.')) for one in parameters)
        self.is_pushed = measurement.force is not None and drives_directly(scene)
        self._held: Breakpoints | None = None
        self._tolerance: float | None = None
        self.runs = 0

    def hold_table(self, values: Numbers | None, coarser: float = 1.0) -> bool:
        """Hold the breakpoints of a smooth kinetic law as they are with these values; None: they go with the trial.

        They may be those of a table that is so much `coarser`.  Return whether there is such a law.
        """
        law = self.scene.axis.friction.kinetic.law
        if law is not None:
            self._held = None if values is None else breakpoints_of(self._values(values), law.shape, coarser)
        return law is not None

    @property
    def tolerance(self) -> float | None:
        """The tolerance of the table of a smooth kinetic law; None without such a law."""
        own = self.scene.values.get(_TOLERANCE)
        return self._tolerance or (None if own is None else float(str(own)))

    def take_tolerance(self, tolerance: float | None) -> None:
        """Take another tolerance of that table than that of the scene; None: that of the scene."""
        self._tolerance = tolerance

    @property
    def has_readings(self) -> bool:
        """Whether an input was measured."""
        return self._measurement.drive_readings is not None or self._measurement.force_readings is not None

    def with_inputs_read_again(self, random: np.random.Generator) -> 'AxisModel':
        """Return the model with inputs as other readings of them would have given them, with noise of their own."""
        measurement = self._measurement
        drive, force = measurement.drive_readings, measurement.force_readings
        again = copy(self)
        again._take_inputs(replace(measurement, drive=drive and drive.read_again(random),
                                   force=force and force.read_again(random)))
        return again

    def _take_inputs(self, measurement: SensorReadings) -> None:
        self._measurement, self._of_inputs = measurement, dict[object, Any]()
        self._dynamics, self._running = _Latest(), _Latest()
        force = measurement.force or constant(0.0)
        self._force = np.array([force.starts, force.values, force.rates])

    def changes(self, values: Numbers) -> dict[str, object]:
        """Return the changes to the scene that trial values are, with static friction not below kinetic."""
        own = self._values(values)
        return {name: own[name] for name in own if own[name] != self.scene.values.get(name)}

    def dynamics(self, values: Numbers) -> Dynamics | None:
        """Return the axis and its inputs with trial values; None where these contradict each other."""
        key = values.tobytes(), self._held, self._tolerance
        if key != self._dynamics.key:
            self._dynamics.key, self._dynamics.made = key, self._made(values)
        found: Dynamics | None = self._dynamics.made
        return found

    def _made(self, values: Numbers) -> Dynamics | None:
        try:
            found = dynamics_of(self._with_table(self._values(values)) | _MEAN_LAW)
        except StickslipError:
            return None
        force = self._measurement.force
        if force is not None and not self._keeps_force:
            force = self._force_of(values)
        return found._replace(drive=self._measurement.drive or found.drive, force=force or found.force)

    def _with_table(self, values: dict[str, object]) -> dict[str, object]:
        law = self.scene.axis.friction.kinetic.law
        return values if law is None else with_table(values, law.shape, self._held)

    def delay(self, values: Numbers, channel: str = 'external_force') -> float:
        """Return how long after its readings the measured force acts, or how late a channel is read, s."""
        return self._of_sensor(values, channel, DELAY, 0.0)

    def _of_sensor(self, values: Numbers, channel: str, what: str, otherwise: float) -> float:
        place = self._sensors.get((channel, what))
        return otherwise if place is None else float(values[place])

    def _force_of(self, values: Numbers) -> InputProfile:
        """Return the force that acted, from what its sensor measured."""
        offset, scale = self.gain(values, 'external_force')
        starts, forces, rates = self._force
        starts, forces, rates = starts + self.delay(values), (forces - offset) / scale, rates / scale
        first = max(int(np.searchsorted(starts, 0.0, 'right')) - 1, 0)
        if starts[0] > 0.0:   # up to there the first reading holds
            starts, forces, rates = (np.append(one, numbers) for one, numbers in (
                (0.0, starts), (forces[0], forces), (0.0, rates)))
        begin = forces[first] - rates[first] * starts[first]
        return InputProfile((0.0, *starts[first + 1:].tolist()), (float(begin), *forces[first + 1:].tolist()),
                            tuple(rates[first:].tolist()))

    def _values(self, values: Numbers) -> dict[str, object]:
        """Return the values of the scene, those of the free parameters among them."""
        own = {**self.scene.values, **changes_at(self.scene.values, self._names, values[self._own])}
        if self._tolerance is not None:
            own[_TOLERANCE] = self._tolerance
        put_in_order(own)
        return own

    def start_force(self, values: Numbers) -> float:
        """Return the drive force at the start as its sensor would measure it, N."""
        own, (offset, scale) = self._values(values), self.gain(values, 'drive_force')
        stiffness, damping, stretch, velocity = (float(str(own[name])) for name in (
            'axis.drive_stiffness', 'axis.drive_damping', 'initial.stretch', 'initial.velocity'))
        drive = self._measurement.drive or self.scene.drive
        return offset + scale * (stiffness * stretch + damping * (drive.value_at(0.0) - velocity))

    def drive_of(self, values: Numbers) -> InputProfile:
        """Return the velocity of the drive: as it was measured, or with trial values."""
        found = self.dynamics(values)
        return self.scene.drive if found is None else found.drive

    def gain(self, values: Numbers, channel: str) -> tuple[float, float]:
        """Return offset and scale of the sensor of a channel."""
        return self._of_sensor(values, channel, 'offset', 0.0), self._of_sensor(values, channel, 'scale', 1.0)

    def state_after(self, motion: MeasuredMotion | None, dynamics: Dynamics, values: Numbers) -> InitialState:
        """Return the state at the end of a measured motion: at rest, the spring as far stretched as it must be.

        Without a motion it is that at the start of the run.
        """
        if motion is None:
            return dynamics.initial
        offset, scale = self.gain(values, 'position')
        position = (motion.stop - offset) / scale
        gone = self._travelled(dynamics.drive, motion.end)
        stretch = dynamics.initial.stretch + gone - (position - dynamics.initial.position)
        deflection = 0.0
        if isinstance(dynamics.axis.contact, CompliantContact) and not dynamics.axis.contact.undeflected:
            friction = dynamics.axis.friction.along(motion.direction)
            normal = dynamics.axis.normal_force + (dynamics.load.value_at(motion.end) if dynamics.load else 0.0)
            held = min(friction.kinetic.coefficients[0], friction.static.initial) * normal
            deflection = _BELOW * motion.direction * held / dynamics.axis.contact.stiffness
        return InitialState(position, 0.0, 0.0, stretch, deflection)

    def samples(self, dynamics: Dynamics, begin: float, initial: InitialState, at: Instants, delay: float = 0.0,
                held: float | None = None) -> Numbers | None:
        """Return rows of samples from a state at `begin` (s) on, at times since then; None if the solver gives up.

        They are those of a `delay` (s) before; before the state the slider moves evenly.  Up to it the contact `held`
        so much, a coefficient, whatever the static law says.
        """
        early = at.seconds + at.fractions - delay
        at = at if delay == 0.0 else instants_of(np.maximum(early, 0.0))
        rows = np.empty((len(at.seconds), len(Sample._fields)))
        duration = float(at.seconds[-1] + at.fractions[-1])
        try:
            self._simulator(dynamics, begin, initial, duration, True, held).take_samples(at, rows, with_events=False)
        except StickslipError:
            self._running = _Latest()
            return None
        if delay > 0.0:
            rows[:, OUTPUT_PLACES['position']] += np.minimum(early, 0.0) * rows[:, OUTPUT_PLACES['velocity']]
        return rows

    def motion(self, dynamics: Dynamics, begin: float, initial: InitialState, duration: float
               ) -> 'TrialMotion | None':
        """Return the motion from a state at `begin` (s) on, for a duration, s; None where the solver gives up."""
        second = math.floor(duration)
        try:
            simulator = self._simulator(dynamics, begin, initial, duration)
            return TrialMotion(self, simulator, simulator.advance(Instant(second, duration - second)))
        except StickslipError:
            return None

    def _simulator(self, dynamics: Dynamics, begin: float, initial: InitialState, duration: float,
                   is_kept: bool = False, held: float | None = None) -> Simulator:
        """Return a simulator from a state on; one that is kept is begun anew while the dynamics are the same.

        The excess of friction of a slip is by what the contact `held` before, which has let go.
        """
        self.runs += 1
        inputs = (self._from(dynamics.drive, 'drive', begin, duration),
                  self._from(dynamics.force, 'force', begin, duration))
        if is_kept and self._running.key is dynamics and dynamics.load is None:
            found: Simulator = self._running.made
            if held is not None:
                found.change_axis(_holding(dynamics.axis, held))
            found.restart(initial, *inputs)
        else:
            load = shifted(dynamics.load, begin, duration) if dynamics.load else None
            found = Simulator(dynamics.axis if held is None else _holding(dynamics.axis, held), initial, *inputs,
                              load=load)
        if held is not None:
            found.change_axis(dynamics.axis)
        if is_kept:
            self._running.key, self._running.made = dynamics, found
        return found

    def _from(self, profile: InputProfile, which: str, begin: float, duration: float) -> InputProfile:
        """Return a profile from a time on; kept, where no free parameter changes it."""
        if begin == 0.0:
            return profile
        return self._kept((which, begin, duration), self._keeps_drive if which == 'drive' else self._keeps_force,
                          lambda: shifted(profile, begin, duration))

    def _travelled(self, drive: InputProfile, time: float) -> float:
        return self._kept(('travelled', time), self._keeps_drive, lambda: float(travelled(drive, np.array([time]))[0]))

    def _kept(self, key: object, keeps: bool, make: Callable[[], _Made]) -> _Made:
        """Return what is made, kept under a key if it may be."""
        if not keeps:
            return make()
        if key not in self._of_inputs:
            self._of_inputs[key] = make()
        found: _Made = self._of_inputs[key]
        return found


def _holding(axis: Axis, coefficient: float) -> Axis:
    """Return an axis whose contact holds so much in both directions, and not less than kinetic friction."""
    def with_static(friction: Friction) -> Friction:
        law = StaticLaw(StaticLawKind.CONSTANT, max(coefficient, friction.kinetic.coefficients[0]), 0.0)
        return replace(friction, static=law, backward=friction.backward and with_static(friction.backward))

    return replace(axis, friction=with_static(axis.friction))


class TrialMotion:
    """A motion from a known state on: its `events`, and samples, both at times since then."""

    def __init__(self, model: AxisModel, simulator: Simulator, events: Sequence[Event]) -> None:
        self._model, self._simulator, self.events = model, simulator, events

    def samples(self, at: Instants) -> Numbers | None:
        """Return rows of samples at times up to its end; None where the solver gives up."""
        self._model.runs += 1
        rows = np.empty((len(at.seconds), len(Sample._fields)))
        try:
            self._simulator.reset()
            self._simulator.take_samples(at, rows, with_events=False)
        except StickslipError:
            return None
        return rows
