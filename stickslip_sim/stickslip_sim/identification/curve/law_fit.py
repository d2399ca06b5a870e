# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The fit of one law to a measured friction curve, by least squares: values, intervals, a band, and what is left.

The intervals are those of the linearised law: parameter ± t √(s² (JᵀJ)⁻¹), s² the sum of squares per degree of
freedom, t the quantile of Student's distribution.  A parameter at the end of its range counts as known there.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from scipy import special
from scipy.optimize import least_squares, nnls

from ...core.arrays import Numbers
from ...core.ranges import COEFFICIENT, SLOPE
from ...friction.shapes import MAX_EXPONENT, MIN_EXPONENT
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


# A smooth law fitted to a friction curve: all scales are tried, and the best is polished by scipy's `least_squares`.
#
# A start from a guess finds a local minimum; so v_s goes through a grid from a tenth of the lowest speed above 0 to ten
# times the highest (and the exponent through its range), with the best other values at each, which are unique.

# The smooth laws of kinetic friction as a fit sees them: mu(w) = mu_0 g + mu_c (1 − g) + k_v w with g = g(w/v_s).
#
# At a given scale v_s (and exponent) a law is linear in mu_0, mu_c and k_v, none of which may be negative: so its best
# values there come from non-negative least squares, without a start.  The laws are those of `friction.smooth`, for many
# speeds at once.

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
    def logarithms(self) -> tuple[str, ...]:
        """The parameters of which `coefficients` takes the logarithm."""
        return 'stribeck_velocity', 'exponent'

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


_SCALES = 61
_BEYOND = 10.0     # times the speeds of the curve: there a scale may lie
_AT_END = 1e-6     # of a range


def fit_smooth(form: SmoothForm, curve: FrictionCurve) -> Fit:
    """Return the best fit of a law to a curve that has more points than parameters, not all at rest."""
    above = curve.speeds[curve.speeds > 0.0]
    low = np.array([0.0, 0.0, 0.0, np.log(above.min() / _BEYOND), np.log(MIN_EXPONENT)])[:len(form.names)]
    most = max(COEFFICIENT.high, _BEYOND * float(curve.coefficients.max()))    # forces are larger
    high = np.array([most, most, SLOPE.high, np.log(above.max() * _BEYOND),
                     np.log(MAX_EXPONENT)])[:len(form.names)]
    found = least_squares(lambda parameters: form.coefficients(parameters, curve.speeds) - curve.coefficients,
                          np.clip(_start(form, curve, low[3], high[3]), low, high), jac='3-point', bounds=(low, high),
                          x_scale='jac', xtol=1e-14, ftol=1e-14, gtol=1e-14)
    parameters = _settled(form, curve, found.x, (low, high))
    held = tuple(name for name, value, a, b in zip(form.names, parameters, low, high)
                 if min(value - a, b - value) <= _AT_END * min(1.0, b - a))
    return Fit(form.name, form, form.names, parameters, held, len(form.names), _smooth_law(form, parameters),
               curve)


def _start(form: SmoothForm, curve: FrictionCurve, low: float, high: float) -> Numbers:
    """Return the parameters of the best point of the grid."""
    best = np.inf
    start: Numbers = np.zeros(len(form.names))
    for exponent in form.exponents:
        for scale in np.linspace(low, high, _SCALES):
            with np.errstate(invalid='ignore'):    # a column of zeros, far from the speeds of the curve
                values, error = nnls(form.basis(curve.speeds, float(np.exp(scale)), exponent), curve.coefficients)
            if error < best:
                best = error
                start = np.array([*values, scale, np.log(exponent)])[:len(form.names)]
    return start


def _settled(form: SmoothForm, curve: FrictionCurve, parameters: Numbers, ends: tuple[Numbers, Numbers]) -> Numbers:
    """Return the parameters with the linear ones exactly at their best: at 0 where `least_squares` only came near."""
    parameters = np.clip(parameters, *ends)
    exponent = float(np.exp(parameters[4])) if form.free else form.exponents[0]
    linear, _ = nnls(form.basis(curve.speeds, float(np.exp(parameters[3])), exponent), curve.coefficients)
    return np.array([*linear, *parameters[3:]])


