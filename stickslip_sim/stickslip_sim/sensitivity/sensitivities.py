# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Sensitivities: how much each figure of a run changes with each number of its scene."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..core.arrays import Numbers, data_frame
from ..core.errors import InputError, SolverError
from ..core.types import Progress
from ..figures.distance import first_difference
from ..inputs import SceneOrName, scene_of
from ..scene import Scene, changed
from .derived_figures import Figure, described, figure_of
from .moved_number import LARGEST, SMALLEST, MovedNumber, moved_number, moved_numbers
from .multiplier import Multiplier, multiplier_of
from .trace import EventKey, Trace

_STEP = 1e-5         # of a parameter
_SHORTEST = 1e-2    # s, the first look for events
_LATER = (1.0, 1.001, 1.05, 1.3)   # times as long as the base run, until a run has its figures
_HALVINGS = 60       # of a step, to where the sequence of events changes


@dataclass(frozen=True)
class SequenceChange:
    """The events that decide `figure` are others beyond a `value` of `parameter`; `what` says which, in words."""

    figure: str
    parameter: str
    value: float
    what: str


@dataclass(frozen=True)
class Sensitivities:
    """The derivatives of m figures with respect to k parameters.

    `values` (m,) are the figures, in `units`, `numbers` (k,) the parameters, in `parameter_units`; `derivatives` (m, k)
    and their `errors` in the one over the other.  NaN: there is none, since the sequence of events changes within a
    step; `changes` says where.  `sides` (k): whether a parameter could be moved to `both` sides, or one.
    """

    scene: Scene
    figures: tuple[str, ...]
    units: tuple[str, ...]
    values: Numbers
    parameters: tuple[str, ...]
    parameter_units: tuple[str, ...]
    numbers: Numbers
    sides: tuple[str, ...]
    derivatives: Numbers
    errors: Numbers
    changes: tuple[SequenceChange, ...]

    @property
    def relative(self) -> Numbers:
        """Return by what share each figure changes for each share of a parameter (m, k): ∂ ln f / ∂ ln p."""
        with np.errstate(divide='ignore', invalid='ignore'):
            found: Numbers = self.derivatives * self.numbers / self.values[:, None]
        return found

    @cached_property
    def multiplier(self) -> Multiplier:
        """The multiplier of the limit cycle that the scene ends in: how fast it attracts."""
        return multiplier_of(self.scene)

    def frame(self) -> Any:
        """Return a pandas.DataFrame of the derivatives, a row each; raises InputError without pandas."""
        of, by = (grid.reshape(-1) for grid in np.indices(self.derivatives.shape))
        return data_frame({
            'figure': np.array(self.figures)[of], 'unit': np.array(self.units)[of],
            'parameter': np.array(self.parameters)[by], 'parameter_unit': np.array(self.parameter_units)[by],
            'derivative': self.derivatives.reshape(-1), 'error': self.errors.reshape(-1),
            'relative': self.relative.reshape(-1)}, 'derivatives')


def sensitivities(scene: SceneOrName, figures: Iterable[str], parameters: Iterable[str] | None = None,
                  step: float = _STEP, progress: Progress = None) -> Sensitivities:
    """Return the derivatives of figures of a run with respect to parameters of its scene, each with its error.

    `figures` are names as event.10.time, stick.3.position, position@0.5 or period (docs/sensitivities.md); `parameters`
    are numbers of the scene, an element of a list as friction.kinetic.coefficients[1] (None: all that decide the
    motion).  Central differences of exact runs at `step` and half of it, relative to the parameter, and Richardson.
    Raises InputError, and SolverError when the scene itself cannot be run.
    """
    if not SMALLEST <= step <= LARGEST:
        raise InputError('step', step, f'from {SMALLEST:g} to {LARGEST:g} of a parameter',
                         f'leave it out for {_STEP:g}')
    exact = changed(scene_of(scene), {'solver.name': 'exact'})
    asked = [figure_of(name) for name in _names('figures', figures)]
    moved = (moved_numbers(exact, step) if parameters is None
             else [moved_number(exact, name, step) for name in _names('parameters', parameters)])
    base = _base_run(exact, asked)
    pinned = [one.pinned(base) for one in asked]
    columns, changes = [], []
    for count, one in enumerate(moved, 1):
        column = _Column(one, pinned, base)
        columns.append(column.derivatives())
        changes += column.changes()
        if progress:
            progress(count / len(moved))
    derivatives, errors = np.moveaxis(np.array(columns), 0, -1)
    return Sensitivities(
        exact, tuple(one.name for one in pinned), tuple(one.unit for one in pinned),
        np.array([one.value(base) for one in pinned]), tuple(one.name for one in moved),
        tuple(one.unit for one in moved), np.array([one.value for one in moved]),
        tuple(one.stencil.side for one in moved), derivatives, errors, tuple(changes))


