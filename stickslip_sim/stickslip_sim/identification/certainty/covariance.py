# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How well a fit knows its parameters: covariance, intervals, and the combinations that the data cannot tell apart.

Covariance: (JᵀJ)⁻¹ of the weighted derivatives, times what the residuals of a channel go together for.  Combinations:
right singular vectors of J whose singular value is so small that the data leave the parameters anywhere in their
ranges along them.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaincinv

from ...core.arrays import Numbers
from ..given.free_parameters import FreeParameter
from ..identified import LEVEL, Combination

QUANTILE = 2.0 * float(gammaincinv(0.5, LEVEL))   # of the rise of the sum of squares at the ends of an interval
_LOST = 0.3      # of the range of a parameter: a standard deviation so large says nothing
_PART = 0.1      # of the largest weight: below, a parameter has no part in a combination
_ROUNDING = 1e-10   # of JᵀJ with a diagonal of 1: what its derivatives, differences, are exact to


class Certainty(NamedTuple):
    """The covariance (k, k) of what the fit works on, and which parameters (k,) the data determine."""

    covariance: Numbers
    known: NDArray[np.bool_]

    @property
    def deviations(self) -> Numbers:
        """The standard deviations (k,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @property
    def correlation(self) -> Numbers:
        """The correlation (k, k); NaN with parameters that the data do not determine."""
        deviations = np.where(self.known, self.deviations, np.nan)
        return np.asarray(self.covariance / np.outer(deviations, deviations))


def certainty_of(information: Numbers, inflation: float, parameters: Sequence[FreeParameter]) -> Certainty:
    """Return what JᵀJ (k, k) of all residuals says; `inflation` is the factor on the covariance."""
    moves = np.diag(information) > 0.0   # not what is held
    scale = np.sqrt(np.where(moves, np.diag(information), 1.0))
    widths = _widths(parameters)
    sizes, vectors = np.linalg.eigh(information / np.outer(scale, scale))
    covariance = np.zeros_like(information)
    for size, way in zip(sizes, (vectors / scale[:, None]).T):
        if size > _ROUNDING:
            covariance += inflation / size * np.outer(way, way)
        elif moves[np.abs(way / widths).argmax()]:    # anywhere in the ranges along it
            far = way / np.abs(way / widths).max()
            covariance += np.outer(far, far)
    return Certainty(covariance, moves & (np.sqrt(np.diag(covariance)) < _LOST * widths))


def combinations_of(information: Numbers, parameters: Sequence[FreeParameter]) -> tuple[Combination, ...]:
    """Return what JᵀJ (k, k) of the measured channels leaves free."""
    squares, turned = np.linalg.eigh(information)
    rounding = _ROUNDING * np.diag(information) @ turned**2
    sizes, vectors = np.sqrt(np.where(squares > rounding, squares, 0.0)), turned.T
    widths = _widths(parameters)
    found = []
    for size, vector in zip(sizes, vectors):
        weights = vector / vector[np.abs(vector).argmax()]
        reach = float(np.min(widths / np.maximum(np.abs(weights), 1e-9)))
        length = float(np.linalg.norm(weights))
        spread = length**-1 / size if size > 0.0 else np.inf
        if spread < _LOST * reach:
            continue
        rows = [k for k in np.argsort(-np.abs(weights), kind='stable') if abs(weights[k]) >= _PART]
        names = tuple(parameters[k].name for k in rows)
        powers = tuple(_plain(float(weights[k])) for k in rows)
        found.append(Combination(names, powers, spread, _statement(names, powers)))
    return tuple(found)


def _widths(parameters: Sequence[FreeParameter]) -> Numbers:
    return np.array([one.inner(one.high) - one.inner(one.low) for one in parameters])


def _plain(weight: float) -> float:
    """Return a weight, as a simple ratio where it is one but for noise."""
    near = round(6.0 * weight) / 6.0
    return round(near if abs(weight - near) < 0.02 else weight, 3)


def _statement(names: Sequence[str], powers: Sequence[float]) -> str:
    if len(names) == 1:
        return f'the data do not determine {names[0]}'
    if all(power == powers[0] for power in powers):
        return f'the data determine only the ratios of {", ".join(names[:-1])} and {names[-1]}: all may be larger by ' \
               'one factor'
    together = ', '.join(f'{name} to the power {power:g}' for name, power in zip(names, powers))
    return f'the data do not change with one factor on all of: {together}'
