# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The highest value at which an answer changes, for many scenes at once: a scan, then sections of all stretches.

`answer_changes` finds every change of one scene, and what cannot be decided about it; here thousands of scenes are
asked for one number each, so that the compiled batch runs many of them side by side.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from .answer_changes import NO, YES, Answers
from .variation import Variation

SCAN = 33          # values; two changes between neighbours among them cancel each other
ALL_OVER, NOWHERE = np.inf, -np.inf    # in place of a value: the answer is YES, or NO, all over the range
_SECTIONS = 8      # of a stretch, looked at in one go
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
    for row, stretch in _narrowed(question, stretches, over.log, accuracy).items():
        if _width(stretch) <= _UNSURE:
            found[row] = 0.5 * (stretch.low + stretch.high)
    return found


def _narrowed(question: QuestionOfRows, stretches: dict[int, _Stretch], log: bool, accuracy: float
              ) -> dict[int, _Stretch]:
    """Return the stretches as narrow as asked for, or as narrow as answers can be had."""
    known = dict(stretches)
    asked = {row: stretch for row, stretch in known.items() if _width(stretch) > accuracy}
    while asked:
        for row, (values, answers) in _answered(question, asked, _SECTIONS + 1, log).items():
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
