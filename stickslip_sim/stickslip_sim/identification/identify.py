# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From a measured run to the scene that reproduces it, with how well each of its numbers is known."""

import os
import time
from collections.abc import Mapping, Sequence
from contextlib import closing, nullcontext
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..axis import CompliantContact
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..inputs import SceneOrName, scene_of
from ..recording import run_of
from ..runs import Run
from ..runs.report import named_apart
from ..scene import Scene, changed
from ..scene.load import named
from ..study.variation import changes_at
from .axis_model import AxisModel
from .break_away_scatter import sought_scatter, with_scatter
from .certainty import (
    QUANTILE,
    Certainty,
    certainty_of,
    changes_by_inputs,
    combinations_of,
    correlation_length,
    covariance_by_inputs,
    inflation_of,
    misfits_of_fit,
    more_by_inputs,
    with_profile_intervals,
)
from .direct import with_delay
from .fit_problem import FitProblem
from .force_noise import with_quiet_rests
from .free_parameters import FreeParameter, free_parameters
from .identified import (
    AT_BOUND,
    FOUND,
    NOT_IDENTIFIABLE,
    VOID,
    ChannelFit,
    Estimate,
    Identification,
    LawFit,
    Prediction,
    RunAlone,
    SlipFit,
    StartEnd,
)
from .identified_scene import with_measured_inputs
from .least_squares import square_cost
from .many_fits import Keeper, fits_from
from .motions import MeasuredMotion, motions_of, track_of
from .other_laws import CRITERION, along_the_run, best_of_slips, criterion_of, with_laws
from .prediction import KnownSensors, check_is_moved, predict, predicted
from .readings import SensorReadings, check_distinct, drives_directly, readings_of, travelled
from .run_start import from_measured_start
from .several_runs import RunFit, disagreements, is_own, joint_ends
from .slip_features import shown_break_away
from .stages import Ended, StageProgress, best_fit, starts_of

# What the best fit amounts to: estimates with intervals, channels, tests, combinations, slips.

_SCORE = float(np.sqrt(QUANTILE))
_AT_END = 1e-6       # of a range
_UNSETTLED = 'the fit has not come to rest: the best point so far, whose intervals may be too narrow'
_OF_SLIPS = ('the model does not follow the whole run: single slips are fitted, each from a measured arrest, and shown'
             ' from there')
_ALONG = ('the model does not fit sample by sample: of what they leave open, numbers are taken with which the position'
          ' follows the whole run')
_WHOLE, _SINGLE = 'fit of the whole run', 'fit of single slips, each from a measured arrest'


