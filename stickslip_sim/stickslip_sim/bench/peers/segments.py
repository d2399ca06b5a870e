# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The automaton around an integrator that is called from Python, segment by segment."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.errors import SolverError
from ..problem import Outcome, Problem
from .automaton import SIZE, TIME, U, X, motion_of
from .resets import end_of_piece, enter_piece, move, note, reset

ToEvent = Callable[[Any, float, float, float], tuple[float, float, float, int]]


def run_segments(problem: Problem, to_event: ToEvent) -> Outcome:
    """Simulate; `to_event(q, limit, x, u)` integrates from a reset to the first guard that falls, or for `limit` s.

    It returns time, x and ẋ there, and the guard or −1.
    """
    p, w, pieces = problem.parameters, problem.sinusoids, problem.pieces
    m, events = np.zeros(SIZE), problem.event_rows()
    rows = 0
    for k in range(len(pieces)):
        end = end_of_piece(pieces, k, problem.duration)
        kind, direction = enter_piece(p, m, w, problem.start, pieces, k)
        rows = note(events, rows, m, kind, direction)
        while m[TIME] < end and rows >= 0:
            t, x, u, fallen = to_event(np.array(motion_of(p, m)), end - m[TIME], m[X], m[U])
            move(p, m, w, t, x, u)
            if fallen < 0:
                m[TIME] = end
            else:
                kind, direction = reset(p, m, w, fallen)
                rows = note(events, rows, m, kind, direction)
        if rows < 0:
            raise SolverError('more events than the table holds')
    return Outcome(events[:rows].copy(), float(m[X]))
