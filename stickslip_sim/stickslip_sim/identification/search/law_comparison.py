# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Laws compared: the run fitted with others in place of those of the scene, each from the estimate that was found.

The criterion of each is that of its best fit of the whole run, also where no law follows it: then the best of them is
the one that comes nearest.
"""

import time
from dataclasses import replace

import numpy as np

from ..fit.fit_problem import FitProblem
from ..given.free_parameters import FreeParameter
from ..identified import Identification, LawFit
from ..trial.axis_model import AxisModel
from .criterion import criterion_of
from .many_fits import Keeper, KeyedFit, kept_fits
from .other_laws import OtherLaw, other_laws
from .stages import StageProgress


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
