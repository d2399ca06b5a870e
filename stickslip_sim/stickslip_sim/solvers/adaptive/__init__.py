# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Adaptive steps: scipy's `solve_ivp` with its events, mode by mode; for smooth laws too.

| method | order | for                                                                 |
|--------|-------|---------------------------------------------------------------------|
| RK45   | 5     | loose tolerances                                                    |
| DOP853 | 8     | tight tolerances: the one to begin with                             |
| Radau  | 5     | stiff contacts                                                      |
| BDF    | 1-5   | stiff contacts, loose tolerances                                    |
| LSODA  | 1-12  | motions that are stiff at times                                     |

An event is where a guard falls through zero within a step, found to rounding on the interpolant of that step
(`first_fall`), and goes on below it by more than the tolerances make of its value: what stays within them is no event.
Steps are at most an eighth of the period of the fastest sinusoid.  A mode is integrated from its segment start on,
as far as asked for, and looked up on the interpolants: events and states are the same to the last bit for all samples
and all ways to split a run (`engine`).

When to use it: to check the exact engine by other means, and for a smooth law of kinetic friction itself in place of
its table (`kinetic`).  The cost is milliseconds for every event and every call: thousands of times that of the exact
engine.

Sources: P. Virtanen et al., SciPy 1.0, Nature Methods 17 (2020), doi:10.1038/s41592-019-0686-2; E. Hairer, S. Nørsett,
G. Wanner, Solving Ordinary Differential Equations I, II.5 and II.6.
"""

from typing import Any

from ...core.errors import InputError
from .. import Solver
from .engine import Engine

METHODS = ('RK45', 'DOP853', 'Radau', 'BDF', 'LSODA')
MIN_RTOL = 2.3e-14   # scipy takes none below 100 roundings
_SAME = object()     # as forwards


def solver(method: str = 'DOP853', rtol: float = 1e-8, atol: float = 1e-10, kinetic: Any = None,
           backward: Any = _SAME) -> Solver:
    """Return the solver with the tolerances of a step: `rtol` relative, `atol` in m and m/s.

    `kinetic` is a smooth law with coefficient(speed) that replaces the table of mu_k, and `backward` that of motion
    along −x, left out: the same.  Raises InputError on an unknown method and on tolerances out of range.
    """
    if method not in METHODS:
        raise InputError('solver.method', method, 'one of ' + ', '.join(METHODS) + ' with solver.name: adaptive',
                         'start with DOP853')
    if not MIN_RTOL <= rtol <= 1e-2:
        raise InputError('solver.rtol', rtol, f'>= {MIN_RTOL:g} and <= 0.01', '1e-8 is the default')
    if not 1e-300 <= atol <= 1.0:
        raise InputError('solver.atol', atol, '>= 1e-300 and <= 1 m, m/s', '1e-10 is the default')
    return Engine(method, rtol, atol, (kinetic, kinetic if backward is _SAME else backward))


__all__ = ['METHODS', 'MIN_RTOL', 'solver']
