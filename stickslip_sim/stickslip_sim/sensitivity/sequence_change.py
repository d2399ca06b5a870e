# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where the sequence of events that decides a figure changes: there it has no derivative (grazing)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..figures.distance import first_difference
from .derived_figures import Figure, described
from .moved_number import MovedNumber
from .trace import EventKey, Trace

_HALVINGS = 60


@dataclass(frozen=True)
class SequenceChange:
    """The events that decide `figure` are others beyond a `value` of `parameter`; `what` says which, in words."""

    figure: str
    parameter: str
    value: float
    what: str


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
