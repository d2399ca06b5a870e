# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The contestants of the race: the peers, and the solvers of stickslip, without Python between two events."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import SolverError
from ..core.hot_path import UNIT
from ..core.types import Sample
from ..core.version import __version__
from ..solvers import DONE, Solver, adaptive, exact, fixed_step
from ..solvers.walk import walk_of
from .problem import NO_SETTING, Outcome, Peer, Problem, Setting, time_steps, tolerances

_POSITION = Sample._fields.index('position')


def own_solver(name: str, settings: tuple[Setting, ...], make: Callable[[Setting], Solver]) -> Peer:
    """Return a solver as a contestant; `make` returns it for a setting."""
    return Peer(name, settings, None, lambda: f'stickslip {__version__}', lambda problem, setting: _prepare(
        problem, make(setting)))


def contestants(*, quick: bool = False) -> list[Peer]:
    """Return all; quickly: the coarsest and the finest setting of each, without those that compile anew each time."""
    from .peers import PEERS, sundials

    stepped = [own_solver(f'fixed_step {method}', time_steps(1e-3, 1e-4, 1e-5), partial(_by_step, method))
               for method in ('euler', 'rk4')]
    adapting = [own_solver(f'adaptive {method}', tolerances(1e-6, 1e-9, 1e-12), partial(_by_tolerance, method))
                for method in ('DOP853', 'RK45')]
    everyone = [exact_solver(), *stepped, *adapting, *PEERS]
    if not quick:
        return everyone
    return [peer._replace(settings=tuple(dict.fromkeys((peer.settings[0], peer.settings[-1]))))
            for peer in everyone if peer.name != sundials.PEER.name]


def _by_step(method: str, setting: Setting) -> Solver:
    return fixed_step.solver(method, setting.value)


def _by_tolerance(method: str, setting: Setting) -> Solver:
    return adaptive.solver(method, setting.value, setting.value)


def exact_solver() -> Peer:
    """Return the exact engine as a contestant."""
    name = 'exact' if UNIT is not None else 'exact, plain Python'
    return own_solver(name, (NO_SETTING,), lambda setting: exact.SOLVER)


def state_for(problem: Problem, records: Any) -> Any:
    """Return an empty state with room for the sinusoids of a problem."""
    return records.State(len(problem.sinusoids) // 4)


def sinusoids_for(problem: Problem, records: Any) -> Any:
    """Return the sinusoids of a problem, whose normal force does not vary."""
    return records.Sinusoids(np.pad(problem.sinusoids.reshape(-1, 4), ((0, 0), (0, 1))).ravel().tolist())


def _prepare(problem: Problem, solver: Solver) -> Callable[[], Outcome]:
    of = solver.records
    position, velocity, rest = problem.start.tolist()
    _, v, v_rate, f, f_rate = problem.pieces[0].tolist()
    p, s = of.Parameters(problem.parameters.tolist()), state_for(problem, of)
    sinusoids = sinusoids_for(problem, of)
    events, sample = of.Events(len(problem.event_rows())), of.SampleRow()
    walk = walk_of(solver)
    drive, force = walk.pieces_of(problem.drive), walk.pieces_of(problem.force)
    until = min(problem.drive.piece_at(0.0).end, problem.force.piece_at(0.0).end)
    before = math.nextafter(problem.duration, 0.0)   # a piece that begins at the end is none of the problem
    second = float(math.floor(problem.duration))
    fraction = problem.duration - second

    def simulate() -> Outcome:
        rows = solver.start(p, s, position, velocity, rest, 0.0, 0.0, v, v_rate, f, f_rate, sinusoids, events, 0)
        _, rows, end = walk.run(p, s, drive, force, until, before, sinusoids, events, rows)
        if end == DONE:
            rows, end = solver.advance(p, s, second, fraction, events, rows)
        if end != DONE:
            raise SolverError(f'{solver.name} gave up after {rows} events')
        solver.sample(p, s, second, fraction, sample)
        return Outcome((events, rows), float(sample.tolist()[_POSITION]), _event_columns)

    return simulate


def _event_columns(table: tuple[Any, int]) -> Numbers:
    events, count = table
    rows = (events.row(i) for i in range(count))
    return np.array([(e[0] + e[1], e[2], e[4], e[5], e[6]) for e in rows]).reshape(-1, 5)
