# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The outcome as sentences and as JSON values; SI units."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ..runs import Run
from .judgement import LimitOutcome
from .kinds import TIMING
from .observed_run import gaps_in, observed_motion


def verdict_line(outcomes: Sequence[LimitOutcome]) -> str:
    """Return passed or failed, of how many, and which failed."""
    failed = failures(outcomes)
    if failed:
        return f'FAILED: {len(failed)} of {len(outcomes)}: {", ".join(failed)}'
    return f'PASSED: {len(outcomes)} of {len(outcomes)}'


def failures(outcomes: Sequence[LimitOutcome]) -> list[str]:
    """Return the names of the limits that were not kept."""
    return [outcome.name for outcome in outcomes if not outcome.passed]


def line_of(outcome: LimitOutcome) -> str:
    """Return what was measured, and the limit, in a sentence."""
    if outcome.limit is None or outcome.value is None:
        return outcome.remark
    unit = f' {outcome.limit.kind.unit}'.rstrip()
    text = f'{outcome.limit.kind.name} = {outcome.value!r}{unit}, limit {outcome.limit.maximum!r}{unit}'
    return f'{text} ({outcome.remark})' if outcome.remark else text


def as_json(run: Run, outcomes: Sequence[LimitOutcome]) -> dict[str, Any]:
    """Return everything that was found; an infinite figure is the text 'inf'."""
    motion = observed_motion(run)
    return {
        'run': {'name': run.name, 'begin': motion.begin, 'end': motion.end, 'states': len(motion.time),
                'events': len(motion.events), 'is_complete': run.is_complete, 'notes': list(gaps_in(run))},
        'passed': not failures(outcomes),
        'limits': [_entry(outcome) for outcome in outcomes],
    }


def _entry(outcome: LimitOutcome) -> Mapping[str, Any]:
    limit = outcome.limit
    found = {'name': outcome.name, 'passed': outcome.passed, 'remark': outcome.remark}
    if limit is None:
        return {**found, 'check': TIMING}
    return {**found, 'check': limit.kind.name, 'unit': limit.kind.unit, 'measured': _number(outcome.value),
            'max': limit.maximum, 'margin': _number(outcome.margin), 'window': limit.window._asdict(),
            **limit.settings}


def _number(value: float | None) -> float | str | None:
    return value if value is None or math.isfinite(value) else str(value)
