# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The statements of the paper: the one list that reports and tests go by."""

from ..runs import Run
from ..runs.kept import kept
from .contact_effect import CONTACT_EFFECT
from .continuity import CONTINUITY
from .limit_cycle import LIMIT_CYCLE
from .long_rest import LONG_REST
from .look import RunLook, watched
from .oscillation import OSCILLATION
from .ring_down import RING_DOWN, latest_ringing
from .slip_peaks import SLIP_PEAKS, slip_peaks
from .start_balance import START_BALANCE
from .statement import Finding, Statement, not_applicable
from .two_values import TWO_VALUES

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
