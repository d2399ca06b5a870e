# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Other laws of friction in place of those that were fitted: what is free in each, and where its own fit begins.

A law begins with the numbers that come nearest to the law that was found, there where the run shows it: static friction
after the measured rests, kinetic friction up to a few times the speed at which it falls.
"""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..friction.static import StaticLaw, StaticLawKind
from ..scene import Scene, scene_from_values
from ..scene.schema import BY_NAME
from .axis_model import AxisModel
from .certainty import certainty_of, inflation_of
from .curve.law_fit import SMOOTH_FORMS
from .fit_problem import FitProblem
from .free_parameters import FreeParameter
from .identified import Identification, LawFit
from .least_squares import minimise, robust_cost, slopes_of, square_cost
from .many_fits import Keeper, KeyedFit, kept_fits
from .stages import Ended, StageProgress

_Values = dict[str, float]
_Curve = Callable[[str, _Values], Numbers]

_STATIC, _KINETIC = 'friction.static.', 'friction.kinetic.'
_GROWING = 'limit', 'time_constant'
_STATIC_LAWS = {'constant': ('initial',), 'exponential': _GROWING, 'kato': (*_GROWING, 'exponent'),
                'hyperbolic': _GROWING, 'logarithmic': _GROWING}   # with the numbers that are free in any case
_FORMS = {form.law: form for form in SMOOTH_FORMS if not form.free}
_KINETIC_LAWS = dict.fromkeys(_FORMS, ('stribeck_velocity',))
_WIDER = {'initial': 3.0, 'limit': 3.0, 'time_constant': 10.0, 'stribeck_velocity': 10.0, 'exponent': 5.0}
_RISE = 1.1            # limit over static friction at once: where the fit begins, after a constant law
_REACH, _SPEEDS = 5.0, 50   # Stribeck velocities up to which, and at how many speeds, kinetic laws are likened
_PULL = 1e-4           # to where it began, of a number that the run does not show
_RESTS = 1e-3, 1e9     # s, before the run
_UNITS = 30.0          # of logarithmic growth: 1e13 time constants
_INSIDE = 1e-3         # of a range: so far from its ends a fit begins


class OtherLaw(NamedTuple):
    """A scene with another law, what is free in it, and the names of its laws."""

    scene: Scene
    parameters: tuple[FreeParameter, ...]
    static: str
    kinetic: str


def other_laws(scene: Scene, parameters: Sequence[FreeParameter], rests: Numbers) -> Iterator[OtherLaw]:
    """Yield the scene found with each other static law, and each other smooth kinetic law, of which numbers are free.

    `rests` are times at rest, s.  A law that the rest of the scene does not admit is left out.
    """
    values = {name: value for name, value in scene.values.items() if value is not None}
    kinetic = values[_KINETIC + 'law']
    if _is_free(_STATIC, parameters) and len(rests):
        yield from _others(values, parameters, _STATIC, _STATIC_LAWS,
                           lambda law, own: _static_curve(law, own, rests), float(np.median(rests)))
    if _is_free(_KINETIC, parameters) and kinetic in _FORMS:
        end = _REACH * float(str(values[_KINETIC + 'stribeck_velocity']))
        speeds = np.linspace(0.0, end, _SPEEDS, dtype=np.float64)
        yield from _others(values, parameters, _KINETIC, _KINETIC_LAWS,
                           lambda law, own: _kinetic_curve(law, own, speeds), math.nan)


def _is_free(section: str, parameters: Sequence[FreeParameter]) -> bool:
    return any(one.name.startswith(section) for one in parameters)


def _static_curve(law: str, own: _Values, rests: Numbers) -> Numbers:
    limit = max(own.get('limit', 0.0), own['initial'])
    kind = StaticLaw(StaticLawKind[law.upper()], own['initial'], limit, own.get('time_constant', 1.0),
                     own.get('exponent', 1.0), own.get('delay', 0.0))
    return np.array([kind.coefficient(rest) for rest in rests.tolist()])


def _kinetic_curve(law: str, own: _Values, speeds: Numbers) -> Numbers:
    basis = _FORMS[law].basis(speeds, own['stribeck_velocity'], own.get('exponent', 2.0))
    return np.asarray(basis @ [own['initial'], own['limit'], own.get('viscous', 0.0)])


def _others(values: Mapping[str, object], parameters: Sequence[FreeParameter], section: str,
            laws: Mapping[str, tuple[str, ...]], curve: _Curve, usual_rest: float) -> Iterator[OtherLaw]:
    before = str(values[section + 'law'])
    target = curve(before, _numbers_of(values, section))
    for law, always in laws.items():
        if law == before:
            continue
        given = {**_defaults(values, usual_rest), **values} if section == _STATIC else dict(values)
        given[section + 'law'] = law
        given = {name: value for name, value in given.items()
                 if (when := BY_NAME[name].when) is None or when.holds(given)}
        free = _free(given, parameters, section, always)
        own = {one.name: one for one in free if one.name.startswith(section)}
        given.update(_nearest(list(own.values()), given, section, target, law, curve))
        if section == _STATIC:
            free = (*free, *_rest_before(given, before, values))
        try:
            scene = scene_from_values(given)
        except InputError:
            continue
        yield OtherLaw(scene, free, str(given[_STATIC + 'law']), str(given[_KINETIC + 'law']))


def _rest_before(given: dict[str, object], before: str, values: Mapping[str, object]) -> tuple[FreeParameter, ...]:
    """Put the rest before the run into values with the logarithmic law, which has no limit; return it as free.

    It is the time that this law takes to the coefficient that the law before has after an infinite rest.
    """
    name = 'initial.rest_time'
    if given[_STATIC + 'law'] != 'logarithmic' or math.isfinite(float(str(values.get(name, math.inf)))):
        return ()
    own = _numbers_of(given, _STATIC)
    highest = float(_static_curve(before, _numbers_of(values, _STATIC), np.array([math.inf]))[0])
    units = (highest - own['initial']) / max(own['limit'] - own['initial'], 1e-9)
    low, high = _RESTS
    given[name] = min(max(own['time_constant'] * math.expm1(min(max(units, 0.0), _UNITS)), 2.0 * low), 0.5 * high)
    return (FreeParameter(name, 's', float(str(given[name])), low, high),)


def _defaults(values: Mapping[str, object], usual_rest: float) -> dict[str, object]:
    """Return numbers of a static law that the one before may not have had."""
    return {_STATIC + 'limit': _RISE * float(str(values[_STATIC + 'initial'])),
            _STATIC + 'time_constant': usual_rest, _STATIC + 'exponent': 1.0}


def _numbers_of(values: Mapping[str, object], section: str) -> _Values:
    return {name.removeprefix(section): value for name, value in values.items()
            if name.startswith(section) and isinstance(value, float)}


def _free(given: Mapping[str, object], parameters: Sequence[FreeParameter], section: str, always: Sequence[str]
          ) -> tuple[FreeParameter, ...]:
    """Return what is free with another law: what was, as far as the law has it, and its own numbers in any case."""
    free = [_wider(one, section) for one in parameters if one.sensor is not None or one.name.startswith('initial.')
            or one.name.partition('[')[0] in given]
    known = {one.name for one in free}
    for name in always:
        if section + name not in known:
            value, factor = float(str(given[section + name])), _WIDER[name]
            free.append(FreeParameter(section + name, BY_NAME[section + name].unit, value, value / factor,
                                      value * factor))
    return tuple(free)


def _wider(one: FreeParameter, section: str) -> FreeParameter:
    """Return a number of another law: it means something else there, so its range is wider, and nothing is known."""
    factor = _WIDER.get(one.name.removeprefix(section)) if one.name.startswith(section) else None
    if factor is None:
        return one
    return replace(one, low=one.low / factor if one.low > 0.0 else one.low, high=one.high * factor, prior=None)


def _nearest(own: Sequence[FreeParameter], given: Mapping[str, object], section: str, target: Numbers, law: str,
             curve: _Curve) -> dict[str, object]:
    """Return the numbers of a law with which its curve is nearest to another, in shares of that."""
    fixed = _numbers_of(given, section)
    own = [one for one in own if one.name in given]
    low, high = (np.array([one.inner(end) for one, end in zip(own, ends)])
                 for ends in ([one.low for one in own], [one.high for one in own]))
    margin = _INSIDE * (high - low)
    begin = np.clip([one.inner(float(str(given[one.name]))) for one in own], low + margin, high - margin)

    def named(point: Numbers) -> _Values:
        return {one.name.removeprefix(section): one.outer(number) for one, number in zip(own, point.tolist())}

    def apart(point: Numbers) -> Numbers:
        found = curve(law, {**fixed, **named(point)})
        return np.concatenate([(found - target) / np.abs(target).max(), _PULL * (point - begin)])

    found = least_squares(apart, begin, bounds=(low, high), max_nfev=100).x
    return {section + name: value for name, value in named(np.clip(found, low + margin, high - margin)).items()}


# The criterion by which laws of friction are compared, each by its best fit of the same run.

CRITERION = 'BIC'


def criterion_of(problem: FitProblem, cost: float) -> float:
    """Return the criterion of Bayes of a fit with a sum of squares: the lower, the better."""
    return cost + len(problem.parameters) * float(np.log(_effective_count(problem)))


def _effective_count(problem: FitProblem) -> float:
    """Return how many residuals there are, each counted by its weight."""
    return float(sum(channel.weights.sum() for channel in problem.measurement.channels))


# Laws compared: the run fitted with others in place of those of the scene, each from the estimate that was found.
#
# The criterion of each is that of its best fit of the whole run, also where no law follows it: then the best of them is
# the one that comes nearest.

def with_laws(found: Identification, problem: FitProblem, workers: int, keeper: Keeper | None, progress: StageProgress
              ) -> Identification:
    """Return an identification with `laws`: that of its scene, and the others; the criterion says which is best."""
    began = time.perf_counter()
    rests = np.array([slip.stick_time for slip in found.slips if slip.stick_time > 0.0])
    others = list(other_laws(found.scene, problem.parameters, rests))
    problems = [_problem(other, found, problem) for other in others]
    fits = [KeyedFit(f'law_{other.static}_{other.kinetic}', one, one.start)
            for other, one in zip(others, problems, strict=True)]
    taken = min(found.starts, key=lambda end: end.cost).cost
    laws = [replace(found.laws[0], cost=taken, criterion=criterion_of(problem, taken))]
    progress('laws', 0.0)
    for other, one, end in zip(others, problems, kept_fits(fits, workers, keeper), strict=True):
        cost = end.solution.cost
        if np.isfinite(cost):
            laws.append(LawFit(other.static, other.kinetic, criterion_of(one, cost), len(one.parameters), cost, False))
        progress('laws', len(laws) / (1 + len(fits)))
    return replace(found, laws=tuple(laws), runs=found.runs + sum(one.model.runs for one in problems),
                   seconds=found.seconds + time.perf_counter() - began)


def _problem(other: OtherLaw, found: Identification, problem: FitProblem) -> FitProblem:
    """Return the problem with another law, from the values that were found."""
    parameters = tuple(_from(one, other, found) for one in other.parameters)
    model = AxisModel(other.scene, parameters, problem.measurement)
    return FitProblem(model, parameters, problem.measurement, problem.motions)


def _from(one: FreeParameter, other: OtherLaw, found: Identification) -> FreeParameter:
    """Return a free parameter that begins where its value is: in the scene, or as it was found."""
    value = other.scene.values.get(one.name, found.values.get(one.name, one.start))
    start = float(value) if isinstance(value, float) else found.values.get(one.name, one.start)
    return replace(one, start=min(max(start, one.low), one.high))


# The best numbers of a model that is not that of the axis: by single slips, or by the position of the whole run.
#
# Single slips are fitted each from a measured arrest.
#
# In the whole run its slips come ever more too late or too early, and the least sum of squares means nothing.  It still
# can have the right rests and break-aways, and these weigh most here: they are what such a model is used for.  Where
# the force was measured, the spring begins as far stretched as that says: the stretch must not make up for other
# errors.

_FEWEST_SLIPS, _MOST_SLIPS = 3, 30
_POINTS = 2             # to begin from, of those where fits began and ended, and with what the force says directly
_AGAIN = 2              # times that the best is sought from once more: a simplex that has shrunk stands still
_TRIALS = 60            # at each of them, for each parameter
_STEP, _STEEPEST = 1e-5, 1e4
_ROBUST = 10.0          # figures of slips: beyond, their size counts
_NEAR = 1e-3            # of a logarithm or of a range: so well a point is sought


def best_of_slips(problem: FitProblem, ends: Sequence[Ended]) -> list[Ended]:
    """Return the ends, before them the best fit of single slips where no fit of the whole run is near the data."""
    count = len(problem.sharp_slips)
    if not ends[0].is_lost or count < _FEWEST_SLIPS:
        return [*ends]
    rows = np.unique(np.linspace(0, count - 1, min(count, _MOST_SLIPS)).round().astype(int))
    slips = [problem.sharp_slips[k] for k in rows]

    def residuals(point: Numbers) -> Numbers:
        return problem.of_slips(problem.tied(point), slips, telling=True)

    def cost(point: Numbers) -> float:
        return robust_cost(residuals(point), _ROBUST)

    ended = [point for end in ends for point in (end.start, end.solution.point)]
    direct = [problem.region.inside(problem.with_direct(point)) for point in (*ended, problem.start)]
    points = [point for of in (ended, direct) for point in sorted(of, key=cost)[:_POINTS]]
    nearest = min((_nearest_point(cost, point, problem) for point in points), key=cost)
    for _ in range(_AGAIN):
        nearest = _nearest_point(cost, nearest, problem)
    best = minimise(residuals, nearest, problem.region, most=10, tolerance=1e-3, share=1e-4, robust=_ROBUST,
                    step=_STEP, steepest=_STEEPEST)
    point = problem.tied(best.point)
    whole = square_cost(problem.of_run()(point))
    if not np.isfinite(whole):
        return [*ends]
    untied = partial(problem.of_slips, slips=slips, telling=True)
    figures = untied(point)
    slopes = slopes_of(untied, point, figures, problem.region, _STEP)
    slopes[np.abs(slopes) > _STEEPEST] = 0.0
    best = best._replace(point=point, cost=whole, information=slopes.T @ slopes)
    of_slips = float(figures @ figures) / len(figures)
    return [Ended(ends[0].start, best, True, True, ends[0].tolerance, of_slips), *ends]


def _nearest_point(cost: Callable[[Numbers], float], start: Numbers, problem: FitProblem) -> Numbers:
    """Return where the figures are best, by the simplex of Nelder and Mead.

    A slip that is another one from a point on, and a contact that rings, make steps on which slopes mean nothing.
    """
    from scipy.optimize import Bounds, minimize  # takes a while, and only a wrong model needs it

    region = problem.region
    found = minimize(lambda point: cost(region.inside(point)), start, method='Nelder-Mead',
                     bounds=Bounds(region.low, region.high),
                     options={'maxfev': _TRIALS * len(start), 'xatol': _NEAR, 'fatol': _NEAR, 'adaptive': True})
    return region.inside(np.asarray(found.x))




# An axis that is not quite the model, and driven by a measured force: its position over the whole run.
#
# The filtered residuals take the position that the force leads to for what it is from sample to sample, and let its
# error grow as noise of the force does.  Where a test rejects them, what is left is no noise: friction of the axis
# varies a little along its way, and the best fit to the samples may leave the measured way by much within some seconds,
# for an offset of a percent.  The whole way shows such numbers: of those that the samples leave open, the nearest that
# follow it are taken.

_POSITION_STEP = 1e-4     # of derivatives: the position over the whole run is far from linear only beyond
_LEAST = 1e-12   # of the largest variance: less is rounding


def along_the_run(problem: FitProblem, ends: Sequence[Ended]) -> list[Ended]:
    """Return the ends, the best of them moved to where the position follows the run, if a misfit asks for it.

    Sought is the least of the squares of the position over what is known of it after a rest, counted once for each
    motion, and of the way from the best fit over its covariance.  The cost stays that of the best fit to the samples,
    by which starts and laws are compared.
    """
    best, channels = ends[0], problem.measurement.channels
    rows = [k for k, channel in enumerate(channels) if channel.name == 'position']
    if not (rows and problem.is_direct and problem.motions and best.is_off):
        return [*ends]
    k, point, whole = rows[0], best.solution.point, problem.stretches(len(problem.motions) + 1)
    fitted = problem.fitted(point, problem.stretches())
    assert fitted is not None
    covariance = certainty_of(best.solution.information, inflation_of(problem, fitted), problem.parameters).covariance
    variances, ways = np.linalg.eigh(covariance)
    near = (ways / np.sqrt(np.maximum(variances, _LEAST * variances[-1]))).T
    count = len(channels[k].values)
    factor = np.sqrt(len(problem.motions) / count) / problem.roughly(channels[k])

    def residuals(trial: Numbers) -> Numbers:
        found = problem.fitted(trial, whole)
        if found is None:
            return np.full(count + len(trial), np.nan)
        return np.concatenate([factor * (channels[k].values - found[k]), near @ (trial - point)])

    moved = minimise(residuals, point, problem.region, most=30, tolerance=1e-2, step=_POSITION_STEP)
    return [best._replace(solution=best.solution._replace(point=moved.point), is_along=True), *ends[1:]]