def identification_of(problem: FitProblem, scene: Scene, ends: Sequence[Ended], began: float,
                      is_joint: bool = False) -> Identification:
    """Return what was found; `ends` are those of all starts, the best first, `began` when the work did, s.

    An end that `is_joint` has what other runs say in it, too, and is inflated already.
    """
    best = ends[0]
    point = best.solution.point
    problem.take_input_noise_of(problem.values(point))
    if best.of_slips is None:   # under the noise of the inputs as it is there
        best = best._replace(solution=best.solution._replace(cost=square_cost(problem.of_run()(point))))
    whole = problem.stretches(None if best.of_slips is None else 0)
    fitted = problem.fitted(point, whole)
    assert fitted is not None
    alone = problem.stretches(len(problem.motions) + 1)   # from the start of the run on
    channels = _channels(problem, fitted, problem.fitted(point, alone) if len(whole.parts) > 1 else None)
    information = best.solution.information
    changes = changes_by_inputs(problem, point) if best.of_slips is None else []
    more = more_by_inputs(problem, changes)
    inflation = 1.0 if is_joint else inflation_of(problem, fitted) if best.of_slips is None else max(best.of_slips, 1.0)
    of_readings = certainty_of(information, inflation, problem.parameters)
    by_inputs = covariance_by_inputs(problem, best.solution, [] if is_joint else changes)
    known = of_readings._replace(covariance=of_readings.covariance + by_inputs)
    values = problem.values(point)
    misfits = misfits_of_fit(problem, fitted, more)
    estimates = _estimates(problem, values, known, _WHOLE if best.of_slips is None else _SINGLE)
    if best.of_slips is None and not misfits and not is_joint:
        estimates = with_profile_intervals(estimates, problem, best.solution, of_readings, inflation)
        estimates = tuple(map(_widened, estimates, problem.parameters, np.sqrt(np.diag(by_inputs))))
    if misfits:
        estimates = tuple(map(_void, estimates))
    dynamics = problem.model.dynamics(values)
    assert dynamics is not None
    found, inputs = with_measured_inputs(changed(scene, problem.model.changes(values)), problem.measurement, dynamics)
    return Identification(
        start=scene, scene=found, measured_inputs=inputs,
        estimates=estimates, correlation=known.correlation, channels=channels,
        misfits=tuple(misfits),
        combinations=combinations_of(information - problem.information_beforehand(), problem.parameters),
        starts=tuple(_start_end(problem, end, end is ends[0]) for end in ends),
        laws=(LawFit(str(scene.values['friction.static.law']), str(scene.values['friction.kinetic.law']),
                     criterion_of(problem, best.solution.cost), len(problem.parameters), best.solution.cost, True),),
        slips=_slips(problem, values), criterion=CRITERION, cost=best.solution.cost,
        n_residuals=len(whole.rows) * len(channels), runs=problem.model.runs, seconds=time.perf_counter() - began,
        notes=(*problem.measurement.notes, *([] if best.solution.is_settled else [_UNSETTLED]),
               *([] if best.of_slips is None else [_OF_SLIPS]), *([_ALONG] if best.is_along else [])),
        shift=problem.measurement.shift,
        restarts=tuple(part.begin + problem.measurement.shift for part in whole.parts if part.before is not None))


def _channels(problem: FitProblem, fitted: Sequence[Numbers], free: Sequence[Numbers] | None
              ) -> tuple[ChannelFit, ...]:
    measurement = problem.measurement
    found = []
    for k, channel in enumerate(measurement.channels):
        residuals = channel.values - fitted[k]
        new = problem.white(k, residuals)
        length = correlation_length(new, channel.weights)
        found.append(ChannelFit(channel.name, channel.unit, measurement.times + measurement.shift, channel.values,
                                fitted[k], channel.resolution, (length - 1.0) * measurement.period,
                                None if new is residuals else new, None if free is None else free[k]))
    return tuple(found)


def _estimates(problem: FitProblem, values: Numbers, known: Certainty, derivation: str) -> tuple[Estimate, ...]:
    borders = zip(problem.region.low.tolist(), problem.region.high.tolist(), strict=True)
    return tuple(_estimate(one, float(value), float(deviation), ends if is_known else None, derivation)
                 for one, value, deviation, is_known, ends
                 in zip(problem.parameters, values, known.deviations, known.known, borders, strict=True))


def _estimate(one: FreeParameter, value: float, deviation: float, borders: tuple[float, float] | None,
              derivation: str) -> Estimate:
    """Return an estimate; the fit went as far as the `borders`, None where the data do not determine it."""
    inner = one.inner(value)
    ends = one.outer(inner - _SCORE * deviation), one.outer(inner + _SCORE * deviation)
    low, high = borders or (one.inner(one.low), one.inner(one.high))
    at_end = min(inner - low, high - inner) <= _AT_END * one.width
    own = deviation if one.logarithmic else deviation * (one.high - one.low)
    kind = AT_BOUND if at_end else NOT_IDENTIFIABLE if borders is None else FOUND
    if kind == NOT_IDENTIFIABLE:
        ends, derivation = (one.low, one.high), 'the data do not determine it by itself'
    return Estimate(one.name, one.unit, value, one.start, one.low, one.high, one.logarithmic, own, ends, None, kind,
                    derivation)


def _void(one: Estimate) -> Estimate:
    """Return an estimate of a model that a test rejects."""
    if one.kind == NOT_IDENTIFIABLE:
        return one
    return replace(one, kind=VOID if one.kind == FOUND else one.kind, interval=(float('nan'), float('nan')))


