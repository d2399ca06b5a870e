# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The smooth laws of kinetic friction as a fit sees them: mu(w) = mu_0 g + mu_c (1 − g) + k_v w with g = g(w/v_s).

At a given scale v_s (and exponent) a law is linear in mu_0, mu_c and k_v, none of which may be negative: so its best
values there come from non-negative least squares, without a start.  The laws are those of `friction.smooth`, for many
speeds at once.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...core.arrays import Numbers
from ...friction.shapes import MAX_EXPONENT, MIN_EXPONENT

Falling = Callable[[Numbers, float], Numbers]
LINEAR = ('initial', 'limit', 'viscous')


class SmoothForm(NamedTuple):
    """A smooth law: its `name` in the report, its `law` in a scene, g(z, exponent), and the exponents to start from.

    `free` says whether the exponent is fitted, too.
    """

    name: str
    law: str
    falling: Falling
    exponents: tuple[float, ...]
    free: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """The fitted parameters, as in `friction.kinetic` of a scene."""
        return (*LINEAR, 'stribeck_velocity', *(('exponent',) if self.free else ()))

    def basis(self, speeds: Numbers, scale: float, exponent: float) -> Numbers:
        """Return a column for each of `LINEAR` at the speeds, m/s."""
        g = self.falling(speeds / scale, exponent)
        return np.stack([g, 1.0 - g, speeds], axis=-1)

    def coefficients(self, parameters: Numbers, speeds: Numbers) -> Numbers:
        """Return mu at the speeds; `parameters` in the order of `names`, of scale and exponent the logarithms."""
        exponent = float(np.exp(parameters[4])) if self.free else self.exponents[0]
        basis = self.basis(speeds, float(np.exp(parameters[3])), exponent)
        return np.asarray(basis @ parameters[:3])


def _decay(z: Numbers, exponent: float) -> Numbers:
    with np.errstate(over='ignore', under='ignore'):
        return np.asarray(np.exp(-z**exponent))


def _hyperbola(z: Numbers, exponent: float) -> Numbers:
    return np.asarray(1.0 / (1.0 + z))


_STARTS = tuple(np.geomspace(MIN_EXPONENT, MAX_EXPONENT, 13).tolist())
SMOOTH_FORMS = (
    SmoothForm('gaussian', 'stribeck', _decay, (2.0,)),
    SmoothForm('stribeck', 'stribeck', _decay, _STARTS, free=True),
    SmoothForm('exponential', 'exponential', _decay, (1.0,)),
    SmoothForm('hyperbolic', 'hyperbolic', _hyperbola, (1.0,)),
)
