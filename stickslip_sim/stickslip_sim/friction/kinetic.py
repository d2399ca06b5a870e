# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Kinetic friction over speed, and the excess of its accelerating branch, as piecewise-linear tables.

Both start at speed 0.  The kinetic coefficient continues beyond its last breakpoint with `end_slope`; the excess shape
psi (Fig. 6 of the paper) falls from 1 to 0 and stays there.
"""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

from ..core import ranges
from ..core.errors import InputError
from .smooth import SmoothExcess, SmoothKinetic

MAX_BREAKPOINTS = 1000   # a table is walked at every break-away, within a step
_APART = 1e-8   # of a speed; on a jump between nearer ones friction is lost in the rounding of the speed


@dataclass(frozen=True, slots=True)
class KineticTable:
    """mu_k(|ẋ|): breakpoints `velocities` in m/s and `coefficients`; `end_slope` in s/m beyond the last breakpoint.

    A table made by `tables.kinetic_table` carries the smooth `law` that it stands for, its `error`, the largest
    difference to that law at any speed, and the `tolerance` that was asked for.
    """

    velocities: tuple[float, ...]
    coefficients: tuple[float, ...]
    end_slope: float = 0.0
    law: SmoothKinetic | None = None
    error: float = 0.0
    tolerance: float = 0.0

    def __post_init__(self) -> None:
        name = 'friction.kinetic'
        _check_breakpoints(name, self.velocities, 'coefficients', self.coefficients)
        for value in self.coefficients:
            ranges.COEFFICIENT.check_meaning(f'{name}.coefficients', value, '', 'friction opposes the motion')
        ranges.SLOPE.check_meaning(f'{name}.end_slope', self.end_slope, 's/m',
                                   'a coefficient that fell for ever would become negative; add a breakpoint instead')

    @property
    def limit_velocity(self) -> float:
        """The end of the falling branch, v_gr in m/s: the last breakpoint, or that of the smooth law."""
        return self.velocities[-1] if self.law is None else self.law.limit_velocity

    def coefficient(self, speed: float) -> float:
        """Return mu_k at a speed >= 0 m/s."""
        return _interpolate(self.velocities, self.coefficients, speed, self.end_slope)

    def slopes(self, speed: float) -> tuple[float, float]:
        """Return dmu_k/dw in s/m just below and just above a speed >= 0 m/s; of the smooth law if any."""
        if self.law is not None:
            return self.law.slope(speed), self.law.slope(speed)
        above = _slope_above(self.velocities, self.coefficients, speed, self.end_slope)
        if speed not in self.velocities[1:]:
            return above, above
        upper = self.velocities.index(speed)
        return _slope_above(self.velocities, self.coefficients, self.velocities[upper - 1], self.end_slope), above


@dataclass(frozen=True, slots=True)
class ExcessTable:
    """psi(|ẋ|), the shape of the excess of the accelerating branch: 1 at rest, falling to 0 at the last breakpoint.

    A table made by `tables.excess_table` carries the smooth `law` that it stands for, and its `error`.
    """

    velocities: tuple[float, ...]
    fractions: tuple[float, ...]
    law: SmoothExcess | None = None
    error: float = 0.0

    def __post_init__(self) -> None:
        name = 'friction.excess'
        _check_breakpoints(name, self.velocities, 'fractions', self.fractions)
        if self.fractions[0] != 1.0 or self.fractions[-1] != 0.0:
            raise InputError(f'{name}.fractions', self.fractions, '1 at the first and 0 at the last breakpoint',
                             'psi is relative to the excess at the break-away')
        if any(b > a for a, b in pairwise(self.fractions)):
            raise InputError(f'{name}.fractions', self.fractions, 'falling from 1 to 0', 'sort them')

    def fraction(self, speed: float) -> float:
        """Return psi at a speed >= 0 m/s."""
        return _interpolate(self.velocities, self.fractions, speed, 0.0)


@lru_cache(maxsize=8)
def merged_breakpoints(
    kinetic: KineticTable, excess: ExcessTable | None
) -> tuple[tuple[float, float, float, float, float, float], ...]:
    """Return (velocity, the next one, mu_k, psi) at every breakpoint of the two tables, and both slopes above, s/m.

    Behind the last breakpoint the next velocity is infinite.  The slopes are those of the given tables: between
    breakpoints of both, close together, the difference of two rounded coefficients would have few digits.  psi is 0
    without an excess.
    """
    speeds = sorted({*kinetic.velocities, *(excess.velocities if excess else ())})
    return tuple((v, end, kinetic.coefficient(v), excess.fraction(v) if excess else 0.0,
                  _slope_above(kinetic.velocities, kinetic.coefficients, v, kinetic.end_slope),
                  _slope_above(excess.velocities, excess.fractions, v, 0.0) if excess else 0.0)
                 for v, end in pairwise((*speeds, math.inf)))


def default_excess(kinetic: KineticTable) -> ExcessTable:
    """Return the linear psi from 1 at standstill to 0 at the limit velocity of mu_k.

    Raises InputError when a given table has one breakpoint only, and so no limit velocity.
    """
    if kinetic.limit_velocity == 0.0:
        raise InputError('friction.excess', None, 'a table when friction.kinetic has one breakpoint only',
                         'give friction.excess.velocities and fractions, or acceleration_dependence: false')
    return ExcessTable((0.0, kinetic.limit_velocity), (1.0, 0.0))


def _interpolate(xs: Sequence[float], ys: Sequence[float], x: float, end_slope: float) -> float:
    i = bisect_right(xs, x) - 1
    return ys[i] + _slope_above(xs, ys, x, end_slope) * (x - xs[i])


def _slope_above(xs: Sequence[float], ys: Sequence[float], x: float, end_slope: float) -> float:
    i = bisect_right(xs, x) - 1
    return end_slope if i + 1 == len(xs) else (ys[i + 1] - ys[i]) / (xs[i + 1] - xs[i])


def _check_breakpoints(name: str, velocities: Sequence[float], other: str, values: Sequence[float]) -> None:
    if not velocities or len(velocities) != len(values):
        raise InputError(f'{name}.velocities', list(velocities), f'as many numbers as {name}.{other} ({len(values)})',
                         'give one value for every breakpoint')
    if len(velocities) > MAX_BREAKPOINTS:
        raise InputError(f'{name}.velocities', f'{len(velocities)} breakpoints',
                         f'at most {MAX_BREAKPOINTS} breakpoints',
                         'leave out those that are nearly on a line between others')
    if velocities[0] != 0.0:
        raise InputError(f'{name}.velocities', velocities[0], '0 m/s at the first breakpoint',
                         'the table starts at standstill')
    for before, after in pairwise(velocities):
        if not before < after < math.inf:
            raise InputError(f'{name}.velocities', list(velocities), 'finite and strictly increasing, in m/s',
                             f'{after!r} follows {before!r}; sort the breakpoints and drop double ones')
        if after - before < _APART * after:
            raise InputError(f'{name}.velocities', [before, after], f'at least {_APART * after:.3g} m/s apart, '
                             f'{_APART:g} of the speed', f'they are {after - before:.3g} m/s apart; drop one of them')
