# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the paper says, as something that holds on a run, or not."""

from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any, NamedTuple

from ..runs import Run
from .look import Watch


class StatementOutcome(Enum):
    """What comes of a statement."""

    HOLDS = 'holds'
    FAILS = 'does not hold'
    NOT_APPLICABLE = 'not applicable'


class Finding(NamedTuple):
    """What was found: the outcome, why in one line, and the numbers (SI)."""

    outcome: StatementOutcome
    text: str
    figures: dict[str, float]


class Statement(NamedTuple):
    """One statement of the paper, in our words, and the function that finds whether it holds.

    That has what the `watch` found of each part of the run.
    """

    name: str
    text: str
    finding: Callable[[Run, Sequence[Any]], Finding]
    watch: Watch | None = None


def found(holds: bool, text: str, **figures: float) -> Finding:
    """Return the finding on a statement that applies."""
    return Finding(StatementOutcome.HOLDS if holds else StatementOutcome.FAILS, text, figures)


def not_applicable(reason: str, **figures: float) -> Finding:
    """Return the finding on a statement that this run has nothing to say about."""
    return Finding(StatementOutcome.NOT_APPLICABLE, reason, figures)
