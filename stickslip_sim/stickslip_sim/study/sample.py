"""The points of a study: a grid over all variations, or a Sobol sample between their ends."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..errors import InputError
from .variation import Numbers, Variation

MOST_DRAWN = 1 << 30   # what a Sobol sequence of scipy has


@dataclass(frozen=True)
class Grid:
    """Every combination of the values of the variations; the last one runs fastest."""

    variations: tuple[Variation, ...]

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
        import warnings

        from scipy.stats import qmc

        sequence = qmc.Sobol(len(self.variations), scramble=True, seed=self.seed)
        if first:   # scipy cannot go forward by none
            sequence.fast_forward(first)
        with warnings.catch_warnings():
            warnings.simplefilter('ignore', UserWarning)   # that a part of the sequence is no power of two
            shares = sequence.random(last - first)
        return np.stack([one.at(shares[:, k]) for k, one in enumerate(self.variations)], axis=1)


Sample = Grid | Sobol
