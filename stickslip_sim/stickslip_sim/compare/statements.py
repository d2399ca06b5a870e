# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The statements of the paper: the one list that reports and tests go by."""

from ..runs import Run
from .contact_effect import CONTACT_EFFECT
from .continuity import CONTINUITY
from .limit_cycle import LIMIT_CYCLE
from .long_rest import LONG_REST
from .oscillation import OSCILLATION
from .start_balance import START_BALANCE
from .statement import Finding, Statement, not_applicable
from .two_values import TWO_VALUES

STATEMENTS: tuple[Statement, ...] = (START_BALANCE, CONTINUITY, TWO_VALUES, OSCILLATION, LIMIT_CYCLE, CONTACT_EFFECT,
                                     LONG_REST)


def judged(run: Run) -> list[tuple[Statement, Finding]]:
    """Return what comes of every statement on a run."""
    if run.is_changed:
        changed = not_applicable('parameters were changed while it ran: it is no run of one axis')
        return [(statement, changed) for statement in STATEMENTS]
    return [(statement, statement.judge(run)) for statement in STATEMENTS]
