# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What becomes of an axis that is known only roughly: percentiles of its figures, and which number decides them.

Percentiles are over the independent points A and B of a sample, 2 N of them.  Sobol' indices are those of scipy
(Saltelli et al., 2010, with Jansen's total index):

    S_k = Var(E[f | x_k]) / Var(f) ≈ mean(f(B) (f(A with x_k of B) − f(A))) / Var(f)
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from .figures import Motion
from .sample import Saltelli
from .variation import Numbers

PERCENTS = (5, 25, 50, 75, 95)
SPREAD = {'amplitude': 'm', 'period': 's', 'stick_share': '', 'peak_speed': 'm/s', 'break_away_force': 'N',
          'settling_time': 's'}
_SAME = 1e-12   # of its size: a figure that varies less has no variance but that of rounding


class Index(NamedTuple):
    """Shares of the variance of a figure: by one number alone, and with all that it takes part in.

    `error` is the standard error of the first, as of points drawn at random; those of a Sobol sequence are nearer.
    """

    first_order: float
    error: float
    total: float


class Uncertainty(NamedTuple):
    """`stick_slip` is the share of those of `points` that were `solved`; `unsettled` cycles still differ at the end.

    `percentiles` are for each figure, of the points that stick and slip and have it.  `indices` are for each figure and
    each number; None where a point does not have the figure, or all have the same.
    """

    points: int
    solved: int
    unsettled: int
    stick_slip: float | None   # None: no point was solved
    percentiles: Mapping[str, list[float] | None]
    indices: Mapping[str, Mapping[str, Index] | None]


def uncertainty_of(sample: Saltelli, columns: Mapping[str, Numbers]) -> Uncertainty:
    """Return what the columns of the table of a sample say."""
    known = {name: columns[name].reshape(sample.samples, sample.each) for name in SPREAD}
    motion = columns['motion'].reshape(sample.samples, sample.each)
    slips = np.where(motion == Motion.UNSOLVED, np.nan, (motion == Motion.STICK_SLIP).astype(float))
    drawn = slips[:, :2]
    unsettled = (columns['settled'].reshape(slips.shape)[:, :2] == 0.0) & ~np.isnan(drawn)
    solved = int((~np.isnan(drawn)).sum())
    names = [one.name for one in sample.variations]
    indices = {name: sobol_indices(values) for name, values in {'stick_slip': slips, **known}.items()}
    return Uncertainty(
        drawn.size, solved, int(unsettled.sum()), float(np.nansum(drawn)) / solved if solved else None,
        {name: _percentiles(values[:, :2][drawn == 1.0]) for name, values in known.items()},
        {name: dict(zip(names, found, strict=True)) if found else None for name, found in indices.items()})


def sobol_indices(values: Numbers) -> list[Index] | None:
    """Return the indices of each number, from rows f(A), f(B), f(A with one number of B).

    None without a variance, or with one that leaves the range of numbers.
    """
    from scipy import stats

    if np.isnan(values).any() or np.ptp(values[:, :2]) <= _SAME * np.abs(values[:, :2]).max():
        return None
    a, b, mixed = values[:, 0], values[:, 1], values[:, 2:].T
    twice = {'f_A': np.stack([a, a]), 'f_B': np.stack([b, b]), 'f_AB': np.stack([mixed, mixed], axis=1)}
    found = stats.sobol_indices(func=twice, n=len(values))   # scipy fails on one figure of one number
    first, total = (np.reshape(order, (2, -1))[0].tolist() for order in (found.first_order, found.total_order))
    products = (b - values[:, :2].mean()) * (mixed - a) / values[:, :2].var()   # whose means are the first orders
    errors = (products.std(axis=1) / np.sqrt(len(values))).tolist()
    if not np.isfinite([*first, *errors, *total]).all():
        return None
    return [Index(*row) for row in zip(first, errors, total, strict=True)]


def _percentiles(values: Numbers) -> list[float] | None:
    values = values[~np.isnan(values)]
    return [float(number) for number in np.percentile(values, PERCENTS)] if len(values) else None
