# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Correlations of parameters that are not known exactly: given pair by pair, drawn by a Gaussian copula.

    correlations:
      axis.mass: {axis.normal_force: 0.93, friction.static.limit: -0.2}

A pair that is not named is independent.  The numbers are of the normal scores Φ⁻¹(share) of two parameters: for normal
distributions of the parameters themselves, for lognormal ones of their logarithms.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ..config.strict import section
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..scene import Parameter

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
        raise InputError('correlations', [list(row) for row in matrix.tolist()], 'a positive definite matrix: no '
                         'numbers are correlated like this', 'bring those that are near 1 or -1 nearer to 0')
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
