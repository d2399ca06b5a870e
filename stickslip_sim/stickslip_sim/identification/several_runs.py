# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Several runs of one axis in one fit: numbers that all of them share, and those that each run has of its own.

Each run is fitted alone first.  Then the residuals of all are fitted at once, those of a run over the root of its
inflation: one whose residuals are larger than its noise, or go together, says less.
"""

import re
from collections.abc import Container, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from .certainty import QUANTILE, certainty_of, changes_by_inputs, covariance_by_inputs, inflation_of
from .fit_problem import FitProblem
from .free_parameters import FreeParameter, Region, region_of
from .identified import NOT_IDENTIFIABLE, Estimate, RunAlone, moved
from .least_squares import minimise
from .stages import Ended

_STEPS = 60
_COEFFICIENT = re.compile(r'friction\..*\.(initial|limit|coefficients\[\d+\])')    # a scale or an exponent is no force


class RunFit(NamedTuple):
    """The problem of a run, and where its own fit ended."""

    problem: FitProblem
    end: Ended

    def inflation(self) -> float:
        """Return the factor, 1 or more, on the covariance that its residuals say, by the noise of its inputs, too."""
        if self.end.of_slips is not None:
            return max(self.end.of_slips, 1.0)
        problem, solution = self.problem, self.end.solution
        fitted = problem.fitted(solution.point, problem.stretches())
        assert fitted is not None
        inflation = inflation_of(problem, fitted)
        of_readings = np.diag(certainty_of(solution.information, inflation, problem.parameters).covariance)
        by_inputs = np.diag(covariance_by_inputs(problem, solution, changes_by_inputs(problem, solution.point)))
        moves = of_readings > 0.0
        return inflation * (1.0 + float(np.max(by_inputs[moves] / of_readings[moves], initial=0.0)))

    def residuals(self, point: Numbers) -> Numbers:
        """Return its residuals: of the whole run, or of its slips where only these could be fitted."""
        if self.end.of_slips is None:
            return self.problem.of_run()(point)
        return self.problem.of_slips(self.problem.tied(point), self.problem.sharp_slips, telling=True)


def is_own(name: str, each: Container[str]) -> bool:
    """Return whether each run has a number of its own: its start, offset and delay of its sensors, those of `each`."""
    return name in each or name.startswith('initial.') or (name.startswith('sensor.') and not name.endswith('.scale'))


class _Layout:
    """The numbers of all runs as one point: `places` of those of each run in it, and the `region`."""

    def __init__(self, fits: Sequence[RunFit], each: Container[str]) -> None:
        parameters: list[FreeParameter] = []
        shared: dict[str, int] = {}
        held: list[bool] = []
        self.places: list[NDArray[np.intp]] = []
        self.first: list[NDArray[np.bool_]] = []   # of each run: numbers that no run before has
        for fit in fits:
            rows, new = [], []
            stuck = (fit.problem.region.low == fit.problem.region.high).tolist()
            for one, is_held in zip(fit.problem.parameters, stuck, strict=True):
                known = None if is_own(one.name, each) else shared.get(one.name)
                row = len(parameters) if known is None else known
                if known is None:
                    parameters.append(one)
                    held.append(is_held)
                    if not is_own(one.name, each):
                        shared[one.name] = row
                held[row] &= is_held
                rows.append(row)
                new.append(known is None)
            self.places.append(np.array(rows))
            self.first.append(np.array(new))
        self.count = len(parameters)
        start = np.array([one.inner(one.start) for one in parameters])
        found = region_of(parameters, fits[0].problem.model.scene.values)
        rows = [row for row, is_held in enumerate(held) if is_held]
        self.region: Region = found.holding(rows, start[rows]) if rows else found


def joint_ends(fits: Sequence[RunFit], each: Container[str]) -> list[Ended]:
    """Return the end of each run in the best fit of all at once, from where each ended alone.

    JᵀJ of each is what all runs say of its numbers, inflated.
    """
    finest = min((fit.end.tolerance for fit in fits if fit.end.tolerance is not None), default=None)
    for fit in fits:
        fit.problem.model.take_tolerance(finest)
    layout, inflations = _Layout(fits, each), [fit.inflation() for fit in fits]

    def residuals(point: Numbers) -> Numbers:
        parts = []
        for fit, places, first, inflation in zip(fits, layout.places, layout.first, inflations, strict=True):
            own = fit.residuals(point[places])
            parts += [own[:-len(places)] / inflation**0.5, own[-len(places):][first]]
        whole = np.concatenate(parts)
        return whole if np.isfinite(whole).all() else np.full_like(whole, np.nan)

    solutions = [minimise(residuals, start, layout.region, most=_STEPS, tolerance=1e-3)
                 for start in _starts(fits, layout, inflations)]
    best = min(solutions, key=lambda one: one.cost if np.isfinite(one.cost) else np.inf)
    return [fit.end._replace(solution=best._replace(
        point=best.point[places], information=_marginal(best.information, places)), tolerance=finest, is_along=False)
        for fit, places in zip(fits, layout.places, strict=True)]


def _starts(fits: Sequence[RunFit], layout: _Layout, inflations: Sequence[float]) -> Iterator[Numbers]:
    """Yield points to start from: the mean of the runs by what each knows, then what single runs say."""
    total, weights = np.zeros(layout.count), np.zeros(layout.count)
    for fit, places, inflation in zip(fits, layout.places, inflations, strict=True):
        known = np.diag(fit.end.solution.information) / inflation + 1e-300
        total[places] += known * fit.end.solution.point
        weights[places] += known
    yield layout.region.inside(total / weights)
    for fit, places in zip(fits, layout.places, strict=True):
        start = total / weights
        start[places] = fit.end.solution.point
        yield layout.region.inside(start)


def _marginal(information: Numbers, places: NDArray[np.intp]) -> Numbers:
    """Return what is known of numbers at places when all others are free (the complement of Schur)."""
    others = np.setdiff1d(np.arange(len(information)), places)
    cross = information[np.ix_(places, others)]
    scale = np.sqrt(np.maximum(np.diag(information)[others], 1e-300))
    inverse = np.linalg.pinv(information[np.ix_(others, others)] / np.outer(scale, scale), hermitian=True)
    return np.asarray(information[np.ix_(places, places)] - (cross / scale) @ inverse @ (cross / scale).T)


# What the runs disagree about: numbers whose intervals, each from a run alone, do not meet.

def disagreements(alone: Sequence[RunAlone], each: Container[str], normal_force: float | None) -> Iterator[str]:
    """Yield what runs disagree about; friction in N, too, under a `normal_force` (N) that is known."""
    for name in [one.name for one in alone[0].estimates if not is_own(one.name, each)]:
        said = [(run, one, ends) for run in alone for one in run.estimates
                if one.name == name and (ends := _interval(one)) is not None]
        if said and max(ends[0] for *_, ends in said) > min(ends[1] for *_, ends in said):
            force = normal_force if _COEFFICIENT.fullmatch(name) else None
            words = ', '.join(f'{_words(one, ends, force)} in {run.run}{"" if run.fits else " (which it does not fit)"}'
                              for run, one, ends in said)
            yield f'{name}: {words}: they disagree by more than their intervals'


def _interval(one: Estimate) -> tuple[float, float] | None:
    """Return the interval of an estimate, by its deviation where a test rejects the model; None without any."""
    if one.kind == NOT_IDENTIFIABLE:
        return None
    reach = QUANTILE**0.5 * one.standard_deviation
    return (moved(one, -reach), moved(one, reach)) if np.isnan(one.best_interval[0]) else one.best_interval


def _words(one: Estimate, ends: tuple[float, float], force: float | None) -> str:
    scale, unit = (1.0, one.unit) if force is None else (force, 'N')
    return f'{scale * one.value:.5g} [{scale * ends[0]:.5g}, {scale * ends[1]:.5g}] {unit}'.rstrip()
