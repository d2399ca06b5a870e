# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The integration of one mode from its segment start on, as far as it was asked for.

Its steps do not depend on when that was: between two of them a motion is looked up on their interpolant.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ...axis.state_record import State
from .mode_problem import ModeGuard, ModeMotion

# Where a guard first falls through 0 within a step of the integration, also where it comes back within that step.
#
# The guard is sampled at the points where Chebyshev's polynomial of degree 8 has its extremes; steps are short against
# all that it is made of.  Where the coefficients of the polynomial through the samples do not show that it stays above
# 0, the guard is looked at where that polynomial has its extremes, too.

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


_NEVER = 1e10   # s, after all times; LSODA takes no infinity,
_FIRST = 1e-6   # s, and would begin with a share of it


class Reached(NamedTuple):
    """Where an integration came to."""

    time: float          # s, after the segment start
    travel: float        # m
    velocity: float      # m/s
    kind: float | None   # of the event there; None: none


class ModeIntegration:
    """The motion of the mode that a state is in, up to the event that ends it."""

    def __init__(self, motion: ModeMotion, s: State) -> None:
        from scipy import integrate  # a second that a user of the other solvers need not wait

        self.motion = motion
        self._state, self._begin = s, _place(s)
        self._guards = motion.guards()
        now = (0.0, s.velocity)
        self._event = next((Reached(0.0, *now, guard.kind) for guard in self._guards if guard.value(0.0, now) < 0.0),
                           None)
        self._integrator: Any = None
        tolerance = motion.tolerance
        first = {'first_step': _FIRST} if tolerance.method == 'LSODA' else {}
        self._make = partial(getattr(integrate, tolerance.method), motion.rates, 0.0, now, _NEVER,
                             rtol=tolerance.rtol, atol=tolerance.atol, **first)
        self._dense: Any = None     # of the latest step

    def is_from(self, s: State) -> bool:
        """Return whether it is that of a state, which has not changed since."""
        return s is self._state and _place(s) == self._begin

    def reach(self, t: float) -> Reached | None:
        """Return the event up to t, or t; None where the integration fails.  No t may come before an earlier one."""
        try:
            while self._event is None and (self._integrator is None or self._integrator.t < t):
                if not self._step():
                    return None
        except (ArithmeticError, ValueError, np.linalg.LinAlgError):   # on numbers that are not finite
            return None
        if self._event is not None and self._event.time <= t:
            return self._event
        travel, velocity = map(float, self._dense(t))
        return Reached(t, travel, velocity, None)

    def _step(self) -> bool:
        """Make a step; return whether its end is a state."""
        if self._integrator is None:
            self._integrator = self._make(max_step=self.motion.longest_step(0.0))
        solver = self._integrator
        solver.max_step = self.motion.longest_step(solver.t)
        solver.step()
        if solver.status == 'failed' or not np.isfinite(solver.y).all():
            return False
        self._dense = solver.dense_output()
        self._event = _event_within(self._dense, self._guards)
        return True


def _place(s: State) -> tuple[float, ...]:
    return s.second, s.fraction, s.mode, s.position, s.velocity


def _value_on(guard: ModeGuard, dense: Any, time: float) -> float:
    return guard.value(time, dense(time))


def _event_within(dense: Any, guards: list[ModeGuard]) -> Reached | None:
    """Return the first event within a step of the integration, if there is one."""
    begin, end = float(dense.t_old), float(dense.t)
    times = [begin + (end - begin) * float(share) for share in SAMPLED_AT]
    states = [(float(y), float(u)) for y, u in dense(np.array(times)).T]
    first = None
    for guard in guards:
        samples = [guard.value(time, state) for time, state in zip(times, states)]
        error = max(guard.error(begin, states[0]), guard.error(end, states[-1]))
        root = first_fall(partial(_value_on, guard, dense), begin, end, samples, error)
        if root is not None and (first is None or root < first.time):
            y, u = map(float, dense(root))
            first = Reached(root, y, u, guard.kind)
    return first
