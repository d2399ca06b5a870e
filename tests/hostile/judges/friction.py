# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The characteristics of friction once more, from the tables and laws as given."""

import math
from bisect import bisect_right
from typing import Any, NamedTuple

import numpy as np

from stickslip_sim.axis import Axis, Friction
from stickslip_sim.friction import StaticLaw, StaticLawKind

Long = np.longdouble


class Line(NamedTuple):
    """value + slope (w − at)."""

    at: Any
    value: Any
    slope: Any

    def of(self, speed: Any) -> Any:
        """Return the value at a speed."""
        return self.value + self.slope * (speed - self.at)


class Table:
    """Breakpoints of mu_k and psi of one direction together, in extended precision."""

    def __init__(self, friction: Friction) -> None:
        kinetic, excess = friction.kinetic, friction.excess
        self.has_branches = excess is not None
        self.breakpoints = sorted({*kinetic.velocities, *(excess.velocities if excess else ())})
        self._kinetic = kinetic.velocities, kinetic.coefficients, kinetic.end_slope
        self._excess = (excess.velocities, excess.fractions, 0.0) if excess else ((0.0,), (0.0,), 0.0)

    def segment(self, speed: float, rising: bool) -> int:
        """Return the segment at a speed: at a breakpoint the one above it, or below it where the speed falls."""
        index = bisect_right(self.breakpoints, speed) - 1
        return index - 1 if not rising and index > 0 and self.breakpoints[index] == speed else index

    def kinetic(self, segment: int) -> Line:
        """Return mu_k on a segment."""
        return _line(*self._kinetic, self.breakpoints[segment])

    def psi(self, segment: int) -> Line:
        """Return psi on a segment."""
        return _line(*self._excess, self.breakpoints[segment])


class Tables:
    """The table of each direction."""

    def __init__(self, axis: Axis) -> None:
        self._ahead, self._back = (Table(axis.friction.along(direction)) for direction in (1.0, -1.0))

    def along(self, direction: float) -> Table:
        """Return the table of motion in a direction."""
        return self._back if direction < 0.0 else self._ahead


def _line(speeds: Any, values: Any, end_slope: float, speed: float) -> Line:
    i = bisect_right(speeds, speed) - 1
    if i + 1 == len(speeds):
        return Line(Long(speeds[i]), Long(values[i]), Long(end_slope))
    slope = (Long(values[i + 1]) - Long(values[i])) / (Long(speeds[i + 1]) - Long(speeds[i]))
    return Line(Long(speeds[i]), Long(values[i]), slope)


def static(law: StaticLaw, rest: Any) -> tuple[Any, Any]:
    """Return mu_s and its rate after rest times (an array)."""
    rest = np.asarray(rest, dtype=Long)
    values, growth = _grown(law, np.maximum(rest - Long(law.delay), 0))
    return values, np.where(rest < Long(law.delay), 0, growth)


def _grown(law: StaticLaw, rest: Any) -> tuple[Any, Any]:
    zero = np.zeros_like(rest)
    initial, rise = Long(law.initial), Long(law.limit) - Long(law.initial)
    if law.kind == StaticLawKind.CONSTANT:
        return zero + initial, zero
    if law.bounded and math.isinf(float(rest.flat[0])):
        return zero + Long(law.limit), zero
    tau = Long(law.time_constant)
    z = rest / tau
    with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
        if law.kind == StaticLawKind.EXPONENTIAL:
            return initial - rise * np.expm1(-z), rise / tau * np.exp(-z)
        if law.kind == StaticLawKind.KATO:
            n = Long(law.exponent)
            power = z ** n
            rate = np.where(z > 0, rise * n * power / np.where(z > 0, rest, 1) * np.exp(-power), np.inf)
            return initial - rise * np.expm1(-power), rate
        if law.kind == StaticLawKind.HYPERBOLIC:
            return initial + rise * z / (1 + z), rise / tau / (1 + z) ** 2
        return initial + rise * np.log1p(z), rise / tau / (1 + z)
