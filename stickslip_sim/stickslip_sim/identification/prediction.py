# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene driven by the measured input of a run that it was not identified from, and how far it is off.

Found are where the run starts, the offset of its sensors, and their delay where it is not known; the physics stays that
of the scene.
"""

import math
import os
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..axis import CompliantContact
from ..core.arrays import Numbers
from ..core.errors import InputError, SolverError
from ..inputs import SceneOrName, scene_of
from ..recording import MeasuredRun, run_of
from ..runs import Run
from ..scene import Scene
from .axis_model import AxisModel
from .fit_problem import FitProblem
from .force_noise import with_quiet_rests
from .free_parameters import FreeParameter
from .identified import ChannelFit, FoundNumber, Identification, Prediction, fit_percent
from .identified_scene import FORMS, IDENTIFIED_SCENE, OF_SENSORS, number_words
from .least_squares import Residuals, Solution, minimise, square_cost
from .motions import motions_of, track_of
from .readings import Channel, SensorReadings, drives_directly, readings_of, travelled
from .report import sensor_errors
from .run_start import from_measured_start

# What moves a scene beside a run, and what is known of the sensors.
#
# The inputs of the scene itself are another run's where it was identified from one: beside this run they say nothing.

DRIVE_COLUMNS = 'drive_velocity', 'drive_position'
_COLUMNS = {'drive': DRIVE_COLUMNS, 'force': ('external_force',)}
_PUSHED = 'external_force', 'drive_force'   # of a scene without a drive spring


class KnownSensors(NamedTuple):
    """Errors of sensors as `sensor.CHANNEL.offset`, and the inputs of a scene that are those of another run."""

    errors: Mapping[str, float]
    inputs: Container[str]


def known_sensors(source: str) -> KnownSensors:
    """Return what stands beside an identified scene, a file; nothing beside another.  Raises InputError."""
    folder = Path(source).parent
    if Path(source).name != IDENTIFIED_SCENE:
        return KnownSensors({}, ())
    return KnownSensors(sensor_errors(folder), [name for name, form in FORMS.items() if (folder / form.file).is_file()])


def check_is_moved(scene: Scene, source: str, others: Container[str], run: Run) -> None:
    """Raise InputError where a run has not measured what moves a scene, some of whose inputs are those of others."""
    if not isinstance(run, MeasuredRun):
        return
    for section, columns in ({'force': _PUSHED} if drives_directly(scene) else _COLUMNS).items():
        if not set(columns) & set(run.measured) and (section in others or columns == _PUSHED):
            whose = f'that of {source} is the one of another run' if section in others else 'nothing else moves this '\
                'scene'
            raise InputError('RUN', run.name, f'measured with its {" or ".join(columns)}: {whose}',
                             f'import it with {columns[-1]}=COLUMN')


def predict(scene: SceneOrName | Identification, run: Run | str | os.PathLike[str], *,
            resolutions: Mapping[str, float] | None = None) -> Prediction:
    """Return what a scene, or an identification, says of another run, driven by what that measured of its inputs.

    Offsets of the sensors, delays that an identification has not found, and the start of the run are found; nothing
    else of the scene changes.
    `resolutions` as `identify`.  Raises InputError where the run has not measured what moves the scene, RecordingError,
    and SolverError.
    """
    given = run_of(run)
    if isinstance(scene, Identification):
        errors = {name: value for name, value in scene.values.items() if name.startswith(OF_SENSORS)}
        return predicted(scene.scene, scene.scene.name, KnownSensors(errors, scene.measured_inputs), given, resolutions)
    made = scene_of(scene)
    source = os.fspath(scene) if isinstance(scene, str | os.PathLike) else made.name
    return predicted(made, source, known_sensors(source), given, resolutions)


def predicted(scene: Scene, source: str, known: KnownSensors, run: Run,
              resolutions: Mapping[str, float] | None = None) -> Prediction:
    """Return the same of a scene from a source, of whose sensors so much is known."""
    check_is_moved(scene, source, known.inputs, run)
    problem, notes = _problem(scene, run, known.errors, resolutions or {})
    best = _nearest(problem)
    fitted = problem.fitted(best.point, problem.stretches(len(problem.motions) + 1))
    if fitted is None:
        raise SolverError(f'{scene.name} has no motion along {run.name}: check the units of its inputs')
    measurement = problem.measurement
    channels = tuple(ChannelFit(one.name, one.unit, measurement.times + measurement.shift, one.values, column,
                                one.resolution) for one, column in zip(measurement.channels, fitted, strict=True))
    found = tuple(_found(problem, best.point))
    lacks_drive = isinstance(run, MeasuredRun) and not set(DRIVE_COLUMNS) & set(run.measured)
    if lacks_drive and not drives_directly(scene):
        notes = (f'the drive is that of the scene: {run.name} measured none', *notes)
    return Prediction(scene, run.name, channels, found, _stretch_fit(problem, best.point, channels),
                      (*measurement.notes, *notes, *_remarks(channels, found)))


# The problem: the physics is held, by being none of the parameters.

_WIDE = 2.0           # ranges of what was read: so far an offset may be off
_LATEST = 5.0, 5e-3   # periods, s: the longest delay, the larger of the two
_FIRST_SLIPS = 1, 3, 8, 20, 50
_LEAST = 1e-6         # m: so far a stretch may be off without friction
_STEPS = 30
_TRIED = 33           # stretches at the start that nothing measured
_KEPT = 2             # of them
_AT_END = 1e-3        # of a range


def _problem(scene: Scene, run: Run, errors: Mapping[str, float], resolutions: Mapping[str, float]
             ) -> tuple[FitProblem, tuple[str, ...]]:
    measurement = readings_of(run, scene, resolutions)
    measurement = replace(measurement, channels=tuple(map(_weighed, measurement.channels)))
    motions = motions_of(track_of(measurement, measurement.drive or scene.drive))
    parameters = tuple(_offsets(scene, measurement, errors))
    scene, parameters, notes = from_measured_start(scene, parameters, measurement, motions)
    parameters = (*parameters, *_of_force(measurement, errors), *_delays(scene, measurement, errors))
    if drives_directly(scene):
        measurement = with_quiet_rests(measurement, motions, isinstance(scene.axis.contact, CompliantContact))
    return FitProblem(AxisModel(scene, parameters, measurement), parameters, measurement, motions), notes


def _weighed(channel: Channel) -> Channel:
    """Return a channel; one that is constant counts for nothing, for its noise is not known."""
    is_constant = math.isnan(fit_percent(channel.values, channel.values))
    return replace(channel, resolution=np.inf) if is_constant else channel


def _offsets(scene: Scene, measurement: SensorReadings, errors: Mapping[str, float]) -> Iterator[FreeParameter]:
    """Yield scales of sensors, which stay, offsets but that of the drive force; the stretch, where nothing says it."""
    for name, value in errors.items():
        if name.endswith('.scale'):
            yield FreeParameter(name, '', value, value, value, (math.log(value), 1.0))
    for channel in measurement.channels:
        if channel.name == 'position':   # an encoder counts from anywhere
            scale = errors.get('sensor.position.scale', 1.0)
            yield _offset('position', 'm', float(channel.values[0]) - scale * scene.initial.position, channel.values)
        elif channel.name != 'drive_force':
            yield _offset(channel.name, channel.unit, errors.get(f'sensor.{channel.name}.offset', 0.0), channel.values)
    is_known = measurement.channel('drive_force') is not None or scene.values['drive.course'] == 'position'
    if scene.axis.drive_stiffness > 0.0 and not is_known:
        begin, friction = scene.initial.stretch, scene.axis.normal_force * scene.axis.friction.static.limit
        most = max(_WIDE * friction / scene.axis.drive_stiffness, _LEAST)
        yield FreeParameter('initial.stretch', 'm', begin, begin - most, begin + most)
    if measurement.force_readings is not None:
        yield _offset('external_force', 'N', errors.get('sensor.external_force.offset', 0.0),
                      measurement.force_readings.values)


def _of_force(measurement: SensorReadings, errors: Mapping[str, float]) -> Iterator[FreeParameter]:
    """Yield the offset of the drive force: it is small enough to let the force say how the spring begins."""
    force = measurement.channel('drive_force')
    if force is not None and force.resolution < np.inf:
        yield _offset('drive_force', 'N', errors.get('sensor.drive_force.offset', 0.0), force.values)


def _offset(channel: str, unit: str, start: float, values: Numbers) -> FreeParameter:
    most = _WIDE * max(float(np.ptp(values)), 1e-3 * float(np.abs(values).max()), 1e-9)
    return FreeParameter(f'sensor.{channel}.offset', unit, start, start - most, start + most)


def _delays(scene: Scene, measurement: SensorReadings, errors: Mapping[str, float]) -> Iterator[FreeParameter]:
    """Yield the delay of each channel beside the inputs; of an input, where that alone moves the slider.

    One that is known stays: found anew in each run it would make up for errors of the physics.
    """
    most = max(_LATEST[0] * measurement.period, _LATEST[1])
    outputs = [one.name for one in measurement.channels if one.resolution < np.inf]
    for channel in ['external_force'] if drives_directly(scene) else outputs:
        name = f'sensor.{channel}.delay'
        known = errors.get(name)
        yield FreeParameter(name, 's', 0.0, -most, most) if known is None else \
            FreeParameter(name, 's', known, known, known, (known, 1.0))


def _nearest(problem: FitProblem) -> Solution:
    """Return where the plain residuals of the whole run are least: at once, and by ever more slips from its start."""
    whole = partial(problem.of_stretches, stretches=problem.stretches(len(problem.motions) + 1))
    parts = [partial(problem.of_stretches, stretches=problem.stretches(count, 1, problem.motions))
             for count in _FIRST_SLIPS if count < len(problem.motions)]
    begin = problem.region.inside(problem.nearest_start)
    points = [begin]
    for point in (begin, *_other_stretches(problem, begin, parts[-1] if parts else whole)):
        for part in parts:
            point = _least(part, point, problem).point
        points.append(point)
    return min((_least(whole, point, problem) for point in points), key=lambda end: end.cost)


def _least(residuals: Residuals, point: Numbers, problem: FitProblem) -> Solution:
    return minimise(residuals, point, problem.region, most=_STEPS, tolerance=1e-3, informs=False)


def _other_stretches(problem: FitProblem, begin: Numbers, residuals: Residuals) -> list[Numbers]:
    """Return points with other stretches of the spring at the start, which shift all slips, the nearest few."""
    k = next((k for k, one in enumerate(problem.parameters) if one.name == 'initial.stretch'), None)
    if k is None:
        return []
    trials = [problem.region.holding(k, number).inside(begin)
              for number in np.linspace(problem.region.low[k], problem.region.high[k], _TRIED).tolist()]
    return sorted(trials, key=lambda trial: square_cost(residuals(trial)))[:_KEPT]


# What it comes to.

def _found(problem: FitProblem, point: Numbers) -> Iterator[FoundNumber]:
    for one, value, number in zip(problem.parameters, problem.values(point).tolist(), point, strict=True):
        if one.low < one.high:
            margin = _AT_END * one.width
            is_at_end = not one.inner(one.low) + margin < number < one.inner(one.high) - margin
            yield FoundNumber(one.name, one.unit, value, is_at_end)


def _stretch_fit(problem: FitProblem, point: Numbers, channels: Sequence[ChannelFit]) -> float:
    """Return the fit of the stretch of the spring: of the way of the drive less the position."""
    position = next((one for one in channels if one.name == 'position'), None)
    if position is None or problem.model.scene.axis.drive_stiffness == 0.0:
        return math.nan
    values = problem.values(point)
    _, scale = problem.model.gain(values, 'position')
    times = np.maximum(problem.measurement.times - problem.model.delay(values, 'position'), 0.0)
    gone = scale * travelled(problem.model.drive_of(values), times)
    return fit_percent(gone - position.measured, position.measured - position.fitted)


def _remarks(channels: Sequence[ChannelFit], found: Sequence[FoundNumber]) -> Iterator[str]:
    for channel in channels:
        if math.isnan(channel.fit_percent):
            yield f'{channel.name} is constant: its fit in % is undefined, and it counts for nothing'
    for one in found:
        if one.is_at_end:
            yield f'{one.name} ended at the end of its range, {number_words(one.value, one.unit)}: beware of it'
