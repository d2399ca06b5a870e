# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The points of a study: a grid over all variations, a Sobol sample between their ends, or one of distributions."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..scene import Parameter
from ..scene.ros_yaml import section
from .variation import Variation, entry_of

# The distribution of a parameter that is not known exactly, cut where the user cuts it.

_TAILS = 4.0     # standard deviations: 6e-5 of the probability lies beyond
_WIDEST = 1e6    # times the median, one standard deviation away


class Rule(NamedTuple):
    """The condition on one number of a law, in words and as a test of all numbers."""

    number: str
    allowed: str
    holds: Callable[..., bool]


class Law(NamedTuple):
    """A family of distributions: the `numbers` that choose one, their conditions, and that one of scipy.stats.

    `ends`: where tails without an end may be cut; None where there are none.
    """

    numbers: tuple[str, ...]
    rules: tuple[Rule, ...]
    frozen: Callable[..., Any]
    ends: Callable[..., tuple[float, float]] | None = None


LAWS = {
    'normal': Law(
        ('mean', 'standard_deviation'), (Rule('standard_deviation', '> 0', lambda mean, sd: sd > 0.0),),
        lambda stats, mean, sd: stats.norm(mean, sd),
        lambda mean, sd: (mean - _TAILS * sd, mean + _TAILS * sd)),
    'lognormal': Law(
        ('median', 'geometric_standard_deviation'),
        (Rule('median', '> 0', lambda median, sd: median > 0.0),
         Rule('geometric_standard_deviation', '> 1 and <= 1e6: two thirds lie between median / it and median * it',
              lambda median, sd: 1.0 < sd <= _WIDEST)),
        lambda stats, median, sd: stats.lognorm(np.log(sd), scale=median),
        lambda median, sd: (median / sd**_TAILS, median * sd**_TAILS)),
    'uniform': Law(('low', 'high'), (Rule('high', 'above low', lambda low, high: low < high),),
                   lambda stats, low, high: stats.uniform(low, high - low)),
    'triangular': Law(
        ('low', 'mode', 'high'),
        (Rule('high', 'above low', lambda low, mode, high: low < high),
         Rule('mode', 'from low to high', lambda low, mode, high: low <= mode <= high)),
        lambda stats, low, mode, high: stats.triang((mode - low) / (high - low), low, high - low)),
}


@dataclass(frozen=True)
class Distribution:
    """A parameter of a scene, or an element of a list, that follows one of `LAWS` between `low` and `high`.

    `numbers` are those of the law, in its order and in the unit of the parameter.
    """

    name: str
    law: str
    numbers: tuple[float, ...]
    low: float
    high: float

    @property
    def unit(self) -> str:
        """Of the parameter, as in the schema."""
        return entry_of(self.name)[0].unit

    @property
    def kept(self) -> float:
        """The probability between `low` and `high` of the law before it was cut."""
        return self._shares[1] - self._shares[0]

    def at(self, shares: Numbers) -> Numbers:
        """Return the values below which these shares of the probability lie."""
        values = self._frozen.ppf(self._shares[0] + self.kept * shares)
        return np.asarray(np.clip(values, self.low, self.high))   # rounding alone leaves the range

    @cached_property
    def _frozen(self) -> Any:
        from scipy import stats

        return LAWS[self.law].frozen(stats, *self.numbers)

    @cached_property
    def _shares(self) -> tuple[float, float]:
        low, high = self._frozen.cdf([self.low, self.high]).tolist()
        return low, high


# Correlations of parameters that are not known exactly: given pair by pair, drawn by a Gaussian copula.
#
#     correlations:
#       axis.mass: {axis.normal_force: 0.93, friction.static.limit: -0.2}
#
# A pair that is not named is independent.  The numbers are of the normal scores Φ⁻¹(share) of two parameters: for
# normal distributions of the parameters themselves, for lognormal ones of their logarithms.

Correlations = tuple[tuple[float, ...], ...]   # (k, k), in the order of the parameters

_PAGE = 'docs/maps.md'
_LEAST = 1e-12          # of the eigenvalues: with less, rounding decides whether such numbers exist
_OPEN = 2.0**-54        # a share of 0 or 1 has no normal score


def correlations_of(names: Sequence[str], given: object) -> Correlations | None:
    """Return the correlations of parameters from a section of a file; None where it gives none.  Raises InputError."""
    if given is None:
        return None
    matrix = np.eye(len(names))
    seen: set[frozenset[str]] = set()
    for first, second, number in _pairs(names, section('correlations', given, tuple(names), _PAGE)):
        i, j = names.index(first), names.index(second)
        pair = frozenset((first, second))
        if i == j or pair in seen:
            raise InputError(f'correlations.{first}', second, 'another parameter, each pair once', 'drop this one')
        seen.add(pair)
        matrix[i, j] = matrix[j, i] = number
    if np.linalg.eigvalsh(matrix)[0] < _LEAST:
        raise InputError('correlations', [list(row) for row in matrix.tolist()], 'a positive definite matrix: these '
                         'contradict each other', 'move those near 1 or -1 towards 0')
    return tuple(map(tuple, matrix.tolist())) if seen else None


def correlated(shares: Numbers, factor: Numbers) -> Numbers:
    """Return shares (n, k) with the correlations of `factor_of`, from independent ones."""
    from scipy.special import ndtr, ndtri

    return np.asarray(ndtr(ndtri(np.clip(shares, _OPEN, 1.0 - _OPEN)) @ factor.T))


