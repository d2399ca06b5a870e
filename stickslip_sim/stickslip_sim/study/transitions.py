# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where the verdict on a number changes: a scan, then nested sections of each stretch in which it does."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .figures import Numbers

NO, YES, OPEN = 0, 1, -1   # verdicts; OPEN: it cannot be told
Verdicts = NDArray[np.int64]
Judge = Callable[[Numbers], Verdicts]

_SCAN = 65       # values
_SECTIONS = 16   # of a stretch, all judged at once
_GAIN = 0.9      # a stretch that shrinks less is as short as it gets


class Transition(NamedTuple):
    """The verdict is `not rises` at `low` and `rises` at `high`; in between it is not known.

    `resolved`: the two are as close as was asked for.
    """

    low: float
    high: float
    rises: bool
    resolved: bool

    @property
    def value(self) -> float:
        """The middle."""
        return self.low + 0.5 * (self.high - self.low)


class Course(NamedTuple):
    """The verdict over a range: that at its low end, and where it changes."""

    first: int
    transitions: tuple[Transition, ...]

    def at(self, value: float) -> int:
        """Return the verdict at a value that lies in no transition."""
        passed = sum(one.value < value for one in self.transitions)
        return self.first if passed % 2 == 0 else 1 - self.first


def course(judge: Judge, low: float, high: float, log: bool, accuracy: float,
           progress: Callable[[float], None] | None = None) -> Course:
    """Return how the verdict goes from `low` to `high`, each change within a relative `accuracy`.

    Two changes between neighbours of the scan, 65 values, even or in steps of one ratio (`log`), cancel each other.
    """
    values = np.asarray((np.geomspace if log else np.linspace)(low, high, _SCAN), dtype=np.float64)
    verdicts = judge(values)
    known = np.flatnonzero(verdicts != OPEN)
    if not len(known):
        return Course(OPEN, ())
    changes = [(a, b) for a, b in pairwise(known) if verdicts[a] != verdicts[b]]
    found = []
    for k, (a, b) in enumerate(changes):
        found.append(_narrowed(judge, float(values[a]), float(values[b]), bool(verdicts[b]), accuracy))
        if progress:
            progress((k + 1) / len(changes))
    return Course(int(verdicts[known[0]]), tuple(found))


def _narrowed(judge: Judge, low: float, high: float, rises: bool, accuracy: float) -> Transition:
    """Return the transition in a stretch at whose ends the verdicts differ."""
    while high - low > max(accuracy * max(abs(low), abs(high)), 2.0 * math.ulp(max(abs(low), abs(high)))):
        values = np.unique(np.linspace(low, high, _SECTIONS + 1)[1:-1])
        verdicts = judge(values)
        after = np.flatnonzero(verdicts == int(rises))
        end = int(after[0]) if len(after) else len(values)
        before = np.flatnonzero(verdicts[:end] == int(not rises))
        closer = (float(values[before[-1]]) if len(before) else low, float(values[end]) if end < len(values) else high)
        if closer[1] - closer[0] > _GAIN * (high - low):
            return Transition(low, high, rises, False)
        low, high = closer
    return Transition(low, high, rises, True)
