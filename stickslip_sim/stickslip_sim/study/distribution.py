# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The distribution of a parameter that is not known exactly, cut where the user cuts it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..core.arrays import Numbers
from .variation import parameter_of

_TAILS = 4.0     # standard deviations: 6e-5 of the probability lies beyond
_WIDEST = 1e6    # times the median, one standard deviation away


class Rule(NamedTuple):
    """The condition on one number of a law, in words and as a test of all numbers."""

    number: str
    allowed: str
    holds: Callable[..., bool]


class Law(NamedTuple):
    """A family of distributions: the `numbers` that choose one, their conditions, and that one as scipy has it.

    `ends`: where tails without an end may be cut; None where there are none.
    """

    numbers: tuple[str, ...]
    rules: tuple[Rule, ...]
    frozen: Callable[..., Any]
    ends: Callable[..., tuple[float, float]] | None = None


def _normal(mean: float, standard_deviation: float) -> Any:
    from scipy.stats import norm

    return norm(mean, standard_deviation)


def _lognormal(median: float, geometric_standard_deviation: float) -> Any:
    from scipy.stats import lognorm

    return lognorm(np.log(geometric_standard_deviation), scale=median)


def _uniform(low: float, high: float) -> Any:
    from scipy.stats import uniform

    return uniform(low, high - low)


def _triangular(low: float, mode: float, high: float) -> Any:
    from scipy.stats import triang

    return triang((mode - low) / (high - low), low, high - low)


LAWS = {
    'normal': Law(
        ('mean', 'standard_deviation'), (Rule('standard_deviation', '> 0', lambda mean, sd: sd > 0.0),),
        _normal, lambda mean, sd: (mean - _TAILS * sd, mean + _TAILS * sd)),
    'lognormal': Law(
        ('median', 'geometric_standard_deviation'),
        (Rule('median', '> 0', lambda median, sd: median > 0.0),
         Rule('geometric_standard_deviation', '> 1 and <= 1e6: two thirds lie between median / it and median * it',
              lambda median, sd: 1.0 < sd <= _WIDEST)),
        _lognormal, lambda median, sd: (median / sd**_TAILS, median * sd**_TAILS)),
    'uniform': Law(('low', 'high'), (Rule('high', 'above low', lambda low, high: low < high),), _uniform),
    'triangular': Law(
        ('low', 'mode', 'high'),
        (Rule('high', 'above low', lambda low, mode, high: low < high),
         Rule('mode', 'from low to high', lambda low, mode, high: low <= mode <= high)), _triangular),
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
        return parameter_of(self.name)[0].unit

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
        return LAWS[self.law].frozen(*self.numbers)

    @cached_property
    def _shares(self) -> tuple[float, float]:
        low, high = self._frozen.cdf([self.low, self.high]).tolist()
        return low, high
