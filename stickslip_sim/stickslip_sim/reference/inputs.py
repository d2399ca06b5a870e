"""An input course in multiple precision: its pieces one after the other, periods included."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from mpmath import inf, mpf

from ..courses import Course


@dataclass(frozen=True)
class Segment:
    """An input from one instant on: value + slope (t - start)."""

    start: mpf
    value: mpf
    slope: mpf

    def at(self, t: mpf) -> mpf:
        """Return the value at an instant."""
        return self.value + self.slope * (t - self.start)


@dataclass(frozen=True)
class Input:
    """A course v(t) or F(t); right-continuous."""

    course: Course

    def segments(self) -> Iterator[Segment]:
        """Yield the pieces in the order of time, without end when the course is periodic."""
        course, turn = self.course, 0
        pieces = [tuple(map(mpf, piece)) for piece in zip(course.starts, course.values, course.rates)]
        while True:
            begin = turn * mpf(course.period) if turn else mpf(0)
            for start, value, slope in pieces:
                yield Segment(begin + start, value, slope)
            if math.isinf(course.period):
                return
            turn += 1


class Walk:
    """An input that is followed in time: the piece that holds, and `until` when."""

    def __init__(self, course: Input) -> None:
        self._segments = course.segments()
        self._here = next(self._segments)
        self._next = next(self._segments, None)

    @property
    def until(self) -> mpf:
        """Return the instant at which the next piece begins."""
        return self._next.start if self._next else inf

    def at(self, t: mpf) -> Segment:
        """Return the piece that holds from `t` on; t never goes back."""
        while self._next and self._next.start <= t:
            self._here, self._next = self._next, next(self._segments, None)
        return self._here
