# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a recorded run comes out the same when it is run again."""

from collections import deque
from typing import NamedTuple

from ..core.callbacks import Progress
from ..core.errors import RecordingError
from ..recording import Bag, RecordedRun
from ..recording.topics import MODE_EVENT, SLIDER_STATE
from ..runs import simulate
from .blocks import same_bytes
from .difference import Comparison, Difference
from .origin import offline_of
from .recorded_steps import RecordedStep, steps_of
from .remake import Maker, maker_of

_REPORTED_EVERY = 1000   # steps


class Verdict(NamedTuple):
    """What was the same: steps with their states, up to `end` (s), and transitions; then the first difference."""

    steps: int
    events: int
    missing: int          # steps before the last of those, without a recorded state
    end: float
    difference: Difference | None


def verify(run: RecordedRun, progress: Progress = None) -> Verdict:
    """Run a recording again up to its end or to the first difference.

    Raises RecordingError when there is nothing in it to compare, SolverError when the solver gives up.
    """
    if (offline := offline_of(run)) and (same := same_bytes(run, simulate(run.scene, *offline, progress))):
        return Verdict(same.steps, same.events, 0, same.end, None)
    maker = maker_of(run, run.scene, progress=progress)
    look = _Look(run.bag, maker, None if offline else progress)
    for step in steps_of(run, maker.start):
        look.at(step)
        if look.difference:
            break
    if not (look.steps or look.difference):
        raise RecordingError(f'{run.bag.path}: no step with its state in it; nothing can be verified')
    return Verdict(look.steps, look.events, look.missing, look.end, look.difference)


class _Look:
    """Makes and compares one recorded step after the other."""

    def __init__(self, bag: Bag, maker: Maker, progress: Progress) -> None:
        self.steps = self.events = self.missing = 0
        self.end = 0.0
        self.difference: Difference | None = None
        self._first = maker.start + 1
        self._maker, self._progress = maker, progress
        self._comparison = Comparison(bag)
        self._total = sum(bag.counts[topic] for topic, kind in bag.topics.items() if kind == SLIDER_STATE.type)

    def at(self, step: RecordedStep) -> None:
        made = deque(self._maker.make(step), 1).pop()    # those before it were not recorded
        self.difference = self._comparison.first_difference(step, made)
        if self.difference:
            return
        self.events += len(step.outputs[MODE_EVENT])
        if step.is_whole:
            self.steps += 1
            self.missing = made.number + 1 - self._first - self.steps
            self.end = made.sample.time
            if self._progress and self.steps % _REPORTED_EVERY == 0:
                self._progress(self.steps / self._total)
