# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A smooth law fitted to a friction curve: all scales are tried, and the best is polished by scipy's `least_squares`.

A start from a guess finds a local minimum; so v_s goes through a grid from a tenth of the lowest speed above 0 to ten
times the highest (and the exponent through its range), with the best other values at each, which are unique.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares, nnls

from ...core.arrays import Numbers
from ...core.ranges import COEFFICIENT, SLOPE
from ...friction.shapes import MAX_EXPONENT, MIN_EXPONENT
from .law_fit import Fit
from .measured_curve import FrictionCurve

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
    high = np.array([COEFFICIENT.high, COEFFICIENT.high, SLOPE.high, np.log(above.max() * _BEYOND),
                     np.log(MAX_EXPONENT)])[:len(form.names)]
    found = least_squares(lambda parameters: form.coefficients(parameters, curve.speeds) - curve.coefficients,
                          np.clip(_start(form, curve, low[3], high[3]), low, high), jac='3-point', bounds=(low, high),
                          x_scale='jac', xtol=1e-14, ftol=1e-14, gtol=1e-14)
    parameters = _settled(form, curve, found.x, (low, high))
    held = tuple(name for name, value, a, b in zip(form.names, parameters, low, high)
                 if min(value - a, b - value) <= _AT_END * min(1.0, b - a))
    return Fit(form.name, form, form.names, parameters, held, len(form.names), _scene(form, parameters),
               curve)


def _start(form: SmoothForm, curve: FrictionCurve, low: float, high: float) -> Numbers:
    """Return the parameters of the best point of the grid."""
    best = np.inf
    start: Numbers = np.zeros(len(form.names))
    for exponent in form.exponents:
        for scale in np.linspace(low, high, _SCALES):
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


def _scene(form: SmoothForm, parameters: Numbers) -> dict[str, object]:
    """Return the section friction.kinetic of a scene."""
    initial, limit, viscous, scale = parameters[:4].tolist()
    values: dict[str, object] = {'law': form.law, 'initial': initial, 'limit': limit,
                                 'stribeck_velocity': float(np.exp(scale)), 'viscous': viscous}
    if form.law == 'stribeck':
        values['exponent'] = float(np.exp(parameters[4])) if form.free else form.exponents[0]
    return values
