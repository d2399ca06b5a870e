# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""scipy's solve_ivp with events: what most people reach for.  Right-hand side and guards are compiled."""

import importlib.metadata
from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.errors import SolverError
from ..problem import Outcome, Peer, Problem, Setting, tolerances
from .automaton import GUARDS, SIZE, TIME, U, X, always_compiled, guards, missing, motion_of, rates
from .resets import end_of_piece, enter_piece, move, note, reset

_FINEST = 100 * np.finfo(float).eps   # scipy's own floor of the relative tolerance


@always_compiled
def _rates_into(q, w, t, y, out):
    out[0], out[1] = rates(q, w, t, y[0], y[1])


@always_compiled
def _guard(q, w, t, y, which):
    return guards(q, w, t, y[0], y[1])[which]


class _Guard:
    """A guard as solve_ivp wants it: it ends the integration where it falls through zero."""

    terminal = True
    direction = -1.0

    def __init__(self, q: Any, w: Any, which: float) -> None:
        self._q, self._w, self._which = q, w, which

    def __call__(self, t: float, y: Any) -> Any:
        return _guard(self._q, self._w, t, y, self._which)


def _run(problem: Problem, method: str, tolerance: float) -> Outcome:
    """Simulate, segment by segment."""
    from scipy.integrate import solve_ivp

    p, w, pieces = problem.parameters, problem.sinusoids, problem.pieces
    options: dict[str, Any] = {'method': method, 'rtol': max(tolerance, _FINEST), 'atol': tolerance,
                               'max_step': problem.longest_step}

    def to_event(q: Any, limit: float, x: float, u: float) -> tuple[float, float, float, int]:
        """Integrate from a reset to the first guard that falls, or for `limit` s; return t, x, ẋ, the guard or −1."""
        def right_side(t: float, y: Any) -> Any:
            out = np.empty(2)
            _rates_into(q, w, t, y, out)
            return out

        try:
            done = solve_ivp(right_side, (0.0, limit), (x, u),
                             events=[_Guard(q, w, i) for i in range(GUARDS)], **options)
        except ValueError as error:    # its interpolant begins off the state, beyond a guard that is about to fall
            raise SolverError(f'solve_ivp: {error}') from error
        if not done.success:
            raise SolverError(f'solve_ivp: {done.message}')
        fallen = next((i for i, times in enumerate(done.t_events) if len(times)), -1)
        return done.t[-1], done.y[0, -1], done.y[1, -1], fallen

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


def _prepare(method: str) -> Callable[[Problem, Setting], Callable[[], Outcome]]:

    def prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
        return lambda: _run(problem, method, setting.value)

    return prepare


def _version() -> str:
    return f'scipy {importlib.metadata.version("scipy")}'


SCIPY_PEERS = tuple(
    Peer(f'scipy {method}', settings, missing('scipy', 'scipy'), _version, _prepare(method)) for method, settings in (
        ('DOP853', tolerances(1e-4, 1e-6, 1e-8, 1e-10, 1e-12)), ('LSODA', tolerances(1e-6, 1e-9, 1e-12)),
        ('Radau', tolerances(1e-6, 1e-9))))
