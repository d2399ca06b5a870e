# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What comes of every limit of a file on one run."""

import math
from typing import NamedTuple

from ..core.errors import InputError, RecordingError
from ..runs import Run
from .limits import CheckedSpan, Limit, Limits, check_fit
from .measures import TIMING_LIMIT, no_sample_in
from .observed_run import (
    KnownCommands,
    MotionBlock,
    MotionSpan,
    ObservedMotion,
    commands_of,
    motion_blocks,
    observed_motion,
    states_of,
    timing_of,
    unmeasured,
)


class LimitOutcome(NamedTuple):
    """What a limit came to; without a `value` there was nothing to measure, or there is no number (timing)."""

    name: str
    limit: Limit | None   # None: timing
    passed: bool
    value: float | None
    remark: str
    span: CheckedSpan = CheckedSpan()
    is_unchecked: bool = False   # no command came in its window: no controller was checked

    @property
    def margin(self) -> float | None:
        """What is left up to the limit; negative beyond it."""
        return None if self.limit is None or self.value is None else self.limit.maximum - self.value


def outcomes_of(limits: Limits, run: Run) -> list[LimitOutcome]:
    """Return the outcome of every limit, timing last; raises InputError when one does not fit the run.

    A recording that was cut off is checked as far as it goes.
    """
    motion, timing, commands = observed_motion(run), timing_of(run), commands_of(run)
    has_timing = timing is not None and timing.valid is not None
    check_fit(limits, motion.begin, motion.end if run.is_complete else math.inf, has_timing, commands)
    found = [_begun(limit, motion, commands, limits.needs_commands) for limit in limits.limits]
    open_ones = [one for one in found if isinstance(one, _Open)]
    reference = limits.reference_at(commands.first if commands else None)
    for block in motion_blocks(states_of(run), motion.events, reference):
        for one in open_ones:
            one.take(block)
    outcomes = [one.outcome() if isinstance(one, _Open) else one for one in found]
    for outcome in outcomes:
        if outcome.value is not None and math.isnan(outcome.value):
            raise RecordingError(f'{run.name}: {outcome.name} needs {" and ".join(unmeasured(run))}, which was not '
                                 'measured; leave this limit out, or import that column too')
    if limits.timing and timing:
        outcomes.append(LimitOutcome(TIMING_LIMIT, None, bool(timing.valid), None, timing.verdict))
    return outcomes


class _Open:
    """A limit that is being checked, while the motion comes block by block."""

    def __init__(self, limit: Limit, checked: CheckedSpan, span: MotionSpan) -> None:
        self._limit, self._checked, self._span = limit, checked, span
        self._measurement = limit.kind.measure(span, **limit.settings)
        self._has_samples = False

    def take(self, block: MotionBlock) -> None:
        part = block.cut(self._span.begin, self._span.end)
        self._has_samples |= len(part.time) > 0
        self._measurement.take(part)

    def outcome(self) -> LimitOutcome:
        """Return what came of it; raises InputError when it does not fit what was measured."""
        limit = self._limit
        if not self._has_samples:
            raise no_sample_in(self._span.begin, self._span.end)
        try:
            value, remark = self._measurement.figure()
        except InputError as error:
            raise InputError(f'{limit.name}.{error.name}', error.value, error.allowed, error.fix) from None
        return LimitOutcome(limit.name, limit, value <= limit.maximum, value, remark, self._checked)


def _begun(limit: Limit, motion: ObservedMotion, commands: KnownCommands | None, needs_commands: bool
           ) -> LimitOutcome | _Open:
    """Return a limit with its part of the run; its outcome where there is nothing to measure."""
    first = commands.first if commands else None
    span = limit.window.at(first)
    if span is None:
        return _unchecked(limit, CheckedSpan(), motion.end)
    begin = motion.begin if span.begin is None else span.begin
    end = motion.end if span.end is None else min(span.end, motion.end)
    if begin >= motion.end:
        return LimitOutcome(limit.name, limit, False, None, f'the run has nothing from t = {begin:g} s on', span)
    if commands and needs_commands and (first is None or first > end):
        return _unchecked(limit, span, end)
    return _Open(limit, span, motion.cut(begin, end))


def _unchecked(limit: Limit, span: CheckedSpan, end: float) -> LimitOutcome:
    remark = f'no drive velocity came until t = {end:g} s: no controller was checked'
    return LimitOutcome(limit.name, limit, False, None, remark, span, is_unchecked=True)
