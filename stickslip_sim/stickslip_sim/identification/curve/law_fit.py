# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The fit of one law to a measured friction curve, by least squares: values, intervals, a band, and what is left.

The intervals are those of the linearised law: parameter ± t √(s² (JᵀJ)⁻¹), s² the sum of squares per degree of
freedom, t the quantile of Student's distribution.  A parameter at the end of its range counts as known there.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy import special

from ...core.arrays import Numbers
from .measured_curve import FrictionCurve

_LEVEL = 0.95
_ROUNDING = 1e-9        # of the largest coefficient: no curve is known better
SPARE = 3               # points more than parameters: fewer, and the last term of the criterion has no sense
MISSED = 0.1            # of the range of the coefficients: with residuals above it, rms, a law misses the points
_DETERMINED = 5.0       # times up and down: wider, an interval of the linearised law means nothing


class FittedLaw(Protocol):
    """A law with parameters; of those whose name is in `logarithms` it takes the logarithm."""

    @property
    def logarithms(self) -> tuple[str, ...]:
        """The parameters of which the fit has the logarithm."""

    def coefficients(self, parameters: Numbers, speeds: Numbers) -> Numbers:
        """Return mu at the speeds, m/s."""


def enough_points(count: int, curve: FrictionCurve) -> bool:
    """Return whether a curve has the points and speeds that a law with `count` parameters needs for its criterion."""
    return len(curve.speeds) >= count + SPARE and len(np.unique(curve.speeds)) >= count


@dataclass(frozen=True)
class Fit:
    """A law fitted to a curve.

    `parameters` are named as in the section friction.kinetic of a scene (an element of a list as `coefficients[0]`),
    `held` those at an end of their range.  `count` has all that was fitted, the breakpoints of a table too.  `scene`
    has the values for the scene.
    """

    name: str
    law: FittedLaw
    names: tuple[str, ...]
    parameters: Numbers
    held: tuple[str, ...]
    count: int
    scene: Mapping[str, object]
    curve: FrictionCurve

    @property
    def residuals(self) -> Numbers:
        """Measured less fitted, at each point."""
        return self.curve.coefficients - self.at(self.curve.speeds)

    @property
    def rms(self) -> float:
        """The root of the mean square of the residuals."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @property
    def miss(self) -> float:
        """The rms of the residuals over the range of the measured coefficients."""
        coefficients = self.curve.coefficients
        return self.rms / max(float(np.ptp(coefficients)), _ROUNDING * float(coefficients.max()))

    @property
    def at_rest(self) -> float:
        """The fitted coefficient at rest."""
        return float(self.at(np.zeros(1))[0])

    @property
    def extrapolates(self) -> bool:
        """Whether the coefficient at rest lies well above all that was measured, and no point is at rest."""
        slowest, coefficients = self.curve.speeds.min(), self.curve.coefficients
        return bool(slowest > 0.0 and self.at_rest > coefficients.max() + MISSED * np.ptp(coefficients))

    @property
    def criterion(self) -> float:
        """AICc, the information criterion of Akaike for few points: n ln(SSE/n) + 2k + 2k(k + 1)/(n − k − 1).

        k counts the parameters and the variance; the law with the lowest is best (Hurvich and Tsai 1989).
        """
        n, k = len(self.curve.speeds), self.count + 1
        least = (_ROUNDING * self.curve.coefficients.max())**2
        return float(n * np.log(max(self.rms**2, least)) + 2 * k + 2 * k * (k + 1) / (n - k - 1))

    def at(self, speeds: Numbers) -> Numbers:
        """Return the fitted coefficients at speeds, m/s."""
        return self.law.coefficients(self.parameters, speeds)

    def band(self, speeds: Numbers) -> Numbers:
        """Return half the width of the 95 % band of the fitted curve at speeds."""
        covariance = self._covariance
        if not np.isfinite(covariance).all():
            return np.full(np.shape(speeds), np.inf)
        slopes = self._slopes(speeds)
        return np.asarray(self._quantile * np.sqrt(np.einsum('ij,jk,ik->i', slopes, covariance, slopes)))

    def intervals(self) -> dict[str, tuple[float, float] | None]:
        """Return the 95 % interval of each parameter that was not held; None where the points do not determine it."""
        found: dict[str, tuple[float, float] | None] = {}
        errors = self._quantile * np.sqrt(np.diag(self._covariance))
        free = [name not in self.held for name in self.names]
        for name, value, error in zip(np.array(self.names)[free], self.parameters[free], errors):
            log = name in self.law.logarithms
            ends = value - error, value + error
            low, high = np.exp(ends) if log else np.maximum(ends, 0.0)
            known = error <= np.log(_DETERMINED) if log else np.isfinite(error)
            found[str(name)] = (float(low), float(high)) if known else None
        return found

    @property
    def _quantile(self) -> float:
        return float(special.stdtrit(len(self.curve.speeds) - self.count, 0.5 * (1.0 + _LEVEL)))

    @property
    def _covariance(self) -> Numbers:
        """The covariance of the parameters that were not held; infinite where the points do not determine them."""
        slopes = self._slopes(self.curve.speeds)
        scale = np.linalg.norm(slopes, axis=0)
        if not scale.all() or np.linalg.cond(slopes / scale) > 1e8:
            return np.full((slopes.shape[1],) * 2, np.inf)
        variance = np.sum(self.residuals**2) / (len(self.curve.speeds) - self.count)
        inner = slopes / scale
        return np.asarray(variance * np.linalg.inv(inner.T @ inner) / np.outer(scale, scale))

    def _slopes(self, speeds: Numbers) -> Numbers:
        """Return the derivatives of the coefficients by the parameters that were not held, by central differences."""
        columns = []
        for k, name in enumerate(self.names):
            if name not in self.held:
                step = np.zeros_like(self.parameters)
                step[k] = 1e-6 * max(1.0, abs(self.parameters[k]))
                columns.append((self.law.coefficients(self.parameters + step, speeds)
                                - self.law.coefficients(self.parameters - step, speeds)) / (2.0 * step[k]))
        return np.stack(columns, axis=-1)
