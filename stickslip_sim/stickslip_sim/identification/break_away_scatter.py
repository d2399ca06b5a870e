# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How break-aways scatter around the static law: its mean, and the relative standard deviation of a stick.

Break-away i shows mu_i after the rest t_i, from which its factor f_i on the law follows.  With n break-aways and k free
numbers of the law Σ (f_i − 1)² is distributed as s² χ²(n − k), which gives s and its interval.  Where the whole run
cannot be followed for the scatter, the numbers of the law are the most likely ones by the break-aways.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from ..axis import CompliantContact, Friction
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..friction import StaticLaw, StaticLawKind
from ..scene import changed
from .direct import friction_at_break_aways
from .fit_problem import FitProblem
from .free_parameters import FreeParameter
from .identified import AT_BOUND, FOUND, LEVEL, NOT_IDENTIFIABLE, Estimate, Identification
from .slip_features import shown_break_away

SCATTER = 'friction.static.scatter'
FEWEST = 8           # break-aways that say how they scatter
_LAW = 'friction.static.'
_LOWEST = 1e-3       # of a factor
_LATER = 1e-7        # s, for a derivative
_FIRST = 0.1         # of a range: how far the search for the law begins to look
_CLOSE = 1e-3        # of the logarithm of the likelihood, and of what the fit works on
_HALVINGS, _WIDE = 12, 1.5   # for an end of an interval; the logarithm of the widest one of a scatter
_SCORE = 1.96        # standard deviations in half an interval


class LoadedBreakAway(NamedTuple):
    """A measured break-away: the `rest` before it, s, the `coefficient`, its `rate` of loading, 1/s, the direction."""

    rest: float
    coefficient: float
    rate: float
    forwards: bool


def loaded_break_aways(problem: FitProblem, values: Numbers) -> list[LoadedBreakAway]:
    """Return the break-aways of sharp slips that a force which grew led to.

    Sensors show a slip when it is fast enough, late by what those of the model show: under the force that grew on.
    """
    dynamics, slips = problem.model.dynamics(values), problem.sharp_slips
    if dynamics is None:
        return []
    axis, found = dynamics.axis, []
    stiffness = axis.drive_stiffness
    if isinstance(axis.contact, CompliantContact):   # both springs are loaded, one behind the other
        stiffness /= 1.0 + stiffness / axis.contact.stiffness
    late = [shown_break_away(problem.model, dynamics, values, slip, problem.track).late for slip in slips]
    usual = float(np.median([one for one in late if np.isfinite(one)] or [0.0]))
    slips = [slip._replace(motion=replace(slip.motion, begin=slip.rest_begin + slip.slip.rest - usual))
             for slip in slips if slip.slip.rest > usual]
    for slip, one in zip(slips, friction_at_break_aways(problem.model, values, problem.measurement, slips),
                         strict=True):
        begin = slip.motion.begin
        normal = axis.normal_force + (dynamics.load.value_at(begin) if dynamics.load else 0.0)
        rate = slip.motion.direction * (stiffness * dynamics.drive.value_at(begin)
                                        + dynamics.force.piece_at(begin).rate) / normal
        if one.coefficient > 0.0 and rate > 0.0:
            found.append(LoadedBreakAway(one.rest, one.coefficient, rate, one.forwards))
    return found


def sought_scatter(parameters: Sequence[FreeParameter]) -> tuple[tuple[FreeParameter, ...], FreeParameter | None]:
    """Return what is left for the fit, and the scatter, if that is sought; raises InputError where nothing is left."""
    others = tuple(one for one in parameters if one.name != SCATTER)
    if not others:
        raise InputError('free parameter', SCATTER, 'not the only one: it is found around the static law',
                         'free friction.static.limit, too')
    return others, next((one for one in parameters if one.name == SCATTER), None)


def factor_of(law: StaticLaw, at_rest: float, one: LoadedBreakAway) -> float:
    """Return the factor on the mean law that a break-away shows; mu_0 of a stick is not below mu_k(0), `at_rest`."""
    mean = law.coefficient(one.rest)
    factor = one.coefficient / mean
    if factor * law.initial >= at_rest or law.kind == StaticLawKind.CONSTANT or law.limit == law.initial:
        return factor
    grown = (mean - law.initial) / (law.limit - law.initial)
    return max((at_rest + (one.coefficient - at_rest) / grown) / law.limit, _LOWEST) if grown > 0.0 else factor


