# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where a fit may go: within the ranges, static friction not below kinetic friction, nor its limit below its start.

Beyond such a border the axis stays what it is (`friction_tables.put_in_order` raises the lower number), so that a fit
which goes there finds no way back: its sum of squares does not change with the number that is too low.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ...core.arrays import Numbers
from ..given.free_parameters import FreeParameter

_KINETIC, _STATIC = 'friction.kinetic.', 'friction.static.'


class Region:
    """Points (k,) between `low` and `high`, in which numbers of a chain do not fall.

    `chain` has their places, and `scales` (k,) what makes them comparable: one times the other is in order.
    """

    def __init__(self, low: Numbers, high: Numbers, chain: Sequence[int] = (), scales: Numbers | None = None) -> None:
        self._chain = tuple(chain)
        self._scales = np.ones(len(low)) if scales is None else scales
        self.low, self.high = low.copy(), high.copy()
        for before, after in self._pairs:
            self.low[after] = max(low[after], self._likened(self.low, before, after))
        for before, after in self._pairs[::-1]:
            self.high[before] = min(high[before], self._likened(self.high, after, before))
        ends = np.diag(self._scales)
        rises = [ends[after] - ends[before] for before, after in self._pairs]
        self._normals = np.stack([*np.eye(len(low)), *-np.eye(len(low)), *rises])
        self._limits = np.concatenate([self.low, -self.high, np.zeros(len(rises))])

    @property
    def _pairs(self) -> list[tuple[int, int]]:
        return list(zip(self._chain, self._chain[1:]))

    def _likened(self, point: Numbers, place: int, other: int) -> float:
        """Return the number at another place that is as large as the one at a place."""
        return float(point[place] * self._scales[place] / self._scales[other])

    def inside(self, point: Numbers) -> Numbers:
        """Return the point with numbers out of their range at its end, and those too low in the chain raised."""
        found = np.clip(point, self.low, self.high)
        for before, after in self._pairs:
            found[after] = max(found[after], self._likened(found, before, after))
        return np.asarray(found)

    def at(self, shares: Numbers) -> Numbers:
        """Return the point at shares (k,) of what each number has left above those before it in the chain."""
        found = self.low + shares * (self.high - self.low)
        for before, after in self._pairs:
            least = max(self.low[after], self._likened(found, before, after))
            found[after] = least + shares[after] * (self.high[after] - least)
        return np.asarray(found)

    def holding(self, place: int, number: float) -> 'Region':
        """Return the points of it that have a number at a place."""
        low, high = self.low.copy(), self.high.copy()
        low[place] = high[place] = number
        return Region(low, high, self._chain, self._scales)

    def borders(self, point: Numbers) -> tuple[Numbers, Numbers]:
        """Return inward normals (m, k) of the borders, and how far in a point is along each (m,), rounding left out."""
        return self._normals, np.maximum(self._normals @ point - self._limits, 0.0)


def region_of(parameters: Sequence[FreeParameter], values: Mapping[str, object]) -> Region:
    """Return where parameters may go, the other numbers being those of a scene, its `values`."""
    low = np.array([one.inner(one.low) for one in parameters])
    high = np.array([one.inner(one.high) for one in parameters])
    places = {one.name: k for k, one in enumerate(parameters)}
    floor, chain = 0.0, []
    for name, value in _rising(values):
        if name in places:
            chain.append(places[name])
            one = parameters[chain[-1]]
            low[chain[-1]] = min(max(low[chain[-1]], one.inner(max(floor, one.low))), high[chain[-1]])
        else:
            floor = max(floor, value)
    if len({parameters[k].logarithmic for k in chain}) > 1:
        return Region(low, high)   # one by its logarithm, and one not: the model alone puts them in order
    found = Region(low, high, chain, np.array([1.0 if one.logarithmic else one.high - one.low for one in parameters]))
    return found if bool(np.all(found.low <= found.high)) else Region(low, high)


def _rising(values: Mapping[str, object]) -> Iterator[tuple[str, float]]:
    """Yield the coefficients of which none is below the one before, and what they are in a scene."""
    kinetic = values.get(_KINETIC + 'initial')
    if kinetic is None:
        coefficients = values[_KINETIC + 'coefficients']
        assert isinstance(coefficients, tuple)
        yield _KINETIC + 'coefficients[0]', float(coefficients[0])
    else:
        yield _KINETIC + 'initial', float(str(kinetic))
    for name in (_STATIC + 'initial', _STATIC + 'limit'):
        if name in values:
            yield name, float(str(values[name]))
