# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A table fitted to a friction curve: straight segments between few breakpoints, chosen one after the other.

A table with given breakpoints is linear in its coefficients and its end slope.  It begins with one breakpoint, at rest
(Coulomb's law with a viscous slope); then each time the measured speed that lowers the sum of squares most becomes a
breakpoint, as long as that lowers the criterion, in which each of them counts as a parameter.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from ...core.arrays import Numbers
from .law_fit import Fit, enough_points
from .measured_curve import FrictionCurve

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
    return _scene(speeds, means, None)


def _fitted(breakpoints: tuple[float, ...], curve: FrictionCurve) -> Fit:
    law = _TableLaw(breakpoints)
    parameters, _ = nnls(law.basis(curve.speeds), curve.coefficients)
    open_end = breakpoints[-1] < curve.speeds.max()
    names = (*(f'coefficients[{k}]' for k in range(len(breakpoints))), 'end_slope')
    held = tuple(name for name, value in zip(names, parameters) if value == 0.0)
    count = 2 * len(breakpoints) - 1 + open_end
    return Fit('table', law, names, parameters, held, count,
               _scene(np.array(breakpoints), parameters[:-1], float(parameters[-1]) if open_end else None), curve)


def _scene(speeds: Numbers, means: Numbers, end_slope: float | None) -> dict[str, object]:
    """Return friction.kinetic; without an `end_slope` the last segment goes on, where it does not fall."""
    if end_slope is None:
        end_slope = max((means[-1] - means[-2]) / (speeds[-1] - speeds[-2]), 0.0) if len(speeds) > 1 else 0.0
    return {'law': 'table', 'velocities': tuple(speeds.tolist()), 'coefficients': tuple(means.tolist()),
            'end_slope': float(end_slope)}
