# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What an identification leaves open of a scene, as a file for `stickslip uncertainty --with`.

A number that was found is normal, or lognormal where the fit took its logarithm, and correlated with the others as in
the fit.  One at the end of its range falls from there; those that the run knows only together share a factor, and
one that it does not know at all is uniform over its range.
"""

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..scene import Scene
from ..study.distribution import LAWS, Distribution
from ..study.points import scene_at
from ..study.study import MOST_VARIATIONS
from ..study.uncertainty import LEAST_KEPT
from ..study.variation import parameter_of
from .identified import FOUND, NOT_IDENTIFIABLE, VOID, Combination, Estimate, Identification, moved
from .identified_scene import OF_SENSORS, rounded_scene

# Numbers that a run knows only together, as distributions: each by itself is wide, and all go up and down as one.
#
# Where only the product of pₖ to the power wₖ is free, ln pₖ = ln p̂ₖ + wₖ s with one s for all: the covariance of the
# logarithms is σ² w wᵀ, with σ as wide as the ranges leave it.

REACH = 2.0   # standard deviations from the value to the nearest end of a range


def with_shared_factors(found: Identification) -> tuple[list[Estimate], Numbers, frozenset[str]]:
    """Return the estimates and their correlation (k, k), with those of combinations as if found, and their names."""
    estimates = list(found.estimates)
    places = {one.name: k for k, one in enumerate(estimates) if one.kind == NOT_IDENTIFIABLE}
    covariance = np.zeros((len(estimates),) * 2)
    for together in found.combinations:
        if len(together.names) > 1 and all(name in places for name in together.names):
            rows = [places[name] for name in together.names]
            weights = np.zeros(len(estimates))
            weights[rows] = together.weights
            covariance += _shared_spread(together, [estimates[k] for k in rows])**2 * np.outer(weights, weights)
    deviations = np.sqrt(np.diag(covariance))
    shared = [k for k in range(len(estimates)) if deviations[k] > 0.0]
    correlation = np.array(found.correlation, dtype=np.float64)
    correlation[shared] = correlation[:, shared] = 0.0
    for i in shared:
        for j in shared:
            correlation[i, j] = covariance[i, j] / (deviations[i] * deviations[j])
        scale = 1.0 if estimates[i].logarithmic else estimates[i].high - estimates[i].low
        estimates[i] = replace(estimates[i], kind=FOUND, standard_deviation=float(deviations[i]) * scale)
    return estimates, correlation, frozenset(estimates[k].name for k in shared)


def _shared_spread(together: Combination, estimates: list[Estimate]) -> float:
    """Return the standard deviation of what is free: no number is to leave its range within REACH of them."""
    ways = [_way(one) / abs(weight) for one, weight in zip(estimates, together.weights, strict=True)]
    return min(together.spread, min(ways) / REACH)


def _way(one: Estimate) -> float:
    """Return how far it is to the nearest end of the range, as the fit sees the number."""
    if one.logarithmic:
        return max(min(math.log(one.high / one.value), math.log(one.value / one.low)), 0.0)
    return max(min(one.high - one.value, one.value - one.low), 0.0) / (one.high - one.low)


_TAILS = (4.0, 3.0, 2.0, 1.5, 1.0)   # standard deviations: the widest whose corners are scenes
_WEAKEST = 5e-4                      # a correlation that is left out
_SHRINK = 1e-6                       # of the correlations: what rounding makes indefinite is a matrix again
_LEAST = 1e-9                        # of the eigenvalues
_NARROWEST = 1e-9                    # of its size: a standard deviation that is smaller is rounding


class _Entry(NamedTuple):
    """A distribution of the file: its words, and the ends of its range."""

    words: str
    low: float
    high: float


def posterior_text(found: Identification, run: str) -> str:
    """Return the file: numbers of the scene that were free, at most as many as a study takes."""
    every, correlation, shared = with_shared_factors(found)
    free = [k for k, one in enumerate(every) if not one.name.startswith(OF_SENSORS)]
    chosen = sorted(sorted(free, key=lambda k: -_relative(every[k]))[:MOST_VARIATIONS])
    estimates = [every[k] for k in chosen]
    entries = _entries(rounded_scene(found), estimates, shared)
    lines = [f'# What the run {run} leaves open of {found.scene.name}, for stickslip uncertainty --with.',
             '# Correlations are those of the fit.',
             *([] if found.fits else ['# THE MODEL DOES NOT FIT this run: neither do these spreads hold.']),
             *_left_out(found, free, chosen), 'seed: 0', 'parameters:']
    lines += [f'  {_key(one.name)}: {{{entry.words}}}' for one, entry in zip(estimates, entries, strict=True)]
    return '\n'.join([*lines, *_correlation_lines(estimates, correlation[np.ix_(chosen, chosen)])]) + '\n'


def _relative(one: Estimate) -> float:
    return math.inf if one.kind == NOT_IDENTIFIABLE else _spread(one) / (1.0 if one.logarithmic else _size(one))


def _left_out(found: Identification, free: Sequence[int], chosen: Sequence[int]) -> Iterator[str]:
    names = [found.estimates[k].name for k in free if k not in chosen]
    if names:
        yield f'# A study takes {MOST_VARIATIONS} numbers; those known best are left out: {", ".join(names)}'


def _entries(scene: Scene, estimates: Sequence[Estimate], shared: frozenset[str]) -> list[_Entry]:
    """Return the distributions, with tails as long as every combination of their ends is a scene.

    Those of `shared` factors are all cut at one place, so that they stay together, and within their ranges.
    """
    for tails in _TAILS:
        found = [_entry(one, min(tails, REACH) if one.name in shared else tails) for one in estimates]
        if _corners_are_scenes(scene, estimates, found):
            break
    return found


def _corners_are_scenes(scene: Scene, estimates: Sequence[Estimate], entries: Sequence[_Entry]) -> bool:
    names = [one.name for one in estimates]
    try:
        for corner in itertools.product(*((entry.low, entry.high) for entry in entries)):
            scene_at(scene.values, names, np.array(corner))
    except InputError:
        return False
    return True


def _entry(one: Estimate, tails: float) -> _Entry:
    if one.kind == NOT_IDENTIFIABLE:
        return _Entry(f'distribution: uniform, low: {one.low!r}, high: {one.high!r}', one.low, one.high)
    spread = _spread(one)
    if one.kind not in (FOUND, VOID):
        return _one_sided(one, spread)
    law, number = ('lognormal', math.exp(spread)) if one.logarithmic else ('normal', spread)
    numbers = one.value, number
    low, high = _allowed(one.name, moved(one, -tails * spread), moved(one, tails * spread))
    if Distribution(one.name, law, numbers, low, high).kept < LEAST_KEPT:
        return _one_sided(one, spread)
    words = ', '.join(f'{name}: {number!r}' for name, number in zip(LAWS[law].numbers, numbers, strict=True))
    return _Entry(f'distribution: {law}, {words}, between: [{low!r}, {high!r}]', low, high)


def _one_sided(one: Estimate, spread: float) -> _Entry:
    """Return what falls from the end of a range inwards, over two standard deviations."""
    inward = 1.0 if one.value - one.low <= one.high - one.value else -1.0
    low, high = sorted((one.value, min(max(moved(one, 2.0 * inward * spread), one.low), one.high)))
    return _Entry(f'distribution: triangular, low: {low!r}, mode: {one.value!r}, high: {high!r}', low, high)


def _spread(one: Estimate) -> float:
    """Return the standard deviation, of the logarithm where the fit took it, between that of rounding and the range."""
    width = math.log(one.high / one.low) if one.logarithmic else one.high - one.low
    known = one.standard_deviation if math.isfinite(one.standard_deviation) else 0.0
    return max(min(known, width), _NARROWEST * (1.0 if one.logarithmic else _size(one)))


def _size(one: Estimate) -> float:
    return max(abs(one.value), one.high - one.low)


def _allowed(name: str, low: float, high: float) -> tuple[float, float]:
    """Return a range within that of the parameter."""
    entry, _ = parameter_of(name)
    return (low if entry.low is None else max(low, entry.low)), (high if entry.high is None else min(high, entry.high))


def _correlation_lines(estimates: Sequence[Estimate], correlation: Numbers) -> Iterator[str]:
    if len(estimates) < 2:    # none where numbers of sensors alone were free
        return
    matrix = _definite(estimates, correlation)
    names = [one.name for one in estimates]
    rows = [[(names[j], matrix[i, j]) for j in range(i) if abs(matrix[i, j]) > _WEAKEST] for i in range(len(names))]
    if any(rows):
        yield 'correlations:'
    for name, row in zip(names, rows):
        if row:
            yield f'  {_key(name)}: {{{", ".join(f"{_key(other)}: {number:.6f}" for other, number in row)}}}'


def _definite(estimates: Sequence[Estimate], correlation: Numbers) -> Numbers:
    """Return the correlations of numbers that were found, shrunk until they are definite; 0 for all others."""
    known = np.array([one.kind in (FOUND, VOID) for one in estimates])
    matrix = np.where(np.isfinite(correlation) & known & known[:, None], correlation, 0.0)
    matrix[np.abs(matrix) <= _WEAKEST] = 0.0
    np.fill_diagonal(matrix, 1.0)
    shrink = _SHRINK
    while np.linalg.eigvalsh(matrix)[0] < _LEAST or np.abs(matrix - np.eye(len(matrix))).max(initial=0.0) > 0.999999:
        matrix = (1.0 - shrink) * matrix + shrink * np.eye(len(matrix))
        shrink *= 2.0
    return matrix


def _key(name: str) -> str:
    return f'"{name}"' if '[' in name else name
