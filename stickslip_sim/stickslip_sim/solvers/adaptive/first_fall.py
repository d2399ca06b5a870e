# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where a guard first falls through 0 within a step of the integration, also where it comes back within that step.

The guard is sampled at the points where Chebyshev's polynomial of degree 8 has its extremes; steps are short against
all that it is made of.  Where the coefficients of the polynomial through the samples do not show that it stays above 0,
the guard is looked at where that polynomial has its extremes, too.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

_DEGREE = 8
_POINTS = -np.cos(math.pi * np.arange(_DEGREE + 1) / _DEGREE)
_TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(_POINTS, _DEGREE))
_NARROW = 4.0 * 2.220446049250313e-16   # s and relative, as in solve_ivp
SAMPLED_AT = 0.5 * (1.0 + _POINTS)      # of the step


def first_fall(guard: Callable[[float], float], begin: float, end: float, samples: list[float], error: float
               ) -> float | None:
    """Return when a guard falls below 0 by more than its error; None where it does not.

    `samples` are its values at `SAMPLED_AT` from `begin` to `end`, s.
    """
    from scipy.optimize import brentq  # a second that a user of the other solvers need not wait

    coefficients = _TO_COEFFICIENTS @ samples
    if not coefficients[0] - np.abs(coefficients[1:]).sum() < -error:
        return None
    seen = [(begin + (end - begin) * float(share), value) for share, value in zip(SAMPLED_AT, samples)]
    slope = np.trim_zeros(chebyshev.chebder(coefficients), 'b')
    turns = chebyshev.chebroots(slope) if len(slope) else slope
    for turn in turns[np.isreal(turns)].real:
        if -1.0 < turn < 1.0:
            time = begin + (end - begin) * 0.5 * (1.0 + float(turn))
            seen.append((time, guard(time)))
    above = begin
    for time, value in sorted(seen):
        if value < -error:
            return float(brentq(guard, above, time, xtol=_NARROW, rtol=_NARROW)) if guard(above) > 0.0 else above
        if value >= 0.0:
            above = time
    return None
