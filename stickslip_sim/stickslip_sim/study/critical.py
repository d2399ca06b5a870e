# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Critical values: where an axis that starts from rest begins to stick and slip, and where steady sliding is lost.

From rest: the scene as it is, run by the exact engine until its motion settles; is that stick-slip?  From sliding:
steady sliding at the drive's velocity, slightly disturbed; it is lost where h + N mu_k′(v) < 0.  Between the two values
both motions go on, and the start decides.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..core.arrays import Numbers
from ..core.callbacks import Progress
from ..core.errors import InputError
from ..scene import Scene
from .answer_changes import FAILED, NO, OPEN, YES, Answers, Findings, find_transitions
from .point_figures import Motion, figures_of_runs
from .points import batches, runs_in_batches, scene_at, works_in_batches
from .steady import sliding_slope
from .table_facts import TableFact, table_fact
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
