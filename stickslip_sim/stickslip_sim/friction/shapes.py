# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Smooth shapes g(z) that fall from 1 at z = 0 to 0: the falling part of a kinetic law, or the excess psi.

| shape     | g(z)                    | support  | inflection           |
|-----------|-------------------------|----------|----------------------|
| Decay     | exp(−z^δ)               | z >= 0   | ((δ−1)/δ)^(1/δ), δ > 1 |
| Hyperbola | 1/(1 + z)               | z >= 0   |                      |
| Cosine    | (1 + cos πz)/2          | [0, 1]   | 1/2                  |
| Power     | (1 − z)^n, n > 1        | [0, 1]   |                      |

Each is concave before its inflection and convex from there on, also beyond its support, where it is 0.  All that
`refine` needs is here: value, slope (of dimension 1), inflection.
"""

import math
from dataclasses import dataclass
from typing import Protocol

MIN_EXPONENT, MAX_EXPONENT = 0.2, 20.0   # of a decay: beyond, its tail or its edge has no physical meaning


class Shape(Protocol):
    """A function that falls from 1 to 0, concave up to `inflection` (0: nowhere) and convex from there on."""

    def __hash__(self) -> int:
        """Return a hash: shapes are values, and their tables are kept."""

    @property
    def inflection(self) -> float:
        """Where the curvature changes its sign."""

    def value(self, z: float) -> float:
        """Return g at z >= 0."""

    def slope(self, z: float) -> float:
        """Return g′ at z >= 0; it may be −infinity at 0."""

    def reach(self, share: float) -> float:
        """Return the z at which g has dropped to a share in (0, 1)."""


@dataclass(frozen=True, slots=True)
class Decay:
    """exp(−z^δ): Gaussian for δ = 2, exponential for δ = 1."""

    exponent: float

    @property
    def inflection(self) -> float:
        """Where the curvature changes its sign."""
        n = self.exponent
        return ((n - 1.0) / n) ** (1.0 / n) if n > 1.0 else 0.0

    def value(self, z: float) -> float:
        """Return g at z >= 0."""
        return math.exp(-self._power(z))

    def slope(self, z: float) -> float:
        """Return g′ at z >= 0; −infinity at 0 for δ < 1."""
        n = self.exponent
        if z == 0.0:
            return 0.0 if n > 1.0 else (-1.0 if n == 1.0 else -math.inf)
        power = self._power(z)
        return -n * (power / z) * math.exp(-power)

    def reach(self, share: float) -> float:
        """Return the z at which g has dropped to a share in (0, 1)."""
        return float((-math.log(share)) ** (1.0 / self.exponent))

    def _power(self, z: float) -> float:
        """Return z^δ, or 1000, whose decay is 0, where it is more: it might leave the range of numbers."""
        if z > 1.0 and self.exponent * math.log(z) > 6.9:
            return 1000.0
        return float(z ** self.exponent)


@dataclass(frozen=True, slots=True)
class Hyperbola:
    """1/(1 + z)."""

    @property
    def inflection(self) -> float:
        """Where the curvature changes its sign: nowhere."""
        return 0.0

    def value(self, z: float) -> float:
        """Return g at z >= 0."""
        return 1.0 / (1.0 + z)

    def slope(self, z: float) -> float:
        """Return g′ at z >= 0."""
        return -1.0 / (1.0 + z) / (1.0 + z)

    def reach(self, share: float) -> float:
        """Return the z at which g has dropped to a share in (0, 1)."""
        return 1.0 / share - 1.0


@dataclass(frozen=True, slots=True)
class Cosine:
    """(1 + cos πz)/2 up to z = 1: flat at both ends."""

    @property
    def inflection(self) -> float:
        """Where the curvature changes its sign."""
        return 0.5

    def value(self, z: float) -> float:
        """Return g at z >= 0."""
        return math.cos(0.5 * math.pi * z) ** 2 if z < 1.0 else 0.0

    def slope(self, z: float) -> float:
        """Return g′ at z >= 0."""
        return -0.5 * math.pi * math.sin(math.pi * z) if z < 1.0 else 0.0

    def reach(self, share: float) -> float:
        """Return the z at which g has dropped to a share in (0, 1)."""
        return math.acos(2.0 * share - 1.0) / math.pi


@dataclass(frozen=True, slots=True)
class Power:
    """(1 − z)^n up to z = 1, n > 1: steep at rest, flat at the end."""

    exponent: float

    @property
    def inflection(self) -> float:
        """Where the curvature changes its sign: nowhere."""
        return 0.0

    def value(self, z: float) -> float:
        """Return g at z >= 0."""
        return float((1.0 - z) ** self.exponent) if z < 1.0 else 0.0

    def slope(self, z: float) -> float:
        """Return g′ at z >= 0."""
        return -self.exponent * float((1.0 - z) ** (self.exponent - 1.0)) if z < 1.0 else 0.0

    def reach(self, share: float) -> float:
        """Return the z at which g has dropped to a share in (0, 1)."""
        return 1.0 - float(share ** (1.0 / self.exponent))
