# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The step of Levenberg and Marquardt that stays within a region: least distance programming (Lawson and Hanson 1974).

A step that is cut off at a border is not the best one there is: the numbers that stay free go elsewhere once one of
them is held.
"""

import numpy as np
from scipy.optimize import nnls

from ...core.arrays import Numbers
from .region import Region

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
