# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Fixed steps: the loop that most engineers would write, with its limits stated.

| method | a step                                           | order in a mode | across transitions | evaluations |
|--------|--------------------------------------------------|-----------------|--------------------|-------------|
| euler  | semi-implicit Euler: the new velocity moves      | 1               | 1                  | 1           |
| rk4    | classical Runge-Kutta                            | 4               | 1                  | 4           |

Transitions are noted at the end of the step in which they are seen, so that the order is 1 across them with any method;
what begins and ends within a step is missed.  Breakpoints of the friction tables are not looked for.  A slip ends where
the velocity has changed its sign, or, after Karnopp, where it falls within the band |ẋ| < ½ step N mu_s(0)/m and
N mu_s(0) could hold the slider at rest.  The band is half of what friction takes from the velocity in a step; a slow
feed may be stopped in it that would go on.

When to use it: to compare with other programs, or as a rough and quick loop.  The cost is that of its steps, not
of what happens; the exact engine pays for events, and is cheaper nearly always.

Sources: D. Karnopp, Computer simulation of stick-slip friction in mechanical dynamic systems, J. Dyn. Sys. Meas.
Control 107 (1985), doi:10.1115/1.3140698; E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, I.1.
"""

import math
from fractions import Fraction
from typing import Any

from ...axis.records import RECORDS
from ...core.errors import InputError
from ...core.hot_path import entry
from .. import Solver, SolverOfFunctions
from . import loop
from .steps import EULER, RK4, check_step

start, advance = entry(loop.start), entry(loop.advance)
set_inputs, set_parameters = entry(loop.set_inputs), entry(loop.set_parameters)
set_load, sample = entry(loop.set_load), entry(loop.sample)

METHODS = {'euler': EULER, 'rk4': RK4}
MIN_STEP, MAX_STEP = 1e-9, 1.0   # s

_LARGEST = 2 ** 52   # ticks in a second, so that sums of two are exact


def solver(method: str = 'euler', step: float = 1e-3) -> Solver:
    """Return the solver with a `step` in s; raises InputError on an unknown method or a step out of range."""
    if method not in METHODS:
        raise InputError('solver.method', method, 'one of ' + ', '.join(METHODS) + ' with solver.name: fixed_step',
                         'euler is the usual one')
    if not (math.isfinite(step) and MIN_STEP <= step <= MAX_STEP):
        raise InputError('solver.step', step, f'>= {MIN_STEP:g} and <= {MAX_STEP:g} s', 'give the length of a step')
    ticks = Fraction(repr(float(step))).limit_denominator(_LARGEST)
    settings = (METHODS[method], float(ticks.numerator), float(ticks.denominator))

    def begin(*state_and_inputs: Any) -> int:
        return start(*(*state_and_inputs, *settings))

    return SolverOfFunctions('fixed_step', begin, advance, set_inputs, set_parameters, set_load, sample,
                             records=RECORDS,
                             advice=f'try a step shorter than solver.step = {step:g} s, or check the scene')


__all__ = ['MAX_STEP', 'METHODS', 'MIN_STEP', 'check_step', 'solver']
