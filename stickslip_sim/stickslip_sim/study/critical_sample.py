# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The critical value of a parameter where others are known only roughly: one at each point of a sample.

It is the highest value at which stick-slip from rest begins or ends, and the highest at which steady sliding is lost
(`critical`).
"""

from collections.abc import Iterator, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.callbacks import Progress
from ..core.errors import InputError
from .answer_changes import Answers
from .critical import lost_answers, stick_answers
from .highest_change import ALL_OVER, NOWHERE, Places, highest_changes
from .sample import Saltelli
from .study import Study
from .uncertainty import PERCENTS, Index, sobol_indices
from .variation import Variation
from .workers import Workers

ACCURACY = 1e-4        # of the value
STARTS = ('from_rest', 'from_sliding')
_IN_A_CHUNK = 64       # points


@dataclass(frozen=True)
class CriticalStudy:
    """The critical values of the parameter `over` at the points of a study of distributions."""

    study: Study
    over: Variation

    def __post_init__(self) -> None:
        if self.over.name in self.study.names:
            raise InputError('--of', self.over.name, 'another parameter than those that are drawn',
                             'drop it from the file of distributions')

    @property
    def stretches(self) -> list[tuple[int, int]]:
        """The first point of each chunk, and the one after its last."""
        return [(first, min(first + _IN_A_CHUNK, self.study.count))
                for first in range(0, self.study.count, _IN_A_CHUNK)]

    def values(self, first: int, last: int) -> Numbers:
        """Return a row for each point from `first` on, up to `last`, a column for each of STARTS."""
        points = self.study.points(first, last)
        names = (*self.study.names, self.over.name)

        def sticks(rows: Places, numbers: Numbers) -> Answers:
            return stick_answers(self.study.values, names, np.column_stack([points[rows], numbers]))

        def loses_sliding(rows: Places, numbers: Numbers) -> Answers:
            return lost_answers(self.study.values, names, np.column_stack([points[rows], numbers]))

        return np.column_stack([highest_changes(question, last - first, self.over, ACCURACY)
                                for question in (sticks, loses_sliding)])


class CriticalSpread(NamedTuple):
    """How the critical value of one start spreads over the independent points of a sample.

    `all_over` and `nowhere` of the `points` stick and slip (or lose sliding) all over the range, or nowhere; of
    `unknown` the value is not known; the `percentiles` are of all others, None without any.  `indices` are None where
    not every point has a value, or parameters are correlated.
    """

    points: int
    all_over: int
    nowhere: int
    unknown: int
    values: Numbers
    percentiles: list[float] | None
    indices: Mapping[str, Index] | None


def critical_values(study: CriticalStudy, workers: Workers | None = None, progress: Progress = None) -> Numbers:
    """Return the critical values of all points, a row each and a column for each of STARTS."""
    parts = []
    for (_, last), part in zip(study.stretches, _parts(study, workers)):
        parts.append(part)
        if progress:
            progress(last / study.study.count)
    return np.concatenate(parts)


def _parts(study: CriticalStudy, workers: Workers | None) -> Iterator[Numbers]:
    if workers is None:
        yield from (study.values(*stretch) for stretch in study.stretches)
        return
    waiting: list[Future[Numbers]] = [workers.pool.submit(study.values, *stretch) for stretch in study.stretches]
    yield from (future.result() for future in waiting)


def spreads_of(sample: Saltelli, values: Numbers) -> dict[str, CriticalSpread]:
    """Return the spread of each of STARTS from the values of all points of a sample."""
    return {start: _spread(sample, column.reshape(sample.samples, sample.each))
            for start, column in zip(STARTS, values.T, strict=True)}


def _spread(sample: Saltelli, values: Numbers) -> CriticalSpread:
    drawn = values[:, :2]
    known = drawn[np.isfinite(drawn)]
    indices = None if sample.correlations else sobol_indices(np.where(np.isfinite(values), values, np.nan))
    names = [one.name for one in sample.variations]
    return CriticalSpread(
        drawn.size, int((drawn == ALL_OVER).sum()), int((drawn == NOWHERE).sum()), int(np.isnan(drawn).sum()), known,
        np.percentile(known, PERCENTS).tolist() if len(known) else None,
        dict(zip(names, indices, strict=True)) if indices else None)
