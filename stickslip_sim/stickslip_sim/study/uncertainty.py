# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of an axis that is known only roughly: percentiles of its figures, and the parameters that decide them.

Percentiles are over the independent points A and B of a sample, 2 N of them.  Sobol' indices are those of scipy
(Saltelli et al., 2010, with Jansen's total index):

    S_k = Var(E[f | x_k]) / Var(f) ≈ mean(f(B) (f(A with x_k of B) − f(A))) / Var(f)
"""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..figures.point_figures import Motion
from ..scene import Parameter
from ..scene.load import named, read_text
from ..scene.ros_yaml import read_yaml, section
from .sample import LAWS, Correlations, Distribution, Law, Saltelli, correlations_of
from .study import MOST_VARIATIONS
from .variation import ParameterOf, parameter_of

PERCENTS = (5, 25, 50, 75, 95)
SPREAD = ('amplitude', 'period', 'stick_share', 'peak_speed', 'break_away_force', 'settling_time')
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
        {name: percentiles(values) for name, values in spread_of(sample, columns).items()},
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


def percentiles(values: Numbers) -> list[float] | None:
    """Return those of PERCENTS of the values that are known, which may be infinite; None of none."""
    known = values[~np.isnan(values)]
    if not len(known):
        return None
    with np.errstate(invalid='ignore'):
        found = np.percentile(known, PERCENTS)
    upper = np.percentile(known, PERCENTS, method='higher')   # no number lies between two infinite ones
    return [float(number) for number in np.where(np.isnan(found), upper, found)]


# The file of parameters that are not known exactly: read strictly, so that no misspelling passes unseen.
#
# seed: 0
# parameters:
# friction.static.limit: {distribution: normal, mean: 0.24, standard_deviation: 0.02, between: [0.18, 0.3]}
# axis.normal_force: {distribution: uniform, low: 3000.0, high: 3800.0}
# correlations:
# friction.static.limit: {axis.normal_force: -0.9}

_PAGE = 'docs/maps.md'
_SEED = Parameter('seed', 'integer', 0, '', 'of the sample', low=0, high=2**31 - 1)
_LARGEST = 1e15    # as far as any parameter goes
LEAST_KEPT = 0.5   # of the probability: of a law cut further little is left


class Uncertain(NamedTuple):
    """The distributions of a file, the seed of their sample, and how they are correlated (None: they are not)."""

    distributions: tuple[Distribution, ...]
    seed: int
    correlations: Correlations | None = None


def load_uncertain(path: str | os.PathLike[str], find: ParameterOf = parameter_of, most: int = MOST_VARIATIONS
                   ) -> Uncertain:
    """Return the content of a file, as `uncertain_of` does; raises InputError, whose text names the file."""
    if not isinstance(path, str | os.PathLike):   # from Python, as a list of names
        raise InputError('parameters', type(path).__name__, 'the path of a file, or names with their distributions',
                         "for example {'axis.mass': {'distribution': 'uniform', 'low': 300.0, 'high': 400.0}}")
    text = read_text(Path(path), 'file of distributions')
    with named(os.fspath(path)):
        return uncertain_of(read_yaml(text), find, most)


def uncertain_of(document: object, find: ParameterOf = parameter_of, most: int = MOST_VARIATIONS) -> Uncertain:
    """Return the content of a document with `most` parameters or fewer, as YAML gives it; raises InputError.

    `find` returns the parameter of a name, and the index of an element: those of a scene, or others beside them.
    """
    given = section('file', document, ('parameters', 'correlations', 'seed'), _PAGE)
    entries = given.get('parameters')
    if not isinstance(entries, Mapping) or not 1 <= len(entries) <= most:
        raise InputError('parameters', entries, f'a section of 1 to {most} parameters',
                         'for example axis.mass: {distribution: uniform, low: 300.0, high: 400.0}')
    seed = _SEED.checked(given.get('seed', _SEED.default))
    assert isinstance(seed, int)
    distributions = tuple(_distribution(name, entry, find) for name, entry in entries.items())
    return Uncertain(distributions, seed, correlations_of([one.name for one in distributions],
                                                          given.get('correlations')))


def _distribution(name: str, entry: object, find: ParameterOf) -> Distribution:
    parameter = find(name)
    word = entry.get('distribution') if isinstance(entry, Mapping) else entry
    if not isinstance(entry, Mapping) or not isinstance(word, str) or word not in LAWS:
        raise InputError(f'{name}.distribution', word, 'one of ' + ', '.join(LAWS),
                         f'for example {name}: {{distribution: uniform, low: 1.0, high: 2.0}}')
    law = LAWS[word]
    known = ('distribution', *law.numbers, *(('between',) if law.ends else ()))
    given = section(name, entry, known, _PAGE)
    numbers = tuple(_number(f'{name}.{key}', given.get(key)) for key in law.numbers)
    _check_rules(name, law, numbers)
    low, high = _ends(name, given.get('between'), law, numbers) if law.ends else (numbers[0], numbers[-1])
    _check_ends(*parameter, (low, high))
    return _kept(Distribution(name, word, numbers, low, high))


def _check_rules(name: str, law: Law, numbers: tuple[float, ...]) -> None:
    """Raise InputError unless the numbers choose a distribution of a law."""
    for rule in law.rules:
        if not rule.holds(*numbers):
            raise InputError(f'{name}.{rule.number}', numbers[law.numbers.index(rule.number)], rule.allowed,
                             'correct the numbers of this distribution')


def _ends(name: str, given: object, law: Law, numbers: tuple[float, ...]) -> tuple[float, float]:
    """Return where the tails of a distribution are cut; raises InputError."""
    assert law.ends is not None
    if not isinstance(given, list) or len(given) != 2:
        low, high = law.ends(*numbers)
        raise InputError(f'{name}.between', given, 'given as [LOW, HIGH]: a tail without an end leaves every range, '
                         'and is not cut in silence', f'for example between: [{low:.6g}, {high:.6g}]')
    low, high = (_number(f'{name}.between', end) for end in given)
    if not low < high:
        raise InputError(f'{name}.between', given, '[LOW, HIGH] with LOW < HIGH', 'put the two in order')
    return low, high


def _check_ends(entry: Parameter, index: int | None, ends: tuple[float, float]) -> None:
    """Raise InputError unless the parameter may have these values."""
    for end in ends:
        entry.checked(end if index is None else (end,))


def _kept(found: Distribution) -> Distribution:
    if found.kept < LEAST_KEPT:
        raise InputError(f'{found.name}.between', [found.low, found.high], f'a range that keeps {LEAST_KEPT:g} or '
                         f'more of the probability; it keeps {found.kept:.2g}', 'widen it')
    return found


def _number(name: str, given: object) -> float:
    number = Parameter(name, 'double', None, '', '', low=-_LARGEST, high=_LARGEST).checked(given)
    assert isinstance(number, float)
    return number
