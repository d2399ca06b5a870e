# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What an identification may change: parameters of a scene, and offsets and scales of sensors, with their ranges.

A file of them has the format of `stickslip uncertainty --with`; beside the parameters of a scene it may name
`sensor.CHANNEL.offset` and `sensor.CHANNEL.scale`: measured = offset + scale · true; and `sensor.CHANNEL.delay`: what
is read of a measured input acts so much later, what is read of a channel is that of so much earlier.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..scene import Scene
from ..scene.parameter import Parameter
from ..study.sample import Distribution
from ..study.uncertainty import load_uncertain, uncertain_of
from ..study.variation import parameter_of
from .readings import UNITS

DELAY = 'delay'
_OFFSET, _SCALE = 'offset', 'scale'
_SCATTER = 'friction.static.scatter'   # left out: 0
_MOST = 40   # parameters: about as many as an axis has


@dataclass(frozen=True)
class FreeParameter:
    """A parameter that is sought between `low` and `high`, from `start`, all in `unit`.

    The fit works on its logarithm where the range is above 0, else on shares of its range.  `prior` is the mean and the
    standard deviation there, None where the file says only the range.
    """

    name: str
    unit: str
    start: float
    low: float
    high: float
    prior: tuple[float, float] | None = None

    @property
    def logarithmic(self) -> bool:
        """Whether the fit works on the logarithm."""
        return self.low > 0.0

    @property
    def sensor(self) -> tuple[str, str] | None:
        """The channel and `offset`, `scale` or `delay`; None of a parameter of the scene."""
        first, *rest = self.name.split('.')
        return (rest[0], rest[1]) if first == 'sensor' else None

    @property
    def width(self) -> float:
        """The width of the range, as the fit sees it; 1 of one that is held."""
        return self.inner(self.high) - self.inner(self.low) or 1.0

    @property
    def _range(self) -> float:
        """The width of the range in the unit; 1 of one that is held."""
        return self.high - self.low or 1.0

    def inner(self, value: float) -> float:
        """Return what the fit works on."""
        return math.log(value) if self.logarithmic else value / self._range

    def outer(self, number: float) -> float:
        """Return the value of what the fit works on, kept within the range."""
        inside = min(max(number, self.inner(self.low)), self.inner(self.high))   # before exp, which may overflow
        value = math.exp(inside) if self.logarithmic else inside * self._range
        return min(max(value, self.low), self.high)


def values_at(parameters: Sequence[FreeParameter], point: Numbers) -> Numbers:
    """Return the values (k,) of parameters, in their units, at a point (k,) of what the fit works on."""
    return np.array([one.outer(number) for one, number in zip(parameters, point.tolist(), strict=True)])


def free_parameters(scene: Scene, free: str | Path | Mapping[str, object]) -> tuple[FreeParameter, ...]:
    """Return the free parameters of a file, or of its section `parameters`; raises InputError."""
    if isinstance(free, Mapping):
        found = uncertain_of(free if 'parameters' in free else {'parameters': free}, _parameter, _MOST)
    else:
        found = load_uncertain(free, _parameter, _MOST)
    if found.correlations is not None:
        raise InputError('correlations', 'given', 'omitted here: the fit finds the correlations',
                         'drop the section')
    return tuple(_free(scene, distribution) for distribution in found.distributions)


def _parameter(name: str) -> tuple[Parameter, int | None]:
    """Return a parameter of a scene or of a sensor; raises InputError."""
    if not name.startswith('sensor.'):
        return parameter_of(name)
    _, channel, what, *more = [*name.split('.'), '', '']
    if channel not in UNITS or what not in (_OFFSET, _SCALE, DELAY) or any(more):
        raise InputError('free parameter', name, f'sensor.CHANNEL.{_OFFSET}, .{_SCALE} or .{DELAY}, CHANNEL one of '
                         + ', '.join(UNITS), 'for example sensor.drive_force.scale')
    if what == DELAY:
        return Parameter(name, 'double', 0.0, 's', 'the delay of its sensor', low=-1.0, high=1.0), None
    if what == _OFFSET:
        return Parameter(name, 'double', 0.0, UNITS[channel], 'added to the truth', low=-1e15, high=1e15), None
    return Parameter(name, 'double', 1.0, '', 'factor on the truth', low=1e-6, high=1e6), None