def _widened(one: Estimate, parameter: FreeParameter, deviation: float) -> Estimate:
    """Return an estimate whose profile has the standard deviation by the inputs in it, as its covariance has."""
    if one.profile is None or deviation == 0.0:
        return one
    middle, more = parameter.inner(one.value), _SCORE * deviation
    low, high = (parameter.inner(end) for end in one.profile)
    return replace(one, profile=(parameter.outer(middle - float(np.hypot(middle - low, more))),
                                 parameter.outer(middle + float(np.hypot(high - middle, more)))))


def _start_end(problem: FitProblem, end: Ended, is_best: bool) -> StartEnd:
    return StartEnd(tuple(problem.values(end.start).tolist()), tuple(problem.values(end.solution.point).tolist()),
                    end.solution.cost, is_best)


def _slips(problem: FitProblem, values: Numbers) -> tuple[SlipFit, ...]:
    """Return each measured slip beside the one that the model does from the same rest on.

    Both begin by one rule (`break_away`), as the sensors show them.
    """
    dynamics = problem.model.dynamics(values)
    assert dynamics is not None
    found = []
    for measured in problem.sharp_slips:
        rest, force, _ = shown_break_away(problem.model, dynamics, values, measured, problem.track)
        since = measured.rest_begin + problem.measurement.shift
        found.append(SlipFit(since + measured.slip.rest, since + rest, measured.slip.rest, rest,
                             measured.slip.break_away, force))
    return tuple(found)


# What a measurement must have for the parameters that are sought in it, and units that were mistaken.

_NEEDS_REST = 'friction.static.', 'contact.'
_FAR = 30.0   # times: a unit was mistaken
_PER_PARAMETER = 5.0   # effective samples


def check_parameters(parameters: Sequence[FreeParameter], measurement: SensorReadings) -> None:
    """Raise InputError where the data are too few for the parameters, or have no such channel."""
    for one in parameters:
        inputs = ('external_force',) if measurement.force is not None else ()
        if one.sensor is not None and one.sensor[0] not in inputs and measurement.channel(one.sensor[0]) is None:
            known = ', '.join((*(channel.name for channel in measurement.channels), *inputs))
            fix = 'the drive force drives the slider here, and is its external_force' if measurement.force is not None \
                and one.sensor[0] == 'drive_force' else 'leave it out'
            raise InputError('free parameter', one.name, f'of a channel that was measured: {known}', fix)
    count = sum(float(channel.weights.sum()) for channel in measurement.channels)
    if count < _PER_PARAMETER * len(parameters):
        raise InputError('RUN', f'{len(measurement.times)} samples, which say as much as {count:.0f} different ones',
                         f'{_PER_PARAMETER:g} or more for each of the {len(parameters)} free parameters',
                         'measure longer, or free fewer')


def check_data(parameters: Sequence[FreeParameter], measurement: SensorReadings, motions: Sequence[MeasuredMotion],
               scene: Scene) -> None:
    """Raise InputError where the motion has nothing of what is sought, or a unit was mistaken."""
    needed = next((one.name for one in parameters if one.name.startswith(_NEEDS_REST)), None)
    if needed is not None and not motions:
        raise InputError('free parameter', needed, 'one that the motion shows: there is no rest between two motions in '
                         'it, so no static friction', 'measure at a lower feed, or leave it out')
    position = measurement.channel('position')
    drive = measurement.drive or scene.drive
    gone = float(np.ptp(travelled(drive, measurement.times)))
    if position is not None and gone > 0.0 and scene.axis.drive_stiffness > 0.0:
        way = float(np.ptp(position.values))
        if not gone / _FAR < way < gone * _FAR:
            raise InputError('RUN', f'a way of {way:g} m', f'about as long as that of the drive, {gone:g} m',
                             'check the unit of the position and the drive of the scene')
    force = measurement.channel('drive_force')
    scaled = any(one.name == 'sensor.drive_force.scale' for one in parameters)
    friction = scene.axis.friction
    most = scene.axis.normal_force * max(friction.static.limit, friction.kinetic.coefficients[0])
    if force is not None and most > 0.0 and not scaled:
        size = float(np.abs(force.values).max())
        if not most / _FAR < size < most * _FAR:
            raise InputError('RUN', f'a drive force up to {size:g} N', 'about as large as friction in the scene, '
                             f'{most:g} N', 'check its unit, or free sensor.drive_force.scale')


