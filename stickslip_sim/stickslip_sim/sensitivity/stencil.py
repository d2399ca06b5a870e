# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Differences by Richardson: the derivative from two steps, and an error that is no smaller than its own.

On both sides, with D(h) = (f(p + h) − f(p − h))/2h = f′ + c h² + …, two steps give R = (4 D(h/2) − D(h))/3 to the order
h⁴; its error is taken as |R − D(h/2)|, which is that of the better one of the two.  On one side three steps do the
same to the order h³.
"""

from dataclasses import dataclass

import numpy as np

from ..core.arrays import Numbers

_ROUNDING = 2.0 ** -50


@dataclass(frozen=True)
class Stencil:
    """Where a function is taken for its derivative: the parameter plus `offsets` times the step."""

    side: str
    offsets: tuple[float, float, float, float]

    def derivative(self, values: Numbers, step: float, size: float, scale: float = 0.0) -> tuple[Numbers, Numbers]:
        """Return the derivative and its error from `values` (4, ...) at the offsets.

        `size` is that of the parameter: its rounding counts as an error, and so does that of the values, or of the
        `scale` of what they are made from.
        """
        derivative, error = (_both_sides if self.side == BOTH else _one_side)(values, step * self._sign)
        rounding = _ROUNDING * (np.maximum(np.abs(values).max(axis=0), scale) + np.abs(derivative) * size) / abs(step)
        return derivative, error + rounding

    @property
    def _sign(self) -> float:
        return -1.0 if self.side == BELOW else 1.0


BOTH, ABOVE, BELOW = 'both', 'above', 'below'
CENTRAL = Stencil(BOTH, (-1.0, -0.5, 0.5, 1.0))
STENCILS = (CENTRAL, Stencil(ABOVE, (0.0, 0.25, 0.5, 1.0)), Stencil(BELOW, (0.0, -0.25, -0.5, -1.0)))


def _both_sides(values: Numbers, step: float) -> tuple[Numbers, Numbers]:
    coarse, fine = (values[3] - values[0]) / (2.0 * step), (values[2] - values[1]) / step
    derivative = (4.0 * fine - coarse) / 3.0
    return derivative, np.abs(derivative - fine)


def _one_side(values: Numbers, step: float) -> tuple[Numbers, Numbers]:
    fine, middle, coarse = ((values[k] - values[0]) / (offset * step) for k, offset in ((1, 0.25), (2, 0.5), (3, 1.0)))
    first, second = 2.0 * middle - coarse, 2.0 * fine - middle
    derivative = (4.0 * second - first) / 3.0
    return derivative, np.abs(derivative - second)
