# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""When the steps end in simulation time.  Knows no clock."""

import math
from fractions import Fraction

from .types import Instant, tuple_of


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
