# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""heyoka: Taylor series of high order, events by the isolation of the roots of their polynomials.

Its best form on this problem: one integrator for all modes, whose coefficients are run-time parameters; what happens
at an event is done in its callback, which goes on; rigid stick and coasting are solved in closed form, so that the
integrator's own time passes in motion alone.  Reference: Biscani and Izzo, MNRAS 504 (2021) 2614.
"""

import importlib.metadata
import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.errors import SolverError
from ...friction import StaticLawKind
from ..problem import Outcome, Problem
from .always_compiled import NUMBA_MISSING
from .automaton import SIZE, X
from .heyoka_resets import (
    ACCELERATION_PLACE,
    ALL,
    BEYOND,
    ENDED,
    FADING,
    NO_ROOM,
    LEFT,
    ORIGIN,
    PULL,
    RATE,
    SPEED_GUARDS,
    begin_outputs,
    follow,
)
from .peer import Peer, Setting, tolerances

_LAWS = (StaticLawKind.CONSTANT, StaticLawKind.EXPONENTIAL)
_FOREVER = 1e9   # s, of the integrator's own time


def _missing() -> str | None:
    return 'pip install heyoka' if importlib.util.find_spec('heyoka') is None else NUMBA_MISSING


def _integrator(tolerance: float, fallen: Callable[[int, Any], bool]) -> Any:
    """Return the integrator; `fallen` is called with the guard that fell and says whether to go on."""
    import heyoka as hy

    def par(first: int, count: int) -> list[Any]:
        return [hy.par[first + k] for k in range(count)]

    y, u = hy.make_vars('y', 'u')   # travel since the reset, velocity
    t = hy.time - hy.par[ORIGIN]
    constant, of_y, of_u, of_t, of_t2 = par(ACCELERATION_PLACE, 5)
    motion = [(y, u), (u, constant + of_y * y + of_u * u + (of_t + of_t2 * t) * t)]
    fading = hy.par[FADING] * hy.exp(hy.par[RATE] * t)
    constant, of_y, of_u, of_t, of_t2 = par(PULL, 5)
    pull = constant + of_y * y + of_u * u + (of_t + of_t2 * t) * t + fading
    constant, of_y, of_u = par(BEYOND, 3)
    beyond = constant + of_y * y + of_u * u + fading
    constant, of_u = par(SPEED_GUARDS, 2)
    guards = (pull, beyond, constant + of_u * u, hy.par[LEFT] - t)

    def event(which: int) -> Any:
        return hy.t_event(guards[which], callback=lambda ta, _: fallen(which, ta),
                          direction=hy.event_direction.negative)

    return hy.taylor_adaptive(motion, [0.0, 0.0], pars=[0.0] * ALL, tol=tolerance, fast_math=True,
                              t_events=[event(which) for which in range(len(guards))])


def _prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
    if len(problem.sinusoids) or np.any(problem.pieces[:, 2]) or problem.axis.friction.static.kind not in _LAWS:
        raise SolverError('written here for inputs that are constant between jumps, and for an exponential mu_s')
    p, w, start, pieces, end = (problem.parameters, problem.sinusoids, problem.start, problem.pieces,
                                problem.duration)
    m, events, pars = np.zeros(SIZE), problem.event_rows(), np.zeros(ALL)
    place = np.zeros(2)
    at = [0, 0]   # rows in use, and the piece

    def fallen(which: int, ta: Any) -> bool:
        state = ta.state
        at[:] = follow(p, m, w, pieces, end, start, which, ta.time, state[0], state[1], at[1], events, at[0], pars,
                       place)
        state[:] = place
        ta.pars[:] = pars
        return at[1] >= 0

    integrator = _integrator(setting.value, fallen)

    def simulate() -> Outcome:
        integrator.time = 0.0
        at[:] = begin_outputs(p, m, w, pieces, end, start, events, pars, place)
        integrator.state[:] = place
        integrator.pars[:] = pars
        integrator.reset_cooldowns()
        if at[1] >= 0:
            integrator.propagate_until(_FOREVER)
        if at[1] != ENDED:
            raise SolverError('more events than the table holds' if at[1] == NO_ROOM else 'it stopped before the end')
        return Outcome(events[:at[0]].copy(), float(m[X]))

    return simulate


def _version() -> str:
    return f'heyoka {importlib.metadata.version("heyoka")}'


PEER = Peer('heyoka', tolerances(1e-16), _missing(), _version, _prepare)
