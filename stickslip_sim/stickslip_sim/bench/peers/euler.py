"""Semi-implicit Euler on a fixed grid, all of it compiled: what most hand-written simulators are."""

from collections.abc import Callable

import numpy as np

from ...compiled import always_compiled
from ...errors import SolverError
from ..problem import Outcome, Problem
from .automaton import SIZE, U, X, motion_of
from .grid import acceleration, act, begin, fallen_guard, holds, next_piece
from .peer import Peer, Setting, time_steps


@always_compiled
def run(p, at_start, pieces, w, steps, h, m, events):
    """Simulate; return the number of events, −1 when the table is full."""
    rows, piece = begin(p, m, w, at_start, pieces, events), 0
    x, u, since, q = m[X], m[U], 0.0, motion_of(p, m)
    due = next_piece(pieces, piece)
    for k in range(steps):
        time = (k + 1) * h
        if not holds(q):
            u += h * acceleration(q, w, k * h - since, x, u)
            x += h * u
        fallen = fallen_guard(q, w, time - since, x, u)
        if fallen >= 0 or due <= time:
            rows, piece = act(p, m, w, pieces, piece, fallen, time, x, u, events, rows)
            x, u, since, q = m[X], m[U], time, motion_of(p, m)
            due = next_piece(pieces, piece)
            if rows < 0:
                break
    m[X] = x
    return rows


def _prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
    m, events, steps = np.zeros(SIZE), problem.event_rows(), round(problem.duration / setting.value)

    def simulate() -> Outcome:
        rows = run(problem.parameters, problem.start, problem.pieces, problem.waves, steps, setting.value, m, events)
        if rows < 0:
            raise SolverError('more events than the table holds')
        return Outcome(events[:rows].copy(), float(m[X]))

    return simulate


def _version() -> str:
    import numba
    return f'this repository, numba {numba.__version__}'


PEER = Peer('semi-implicit Euler, numba', time_steps(1e-3, 1e-4, 1e-5), None, _version, _prepare)