def factor_of(correlations: Correlations) -> Numbers:
    """Return the lower triangular L with L Lᵀ the correlations; raises ValueError where no such numbers exist."""
    return np.asarray(np.linalg.cholesky(np.array(correlations)))


def _pairs(names: Sequence[str], given: Mapping[str, object]) -> Iterator[tuple[str, str, float]]:
    for first, others in given.items():
        found = section(f'correlations.{first}', others, tuple(names), _PAGE)
        for second, number in found.items():
            entry = Parameter(f'correlations.{first}.{second}', 'double', None, '', '', low=-1.0, high=1.0)
            checked = entry.checked(number)
            assert isinstance(checked, float)
            yield first, second, checked


MOST_DRAWN = 1 << 30   # points of a Sobol sequence of scipy
LEAST_SAMPLES, MOST_SAMPLES = 16, 1 << 24


@dataclass(frozen=True)
class EvenGrid:
    """Every combination of the values of the variations; the last one runs fastest."""

    variations: tuple[Variation, ...]

    def __post_init__(self) -> None:
        for one in self.variations:
            if one.count < 2:
                raise InputError(one.name, one.count, 'a whole number N >= 2 of values', 'use --set for a single value')

    @property
    def count(self) -> int:
        """How many points there are."""
        return math.prod(one.count for one in self.variations)

    def points(self, first: int, last: int) -> Numbers:
        """Return the points from `first` on, up to `last`: a row each, a column for each variation."""
        places = np.unravel_index(np.arange(first, last), [one.count for one in self.variations])
        return np.stack([values[place] for values, place in zip(self._values, places)], axis=1)

    @cached_property
    def _values(self) -> list[Numbers]:
        return [one.grid() for one in self.variations]


@dataclass(frozen=True)
class Sobol:
    """`count` points of a scrambled Sobol sequence between the ends of the variations; a `seed` for each sequence.

    Its first points are those of any longer one.  A power of two fills the space most evenly.  Those of the variations
    that come first may have `correlations`.
    """

    variations: tuple[Variation | Distribution, ...]
    count: int
    seed: int = 0
    correlations: Correlations | None = None

    def __post_init__(self) -> None:
        if not 1 <= self.count <= MOST_DRAWN:
            raise InputError('--sobol', self.count, f'1 to {MOST_DRAWN} points', 'preferably a power of two')

    def points(self, first: int, last: int) -> Numbers:
        """Return the points from `first` on, up to `last`: a row each, a column for each variation."""
        shares = sobol_shares(len(self.variations), self.seed, first, last)
        if self.correlations is not None:
            known = len(self.correlations)
            shares[:, :known] = correlated(shares[:, :known], factor_of(self.correlations))
        return np.stack([one.at(shares[:, k]) for k, one in enumerate(self.variations)], axis=1)


@dataclass(frozen=True)
class Saltelli:
    """Points for Sobol' indices of d numbers that follow distributions (Saltelli et al., 2010).

    For each of `samples` pairs of independent points A and B, d + 2 in turn: A, B, and A with one number of B, for each
    number.  `samples` is a power of two.  With `correlations` there are A and B alone: the indices are of numbers that
    vary one by one.
    """

    variations: tuple[Distribution, ...]
    samples: int
    seed: int = 0
    correlations: Correlations | None = None

    def __post_init__(self) -> None:
        if not LEAST_SAMPLES <= self.samples <= MOST_SAMPLES or self.samples.bit_count() != 1:
            raise InputError('--samples', self.samples, f'a power of two from {LEAST_SAMPLES} to {MOST_SAMPLES}',
                             'a Sobol sequence of another length is uneven')
        _ = self._factor

    @property
    def each(self) -> int:
        """How many points belong to one sample."""
        return 2 if self.correlations else len(self.variations) + 2

    @property
    def count(self) -> int:
        """How many points there are."""
        return self.samples * self.each

    def points(self, first: int, last: int) -> Numbers:
        """Return the points from `first` on, up to `last`: a row each, a column for each variation."""
        d, begin = len(self.variations), first // self.each
        shares = sobol_shares(2 * d, self.seed, begin, -(-last // self.each)).reshape(-1, 2, d)
        a, b = (self._at(shares[:, half]) for half in (0, 1))
        blocks = np.repeat(a[:, None, :], self.each, axis=1)
        blocks[:, 1] = b
        for k in range(self.each - 2):
            blocks[:, 2 + k, k] = b[:, k]
        rows: Numbers = blocks.reshape(-1, d)[first - begin * self.each:last - begin * self.each]
        return rows

    def _at(self, shares: Numbers) -> Numbers:
        own = shares if self._factor is None else correlated(shares, self._factor)
        return np.stack([one.at(own[:, k]) for k, one in enumerate(self.variations)], axis=1)

    @cached_property
    def _factor(self) -> Numbers | None:
        return None if self.correlations is None else factor_of(self.correlations)


def sobol_shares(dimensions: int, seed: int, first: int, last: int) -> Numbers:
    """Return the points from `first` on, up to `last`, of a scrambled Sobol sequence in the unit cube."""
    import warnings

    from scipy.stats import qmc

    sequence = qmc.Sobol(dimensions, scramble=True, seed=seed)
    if first:   # scipy cannot go forward by none
        sequence.fast_forward(first)
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', UserWarning)   # that a part of the sequence is no power of two
        return np.asarray(sequence.random(last - first))


Sampling = EvenGrid | Sobol | Saltelli
