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
from scipy.optimize import nnls

from ..core.arrays import Numbers
from .free_parameters import Region

# The step of Levenberg and Marquardt that stays within a region: least distance programming (Lawson and Hanson 1974).
#
# A step that is cut off at a border is not the best one there is: the numbers that stay free go elsewhere once one of
# them is held.

_LEAST = 1e-15       # of the largest: an eigenvalue of the scaled curvature that is not rounding
_MOST_TURNS = 1000   # of the search for the borders that hold


def bounded_step(information: Numbers, gradient: Numbers, damping: float, point: Numbers, region: Region) -> Numbers:
    """Return the step (k,) to the least of the damped parabola (JᵀJ (k, k), Jᵀr (k,)) within a region.

    The damping is relative to the diagonal.
    """
    move = np.zeros(len(point))
    rows = np.flatnonzero(region.high > region.low)
    if not len(rows):
        return move
    scale = np.sqrt(np.maximum(np.diag(information)[rows], 1e-300))
    sizes, turned = np.linalg.eigh(information[np.ix_(rows, rows)] / np.outer(scale, scale))
    roots = np.sqrt(np.maximum(sizes, _LEAST * sizes[-1]) + damping)
    ways = turned / roots
    free = -ways @ (ways.T @ (gradient[rows] / scale))
    normals, room = region.borders(point)
    normals = normals[:, rows] / scale
    short = -room - normals @ free   # how far a step must go back, along each border's normal
    if np.any(short > 0.0):
        free = free + ways @ _least(normals @ ways, short)
    move[rows] = free / scale
    return region.inside(point + move) - point


def _least(normals: Numbers, short: Numbers) -> Numbers:
    """Return the shortest z with `normals` z ≥ `short`."""
    lengths = np.linalg.norm(normals, axis=1)
    sloped = lengths > 0.0
    normals, short = normals[sloped] / lengths[sloped, None], short[sloped] / lengths[sloped]
    size = float(short.max())
    borders = np.concatenate([normals.T, [short / size]])
    target = np.append(np.zeros(normals.shape[1]), 1.0)
    pushes, _ = nnls(borders, target, maxiter=_MOST_TURNS)
    left = borders @ pushes - target
    return np.asarray(-size * left[:-1] / left[-1])


Residuals = Callable[[Numbers], Numbers]
_Step = float | Numbers

STEP = 1e-6            # of a logarithm, or of a range: rounding is 1e-10 of it, the third derivative 1e-12
_DAMPING = 1e-3        # of the first step, relative to the diagonal
_LEAST_DAMPING, _MOST_DAMPING = 1e-12, 1e12
_UNDAMPED, _SETTLED = 1e-6, 100.0   # a damping, and times what the last step may gain
_CRAWLS = 1e-3         # of a sum that is far from noise: steps that gain less lead nowhere
_SHARES = 1.0, 0.3, 0.1, 0.03   # of a step without damping that are tried, where it promises more
_PROBE = 0.1           # of a step: there its second derivative is taken
_MOST_TURN = 0.75      # of the length of a step
_LONGER, _JUMPS, _LONGEST = 10.0, 0.5, 1e-2   # a step so much longer, at which a derivative falls so far; up to


class Solution(NamedTuple):
    """Where a fit ended: `point` (k,), the sum of squares `cost`, JᵀJ (k, k) there, and whether it came to an end.

    `step` is that of the derivatives.
    """

    point: Numbers
    cost: float
    information: Numbers
    is_settled: bool
    step: _Step = STEP


def slopes_of(residuals: Residuals, point: Numbers, here: Numbers, region: Region, step: _Step,
              one_sided: bool = False) -> Numbers:
    """Return the derivatives (n, k) of residuals, which are `here` at a point, by central differences over a step.

    There may be a step for each parameter (k,).  They are one-sided at a border, and where there is no motion on one
    side; 0 where there is on none; and over the shortest step if they may be `one_sided`, which is right to 1e-6 for
    half the work.  A number that is raised at a border may raise another one with it: the derivatives of single ones
    follow from those along all ways.
    """
    ways, changes, steps = np.eye(len(point)), [], np.broadcast_to(step, point.shape)
    for k in range(len(point)):
        found = []
        for sign in (1.0, -1.0):
            end = region.inside(point + sign * steps[k] * ways[k])
            there = here if np.array_equal(end, point) else residuals(end)
            found.append((end, there) if np.isfinite(there[0]) else (point, here))
            if one_sided and sign > 0.0 and steps[k] <= STEP and np.isfinite(there[0]) and end[k] != point[k]:
                found.append((point, here))
                break
        (up, above), (down, below) = found
        length = up[k] - down[k]
        changes.append((above - below) / length if length else np.zeros(len(here)))
        ways[k] = (up - down) / length if length else ways[k]
    slopes = np.stack(changes, axis=1)
    return slopes if np.array_equal(ways, np.eye(len(point))) else np.linalg.solve(ways, slopes.T).T


