# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the best fit amounts to: estimates with intervals, channels, tests, combinations, slips."""

import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..core.arrays import Numbers
from ..scene import Scene, changed
from .certainty.covariance import QUANTILE, Certainty, certainty_of, combinations_of
from .certainty.noisy_inputs import changes_by_inputs, covariance_by_inputs, more_by_inputs
from .certainty.profiles import with_profile_intervals
from .certainty.residual_tests import correlation_length, inflation_of, misfits_of_fit
from .fit.fit_problem import FitProblem
from .given.free_parameters import FreeParameter
from .given.measured_scene import with_measured_inputs
from .identified import (
    AT_BOUND,
    FOUND,
    NOT_IDENTIFIABLE,
    VOID,
    ChannelFit,
    Estimate,
    Identification,
    LawFit,
    SlipFit,
    StartEnd,
)
from .search.criterion import CRITERION, criterion_of
from .search.stages import Ended
from .trial.slip_features import shown_break_away

_SCORE = float(np.sqrt(QUANTILE))
_AT_END = 1e-6       # of a range
_UNSETTLED = 'the fit has not come to rest: the best point so far, whose intervals may be too narrow'
_OF_SLIPS = ('the model does not follow the whole run: single slips are fitted, each from a measured arrest, and shown'
             ' from there')
_ALONG = ('the model does not fit sample by sample: of what they leave open, numbers are taken with which the position'
          ' follows the whole run')
_WHOLE, _SINGLE = 'fit of the whole run', 'fit of single slips, each from a measured arrest'


def identification_of(problem: FitProblem, scene: Scene, ends: Sequence[Ended], began: float) -> Identification:
    """Return what was found; `ends` are those of all starts, the best first, `began` when the work did, s."""
    best = ends[0]
    point = best.solution.point
    problem.take_input_noise_of(problem.values(point))
    whole = problem.stretches(None if best.of_slips is None else 0)
    fitted = problem.fitted(point, whole)
    assert fitted is not None
    channels = _channels(problem, fitted, None if best.of_slips is None else problem.fitted(point,
                                                                                            problem.stretches(None)))
    information = best.solution.information
    changes = changes_by_inputs(problem, point) if best.of_slips is None else []
    more = more_by_inputs(problem, changes)
    inflation = inflation_of(problem, fitted) if best.of_slips is None else max(best.of_slips, 1.0)
    of_readings = certainty_of(information, inflation, problem.parameters)
    by_inputs = covariance_by_inputs(problem, best.solution, changes)
    known = of_readings._replace(covariance=of_readings.covariance + by_inputs)
    values = problem.values(point)
    misfits = misfits_of_fit(problem, fitted, more)
    estimates = _estimates(problem, values, known, _WHOLE if best.of_slips is None else _SINGLE)
    if best.of_slips is None and not misfits:
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
        starts=tuple(_start_end(problem, end, end is best) for end in ends),
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
    return tuple(_estimate(one, float(value), float(deviation), bool(is_known), derivation)
                 for one, value, deviation, is_known
                 in zip(problem.parameters, values, known.deviations, known.known, strict=True))


def _estimate(one: FreeParameter, value: float, deviation: float, is_known: bool, derivation: str) -> Estimate:
    inner = one.inner(value)
    ends = one.outer(inner - _SCORE * deviation), one.outer(inner + _SCORE * deviation)
    margin = _AT_END * (one.inner(one.high) - one.inner(one.low))
    at_end = min(inner - one.inner(one.low), one.inner(one.high) - inner) <= margin
    own = deviation if one.logarithmic else deviation * (one.high - one.low)
    kind = AT_BOUND if at_end else FOUND if is_known else NOT_IDENTIFIABLE
    if kind == NOT_IDENTIFIABLE:
        return Estimate(one.name, one.unit, value, one.start, one.low, one.high, one.logarithmic, own,
                        (one.low, one.high), None, kind, 'the data do not determine it by itself')
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
        rest, force = shown_break_away(problem.model, dynamics, values, measured, problem.track)
        since = measured.rest_begin + problem.measurement.shift
        found.append(SlipFit(since + measured.slip.rest, since + rest, measured.slip.rest, rest,
                             measured.slip.break_away, force))
    return tuple(found)