def _smooth_law(form: SmoothForm, parameters: Numbers) -> dict[str, object]:
    """Return the section friction.kinetic of a scene."""
    initial, limit, viscous, scale = parameters[:4].tolist()
    values: dict[str, object] = {'law': form.law, 'initial': initial, 'limit': limit,
                                 'stribeck_velocity': float(np.exp(scale)), 'viscous': viscous}
    if form.law == 'stribeck':
        values['exponent'] = float(np.exp(parameters[4])) if form.free else form.exponents[0]
    return values


# A table fitted to a friction curve: straight segments between few breakpoints, chosen one after the other.
#
# A table with given breakpoints is linear in its coefficients and its end slope.  It begins with one breakpoint, at
# rest (Coulomb's law with a viscous slope); then each time the measured speed that lowers the sum of squares most
# becomes a breakpoint, as long as that lowers the criterion, in which each of them counts as a parameter.

_CANDIDATES = 60
_MOST = 12   # breakpoints


@dataclass(frozen=True)
class _TableLaw:
    breakpoints: tuple[float, ...]    # m/s
    logarithms = ()

    def basis(self, speeds: Numbers) -> Numbers:
        """Return a column for each coefficient, and one for the end slope."""
        inside = [np.interp(speeds, self.breakpoints, row) for row in np.eye(len(self.breakpoints))]
        return np.stack([*inside, np.maximum(speeds - self.breakpoints[-1], 0.0)], axis=-1)

    def coefficients(self, parameters: Numbers, speeds: Numbers) -> Numbers:
        """Return mu at the speeds."""
        return np.asarray(self.basis(speeds) @ parameters)


def fit_table(curve: FrictionCurve) -> Fit:
    """Return the table with the lowest criterion that adding breakpoints one by one leads to."""
    best = _fitted((0.0,), curve)
    speeds = np.unique(curve.speeds[curve.speeds > 0.0])
    candidates = speeds if len(speeds) <= _CANDIDATES else np.quantile(speeds, np.linspace(0.0, 1.0, _CANDIDATES))
    breakpoints = (0.0,)
    for _ in range(_MOST - 1):
        tables = [tuple(sorted((*breakpoints, speed))) for speed in candidates.tolist() if speed not in breakpoints]
        fits = [(_fitted(table, curve), table) for table in tables if enough_points(2 * len(table), curve)]
        if not fits:
            return best
        found, breakpoints = min(fits, key=lambda fit: fit[0].rms)
        if found.criterion >= best.criterion:
            return best
        best = found
    return best


def points_table(curve: FrictionCurve) -> dict[str, object]:
    """Return friction.kinetic with a breakpoint at each measured speed, the mean of its points, and one at rest."""
    speeds = np.unique(curve.speeds)
    means = np.array([curve.coefficients[curve.speeds == speed].mean() for speed in speeds])
    if speeds[0] > 0.0:
        speeds, means = np.array([0.0, *speeds]), np.array([means[0], *means])
    return _table_law(speeds, means, None)


def _fitted(breakpoints: tuple[float, ...], curve: FrictionCurve) -> Fit:
    law = _TableLaw(breakpoints)
    parameters, _ = nnls(law.basis(curve.speeds), curve.coefficients)
    open_end = breakpoints[-1] < curve.speeds.max()
    names = (*(f'coefficients[{k}]' for k in range(len(breakpoints))), 'end_slope')
    held = tuple(name for name, value in zip(names, parameters) if value == 0.0)
    count = 2 * len(breakpoints) - 1 + open_end
    return Fit('table', law, names, parameters, held, count,
               _table_law(np.array(breakpoints), parameters[:-1], float(parameters[-1]) if open_end else None), curve)


def _table_law(speeds: Numbers, means: Numbers, end_slope: float | None) -> dict[str, object]:
    """Return friction.kinetic; without an `end_slope` the last segment goes on, where it does not fall."""
    if end_slope is None:
        end_slope = max((means[-1] - means[-2]) / (speeds[-1] - speeds[-2]), 0.0) if len(speeds) > 1 else 0.0
    return {'law': 'table', 'velocities': tuple(speeds.tolist()), 'coefficients': tuple(means.tolist()),
            'end_slope': float(end_slope)}
