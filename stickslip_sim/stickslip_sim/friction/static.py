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

With a scatter each stick has a law of its own: mu_0 and mu_inf times a factor that is drawn as the stick begins,
neither below mu_k at rest, which every stick holds.  The draw depends on the seed and the index of the stick alone.
"""

import math
from dataclasses import dataclass, replace
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
class Scatter:
    """How mu_s scatters: relative standard deviations from stick to stick, `deviation`, and from run to run, `of_run`.

    `seed` is that of the run, 0 or more.  Raises InputError.
    """

    deviation: float
    of_run: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        for name, value in (('scatter', self.deviation), ('scatter_run', self.of_run)):
            if not ranges.SCATTER.low <= value <= ranges.SCATTER.high:
                raise InputError(f'friction.static.{name}', value, f'>= 0 and <= {ranges.SCATTER.high:g}',
                                 'it is relative to mu_s; use 0 for a law without scatter')
        if self.seed < 0:
            raise InputError('seed', self.seed, '>= 0', 'use 0')

    @property
    def key(self) -> float:
        """The seed as the draws take it, well mixed: seeds that follow each other share nothing."""
        seed = self.seed % _KEYS
        words = mixed_words(seed % _WORD, seed // _WORD, 0.0, 0.0)
        return words.left + words.right * _WORD

    def factor(self, stick: int) -> float:
        """Return the factor on mu_s of a stick: 0 for the one that a run may begin with, then one more each."""
        return stick_factor(self.key, self.deviation, self.of_run, float(stick))


@dataclass(frozen=True, slots=True)
class StaticLaw:
    """mu_s(t⁻): `initial` mu_0, `limit` mu_inf, `time_constant` τ in s, `exponent` n of Kato's law.

    It begins to grow after a `delay` in s.  With a `scatter` these are its means.  Raises InputError when the
    coefficient would be negative or fall with the rest time.
    """

    kind: StaticLawKind
    initial: float
    limit: float
    time_constant: float = 1.0
    exponent: float = 1.0
    delay: float = 0.0
    scatter: Scatter | None = None

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

    def of_stick(self, stick: int, at_rest: float) -> 'StaticLaw':
        """Return the law of one stick, by its index; `at_rest` is mu_k(0), which it does not fall below."""
        if self.scatter is None:
            return self
        factor = self.scatter.factor(stick)
        initial = max(factor * self.initial, at_rest)
        return replace(self, initial=initial, limit=max(factor * self.limit, initial), scatter=None)


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


# The draws of the scatter.  A generator that counts: no state but the index of the stick, so that a run goes on from a
# checkpoint, in parts or in another solver with the same draws.  Words of 26 bits, whose squares doubles hold exactly.

_TURN = 2.0 * math.pi
_WORD = 67108864.0            # 2²⁶
_HALF_WORD = 8192.0           # 2¹³
_STEP = 41475559.0            # of the key from round to round: the golden section of a word
_ROUNDS = 16                  # of a Feistel network over two words with the middle of a square; 8 pass all tests
_KEYS = 2 ** 52 - 47          # a prime
_ATTEMPTS = 64                # at a draw within the bounds; at least 95 % succeed
_ATTEMPT_STEP = 1048576.0     # 2²⁰, of the upper word of the counter
_RUN = 35184372088832.0       # 2⁴⁵, the counter of the draw of the run: no stick has it


@compiled
def stick_factor(key: float, deviation: float, of_run: float, stick: float) -> float:
    """Return the factor on mu_s of a stick: that of the run times its own."""
    return _drawn_factor(key, of_run, _RUN) * _drawn_factor(key, deviation, stick)


@compiled
def _drawn_factor(key: float, deviation: float, counter: float) -> float:
    """Return 1 + deviation z, with z normal and so bounded on both sides that the factor is above 0."""
    if deviation == 0.0:
        return 1.0
    for attempt in range(_ATTEMPTS):
        z = _normal(key, counter, float(attempt))
        if deviation * abs(z) < 1.0:
            return 1.0 + deviation * z
    return 1.0


@compiled
def _normal(key: float, counter: float, attempt: float) -> float:
    """Return a standard normal number, by Box and Muller's transform of two words."""
    upper, even = math.floor(counter / _WORD), math.floor(key / _WORD)
    words = mixed_words(counter - upper * _WORD, upper + attempt * _ATTEMPT_STEP, key - even * _WORD, even)
    return math.sqrt(-2.0 * math.log((words.left + 1.0) / _WORD)) * math.cos(_TURN * words.right / _WORD)


class Words(NamedTuple):
    """Two words, whole numbers from 0 to 2²⁶ − 1."""

    left: float
    right: float


@compiled
def mixed_words(left: float, right: float, odd: float, even: float) -> Words:
    """Return two words from two others and two of a key, each bit of which depends on all bits of these."""
    for _ in range(_ROUNDS):
        root = left + odd
        if root >= _WORD:
            root -= _WORD
        word = right + math.floor(root * root / _HALF_WORD)
        word -= math.floor(word / _WORD) * _WORD
        right = left
        left = word
        root = odd + _STEP
        odd = even
        even = root - _WORD if root >= _WORD else root
    return Words(left, right)
