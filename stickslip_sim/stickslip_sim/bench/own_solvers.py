# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The solvers of stickslip as contestants: no Python between two events where they are compiled."""

import math
from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np

from ..axis.layout import (
    EVENT_DIRECTION,
    EVENT_FRACTION,
    EVENT_KIND,
    EVENT_POSITION,
    EVENT_SECOND,
    EVENT_SIZE,
    EVENT_VELOCITY,
    SAMPLE_SIZE,
    STATE_SIZE,
    WAVE_INPUTS,
    WAVE_SIZE,
)
from ..core.errors import SolverError
from ..core.jit import IS_COMPILED
from ..core.types import Sample
from ..core.version import __version__
from ..solvers import DONE, Solver, adaptive, exact, fixed_step
from .peers.peer import EXACT, Peer, Setting, time_steps, tolerances
from .problem import Numbers, Outcome, Problem

_POSITION = Sample._fields.index('position')


def own_solver(name: str, settings: tuple[Setting, ...], make: Callable[[Setting], Solver]) -> Peer:
    """Return a solver as a contestant; `make` returns it for a setting."""
    return Peer(name, settings, None, lambda: f'stickslip {__version__}', lambda problem, setting: _prepare(
        problem, make(setting)))


def own_solvers() -> list[Peer]:
    """Return all solvers of stickslip as contestants."""
    found = [exact_solver()]
    for method, steps in (('euler', time_steps(1e-3, 1e-4, 1e-5)), ('rk4', time_steps(1e-3, 1e-4, 1e-5))):
        found.append(own_solver(f'fixed_step {method}', steps, partial(_by_step, fixed_step.solver, method)))
    for method in ('DOP853', 'RK45'):
        found.append(own_solver(f'adaptive {method}', tolerances(1e-6, 1e-9, 1e-12),
                                partial(_by_tolerance, adaptive.solver, method)))
    return found


def _by_step(make: Callable[..., Solver], method: str, setting: Setting) -> Solver:
    return make(method, setting.value)


def _by_tolerance(make: Callable[..., Solver], method: str, setting: Setting) -> Solver:
    return make(method, setting.value, setting.value)


def exact_solver() -> Peer:
    """Return the exact engine as a contestant."""
    name = 'exact' if IS_COMPILED else 'exact, plain Python'
    return own_solver(name, (EXACT,), lambda setting: exact.SOLVER)


def state_for(problem: Problem) -> Numbers:
    """Return an empty state with space for the sinusoids of a problem."""
    return np.zeros(STATE_SIZE + WAVE_SIZE * (len(problem.sinusoids) // WAVE_INPUTS))


def _prepare(problem: Problem, solver: Solver) -> Callable[[], Outcome]:
    run = _driver(solver.advance, solver.set_inputs, solver.sample)
    begin, duration = problem.start.tolist(), problem.duration
    count = len(problem.event_rows())
    arrays: tuple[Any, ...] = (
        problem.parameters, problem.pieces, problem.sinusoids, np.zeros((count, EVENT_SIZE)), state_for(problem),
        np.zeros(SAMPLE_SIZE))
    p, pieces, sinusoids, events, state, sample = arrays if IS_COMPILED else tuple(a.tolist() for a in arrays)

    def simulate() -> Outcome:
        rows = solver.start(p, state, *begin, *pieces[0][1:], sinusoids, events, 0)
        rows, end = run(p, state, pieces, sinusoids, duration, events, rows, sample)
        if end != DONE:
            raise SolverError(f'{solver.name} gave up after {rows} events')
        return Outcome(events[:rows], float(sample[_POSITION]), _event_columns)

    return simulate


def _event_columns(rows: Any) -> Numbers:
    table = np.array(rows).reshape(-1, EVENT_SIZE)
    times = table[:, EVENT_SECOND] + table[:, EVENT_FRACTION]
    return np.column_stack([times, table[:, (EVENT_KIND, EVENT_DIRECTION, EVENT_POSITION, EVENT_VELOCITY)]])


@cache
def _driver(advance: Callable[..., Any], set_inputs: Callable[..., Any],
            sample_at: Callable[..., Any]) -> Callable[..., Any]:
    """Return a loop over the pieces of the inputs, compiled if the solver is."""

    def run(p: Any, s: Any, pieces: Any, sinusoids: Any, duration: Any, events: Any, rows: Any, sample: Any) -> Any:
        state = DONE
        for k in range(len(pieces)):
            piece = pieces[k]
            if k > 0:
                whole = math.floor(piece[0])
                rows = set_inputs(p, s, float(whole), piece[0] - whole, piece[1], piece[2], piece[3], piece[4],
                                  sinusoids,
                                  events, rows)
            end = pieces[k + 1][0] if k + 1 < len(pieces) else duration
            whole = math.floor(end)
            rows, state = advance(p, s, float(whole), end - whole, events, rows)
            if state != DONE:
                return rows, state
        whole = math.floor(duration)
        sample_at(p, s, float(whole), duration - whole, sample)
        return rows, state

    if not hasattr(advance, 'py_func'):
        return run
    import numba
    compiled: Callable[..., Any] = numba.njit(error_model='numpy')(run)
    return compiled
