# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Fits from many starts: on several processes at once, and kept, so that an interrupted identification goes on.

Which fits there are and in which order they end does not depend on the processes: the result is the same to the last
bit.
"""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import ExitStack
from copy import deepcopy
from functools import partial
from typing import NamedTuple, Protocol

import numpy as np

from ...core.arrays import Numbers
from ...study.workers import processes
from ..fit.fit_problem import FitProblem
from ..fit.least_squares import Solution
from .stages import Ended, fit_from

_Arrays = Mapping[str, Numbers]


class Keeper(Protocol):
    """Keeps the arrays of fits that are done, each under a key."""

    def found(self, key: str) -> _Arrays | None:
        """Return what is kept, None where there is nothing."""

    def keep(self, key: str, arrays: _Arrays) -> None:
        """Keep the arrays of a fit."""


class KeyedFit(NamedTuple):
    """A fit to be made, of a problem from a start, and the key under which it is kept."""

    key: str
    problem: FitProblem
    start: Numbers


class _Fitted(NamedTuple):
    """The end of a fit, and how many simulations it took."""

    end: Ended
    runs: int


def fits_from(problem: FitProblem, starts: Iterator[Numbers], workers: int, keeper: Keeper | None
              ) -> Generator[Ended, None, None]:
    """Yield the fit from each start, in their order; the first is made alone, for it may be good enough."""
    yield from kept_fits([KeyedFit('fit_0', problem, next(starts))], 1, keeper)
    yield from kept_fits([KeyedFit(f'fit_{k}', problem, start) for k, start in enumerate(starts, 1)], workers, keeper)


def kept_fits(fits: Sequence[KeyedFit], workers: int, keeper: Keeper | None) -> Generator[Ended, None, None]:
    """Yield where fits end, in their order; those that are kept are not made again."""
    with ExitStack() as stack:
        works: list[Callable[[], _Fitted]] = [partial(_fit, one.problem, one.start) for one in fits]
        if min(workers, len(fits)) > 1:
            pool = stack.enter_context(processes(min(workers, len(fits)))).pool
            works = [pool.submit(work).result for work in works]
        for one, work in zip(fits, works, strict=True):
            yield _kept(one.problem, one.key, work, keeper)


def _kept(problem: FitProblem, key: str, work: Callable[[], _Fitted], keeper: Keeper | None) -> Ended:
    arrays = None if keeper is None else keeper.found(key)
    fitted = work() if arrays is None else _of_arrays(arrays)
    if arrays is None and keeper is not None:
        keeper.keep(key, _arrays(fitted))
    problem.model.runs += fitted.runs
    return fitted.end


def _fit(problem: FitProblem, start: Numbers) -> _Fitted:
    """Return the fit of a copy of a problem: what one fit leaves in it changes no other, as between processes."""
    own = deepcopy(problem)
    end = fit_from(own, start)
    return _Fitted(end, own.model.runs - problem.model.runs)


def _arrays(fitted: _Fitted) -> _Arrays:
    end = fitted.end
    numbers = np.array([end.solution.cost, end.is_off, end.is_lost, end.tolerance or 0.0, end.solution.is_settled,
                        fitted.runs], dtype=np.float64)
    return {'start': end.start, 'point': end.solution.point, 'information': end.solution.information,
            'numbers': numbers}


def _of_arrays(arrays: _Arrays) -> _Fitted:
    cost, is_off, is_lost, tolerance, is_settled, runs = arrays['numbers'].tolist()
    solution = Solution(arrays['point'], cost, arrays['information'], bool(is_settled))
    return _Fitted(Ended(arrays['start'], solution, bool(is_off), bool(is_lost), tolerance or None), int(runs))
