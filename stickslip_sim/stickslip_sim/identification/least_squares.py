# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Least squares on what the exact engine makes, within ranges: the way of Levenberg and Marquardt, with differences.

A fit has 20,000 residuals and 8 parameters, and a simulation of them takes 1 ms; scipy's `least_squares` factorises the
residuals by singular values at each step, which takes twenty times as long as the simulations.  Here each step solves
the normal equations, scaled to a unit diagonal: their rounding, 1e-16 times the square of the condition, is far below
the step that is accepted or not by the sum of squares itself.  The valley of the sum of squares is narrow and curved
where parameters do nearly the same; a step follows it by its second derivative (geodesic acceleration: Transtrum and
Sethna 2012).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Residuals = Callable[[Numbers], Numbers]
Step = float | Numbers

STEP = 1e-6            # of a logarithm, or of a range: rounding is 1e-10 of it, the third derivative 1e-12
_DAMPING = 1e-3        # of the first step, relative to the diagonal
_LEAST_DAMPING, _MOST_DAMPING = 1e-12, 1e12
_PROBE = 0.1           # of a step: there its second derivative is taken
_MOST_TURN = 0.75      # of the length of a step


class Solution(NamedTuple):
    """Where a fit ended: `point` (k,), the sum of squares `cost`, JᵀJ (k, k) there, and whether it came to an end."""

    point: Numbers
    cost: float
    information: Numbers
    is_settled: bool


def slopes_of(residuals: Residuals, point: Numbers, low: Numbers, high: Numbers, step: Step = STEP) -> Numbers:
    """Return the derivatives (n, k) of residuals by central differences over a step, or one for each parameter (k,).

    They are one-sided at the end of a range, and where there is no motion on one side; 0 where there is on none.
    """
    here: Numbers | None = None
    columns = []
    steps = np.broadcast_to(step, point.shape)
    for k in range(len(point)):
        up, down = point.copy(), point.copy()
        up[k], down[k] = min(point[k] + steps[k], high[k]), max(point[k] - steps[k], low[k])
        above, below = residuals(up), residuals(down)
        if np.isnan(above[0]) or np.isnan(below[0]):
            here = residuals(point) if here is None else here
            above, up = (here, point) if np.isnan(above[0]) else (above, up)
            below, down = (here, point) if np.isnan(below[0]) else (below, down)
        columns.append((above - below) / max(up[k] - down[k], 1e-300))
    return np.stack(columns, axis=1)


def minimise(residuals: Residuals, point: Numbers, low: Numbers, high: Numbers, *, most: int, tolerance: float,
             share: float = 1e-9, robust: float = np.inf, step: Step = STEP, steepest: float = np.inf) -> Solution:
    """Return where the sum of squares is least, from a point on, after at most so many steps.

    It is settled where the next step would gain less than `tolerance`, or that `share` of the sum.  Residuals are all
    NaN where the parameters contradict each other; those beyond `robust` count by their size, not their square.
    A derivative beyond `steepest` is that of a jump, and is left out.
    """
    point = np.clip(point, low, high)
    here = residuals(point)
    cost = _cost(here, robust)
    damping, growth, settled = _DAMPING, 2.0, False
    information = np.eye(len(point))
    for _ in range(most):
        slopes = slopes_of(residuals, point, low, high, step)
        slopes[np.abs(slopes) > steepest] = 0.0
        weights = _weights(here, robust)
        weighted = slopes if weights is None else slopes * weights[:, None]
        information, gradient = weighted.T @ slopes, weighted.T @ here
        while damping < _MOST_DAMPING:
            move = _move(information, gradient, damping, point, low, high)
            gain = -float(move @ (2.0 * gradient + information @ move))
            if gain <= max(tolerance, share * cost):
                settled = True
                break
            bent = None if weights is not None else _bend(residuals, slopes, here, point, move)
            if bent is not None:
                turn = _move(information, slopes.T @ bent, damping, point + move, low, high)
                if _length(turn, information) < _MOST_TURN * _length(move, information):
                    move = np.clip(point + move + 0.5 * turn, low, high) - point
            there = residuals(point + move)
            new = _cost(there, robust)
            if new < cost:
                ratio = (cost - new) / gain
                damping = max(damping * max(1.0 / 3.0, 1.0 - (2.0 * min(ratio, 1.0) - 1.0)**3), _LEAST_DAMPING)
                point, here, cost, growth = point + move, there, new, 2.0
                break
            damping, growth = damping * growth, 2.0 * growth
        else:
            settled = True
        if settled:
            break
    return Solution(point, cost, information, settled)


def _move(information: Numbers, gradient: Numbers, damping: float, point: Numbers, low: Numbers, high: Numbers
          ) -> Numbers:
    """Return the damped step; parameters at an end of their range that would leave it stay."""
    scale = np.sqrt(np.maximum(np.diag(information), 1e-300))
    free = ~(((point <= low) & (gradient > 0.0)) | ((point >= high) & (gradient < 0.0)))
    move = np.zeros(len(point))
    for _ in range(len(point)):
        rows = np.flatnonzero(free)
        if not len(rows):
            break
        scaled = information[np.ix_(rows, rows)] / np.outer(scale[rows], scale[rows])
        move[:] = 0.0
        move[rows] = -np.linalg.solve(scaled + damping * np.eye(len(rows)), gradient[rows] / scale[rows]) / scale[rows]
        out = free & ((point + move < low) & (point <= low) | (point + move > high) & (point >= high))
        if not out.any():
            break
        free &= ~out
    return np.clip(point + move, low, high) - point


def _bend(residuals: Residuals, slopes: Numbers, here: Numbers, point: Numbers, move: Numbers) -> Numbers | None:
    """Return the second derivative (n,) of the residuals along a move; None where there is no motion."""
    there = residuals(point + _PROBE * move)
    if not np.isfinite(there[0]):
        return None
    return np.asarray(2.0 / _PROBE * ((there - here) / _PROBE - slopes @ move))


def _length(move: Numbers, information: Numbers) -> float:
    return float(np.sqrt(np.sum(np.diag(information) * move**2)))


def _cost(residuals: Numbers, robust: float) -> float:
    if not np.isfinite(residuals[0]):
        return np.inf
    if robust == np.inf:
        return float(residuals @ residuals)
    return float(2.0 * robust**2 * np.sum(np.sqrt(1.0 + (residuals / robust)**2) - 1.0))


def _weights(residuals: Numbers, robust: float) -> Numbers | None:
    return None if robust == np.inf else 1.0 / np.sqrt(1.0 + (residuals / robust)**2)
