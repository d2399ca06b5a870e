# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The judgement: every limit of a file on one run."""

import math
from typing import NamedTuple

from ..core.errors import InputError
from ..runs import Run
from .kinds import TIMING
from .limits import Limit, Limits, check_fit
from .observed_motion import ObservedMotion
from .observed_run import observed_motion, timing_of


class LimitOutcome(NamedTuple):
    """What a limit came to; without a `value` there was nothing to measure, or there is no number (timing)."""

    name: str
    limit: Limit | None   # None: timing
    passed: bool
    value: float | None
    remark: str

    @property
    def margin(self) -> float | None:
        """What is left up to the limit; negative beyond it."""
        return None if self.limit is None or self.value is None else self.limit.maximum - self.value


def outcomes_of(limits: Limits, run: Run) -> list[LimitOutcome]:
    """Return the outcome of every limit, timing last; raises InputError when one does not fit the run.

    A recording that was cut off is judged as far as it goes.
    """
    motion, timing = observed_motion(run), timing_of(run)
    if limits.reference:
        motion = motion.following(limits.reference)
    check_fit(limits, motion.begin, motion.end if run.is_complete else math.inf, timing is not None)
    outcomes = [_outcome(limit, motion) for limit in limits.limits]
    if limits.timing and timing:
        outcomes.append(LimitOutcome(TIMING, None, timing.valid, None, timing.verdict))
    return outcomes


def _outcome(limit: Limit, motion: ObservedMotion) -> LimitOutcome:
    begin, end = limit.window
    begin = motion.begin if begin is None else begin
    if begin >= motion.end:
        return LimitOutcome(limit.name, limit, False, None, f'the run has nothing from t = {begin:g} s on')
    part = motion.cut(begin, motion.end if end is None else min(end, motion.end))
    try:
        value, remark = limit.kind.measure(part, **limit.settings)
    except InputError as error:
        raise InputError(f'{limit.name}.{error.name}', error.value, error.allowed, error.fix) from None
    return LimitOutcome(limit.name, limit, value <= limit.maximum, value, remark)
