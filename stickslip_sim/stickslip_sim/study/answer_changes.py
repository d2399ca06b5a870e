# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where the answer of a number changes: a scan, then nested sections of each stretch in which it does.

Where there is no answer, or answers alternate however close the values, the change lies in between; beyond both ends
of such a stretch more values are looked at, until none of them contradicts.
"""

import math
from collections.abc import Callable, Sequence
from itertools import groupby, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.types import Progress
from .variation import Variation

NO, YES, OPEN, FAILED = 0, 1, -1, -2   # answers; OPEN: there is none; FAILED: the run went wrong
Answers = NDArray[np.int64]
Question = Callable[[Numbers], Answers]

_SCAN = 65       # values
_SECTIONS = 16   # of a stretch, all at once
_GAIN = 0.9      # a stretch that shrinks less is as short as it gets
_SPLITS = 1      # so often a stretch may turn out to have several changes
_BEYOND = 8.0    # lengths of a stretch, so far beyond it is looked
_PROBES = 64     # values there, so that answers that are rare by chance are met


class Transition(NamedTuple):
    """The answer is `not rises` at `low` and `rises` at `high`; in between it is not known.

    `resolved`: the two are as close as was asked for.  `failed`: in between are runs that went wrong.
    """

    low: float
    high: float
    rises: bool
    resolved: bool
    failed: bool = False

    @property
    def value(self) -> float:
        """The middle."""
        return self.low + 0.5 * (self.high - self.low)


class Doubt(NamedTuple):
    """Between `low` and `high`, with one answer on either side or an end of the range, are values without any.

    `failed`: their runs went wrong.
    """

    low: float
    high: float
    failed: bool


class Findings(NamedTuple):
    """The answer over a range: that at its low end, where it changes, and where it is not known."""

    first: int
    transitions: tuple[Transition, ...]
    doubts: tuple[Doubt, ...] = ()

    def at(self, value: float) -> int:
        """Return the answer at a value; OPEN where it is not known."""
        unknown = [(one.low, one.high) for one in self.doubts]
        unknown += [(one.low, one.high) for one in self.transitions if not one.resolved]
        if self.first < NO or any(low < value < high for low, high in unknown):
            return OPEN
        passed = sum(one.value < value for one in self.transitions)
        return self.first if passed % 2 == 0 else 1 - self.first

    @property
    def marks(self) -> list[float]:
        """The values at which the result of `at` may change."""
        ends = [end for one in self.transitions for end in ((one.value,) if one.resolved else (one.low, one.high))]
        return [*ends, *(end for one in self.doubts for end in (one.low, one.high))]


class _Scan(NamedTuple):
    """Values in their order, and the answers on them."""

    values: Numbers
    answers: Answers

    def known(self) -> list[int]:
        """Return the places of the values that have an answer."""
        return [int(place) for place in np.flatnonzero(self.answers >= NO)]

    def changes(self) -> list[tuple[int, int]]:
        """Return the places of adjacent values with answers that differ."""
        return [(a, b) for a, b in pairwise(self.known()) if self.answers[a] != self.answers[b]]

    def has_failed(self, first: int, last: int) -> bool:
        """Whether a run from a place to another went wrong."""
        return bool((self.answers[first:last + 1] == FAILED).any())


def find_transitions(question: Question, low: float, high: float, log: bool, accuracy: float,
                     progress: Progress = None) -> Findings:
    """Return how the answer goes from `low` to `high`, each change within a relative `accuracy`.

    Two changes between adjacent values of the scan (65, even or in steps of one ratio with `log`) cancel each other.
    """
    values = np.asarray((np.geomspace if log else np.linspace)(low, high, _SCAN), dtype=np.float64)
    scan = _Scan(values, question(values))
    known, changes = scan.known(), scan.changes()
    if not known:
        failed = scan.has_failed(0, _SCAN)
        return Findings(FAILED if failed else OPEN, (), (Doubt(low, high, failed),))
    found: list[Transition] = []
    for k, (a, b) in enumerate(changes):
        def narrowing(share: float, before: int = k) -> None:
            if progress:
                progress((before + share) / len(changes))

        narrowing(0.0)
        found += _narrowed(question, _part(scan, a, b), accuracy, _SPLITS, narrowing)
    return Findings(int(scan.answers[known[0]]), tuple(found), tuple(_doubts(scan)))


def _doubts(scan: _Scan) -> list[Doubt]:
    """Return where a scan has no answer, but where the answer changes."""
    found, last = [], len(scan.values) - 1
    for is_known, group in groupby(range(last + 1), lambda place: scan.answers[place] >= NO):
        places = list(group)
        before, after = max(places[0] - 1, 0), min(places[-1] + 1, last)
        at_an_end = places[0] == 0 or places[-1] == last
        if not is_known and (at_an_end or scan.answers[before] == scan.answers[after]):
            found.append(Doubt(float(scan.values[before]), float(scan.values[after]), scan.has_failed(before, after)))
    return found


def _narrowed(question: Question, scan: _Scan, accuracy: float, splits: int,
              progress: Callable[[float], None] = lambda _: None) -> list[Transition]:
    """Return the transitions in a scan at whose ends the answers differ: one, or more where each of them is clear."""
    rises, whole = bool(scan.answers[-1]), scan
    first = float(scan.values[-1] - scan.values[0])
    while True:
        low, high = float(scan.values[0]), float(scan.values[-1])
        size = max(abs(low), abs(high))
        progress(_share_of_digits(first, high - low, accuracy * size))
        if high - low <= max(accuracy * size, 2.0 * math.ulp(size)):
            return [Transition(low, high, rises, True)]
        inner = np.unique(np.linspace(low, high, _SECTIONS + 1)[1:-1])
        scan = _Scan(np.array([low, *inner, high]), np.array([int(not rises), *question(inner), int(rises)]))
        changes = scan.changes()
        if len(changes) > 1:
            clear = _each(question, scan, changes, accuracy, splits)
            return clear or [_widened(question, scan, changes[0][0], changes[-1][1], whole)]
        (a, b), = changes
        if scan.values[b] - scan.values[a] > _GAIN * (high - low):
            return [_widened(question, scan, a, b, whole)]
        scan = _part(scan, a, b)


def _share_of_digits(first: float, now: float, last: float) -> float:
    """Return how far a stretch has shrunk from its first length to its last one, by orders of magnitude."""
    return min(math.log(first / now) / math.log(first / last), 1.0) if last < first else 1.0


def _each(question: Question, scan: _Scan, changes: Sequence[tuple[int, int]], accuracy: float,
          splits: int) -> list[Transition]:
    """Return the transition of each of several changes; nothing unless all are clear."""
    found: list[Transition] = []
    for a, b in changes if splits else ():
        parts = _narrowed(question, _part(scan, a, b), accuracy, splits - 1)
        if not all(one.resolved for one in parts):
            return []
        found += parts
    return found


def _widened(question: Question, scan: _Scan, first: int, last: int, whole: _Scan) -> Transition:
    """Return the transition between two places of a scan, moved apart until the values beyond agree with its ends."""
    rises, failed = bool(whole.answers[-1]), scan.has_failed(first, last)
    ends = [float(scan.values[first]), float(scan.values[last])]
    for side, limit, wanted in ((0, float(whole.values[0]), int(not rises)), (1, float(whole.values[-1]), int(rises))):
        contradicts = False   # the end itself
        while ends[side] != limit:
            reach = _BEYOND * (ends[1] - ends[0])
            far = max(ends[0] - reach, limit) if side == 0 else min(ends[1] + reach, limit)
            beyond = np.linspace(ends[side], far, _PROBES + 1)[1:]
            answers = question(np.asarray(beyond, dtype=np.float64))
            against = np.flatnonzero(answers != wanted)
            failed |= bool((answers == FAILED).any())
            if not len(against):
                ends[side] = float(beyond[0]) if contradicts else ends[side]
                break
            contradicts = bool(against[-1] + 1 == len(beyond))
            ends[side] = far if contradicts else float(beyond[against[-1] + 1])
    return Transition(ends[0], ends[1], rises, False, failed)


def _part(scan: _Scan, first: int, last: int) -> _Scan:
    """Return the values from one place to another, with both."""
    return _Scan(scan.values[first:last + 1], scan.answers[first:last + 1])


# The highest value at which an answer changes, for many scenes at once: a scan, then sections of all stretches.
#
# `answer_changes` finds every change of one scene, and what cannot be decided about it; here thousands of scenes are
# asked for one number each, so that the compiled batch runs many of them side by side.

SCAN = 33          # values; two changes between neighbours among them cancel each other
ALL_OVER, NOWHERE = np.inf, -np.inf    # in place of a value: the answer is YES, or NO, all over the range
_ROW_SECTIONS = 8      # of a stretch, looked at in one go
_UNSURE = 1e-2     # of the value: a change that is known no closer is not known

Places = NDArray[np.int64]
QuestionOfRows = Callable[[Places, Numbers], Answers]    # scenes by their numbers, a value for each


class _Stretch(NamedTuple):
    """Adjacent values with answers that differ, nothing known in between."""

    low: float
    high: float


def highest_changes(question: QuestionOfRows, count: int, over: Variation, accuracy: float) -> Numbers:
    """Return for each of `count` scenes the highest change, to a relative `accuracy`; ALL_OVER or NOWHERE without one.

    NaN where it is not known.
    """
    found: Numbers = np.full(count, np.nan)
    stretches: dict[int, _Stretch] = {}
    whole = {row: _Stretch(over.low, over.high) for row in range(count)}
    for row, (values, answers) in _answered(question, whole, SCAN, over.log).items():
        stretch = _highest(values, answers)
        if stretch is not None:
            stretches[row] = stretch
        elif (answers == answers[0]).all() and answers[0] >= NO:
            found[row] = ALL_OVER if answers[0] == YES else NOWHERE
    for row, stretch in _narrowed_rows(question, stretches, over.log, accuracy).items():
        if _width(stretch) <= _UNSURE:
            found[row] = 0.5 * (stretch.low + stretch.high)
    return found


def _narrowed_rows(question: QuestionOfRows, stretches: dict[int, _Stretch], log: bool, accuracy: float
              ) -> dict[int, _Stretch]:
    """Return the stretches as narrow as asked for, or as narrow as answers can be had."""
    known = dict(stretches)
    asked = {row: stretch for row, stretch in known.items() if _width(stretch) > accuracy}
    while asked:
        for row, (values, answers) in _answered(question, asked, _ROW_SECTIONS + 1, log).items():
            narrower = _highest(values, answers) or asked[row]
            if narrower == asked[row] or _width(narrower) <= accuracy:
                del asked[row]
            else:
                asked[row] = narrower
            known[row] = narrower
    return known


def _answered(question: QuestionOfRows, stretches: dict[int, _Stretch], count: int, log: bool
            ) -> dict[int, tuple[Numbers, Answers]]:
    """Return `count` values of each stretch, both ends among them, and the answers on them."""
    spread = np.geomspace if log else np.linspace
    values = np.array([spread(stretch.low, stretch.high, count) for stretch in stretches.values()], dtype=np.float64)
    rows = np.repeat(np.array(list(stretches), dtype=np.int64), count)
    answers = question(rows, values.reshape(-1)).reshape(values.shape)
    return {row: (values[k], answers[k]) for k, row in enumerate(stretches)}


def _highest(values: Numbers, answers: Answers) -> _Stretch | None:
    """Return the highest two known values next to each other with answers that differ; None without."""
    known = np.flatnonzero(answers >= NO)
    changes = np.flatnonzero(answers[known[1:]] != answers[known[:-1]])
    if not len(changes):
        return None
    last = changes[-1]
    return _Stretch(float(values[known[last]]), float(values[known[last + 1]]))


def _width(stretch: _Stretch) -> float:
    """Return the relative width."""
    return (stretch.high - stretch.low) / max(abs(stretch.low), abs(stretch.high))
