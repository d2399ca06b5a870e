# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""When the steps end in simulation time.  Knows no clock."""

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .types import Instant, tuple_of

NANOSECONDS = 1_000_000_000   # of a second
_WHOLE = 2 ** 53   # up to which integers are floats, too


class Instants(NamedTuple):
    """Instants in the order of time, as two arrays."""

    seconds: NDArray[np.float64]     # whole ones
    fractions: NDArray[np.float64]   # s

    def before(self, instant: Instant, *, included: bool = False) -> int:
        """Return how many of them are before an instant, or at it."""
        first = int(np.searchsorted(self.seconds, instant.second, 'left'))
        last = int(np.searchsorted(self.seconds, instant.second, 'right'))
        return first + int(np.searchsorted(self.fractions[first:last], instant.fraction,
                                           'right' if included else 'left'))

    def nanoseconds(self) -> NDArray[np.int64]:
        """Return them rounded to nanoseconds, as `Instant.nanoseconds` does."""
        return self.seconds.astype(np.int64) * NANOSECONDS + np.rint(self.fractions * 1e9).astype(np.int64)

    def part(self, first: int, last: int) -> 'Instants':
        """Return those from one place up to another."""
        return Instants(self.seconds[first:last], self.fractions[first:last])


class Grid:
    """The times of the steps: step n ends at n / rate, exact for every rate (1/s, > 0)."""

    def __init__(self, rate: float) -> None:
        self.rate = rate
        self._up, self._down = decimal(rate).as_integer_ratio()

    def instant(self, step: int) -> Instant:
        """Return the simulation time at which a step ends."""
        second, rest = divmod(step * self._down, self._up)
        return tuple_of(Instant, (float(second), rest / self._up))

    def nanoseconds(self, step: int) -> int:
        """Return that time rounded to nanoseconds."""
        return self.instant(step).nanoseconds

    def steps(self, seconds: float) -> int:
        """Return in how many steps this much time has passed; exact, as both numbers are meant as decimals."""
        return math.ceil(decimal(seconds) * self._up / self._down)


def decimal(number: float) -> Fraction:
    """Return the decimal number that a float was written as, so that 3333 steps at 333.3 Hz take 10 s."""
    return Fraction(repr(number))


def instants(period: Fraction, first: int, last: int) -> Instants:
    """Return k · period for k from `first` on and before `last`, each rounded once."""
    count, size = period.numerator, period.denominator
    if size <= _WHOLE and last * count < 2 ** 63:
        whole, rest = np.divmod(np.arange(first, last, dtype=np.int64) * count, size)
        return Instants(whole.astype(np.float64), rest / size)
    pairs = [instant_of(k * period) for k in range(first, last)]
    return Instants(np.array([pair.second for pair in pairs]), np.array([pair.fraction for pair in pairs]))


def instant_of(time: Fraction) -> Instant:
    """Return a time as an instant, rounded once: to the next second where its fraction would be 1."""
    second, rest = divmod(time.numerator, time.denominator)
    fraction = rest / time.denominator
    return Instant(float(second), fraction) if fraction < 1.0 else Instant(second + 1.0, 0.0)


def multiples(period: Fraction, first: int, last: int) -> NDArray[np.float64]:
    """Return k · period for k from `first` on and before `last`, each as one number, rounded once."""
    count, size = period.numerator, period.denominator
    if size <= _WHOLE and last * count <= _WHOLE:
        return np.arange(first, last, dtype=np.int64) * count / size
    return np.array([k * count / size for k in range(first, last)], dtype=np.float64)
