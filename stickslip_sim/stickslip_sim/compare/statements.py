# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The statements of the paper: the one list that reports and tests go by."""

from ..runs import Run
from ..runs.run import kept
from .contact_statements import CONTINUITY, OSCILLATION
from .look import RunLook, watched
from .other_starts import CONTACT_EFFECT, LIMIT_CYCLE
from .ring_down import RING_DOWN, SLIP_PEAKS, latest_ringing, slip_peaks
from .slip_statements import LONG_REST, START_BALANCE, TWO_VALUES
from .statement import Finding, Statement, not_applicable

STATEMENTS: tuple[Statement, ...] = (START_BALANCE, CONTINUITY, TWO_VALUES, OSCILLATION, LIMIT_CYCLE, CONTACT_EFFECT,
                                     LONG_REST)


def findings_on(run: Run) -> list[tuple[Statement, Finding]]:
    """Return what comes of every statement on a run."""
    if run.is_changed:
        changed = not_applicable('parameters were changed while it ran: it is no run of one axis')
        return [(statement, changed) for statement in STATEMENTS]
    found = observed(run).found
    return [(statement, statement.finding(run, found.get(statement.name, ()))) for statement in STATEMENTS]


@kept
def observed(run: Run) -> RunLook:
    """Look once through a run for all that is said of it."""
    return watched(run, {**{statement.name: statement.watch for statement in STATEMENTS if statement.watch},
                         RING_DOWN: latest_ringing, SLIP_PEAKS: slip_peaks})