class _Column:
    """The runs of one parameter, and what they say of each figure."""

    def __init__(self, moved: MovedNumber, figures: Sequence[Figure], base: Trace) -> None:
        self._moved, self._figures, self._base = moved, figures, base
        self._needed = max(_end(one, base) for one in figures)
        self._runs: dict[float, Trace | None] = {moved.value: base}
        at_stencil = [self._run(moved.at(offset)) for offset in moved.stencil.offsets]
        self._alike = [all(is_alike(one, base, trace) for trace in at_stencil) for one in figures]

    def derivatives(self) -> Numbers:
        """Return the derivative of each figure, and its error: (2, m), NaN where there is none."""
        found = np.full((2, len(self._figures)), math.nan)
        for k, one in enumerate(self._figures):
            if self._alike[k]:
                runs = [self._runs[self._moved.at(offset)] or self._base for offset in self._moved.stencil.offsets]
                values = np.array([one.value(trace) for trace in runs])
                found[:, k] = self._moved.stencil.derivative(values, self._moved.step, abs(self._moved.value))
        return found

    def changes(self) -> list[SequenceChange]:
        """Return where the sequence of events changes, for each figure without a derivative."""
        return [nearest_change(one, self._moved, self._base, self._run)
                for one, alike in zip(self._figures, self._alike) if not alike]

    def _run(self, value: float) -> Trace | None:
        """Return the run of a value, as long as the figures need; None where the scene cannot be run."""
        if value not in self._runs:
            try:
                self._runs[value] = self._traced(self._moved.scene_with(value))
            except (InputError, SolverError):
                self._runs[value] = None
        return self._runs[value]

    def _traced(self, scene: Scene) -> Trace:
        trace = Trace(scene, self._base.times)
        for factor in _LATER:
            trace.extend(factor * self._needed)
            if all(one.is_in(trace) for one in self._figures):
                break
        return trace


def _base_run(scene: Scene, figures: Sequence[Figure]) -> Trace:
    """Return the run of the scene, long enough for its figures, or as long as is looked for them."""
    trace = Trace(scene, np.unique([one.time for one in figures if one.time is not None]))
    trace.extend_until(lambda run: all(one.is_in(run) for one in figures), _SHORTEST)
    return trace


def _end(one: Figure, trace: Trace) -> float:
    """Return how long a run must be for a figure, s."""
    return trace.events[one.extent(trace)[1] - 1].time if one.time is None else one.time


def _names(what: str, given: Iterable[str]) -> list[str]:
    names = [given] if isinstance(given, str) else list(given)
    if not names or len(set(map(str, names))) < len(names):
        raise InputError(what, names, 'one or more names, each once', 'name the figures or parameters to differentiate')
    return names


# Where the sequence of events that decides a figure changes: there it has no derivative (grazing).

def is_alike(figure: Figure, base: Trace, other: Trace | None) -> bool:
    """Whether the same sequence of events decides a figure in both runs; None is a run that could not be made."""
    return other is not None and figure.is_in(other) and _steps(figure, base) == _steps(figure, other)


def nearest_change(figure: Figure, moved: MovedNumber, base: Trace, run: Callable[[float], Trace | None]
                   ) -> SequenceChange:
    """Return where the sequence changes within a step, by bisection; `run` makes the run of a value."""
    found = [_bisected(figure, base, run, moved.value, beyond)
             for beyond in (_first_unlike(figure, moved, base, run, side) for side in (-1.0, 1.0))
             if beyond is not None]
    value, other = min(found, key=lambda pair: abs(pair[0] - moved.value))
    return SequenceChange(figure.name, moved.name, value, _in_words(figure, base, other))


def _first_unlike(figure: Figure, moved: MovedNumber, base: Trace, run: Callable[[float], Trace | None], side: float
                  ) -> float | None:
    """Return the nearest value of the stencil on a side that has another sequence; None where all have the same."""
    values = [moved.at(offset) for offset in sorted(moved.stencil.offsets, key=abs) if offset * side > 0.0]
    return next((value for value in values if not is_alike(figure, base, run(value))), None)


def _bisected(figure: Figure, base: Trace, run: Callable[[float], Trace | None], same: float, other: float
              ) -> tuple[float, Trace | None]:
    """Return the value at the change, between one of the same sequence and one of another, and the run beyond.

    It is that of the scene itself where the change is so near that no value in between has the same sequence.
    """
    found, own = run(other), same
    for _ in range(_HALVINGS):
        middle = 0.5 * (same + other)
        if middle in (same, other):
            break
        trace = run(middle)
        if is_alike(figure, base, trace):
            same = middle
        else:
            other, found = middle, trace
    return own if same == own else other, found


def _steps(figure: Figure, trace: Trace) -> Sequence[EventKey]:
    first, last = figure.extent(trace)
    return trace.sequence[first:last]


def _in_words(figure: Figure, base: Trace, other: Trace | None) -> str:
    if other is None:
        return 'the scene cannot be run there'
    k = first_difference(_steps(figure, base), _steps(figure, other))
    if k is None:
        return 'the figure is missing there'
    words = []
    for trace in (base, other):
        first, last = figure.extent(trace)
        words.append(described(trace.events[first + k]) if first + k < last else 'none')
    return f'event {figure.extent(base)[0] + k + 1} is {words[0]} here, {words[1]} there'
