# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The points of a study: a grid over all variations, a Sobol sample between their ends, or one of distributions."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from .distribution import Correlations, Distribution, correlated, factor_of
from .variation import Variation

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

    Its first points are those of any longer one.  A power of two fills the space most evenly.
    """

    variations: tuple[Variation, ...]
    count: int
    seed: int = 0

    def __post_init__(self) -> None:
        if not 1 <= self.count <= MOST_DRAWN:
            raise InputError('--sobol', self.count, f'1 to {MOST_DRAWN} points', 'best a power of two')

    def points(self, first: int, last: int) -> Numbers:
        """Return the points from `first` on, up to `last`: a row each, a column for each variation."""
        shares = sobol_shares(len(self.variations), self.seed, first, last)
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