Given = Run | str | os.PathLike[str]


def identify(run: Given | Sequence[Given], start: SceneOrName, free: str | Path | Mapping[str, object], *,
             resolutions: Mapping[str, float] | None = None, seed: int = 0, workers: int = 1,
             laws: bool = False, progress: StageProgress | None = None, keeper: Keeper | None = None,
             test: Sequence[Given] = (), each: Sequence[str] = ()) -> Identification:
    """Return the scene that reproduces a measured or recorded run, or several, found from the scene `start`.

    `free` is a file as `uncertainty --with` takes it, or its section of parameters, and names beside parameters of the
    scene `sensor.CHANNEL.offset` and `sensor.CHANNEL.scale`.  `resolutions` are standard deviations of the noise by
    channel, in its unit, where they are known.  `progress` is called with a stage and the share of it that is done.
    With `laws` the run is fitted with other laws of friction, too, and a criterion says which is best.  Fits from
    several starts are shared out to `workers` processes, and kept by a `keeper`, if there is one.
    What is not known of the start of the run is taken from it, and noted.  Several runs share all numbers but their
    start, the offsets and delays of their sensors, and free parameters that `each` run has of its own.  The scene is
    held against each `test` run, as `predict` does.  Raises InputError and RecordingError.
    """
    began = time.perf_counter()
    say = progress or (lambda stage, share: None)
    scene = scene_of(start)
    parameters, scatter = sought_scatter(free_parameters(scene, free))
    runs = [*map(run_of, run)] if isinstance(run, Sequence) and not isinstance(run, str) else [run_of(run)]
    tests = [*map(run_of, test)]
    check_distinct([*runs, *tests])
    _check_several(runs, parameters, each, laws)
    if scatter is not None and len(runs) > 1:
        raise InputError('free parameter', scatter.name, 'left out with several runs', 'find it in one of them')
    problems, ends = [], []
    for one in runs:
        with named(one.name) if len(runs) > 1 else nullcontext():
            problems.append(_problem(one, scene, parameters, resolutions or {}))
    for one in tests:
        with named(one.name):
            _check_test(scene, problems[0].measurement, one)
    for k, problem in enumerate(problems):
        name = f'run_{k}_fit' if k else 'fit'
        with closing(fits_from(problem, starts_of(problem, seed), workers, keeper, name)) as fits:
            found = best_fit(fits, say)
        problem.model.take_tolerance(found[0].tolerance)
        ends.append(best_of_slips(problem, along_the_run(problem, found)))
    say('intervals', 0.9)   # about so much of the work is done
    if len(runs) > 1:
        identified = _of_several([*named_apart(runs)], problems, ends, each, began)
    else:
        identified = identification_of(problems[0], problems[0].model.scene, ends[0], began)
        identified = with_laws(identified, problems[0], workers, keeper, say) if laws else identified
    if scatter is not None:
        identified = with_scatter(identified, problems[0], scatter)
    also = [_along(identified, one, own.own) for one, own in zip(runs[1:], identified.alone[1:])]
    return replace(identified, predictions=(*also, *(predict(identified, one) for one in tests)))


def _problem(run: Run, scene: Scene, parameters: tuple[FreeParameter, ...], resolutions: Mapping[str, float]
             ) -> FitProblem:
    """Return what is sought in a run, its start with it; raises InputError."""
    measurement = readings_of(run, scene, resolutions)
    motions = motions_of(track_of(measurement, measurement.drive or scene.drive))
    check_parameters(parameters, measurement)
    check_data(parameters, measurement, motions, scene)
    scene, parameters, notes = from_measured_start(scene, parameters, measurement, motions)
    measurement = replace(measurement, notes=(*measurement.notes, *notes))
    if drives_directly(scene):
        measurement = with_quiet_rests(measurement, motions, isinstance(scene.axis.contact, CompliantContact))
        parameters, measurement = with_delay(parameters, measurement, scene.axis.mass)
    return FitProblem(AxisModel(scene, parameters, measurement), parameters, measurement, motions)


