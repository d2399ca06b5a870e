"""What the suite is made of: an extreme, the setup it is judged in, the tally of its cases, and its outcome."""

import math
from collections.abc import Callable
from typing import NamedTuple, TypeVar

from ..solvers import Solver, exact

_T = TypeVar('_T')
_SHOWN = 300   # characters of a missed case


class Missed(Exception):  # noqa: N818: it is a finding of the judge, not an error of the product
    """A case went wrong, and how."""


class Setup(NamedTuple):
    """How an extreme is judged: in full or in a reduced size, and which solver is on trial."""

    full: bool = True
    solver: Solver = exact.SOLVER

    def count(self, full: int, reduced: int) -> int:
        """Return how many cases to judge."""
        return full if self.full else reduced

    def choose(self, full: _T, reduced: _T) -> _T:
        """Return what belongs to the size."""
        return full if self.full else reduced


class Finding(NamedTuple):
    """What was measured: `figure` says it in words; `first_miss` how to see the first case that went wrong."""

    figure: str
    passed: bool
    cases: int
    worst: float
    limit: float
    misses: int
    first_miss: str = ''


class Extreme(NamedTuple):
    """One row of the table: what breaks others, the mark for this one, and the function that measures."""

    number: str
    name: str
    elsewhere: str
    mark: str
    measure: Callable[[Setup], Finding]


class Outcome(NamedTuple):
    """A row with its measured figure, and the seconds that took."""

    number: str
    name: str
    elsewhere: str
    mark: str
    finding: Finding
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
        self.first_miss = ''

    def judge(self, case: Callable[..., float], *given: object) -> None:
        """Run a case, which returns its error or raises; whatever it raises is a miss."""
        self.cases += 1
        try:
            error = case(*given)
            if not error <= self.limit:
                self.worst = error if math.isnan(error) else max(self.worst, error)
                raise Missed(f'error {error:.3g}{self._unit}')
            self.worst = max(self.worst, error)
        except Exception as reason:
            self.misses += 1
            if not self.first_miss:
                shown = ', '.join(repr(value) for value in given if not isinstance(value, Solver))
                text = f'{case.__name__}({shown}): {type(reason).__name__}: {reason}'
                self.first_miss = text if len(text) <= _SHOWN else text[:_SHOWN] + '…'

    def finding(self, what: str = 'wrong', extra: str = '', *, kept: bool = True) -> Finding:
        """Return the figures; `kept` is a further mark that `extra` speaks of."""
        parts = [f'{self.misses} of {self.cases} {what}']
        if self.limit > 0.0:
            parts.append(f'error {self.worst:.2g}{self._unit}')
        if extra:
            parts.append(extra)
        passed = self.cases > 0 and self.misses == 0 and kept
        return Finding('; '.join(parts), passed, self.cases, self.worst, self.limit, self.misses, self.first_miss)

    @property
    def _unit(self) -> str:
        return f' {self.unit}' if self.unit else ''


def check(condition: object, what: str) -> None:
    """Raise Missed unless the condition holds."""
    if not condition:
        raise Missed(what)
