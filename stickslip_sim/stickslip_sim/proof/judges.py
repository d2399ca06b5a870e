# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The judges of a run, what a case is judged with, and the tally of what was found."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

from ..axis import Axis, InitialState
from ..core.input_profile import InputProfile
from ..core.types import Event, Instant
from ..figures.distance import first_difference, first_mismatch, seconds_between
from ..reference import simulate
from ..simulation.simulator import Simulator
from ..solvers import Solver, exact
from .axes import input_of, instant, make

DIGITS = 40   # of the reference
_T = TypeVar('_T')
_SHOWN = 300   # characters of a missed case


class Find(Exception):  # noqa: N818
    """What a judge found wrong with a run, in one line: no error of the package."""


@dataclass(frozen=True, slots=True)
class Setup:
    """How an extreme is measured: in full or in a reduced size, and which solver is on trial."""

    full: bool = True
    solver: Solver = exact.SOLVER

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
    """An extreme with its measured figure, and the seconds that took."""

    extreme: Extreme
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

    def measure(self, case: Callable[..., float | None], *given: object) -> None:
        """Run a case, which returns its error (None is 0) or raises; any exception is a miss."""
        self.cases += 1
        try:
            error = case(*given) or 0.0
            if not error <= self.limit:
                self.worst = error if math.isnan(error) else max(self.worst, error)
                raise Find(f'error {error:.3g}{self._unit}')
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
    return str(reason) if isinstance(reason, Find) else f'{type(reason).__name__}: {reason}'


def require(condition: object, what: str) -> None:
    """Raise Find unless the condition holds."""
    if not condition:
        raise Find(what)


def error_of_run(solver: Solver, axis: Axis, drive: float | InputProfile, duration: float,
                 force: float | InputProfile = 0.0) -> float:
    """Return the error of the events of a run from prolonged rest against the reference, as `error_of_events`."""
    events = make(axis, drive, force, solver=solver).advance(instant(duration))
    wanted = simulate(axis, InitialState(), input_of(drive), input_of(force), duration, DIGITS).events
    return error_of_events(events, wanted, duration)


def error_of_events(events: Sequence[Event], wanted: Sequence[Event], duration: float) -> float:
    """Return the largest error of times over the duration and of positions over the travel.

    Raises Find when the events are not the same ones.
    """
    first = first_mismatch(events, wanted)
    if first < max(len(events), len(wanted)):
        got, due = ([(event.kind.name, event.direction) for event in run[first:first + 2]] for run in (events, wanted))
        raise Find(f'{len(events)} events instead of {len(wanted)}; number {first} differs: {got} instead of {due}')
    start = wanted[0].position if wanted else 0.0
    travel = max((abs(event.position - start) for event in wanted), default=0.0) or 1.0
    return max((max(seconds_between(e, w) / duration, abs(e.position - w.position) / travel)
                for e, w in zip(events, wanted)), default=0.0)


def same_bits(events: Sequence[Event], wanted: Sequence[Event], how: str = '') -> None:
    """Raise Find unless two lists of events are the same to the bit; `how` says what may have changed them."""
    first = first_difference(events, wanted)
    if first is not None:
        got, due = (tuple(run[first]) if first < len(run) else 'none' for run in (events, wanted))
        raise Find(f'{how}{": " if how else ""}event {first} of {len(events)} is {got} and not {due}')


def in_parts(simulator: Simulator, times: Iterable[Instant]) -> list[Event]:
    """Return the events up to each of these instants in a call of its own."""
    return [event for time in times for event in simulator.advance(time)]
