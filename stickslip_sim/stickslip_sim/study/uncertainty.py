# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of an axis that is known only roughly: percentiles of its figures, and the parameters that decide them.

Percentiles are over the independent points A and B of a sample, 2 N of them.  Sobol' indices are those of scipy
(Saltelli et al., 2010, with Jansen's total index):

    S_k = Var(E[f | x_k]) / Var(f) ≈ mean(f(B) (f(A with x_k of B) − f(A))) / Var(f)
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from .point_figures import Motion
from .sample import Saltelli

PERCENTS = (5, 25, 50, 75, 95)
SPREAD = {'amplitude': 'm', 'period': 's', 'stick_share': '', 'peak_speed': 'm/s', 'break_away_force': 'N',
          'settling_time': 's'}
_SAME = 1e-12   # of its size: a figure that varies less has no variance but that of rounding


class Index(NamedTuple):
    """Shares of the variance of a figure: by one number alone, and with all that it takes part in.

    `error` and `total_error` are their standard errors as of points drawn at random; a Sobol sequence is nearer.
    """

    first_order: float
    error: float
    total: float
    total_error: float


class Uncertainty(NamedTuple):
    """`stick_slip` is the share of those of `points` that are `known`; all others `failed`, or are `undecided`.

    Cycles of `unsettled` still differ at the end.  `percentiles` are for each figure, of the points that stick and slip
    and have it.  `indices` are for each figure and each number; None where a point does not have the figure, all have
    the same, or the numbers are correlated.
    """

    points: int
    known: int
    failed: int
    undecided: int
    unsettled: int
    stick_slip: float | None
    percentiles: Mapping[str, list[float] | None]
    indices: Mapping[str, Mapping[str, Index] | None]


def uncertainty_of(sample: Saltelli, columns: Mapping[str, Numbers]) -> Uncertainty:
    """Return percentiles and indices from the columns of the table of a sample."""
    known = {name: columns[name].reshape(sample.samples, sample.each) for name in SPREAD}
    slips = _slips(sample, columns)
    drawn = slips[:, :2]
    unsettled = (columns['settled'].reshape(slips.shape)[:, :2] == 0.0) & ~np.isnan(drawn)
    motion = columns['motion'].reshape(slips.shape)[:, :2]
    count = int((~np.isnan(drawn)).sum())
    failed, undecided = (int((motion == one).sum()) for one in (Motion.FAILED, Motion.UNDECIDED))
    names = [one.name for one in sample.variations]
    indices = {name: None if sample.correlations else sobol_indices(values)
               for name, values in {'stick_slip': slips, **known}.items()}
    return Uncertainty(
        drawn.size, count, failed, undecided, int(unsettled.sum()), float(np.nansum(drawn)) / count if count else None,
        {name: _percentiles(values) for name, values in spread_of(sample, columns).items()},
        {name: dict(zip(names, found, strict=True)) if found else None for name, found in indices.items()})


def spread_of(sample: Saltelli, columns: Mapping[str, Numbers]) -> dict[str, Numbers]:
    """Return each figure of the independent points that stick and slip and have it."""
    chosen = _slips(sample, columns)[:, :2] == 1.0
    found = {name: columns[name].reshape(sample.samples, sample.each)[:, :2][chosen] for name in SPREAD}
    return {name: values[~np.isnan(values)] for name, values in found.items()}


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
    squares = 0.5 * (mixed - a)**2 / values[:, :2].var()   # whose means are the totals
    errors, total_errors = ((parts.std(axis=1) / np.sqrt(len(values))).tolist() for parts in (products, squares))
    return [Index(*row) for row in zip(first, errors, total, total_errors, strict=True)]


def _slips(sample: Saltelli, columns: Mapping[str, Numbers]) -> Numbers:
    """Return for each sample and each of its points 1 for stick-slip, 0 without, NaN where that is not known."""
    motion = columns['motion'].reshape(sample.samples, sample.each)
    return np.where(np.isin(motion, (Motion.FAILED, Motion.UNDECIDED)), np.nan, motion == Motion.STICK_SLIP)


def _percentiles(values: Numbers) -> list[float] | None:
    return [float(number) for number in np.percentile(values, PERCENTS)] if len(values) else None
