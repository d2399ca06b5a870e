# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The elements of the suite: an extreme, its setup, the tally of its cases, and its result."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

from ..solvers import Solver, exact

_T = TypeVar('_T')
_SHOWN = 300   # characters of a missed case


class Missed(Exception):  # noqa: N818
    """A case went wrong, and how: a finding of the suite, no error of the package."""


@dataclass(frozen=True, slots=True)
class Setup:
    """How an extreme is measured: in full or in a reduced size, and which solver is on trial."""

    full: bool = True
    solver: Solver = exact.SOLVER

    def count(self, full: int, reduced: int) -> int:
        """Return how many cases to measure."""
        return full if self.full else reduced

    def choose(self, full: _T, reduced: _T) -> _T:
        """Return the value for the size."""
        return full if self.full else reduced


class Measurement(NamedTuple):
    """The result of a measurement: `figure` says it in words; `examples` hold the first miss of each kind."""

    figure: str
    passed: bool
    cases: int
    worst: float
    limit: float
    misses: int
    examples: tuple[str, ...] = ()


class Extreme(NamedTuple):
    """One row of the table: a case that breaks others, the mark for this one, and the function that measures."""

    number: str
    name: str
    elsewhere: str
    mark: str
    measure: Callable[[Setup], Measurement]


class ExtremeResult(NamedTuple):
    """A row with its measured figure, and the seconds that took."""

    number: str
    name: str
    elsewhere: str
    mark: str
    finding: Measurement
    seconds: float

    @property
    def passed(self) -> bool:
        """Whether the mark is met."""
        return self.finding.passed


class Tally:
    """Counts cases, those that went wrong, and the largest error of the others; `limit` is the mark for it."""

    def __init__(self, limit: float, unit: str = '') -> None:
        self.limit, self.unit = limit, unit
        self.cases, self.misses, self.worst = 0, 0, 0.0
        self._examples: dict[str, str] = {}

    def measure(self, case: Callable[..., float], *given: object) -> None:
        """Run a case, which returns its error or raises; any exception is a miss."""
        self.cases += 1
        try:
            error = case(*given)
            if not error <= self.limit:
                self.worst = error if math.isnan(error) else max(self.worst, error)
                raise Missed(f'error {error:.3g}{self._unit}')
            self.worst = max(self.worst, error)
        except Exception as reason:
            self.misses += 1
            if case.__name__ not in self._examples:
                shown = ', '.join(repr(value) for value in given if not isinstance(value, Solver))
                text = f'{case.__name__.strip("_")}: {_reason(reason)}; with {shown}'
                self._examples[case.__name__] = text if len(text) <= _SHOWN else text[:_SHOWN] + '…'

    def finding(self, what: str = 'wrong', extra: str = '', *, kept: bool = True) -> Measurement:
        """Return the figures; `kept` is a further mark that `extra` speaks of."""
        parts = [f'{self.misses} of {self.cases} {what}']
        if self.limit > 0.0:
            parts.append(f'error {self.worst:.2g}{self._unit}')
        if extra:
            parts.append(extra)
        passed = self.cases > 0 and self.misses == 0 and kept
        return Measurement('; '.join(parts), passed, self.cases, self.worst, self.limit, self.misses,
                           tuple(self._examples.values()))

    @property
    def _unit(self) -> str:
        return f' {self.unit}' if self.unit else ''


def _reason(reason: Exception) -> str:
    return str(reason) if isinstance(reason, Missed) else f'{type(reason).__name__}: {reason}'


def require(condition: object, what: str) -> None:
    """Raise Missed unless the condition holds."""
    if not condition:
        raise Missed(what)
