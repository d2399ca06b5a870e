# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Critical values: where an axis that starts from rest begins to stick and slip, and where steady sliding is lost.

From rest: the scene as it is, run by the exact engine until its motion settles; is that stick-slip?  From sliding:
steady sliding at the drive's velocity, slightly disturbed; it is lost where h + N mu_k′(v) < 0.  Between the two values
both motions go on, and the start decides.
"""

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.types import Progress
from ..figures.point_figures import Motion, figures_of_runs
from ..scene import Scene
from .answer_changes import (
    ALL_OVER,
    FAILED,
    NO,
    NOWHERE,
    OPEN,
    YES,
    Answers,
    Findings,
    Places,
    find_transitions,
    highest_changes,
)
from .points import batches, runs_in_batches, scene_at, works_in_batches
from .sample import Saltelli
from .settling import sliding_slope
from .study import Study
from .sweep import Workers
from .theory import TableFact, table_fact
from .uncertainty import PERCENTS, Index, sobol_indices
from .variation import Variation, checked, number_at, parameter_of

_PATIENCE = 20_000   # cycles that a motion is given to settle
_DOUBLINGS = 20      # of its first run
_WIDTH = 100.0       # times up and down from the scene's own value, where no range is given
FINEST = 1e-15


@dataclass(frozen=True)
class Critical:
    """Where the motion changes over a parameter: YES is stick-slip `from_rest`, and lost sliding `from_sliding`.

    `by_table` says which of the values a table of friction decides by its breakpoints and straight segments.
    """

    over: Variation
    accuracy: float
    from_rest: Findings
    from_sliding: Findings
    by_table: tuple[TableFact, ...] = ()

    @property
    def both(self) -> list[tuple[float, float]]:
        """Stretches in which stick-slip goes on from rest, and sliding from sliding."""
        marks = (*self.from_rest.marks, *self.from_sliding.marks)
        ends = sorted({self.over.low, *marks, self.over.high})
        return _joined([(a, b) for a, b in pairwise(ends) if self.from_rest.at(0.5 * (a + b)) == YES
                        and self.from_sliding.at(0.5 * (a + b)) == NO])


def critical_of(scene: Scene, over: Variation, accuracy: float, progress: Progress = None) -> Critical:
    """Return the critical values of a parameter of a scene; raises InputError."""
    if not FINEST <= accuracy < 1.0:
        raise InputError('--accuracy', accuracy, f'>= {FINEST:g} and < 1', 'give the relative width, as 1e-9')
    if not works_in_batches(scene):
        raise InputError('scene', scene.name, 'one with constant inputs, without faults or a normal load, and with the '
                         'solver exact',
                         'a critical value belongs to a motion that settles')
    for end in (over.low, over.high):
        scene_at(scene.values, [over.name], np.array([end]))
    ask = _Questions(scene.values, over.name)
    limits = over.low, over.high, over.log, accuracy
    rest = find_transitions(ask.sticks, *limits, progress)    # it takes nearly all the time
    sliding = find_transitions(ask.loses_sliding, *limits)
    facts = [table_fact(scene.values, over.name, one.value, accuracy, found is sliding)
             for found in (rest, sliding) for one in found.transitions if one.resolved]
    return Critical(over, accuracy, rest, sliding, tuple(fact for fact in facts if fact is not None))


def default_range(scene: Scene, name: str) -> Variation:
    """Return the range of a parameter from a hundredth to a hundred times its value in the scene; raises InputError."""
    entry, index = parameter_of(name)
    value = number_at(scene.values, name)
    if value is None or not 0.0 < value < np.inf:
        raise InputError('--between', None, f'given for {name}, which is no number above 0 in this scene, so that the '
                         'range around it is not known', 'add --between LOW:HIGH' + (
                             f', or --set {name}=… to look from 1/100 to 100 times that' if index is None else ''))
    low, high = value / _WIDTH, value * _WIDTH
    return checked(Variation(name, max(low, entry.low or low), min(high, entry.high or high), 0, True))


@dataclass(frozen=True)
class _Questions:
    """What is asked of values of one parameter of a scene."""

    values: Mapping[str, object]
    name: str

    def sticks(self, numbers: Numbers) -> Answers:
        """Whether stick-slip goes on, from the start of the scene."""
        return stick_answers(self.values, [self.name], numbers[:, None])

    def loses_sliding(self, numbers: Numbers) -> Answers:
        """Whether a disturbance of steady sliding grows."""
        return lost_answers(self.values, [self.name], numbers[:, None])


def stick_answers(values: Mapping[str, object], names: Sequence[str], points: Numbers) -> Answers:
    """Return for each point whether stick-slip goes on, from the start of the scene."""
    runs = runs_in_batches(values, names, points, None, _PATIENCE, _DOUBLINGS)
    figures = figures_of_runs(runs)
    answers = np.where(figures.motion == Motion.STICK_SLIP, YES, NO)
    answers[(figures.motion == Motion.UNDECIDED) | runs.late] = OPEN   # late: a value beside it may never slide
    answers[figures.motion == Motion.FAILED] = FAILED
    return answers


def lost_answers(values: Mapping[str, object], names: Sequence[str], points: Numbers) -> Answers:
    """Return for each point whether a disturbance of steady sliding grows."""
    slopes = np.empty(len(points))
    for members, scene, inputs in batches(values, names, points):
        slopes[members] = sliding_slope(scene.axis, inputs)
    return np.where(np.isnan(slopes), OPEN, np.where(slopes < 0.0, YES, NO))


def _joined(stretches: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return stretches with those put together that touch."""
    joined: list[tuple[float, float]] = []
    for begin, end in stretches:
        if joined and joined[-1][1] == begin:
            joined[-1] = (joined[-1][0], end)
        else:
            joined.append((begin, end))
    return joined


# The critical value of a parameter where others are known only roughly: one at each point of a sample.
#
# It is the highest value at which stick-slip from rest begins or ends, and the highest at which steady sliding is lost
# (`critical`).

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