def _check_several(runs: Sequence[Run], parameters: Sequence[FreeParameter], each: Sequence[str], laws: bool) -> None:
    """Raise InputError on what several runs cannot have, or one alone."""
    names = [one.name for one in parameters]
    for name in each:
        if name not in names:
            raise InputError('each', name, f'a free parameter: {", ".join(names)}', 'name one, or leave it out')
    if each and len(runs) == 1:
        raise InputError('each', each[0], 'omitted with one run', 'give several runs, or drop it')
    if not runs or (laws and len(runs) > 1):
        raise InputError('RUN', len(runs), 'one run where other laws are fitted, else one or more', 'give one run')


def _of_several(names: Sequence[str], problems: Sequence[FitProblem], ends: Sequence[Sequence[Ended]],
                each: Sequence[str], began: float) -> Identification:
    """Return what was found in several runs at once, and what each says alone."""
    alone = [identification_of(problem, problem.model.scene, end, began)
             for problem, end in zip(problems, ends, strict=True)]
    joint = joint_ends([RunFit(problem, end[0]) for problem, end in zip(problems, ends, strict=True)], each)
    found = identification_of(problems[0], problems[0].model.scene, joint[:1], began, is_joint=True)
    misfits = list(found.misfits)
    cost, own = found.cost, []
    for k, (name, problem, end) in enumerate(zip(names, problems, joint, strict=True)):
        values = problem.values(end.solution.point)
        own.append({one.name: float(value) for one, value in zip(problem.parameters, values, strict=True)
                    if is_own(one.name, each)})
        if k > 0:
            problem.take_input_noise_of(values)
            fitted = problem.fitted(end.solution.point, problem.stretches(None if end.of_slips is None else 0))
            assert fitted is not None
            more = more_by_inputs(problem, changes_by_inputs(problem, end.solution.point))
            misfits += [replace(one, channel=f'{one.channel} of {name}', statement=f'{name}: {one.statement}')
                        for one in misfits_of_fit(problem, fitted, more)]
            cost += square_cost(problem.of_run()(end.solution.point))
    is_free = any(one.name == 'axis.normal_force' for one in problems[0].parameters)
    said = tuple(RunAlone(name, one.fits, one.estimates, numbers)
                 for name, one, numbers in zip(names, alone, own, strict=True))
    apart = disagreements(said, each, None if is_free else problems[0].model.scene.axis.normal_force)
    return replace(
        found, misfits=tuple(misfits), estimates=tuple(map(_void, found.estimates)) if misfits else found.estimates,
        cost=cost, n_residuals=sum(one.n_residuals for one in alone), runs=sum(one.model.runs for one in problems),
        notes=(*found.notes, f'{len(names)} runs share one scene; pictures, slips and the numbers that differ by run '
               f'are those of {names[0]}'),
        alone=said, disagreements=tuple(apart))


def _along(found: Identification, run: Run, own: Mapping[str, float]) -> Prediction:
    """Return the scene along another run that was fitted, with the numbers that this has of its own."""
    names = [name for name in own if not name.startswith(('sensor.', 'initial.'))]
    values = changes_at(found.scene.values, names, np.array([own[name] for name in names]))
    scene = changed(found.scene, values)
    errors = {name: value for name, value in {**found.values, **own}.items() if name.startswith('sensor.')}
    along = predicted(scene, scene.name, KnownSensors(errors, found.measured_inputs), run)
    return replace(along, notes=('it was fitted, too: no test of the scene', *along.notes))


def _check_test(scene: Scene, measurement: SensorReadings, run: Run) -> None:
    """Raise InputError, before the work begins, on a run that the scene found cannot be held against."""
    inputs = {'drive': measurement.drive, 'force': measurement.force}
    check_is_moved(scene, 'the run to identify', [name for name, own in inputs.items() if own is not None], run)
    readings_of(run, scene, {})