def factors_of(friction: Friction, measured: Sequence[LoadedBreakAway]) -> Numbers:
    """Return the factors (n,) on the mean law of measured break-aways."""
    sides = [friction.along(1.0 if one.forwards else -1.0) for one in measured]
    return np.array([factor_of(side.static, side.kinetic.coefficients[0], one)
                     for side, one in zip(sides, measured, strict=True)])


def deviation_of(factors: Numbers, free: int) -> tuple[float, tuple[float, float]]:
    """Return the standard deviation of factors (n,) around a law with so many free numbers, and its interval."""
    from scipy.stats import chi2

    degrees = len(factors) - max(free, 1)
    off = factors - 1.0 if free else factors - factors.mean()
    total = float(off @ off)
    low, high = (float(np.sqrt(total / chi2.ppf(0.5 * (1.0 + sign * LEVEL), degrees))) for sign in (1.0, -1.0))
    return float(np.sqrt(total / degrees)), (low, high)


def with_scatter(found: Identification, problem: FitProblem, sought: FreeParameter) -> Identification:
    """Return what was found with the scatter of its break-aways, and the mean law where no test passes for it."""
    point = np.array([one.inner(found.values[one.name]) for one in problem.parameters])
    scatter, law = scatter_estimates(problem, point, sought, seeks_law=not found.fits)
    size = len(found.estimates)
    correlation = np.eye(size + 1)
    correlation[:size, :size] = found.correlation
    for k, before in enumerate(found.estimates):
        if before.name in law:
            correlation[k] = correlation[:, k] = np.eye(size + 1)[k]
    values = {name: one.value for name, one in {**law, SCATTER: scatter}.items()}
    notes = found.notes if not law else (*found.notes, (
        f'break-aways scatter by {100.0 * scatter.value:.2g} % of mu_s: no single motion follows the whole run; static '
        'friction is fitted to its break-aways'))
    return replace(found, estimates=(*(law.get(one.name, one) for one in found.estimates), scatter),
                   correlation=correlation, scene=changed(found.scene, values), notes=notes)


def scatter_estimates(problem: FitProblem, point: Numbers, sought: FreeParameter, *, seeks_law: bool
                      ) -> tuple[Estimate, dict[str, Estimate]]:
    """Return the scatter around the law at a point (k,); or around the one that is fitted to the break-aways, with it.

    The numbers of that law are estimates by name.  Too few break-aways show no scatter.
    """
    places = [k for k, one in enumerate(problem.parameters) if one.name.startswith(_LAW)]
    measured = loaded_break_aways(problem, problem.values(point))
    degrees = len(measured) - max(len(places), 1)
    if degrees < FEWEST - 1:
        return _estimate(sought, sought.start, np.nan, (sought.low, sought.high), NOT_IDENTIFIABLE,
                         f'{len(measured)} break-aways are too few to show it'), {}
    law, mean = {}, None
    if places and seeks_law:
        mean = _mean_law(problem, point, places, measured)
        point, law = mean.point, _of_the_law(problem, mean, places, len(measured))
    dynamics = problem.model.dynamics(problem.values(point))
    assert dynamics is not None
    value, interval = deviation_of(factors_of(dynamics.axis.friction, measured), len(places))
    interval = interval if mean is None else mean.of_scatter
    inside = min(max(value, sought.low), sought.high)
    share = 1.0 / float(np.sqrt(2.0 * degrees))
    return _estimate(sought, inside, share if sought.logarithmic else share * value, interval,
                     FOUND if inside == value else AT_BOUND, f'{len(measured)} break-aways around the static law'), law


def _estimate(one: FreeParameter, value: float, deviation: float, interval: tuple[float, float], kind: str,
              derivation: str) -> Estimate:
    return Estimate(one.name, one.unit, value, one.start, one.low, one.high, one.logarithmic, deviation, interval, None,
                    kind, derivation)


class _MeanLaw(NamedTuple):
    """The law around which break-aways scatter: its point (k,), the ends of its numbers, and those of the scatter."""

    point: Numbers
    ends: list[tuple[float, float]]
    of_scatter: tuple[float, float]


