# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""SUNDIALS CVODE as a Python user has it: scikit-sundae, its callbacks, right-hand side and root functions compiled."""

import importlib.metadata
import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np

from .always_compiled import NUMBA_MISSING, always_compiled
from ...core.errors import SolverError
from ..problem import Outcome, Problem
from .automaton import GUARDS, guards, rates
from .peer import Peer, Setting, tolerances
from .segments import run_segments

_MISSING = NUMBA_MISSING if importlib.util.find_spec('sksundae') else 'pip install scikit-sundae'
_MAX_STEPS = 10_000   # memory for as many is taken anew at each event


@always_compiled
def _rates_into(q, w, t, y, out):
    out[0], out[1] = rates(q, w, t, y[0], y[1])


@always_compiled
def _guards_into(q, w, t, y, out):
    out[0], out[1], out[2] = guards(q, w, t, y[0], y[1])


class _Solver:

    def __init__(self, problem: Problem, tolerance: float) -> None:
        from sksundae.cvode import CVODE

        self._problem, w = problem, problem.sinusoids
        self._q: Any = None

        def right_side(t: float, y: Any, out: Any) -> None:
            _rates_into(self._q, w, t, y, out)

        def events(t: float, y: Any, out: Any) -> None:
            _guards_into(self._q, w, t, y, out)

        events.terminal, events.direction = [True] * GUARDS, [-1] * GUARDS  # type: ignore[attr-defined]
        longest = problem.longest_step if problem.longest_step < np.inf else 0.0
        self._cvode = CVODE(right_side, method='Adams', rtol=tolerance, atol=tolerance, eventsfn=events,
                            num_events=GUARDS, max_num_steps=_MAX_STEPS, max_step=longest)

    def simulate(self) -> Outcome:
        """Run once."""
        return run_segments(self._problem, self._to_event)

    def _to_event(self, q: Any, limit: float, x: float, u: float) -> tuple[float, float, float, int]:
        self._q = q
        done = self._cvode.solve(np.array([0.0, limit]), np.array([x, u]))
        if not done.success:
            raise SolverError(f'CVODE: {done.message}')
        time = float(done.t[-1])
        # at the end of the interval it reports events that are none
        fallen = int(np.argmax(done.i_events[-1] != 0)) if time < limit else -1
        return time, float(done.y[-1, 0]), float(done.y[-1, 1]), fallen


def _prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
    return _Solver(problem, setting.value).simulate


def _version() -> str:
    return f'scikit-sundae {importlib.metadata.version("scikit-sundae")}'


PEER = Peer('scikit-sundae CVODE (Adams)', tolerances(1e-6, 1e-8, 1e-12), _MISSING, _version, _prepare)
