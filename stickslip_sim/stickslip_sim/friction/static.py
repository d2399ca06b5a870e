# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Static friction that rises with the rest time t⁻.

| law         | mu_s(t)                                       | source                          |
|-------------|-----------------------------------------------|---------------------------------|
| constant    | mu_0                                          | Coulomb                         |
| exponential | mu_inf − (mu_inf − mu_0) exp(−t/τ)            | the paper                       |
| kato        | mu_inf − (mu_inf − mu_0) exp(−(t/τ)ⁿ)         | Kato, Sato and Matsubayashi 1972|
| hyperbolic  | mu_0 + (mu_inf − mu_0) t/(t + τ)              |                                 |
| logarithmic | mu_0 + (mu_inf − mu_0) ln(1 + t/τ), unbounded | Dieterich 1978                  |

With a delay t is what the rest time is beyond that, and mu_s = mu_0 before.
"""

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

from ..core import ranges
from ..core.errors import InputError
from ..core.hot_path import compiled, inlined


class StaticLawKind(IntEnum):
    """The shape of mu_s(t⁻)."""

    CONSTANT = 0
    EXPONENTIAL = 1
    KATO = 2
    HYPERBOLIC = 3
    LOGARITHMIC = 4


CONSTANT = int(StaticLawKind.CONSTANT)
EXPONENTIAL = int(StaticLawKind.EXPONENTIAL)
KATO = int(StaticLawKind.KATO)
HYPERBOLIC = int(StaticLawKind.HYPERBOLIC)
LOGARITHMIC = int(StaticLawKind.LOGARITHMIC)


@dataclass(frozen=True, slots=True)
class StaticLaw:
    """mu_s(t⁻): `initial` mu_0, `limit` mu_inf, `time_constant` τ in s, `exponent` n of Kato's law.

    It begins to grow after a `delay` in s.  Raises InputError when the coefficient would be negative or fall with the
    rest time.
    """

    kind: StaticLawKind
    initial: float
    limit: float
    time_constant: float = 1.0
    exponent: float = 1.0
    delay: float = 0.0

    def __post_init__(self) -> None:
        ranges.COEFFICIENT.check_meaning('friction.static.initial', self.initial, '', 'give mu_s at zero rest time')
        if self.kind == StaticLawKind.CONSTANT:
            return
        if not self.initial <= self.limit < math.inf:
            raise InputError('friction.static.limit', self.limit, f'finite and >= initial ({self.initial!r})',
                             'static friction grows with rest time; swap the two values or use law: constant')
        ranges.TIME_CONSTANT.check_meaning('friction.static.time_constant', self.time_constant, 's',
                                           'use law: constant for a coefficient that does not grow')
        ranges.KATO_EXPONENT.check_meaning('friction.static.exponent', self.exponent, '',
                                           'n = 1 is the exponential law')
        ranges.TIME.check_meaning('friction.static.delay', self.delay, 's', 'use 0 for a growth from the arrest on')

    @property
    def bounded(self) -> bool:
        """Whether mu_s stays finite upon infinite rest."""
        return self.kind != StaticLawKind.LOGARITHMIC

    def coefficient(self, rest_time: float) -> float:
        """Return mu_s after `rest_time` seconds (infinite is allowed for a bounded law)."""
        return static_coefficient(int(self.kind), self.initial, self.limit, self.time_constant, self.exponent,
                                  max(rest_time - self.delay, 0.0))


@inlined
def static_coefficient(kind: float, initial: float, limit: float, tau: float, exponent: float, rest: float) -> float:
    """Return mu_s(rest)."""
    if kind == CONSTANT or rest == 0.0:
        return initial
    rise = limit - initial
    if rest == math.inf:
        return limit
    if kind == EXPONENTIAL:
        return initial - rise * math.expm1(-rest / tau)
    if kind == KATO:
        return initial - rise * math.expm1(-_power(rest / tau, exponent))
    if kind == HYPERBOLIC:
        return initial + rise * (rest / (rest + tau))
    return initial + rise * math.log1p(rest / tau)


class StaticGrowth(NamedTuple):
    """mu_s at a rest time, and how it grows; under Kato's law with n < 1 the last two are infinite at rest 0."""

    coefficient: float
    rate: float        # 1/s
    curvature: float   # 1/s², a bound on −mu_s″ from there on; −mu_s″ itself for a concave law


@inlined
def static_growth(kind: float, initial: float, limit: float, tau: float, exponent: float, rest: float
                 ) -> StaticGrowth:
    """Return mu_s and how it grows at `rest`."""
    if kind == CONSTANT or limit == initial:
        return StaticGrowth(initial, 0.0, 0.0)
    if rest == math.inf:
        return StaticGrowth(limit, 0.0, 0.0)
    rise = limit - initial
    z = rest / tau
    if kind == EXPONENTIAL:
        risen = math.expm1(-z)
        slope = rise / tau * (1.0 + risen)
        return StaticGrowth(initial - rise * risen, slope, slope / tau)
    if kind == KATO:
        slope, curvature = _kato_growth(rise / tau, tau, exponent, z)
        return StaticGrowth(static_coefficient(kind, initial, limit, tau, exponent, rest), slope, curvature)
    if kind == HYPERBOLIC:
        slope = rise / tau / ((1.0 + z) * (1.0 + z))
        return StaticGrowth(initial + rise * (rest / (rest + tau)), slope, 2.0 * slope / (tau * (1.0 + z)))
    slope = rise / tau / (1.0 + z)
    return StaticGrowth(initial + rise * math.log1p(z), slope, slope / (tau * (1.0 + z)))


@compiled
def _power(z: float, n: float) -> float:
    """Return zⁿ for z >= 0, and infinity where it leaves the range of numbers."""
    if z == 0.0:
        return 0.0 if n > 0.0 else math.inf
    return math.inf if n * math.log(z) > 700.0 else z ** n


@compiled
def _kato_growth(rise: float, tau: float, n: float, z: float) -> tuple[float, float]:
    """Return the last two of `static_growth`.

    −mu_s″ τ²/Δmu = exp(−s) (n² s^(2−2/n) + n (1−n) s^(1−2/n)) with s = zⁿ; for n > 1 its first term peaks at
    s = 2 − 2/n, and the other is negative.
    """
    if z == 0.0 and n < 1.0:
        return math.inf, math.inf
    s = _power(z, n)
    decay = math.exp(-s)
    if decay == 0.0:
        return 0.0, 0.0
    slope = rise * n * decay * (_power(z, n - 1.0) if n != 1.0 else 1.0)
    if n > 1.0:
        s = max(s, 2.0 - 2.0 / n)
        return slope, rise / tau * n * n * s ** (2.0 - 2.0 / n) * math.exp(-s)
    if z == 0.0:
        return slope, rise / tau
    first = n * n * _power(z, 2.0 * n - 2.0) + n * (1.0 - n) * _power(z, n - 2.0)
    return slope, rise / tau * first * decay
