# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How long a step may be: a longer one lets a motion grow that the axis itself damps.

A mode is y″ + 2γ y′ + ω² y.  Semi-implicit Euler is stable while h²ω² + 4γh < 4 (Jury's criterion for its step matrix,
of trace 2 − 2γh − h²ω² and determinant 1 − 2γh); RK4 while |1 + z + z²/2 + z³/6 + z⁴/24| < 1 for both z = hλ.
"""

import cmath
import math
from collections.abc import Iterator
from itertools import pairwise

from ...axis import Axis, CompliantContact, Friction
from ...core.errors import InputError

_REACH = 4.0      # RK4 is stable nowhere beyond |z| = 3
_FOUND = 1e-6     # relative; how well the longest step of RK4 is found


def check_step(axis: Axis, method: str, step: float) -> None:
    """Raise InputError when `step` (s) is too long for the fastest mode of an axis."""
    for name, gamma, omega2 in _modes(axis):
        longest = 0.0
        if math.isfinite(gamma * gamma + omega2):
            longest = _longest_euler(gamma, omega2) if method == 'euler' else _longest_rk4(gamma, omega2)
        if step > longest:
            raise InputError('solver.step', step, f'<= {longest:.3g} s for {name} of this axis with {method}',
                             'shorten the step, or use solver.name: exact, which has none')


def _modes(axis: Axis) -> Iterator[tuple[str, float, float]]:
    """Yield name, γ and ω² of the modes that move; of slip with the steepest rise of friction in its table."""
    rise = max(map(_steepest_rise, axis.friction.sides))
    yield 'slip', 0.5 * (axis.drive_damping + axis.normal_force * rise) / axis.mass, axis.drive_stiffness / axis.mass
    if isinstance(axis.contact, CompliantContact):
        yield ('stick', 0.5 * (axis.drive_damping + axis.contact.damping) / axis.mass,
               (axis.drive_stiffness + axis.contact.stiffness) / axis.mass)


def _steepest_rise(friction: Friction) -> float:
    kinetic = friction.kinetic
    breakpoints = list(zip(kinetic.velocities, kinetic.coefficients, strict=True))
    slopes = [(mu1 - mu0) / (v1 - v0) for (v0, mu0), (v1, mu1) in pairwise(breakpoints)]
    return max(0.0, kinetic.end_slope, *slopes)


def _longest_euler(gamma: float, omega2: float) -> float:
    second_rate = gamma + math.sqrt(gamma * gamma + omega2)
    return 2.0 / second_rate if second_rate > 0.0 else math.inf


def _longest_rk4(gamma: float, omega2: float) -> float:
    """Return the step where the larger factor of both eigenvalues leaves the unit circle, by bisection."""
    root = cmath.sqrt(gamma * gamma - omega2)
    eigenvalues = (-gamma - root, -gamma + root)
    fastest = max(map(abs, eigenvalues))
    if fastest == 0.0:
        return math.inf
    low, high = 0.0, _REACH / fastest
    while high - low > _FOUND * high:
        middle = 0.5 * (low + high)
        if all(abs(_growth(middle * eigenvalue)) <= 1.0 + 1e-12 for eigenvalue in eigenvalues):
            low = middle
        else:
            high = middle
    return low


def _growth(z: complex) -> complex:
    return 1.0 + z * (1.0 + z * (0.5 + z * (1.0 / 6.0 + z / 24.0)))
