# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Semi-implicit Euler on a fixed grid, all of it compiled: what most hand-written simulators are."""

from collections.abc import Callable

import numpy as np

from .always_compiled import NUMBA_MISSING, always_compiled
from ...core.errors import SolverError
from ..problem import Outcome, Problem
from .automaton import Q_MASS, Q_MODE, SIZE, STICK, TIME, U, X, applied, is_compliant, motion_of
from .grid import act, begin, breaks, look, next_piece
from .peer import Peer, Setting, time_steps


@always_compiled
def _wait(q, w, h, k, last, since, x):
    """Step in a rigid stick, where nothing moves, until it breaks away or `last`; return the step and 0 or −1."""
    while k < last:
        k += 1
        t = k * h - since
        if breaks(q, w, t, x, 0.0, applied(q, w, t, x, 0.0)):
            return k, 0
    return k, -1


@always_compiled
def _march(q, w, h, k, last, since, x, u):
    """Step from k h until a guard has fallen, at most to `last` h; return the step, x, ẋ and the guard or −1.

    The acceleration at the end of a step is that of the next one, so that the forces are summed once a step.
    """
    per_mass = 1.0 / q[Q_MASS]
    rate, fallen = look(q, w, per_mass, k * h - since, x, u)
    fallen = -1
    while k < last and fallen < 0:
        k += 1
        u += h * rate
        x += h * u
        rate, fallen = look(q, w, per_mass, k * h - since, x, u)
    return k, x, u, fallen


@always_compiled
def run(p, at_start, pieces, w, steps, h, m, events):
    """Simulate; return the number of events, −1 when the table is full."""
    rows, piece, k = begin(p, m, w, at_start, pieces, events), 0, 0
    while k < steps and rows >= 0:
        due = next_piece(pieces, piece)
        last = steps
        if due < steps * h:
            last = int(due / h)
            while last * h < due:
                last += 1
        q, x, u = motion_of(p, m), m[X], m[U]
        if q[Q_MODE] == STICK and not is_compliant(q):
            k, fallen = _wait(q, w, h, k, last, m[TIME], x)
        else:
            k, x, u, fallen = _march(q, w, h, k, last, m[TIME], x, u)
        rows, piece = act(p, m, w, pieces, piece, fallen, k * h, x, u, events, rows)
    return rows


def _prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
    m, events, steps = np.zeros(SIZE), problem.event_rows(), round(problem.duration / setting.value)

    def simulate() -> Outcome:
        rows = run(problem.parameters, problem.start, problem.pieces, problem.sinusoids, steps, setting.value, m,
                   events)
        if rows < 0:
            raise SolverError('more events than the table holds')
        return Outcome(events[:rows].copy(), float(m[X]))

    return simulate


def _version() -> str:
    import numba
    return f'this repository, numba {numba.__version__}'


PEER = Peer('semi-implicit Euler, numba', time_steps(1e-3, 1e-4, 1e-5), NUMBA_MISSING, _version, _prepare)