def steps_over_jumps(residuals: Residuals, found: 'Solution', region: Region, step: _Step) -> Numbers:
    """Return steps (k,) of derivatives that no jump decides: longer ones, where that lowers a derivative by far.

    A fit likes to end at the edge of a jump.  Over a short step there the derivative is that of the jump, as large as
    the step is short: the fit stands still, and takes the parameter for known.
    """
    point, sizes = found.point, np.sqrt(np.diag(found.information))
    here = residuals(point)
    steps: Numbers = np.asarray(np.broadcast_to(step, point.shape), dtype=np.float64)
    longer = _LONGER * steps
    while True:
        again = np.linalg.norm(slopes_of(residuals, point, here, region, longer), axis=0)
        falls = (again < _JUMPS * sizes) & (longer <= _LONGEST)
        if not falls.any():
            return steps
        steps = np.asarray(np.where(falls, longer, steps))
        sizes, longer = np.where(falls, again, 0.0), np.where(falls, _LONGER * steps, steps)


def minimise(residuals: Residuals, point: Numbers, region: Region, *, most: int, tolerance: float,
             share: float = 1e-9, far: float = np.inf, robust: float = np.inf, step: _Step = STEP,
             steepest: float = np.inf, informs: bool = True) -> Solution:
    """Return where the sum of squares is least, from a point on, after at most so many steps.

    It ends where the next step would gain less than `tolerance`, or that `share` of the sum, of a sum beyond `far` a
    larger one; it is settled if a step without damping would not gain much more, or does not, as on a plateau of what
    the data do not determine.
    Residuals are all NaN where the parameters contradict each other; those beyond `robust` count by their size, not
    their square.  A derivative beyond `steepest` is that of a jump, and is left out.  Where the solution `informs`, its
    JᵀJ is by central differences: what the data do not determine shows in nothing else.  Else it is the last one of the
    search, by differences that may be one-sided.
    """
    def jacobian(one_sided: bool) -> tuple[Numbers, Numbers]:
        slopes, weights = slopes_of(residuals, point, here, region, step, one_sided), _weights(here, robust)
        slopes[np.abs(slopes) > steepest] = 0.0
        return slopes, slopes if weights is None else slopes * weights[:, None]

    def end(is_settled: bool) -> Solution:
        if informs:
            slopes, weighted = jacobian(False)
            return Solution(point, cost, weighted.T @ slopes, is_settled, step)
        return Solution(point, cost, information, is_settled, step)

    point = region.inside(point)
    here = residuals(point)
    cost, damping, growth = _cost(here, robust), _DAMPING, 2.0
    information: Numbers = np.eye(len(point))
    for _ in range(most):
        slopes, weighted = jacobian(True)
        information, gradient = weighted.T @ slopes, weighted.T @ here
        least = max(tolerance, (share if cost <= far else max(share, _CRAWLS)) * cost)
        while True:
            move = bounded_step(information, gradient, damping, point, region)
            gain = _gain(information, gradient, move)
            if not gain > least or damping > _MOST_DAMPING:
                whole = bounded_step(information, gradient, _UNDAMPED, point, region)
                return end(not _gain(information, gradient, whole) > _SETTLED * least or all(
                    cost - _cost(residuals(point + part * whole), robust) < _SETTLED * least for part in _SHARES))
            bent = None if robust < np.inf else _bend(residuals, slopes, here, point, move)
            if bent is not None:
                turn = bounded_step(information, slopes.T @ bent, damping, point + move, region)
                if _length(turn, information) < _MOST_TURN * _length(move, information):
                    move = region.inside(point + move + 0.5 * turn) - point
            there = residuals(point + move)
            new = _cost(there, robust)
            if new < cost:
                ratio = (cost - new) / gain
                damping = max(damping * max(1.0 / 3.0, 1.0 - (2.0 * min(ratio, 1.0) - 1.0)**3), _LEAST_DAMPING)
                point, here, cost, growth = point + move, there, new, 2.0
                break
            damping, growth = damping * growth, 2.0 * growth
    return end(False)


def informed(residuals: Residuals, found: Solution, region: Region) -> Solution:
    """Return a solution of squares with JᵀJ by central differences."""
    slopes = slopes_of(residuals, found.point, residuals(found.point), region, found.step)
    return found._replace(information=slopes.T @ slopes)


def _gain(information: Numbers, gradient: Numbers, move: Numbers) -> float:
    """Return by how much a step lowers the sum of squares, were the residuals linear."""
    return -float(move @ (2.0 * gradient + information @ move))


def _bend(residuals: Residuals, slopes: Numbers, here: Numbers, point: Numbers, move: Numbers) -> Numbers | None:
    """Return the second derivative (n,) of the residuals along a move; None where there is no motion."""
    there = residuals(point + _PROBE * move)
    if not np.isfinite(there[0]):
        return None
    return np.asarray(2.0 / _PROBE * ((there - here) / _PROBE - slopes @ move))


def _length(move: Numbers, information: Numbers) -> float:
    return float(np.sqrt(np.sum(np.diag(information) * move**2)))


def square_cost(residuals: Numbers) -> float:
    """Return the sum of squares; infinite where there is no motion."""
    return float(residuals @ residuals) if np.isfinite(residuals[0]) else np.inf


def robust_cost(residuals: Numbers, robust: float = 1.0) -> float:
    """Return half the sum of squares, in units of `robust`, of residuals that beyond it count by their size."""
    return float(np.sum(np.sqrt(1.0 + (residuals / robust)**2) - 1.0)) if np.isfinite(residuals).all() else np.inf


def _cost(residuals: Numbers, robust: float) -> float:
    return square_cost(residuals) if robust == np.inf else 2.0 * robust**2 * robust_cost(residuals, robust)


def _weights(residuals: Numbers, robust: float) -> Numbers | None:
    return None if robust == np.inf else 1.0 / np.sqrt(1.0 + (residuals / robust)**2)