def _mean_law(problem: FitProblem, point: Numbers, places: list[int], measured: Sequence[LoadedBreakAway]) -> _MeanLaw:
    """Return the most likely law, from the one at a point (k,) on, its numbers at some `places` free.

    A stick with a high factor rests longer on its way up the same line of force: levels over the times at rest would
    show a law that grows too much.  So the density of the time at rest counts, that of the factor times df/dt.
    Intervals are those of the profile likelihood, which is that of Student where the law is linear in its numbers.
    """
    from scipy.stats import t as student

    count, degrees = len(measured), len(measured) - len(places)

    def cost(numbers: Numbers, deviation: float | None = None) -> float:
        trial = point.copy()
        trial[places] = numbers
        dynamics = problem.model.dynamics(problem.values(problem.region.inside(trial)))
        if dynamics is None:
            return np.inf
        factors = factors_of(dynamics.axis.friction, measured)
        rises = (factors_of(dynamics.axis.friction, [*map(_later, measured)]) - factors) / _LATER
        if not np.all(rises > 0.0):   # a law that outruns the force breaks nothing away
            return np.inf
        total = float(np.sum((factors - 1.0)**2))
        likely = float(np.sqrt(total / count)) if deviation is None else deviation
        own = 2.0 * np.log(likely) + total / count / likely**2
        return float(0.5 * count * own - np.sum(np.log(rises)))

    low, high = problem.region.low[places], problem.region.high[places]
    best, least = _least(cost, point[places], low, high)
    found = point.copy()
    found[places] = best
    dynamics = problem.model.dynamics(problem.values(found))
    assert dynamics is not None
    middle = float(np.log(np.sqrt(np.mean((factors_of(dynamics.axis.friction, measured) - 1.0)**2))))
    limit = least + 0.5 * count * float(np.log1p(student.ppf(0.5 * (1.0 + LEVEL), degrees)**2 / degrees))

    def of_number(k: int, number: float) -> float:
        others = np.arange(len(places)) != k
        whole = best.copy()
        whole[k] = number

        def beside(numbers: Numbers) -> float:
            whole[others] = numbers
            return cost(whole)

        return _least(beside, best[others], low[others], high[others])[1] - limit

    def of_deviation(number: float) -> float:
        return _least(partial(cost, deviation=float(np.exp(number))), best, low, high)[1] - limit

    ends = [(_crossing(partial(of_number, k), best[k], low[k]), _crossing(partial(of_number, k), best[k], high[k]))
            for k in range(len(places))]
    more = float(np.sqrt(count / degrees))
    low_end, high_end = (more * float(np.exp(_crossing(of_deviation, middle, middle + way))) for way in (-_WIDE, _WIDE))
    return _MeanLaw(found, ends, (low_end, high_end))


def _least(cost: Callable[[Numbers], float], begin: Numbers, low: Numbers, high: Numbers) -> tuple[Numbers, float]:
    """Return where a cost is least within a range, by the simplex of Nelder and Mead, and the cost."""
    from scipy.optimize import Bounds, minimize  # takes a while, and few need it

    if not len(begin):
        return begin, cost(begin)
    ways = np.where(begin + _FIRST * (high - low) <= high, 1.0, -1.0) * _FIRST * (high - low)
    found = minimize(cost, begin, method='Nelder-Mead', bounds=Bounds(low, high), options={
        'xatol': _CLOSE, 'fatol': _CLOSE, 'initial_simplex': np.concatenate([begin[None], begin + np.diag(ways)])})
    return np.asarray(found.x), float(found.fun)


def _crossing(function: Callable[[float], float], inside: float, end: float) -> float:
    """Return where a function that is negative at `inside` comes up to 0 on the way to an end, or the end."""
    if function(end) < 0.0:
        return end
    for _ in range(_HALVINGS):
        middle = 0.5 * (inside + end)
        if function(middle) < 0.0:
            inside = middle
        else:
            end = middle
    return 0.5 * (inside + end)


def _later(one: LoadedBreakAway) -> LoadedBreakAway:
    """Return the break-away that would have come a moment later, under the same load."""
    return one._replace(rest=one.rest + _LATER, coefficient=one.coefficient + one.rate * _LATER)


def _of_the_law(problem: FitProblem, law: _MeanLaw, places: list[int], count: int) -> dict[str, Estimate]:
    """Return the estimates of the numbers of the mean law, by name."""
    own = {}
    for place, (low, high) in zip(places, law.ends, strict=True):
        one = problem.parameters[place]
        is_known = high - low < 0.5 * one.width
        spread = (high - low) / (2.0 * _SCORE)
        own[one.name] = _estimate(one, one.outer(float(law.point[place])),
                                  spread if one.logarithmic else spread * (one.high - one.low),
                                  (one.outer(low), one.outer(high)) if is_known else (one.low, one.high),
                                  FOUND if is_known else NOT_IDENTIFIABLE, f'{count} break-aways, which scatter')
    return own