def _free(scene: Scene, distribution: Distribution) -> FreeParameter:
    name, low, high = distribution.name, distribution.low, distribution.high
    start = _start(scene, name)
    if not math.isfinite(start):
        raise InputError(name, start, 'finite in the scene to start from', 'give it a number there')
    if not low <= start <= high:
        raise InputError(name, start, f'in its range [{low:g}, {high:g}] in the scene to start from',
                         'widen the range, or start from another value')
    found = FreeParameter(name, _parameter(name)[0].unit, start, low, high)
    return replace(found, prior=_prior(distribution, found))


def _start(scene: Scene, name: str) -> float:
    """Return the value in the scene to start from; raises InputError where the scene has no such parameter."""
    entry, index = _parameter(name)
    value = scene.values.get(entry.name, 0.0 if entry.name.startswith(_SCATTER) else entry.default)
    if entry.when is not None and not entry.when.holds(scene.values):
        raise InputError('free parameter', name, f'one that the laws of the scene have: it goes with {entry.when}',
                         'leave it out, or choose that law in the scene to start from')
    if entry.name.endswith('.velocities') and index == 0:
        raise InputError('free parameter', name, 'not the first breakpoint of a table: it is at rest, 0 m/s',
                         'leave it out')
    if index is not None:
        if not isinstance(value, tuple) or index >= len(value):
            raise InputError('free parameter', name, f'an element of {entry.name} of the scene to start from',
                             'count from 0')
        value = value[index]
    if not isinstance(value, float):
        raise InputError('free parameter', name, 'a number that the scene to start from has', 'give it there')
    return value


def _prior(distribution: Distribution, parameter: FreeParameter) -> tuple[float, float] | None:
    """Return mean and standard deviation of a normal or lognormal distribution, as the fit sees the parameter."""
    if distribution.law not in ('normal', 'lognormal'):
        return None
    middle, spread = distribution.numbers
    if distribution.law == 'lognormal':
        return (math.log(middle), math.log(spread)) if parameter.logarithmic else None
    if parameter.logarithmic:
        return (math.log(middle), spread / middle) if middle > 0.0 else None
    width = parameter.high - parameter.low
    return middle / width, spread / width


# Where a fit may go: within the ranges, static friction not below kinetic friction, nor its limit below its start,
# whether they are free or those of the scene.
#
# Beyond such a border the axis stays what it is (`axis_model.put_in_order` raises the lower number), so that a fit
# which goes there finds no way back: its sum of squares does not change with the number that is too low.

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

    def holding(self, places: int | Sequence[int], numbers: float | Numbers) -> 'Region':
        """Return the points of it that have a number at a place, or numbers at places."""
        low, high = self.low.copy(), self.high.copy()
        low[places] = high[places] = numbers
        return Region(low, high, self._chain, self._scales)

    def borders(self, point: Numbers) -> tuple[Numbers, Numbers]:
        """Return inward normals (m, k) of the borders, and how far in a point is along each (m,), rounding left out."""
        return self._normals, np.maximum(self._normals @ point - self._limits, 0.0)


def region_of(parameters: Sequence[FreeParameter], values: Mapping[str, object]) -> Region:
    """Return where parameters may go, the other numbers being those of a scene, its `values`."""
    low = np.array([one.inner(one.low) for one in parameters])
    high = np.array([one.inner(one.high) for one in parameters])
    places = {one.name: k for k, one in enumerate(parameters)}
    floor, ceiling, chain, rising = 0.0, np.inf, [], tuple(_rising(values))
    for name, value in rising:
        if name in places:
            chain.append(places[name])
            one = parameters[chain[-1]]
            low[chain[-1]] = min(max(low[chain[-1]], one.inner(max(floor, one.low))), high[chain[-1]])
        else:
            floor = max(floor, value)
    for name, value in reversed(rising):
        if name in places:
            one = parameters[places[name]]
            high[places[name]] = max(one.inner(min(ceiling, one.high)), low[places[name]])
        else:
            ceiling = min(ceiling, value)
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
