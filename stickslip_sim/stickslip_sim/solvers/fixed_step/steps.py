# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One step of each method, with stick or slip and its direction frozen within the step.

The branches of friction are the set-valued law of docs/model.md, evaluated wherever the force is: along the slip,
friction = N mu_k + min(max(R, 0), N e) with R = ±(F_d + F_e) − N mu_k.  Choosing a branch by the sign of the last
acceleration instead chatters where the branches lie apart, and converges to another motion.  Beyond standstill within a
step the first segment of the table is continued.
"""

import cmath
import math
from collections.abc import Iterator
from itertools import pairwise

from ...axis import Axis, CompliantContact, Friction
from ...axis.codes import STICK, YIELDING
from ...axis.forces import (
    breakpoint_speed,
    contact_force,
    drive_force,
    friction_line,
    is_rigid_stick,
    segment_end,
    yielding_force,
)
from ...axis.layout import Parameters
from ...axis.state_record import State
from ...core.errors import InputError
from ...core.hot_path import compiled
from ..stepping import given_inputs_at

EULER, RK4 = 0.0, 1.0


@compiled
def segment_near(p: Parameters, segment: int, speed: float) -> int:
    """Return `forces.segment_above` of a speed, looking around from a segment of the same direction."""
    while segment_end(p, segment) <= speed < math.inf:
        segment += 1
    while breakpoint_speed(p, segment) > max(speed, 0.0):
        segment -= 1
    return segment


@compiled
def friction_at(p: Parameters, s: State, applied: float, u: float, deflection: float) -> float:
    """Return the friction force at velocity u under `applied` = F_d + F_e, N."""
    if s.mode == STICK:
        return applied if is_rigid_stick(p, s) else contact_force(p, deflection, u)
    if s.mode == YIELDING:
        return yielding_force(p, s)
    speed = s.direction * u
    coefficient, _, psi, _ = friction_line(p, segment_near(p, int(s.segment), speed), speed)
    lower = p.normal_force * coefficient
    rest = min(max(s.direction * applied - lower, 0.0), p.normal_force * s.excess * psi)
    return s.direction * (lower + rest)


@compiled
def acceleration_at(p: Parameters, s: State, spring: float, u: float, deflection: float, v: float, f: float) -> float:
    """Return the acceleration of a moving mode, m/s²."""
    applied = drive_force(p, spring, v, u) + f
    return (applied - friction_at(p, s, applied, u, deflection)) / p.mass


@compiled
def step(p: Parameters, s: State, h: float) -> tuple[float, float, float]:
    """Return travel, velocity and travel of the drive after a step of h from the state."""
    return _euler(p, s, h) if s.grid.method == EULER else _rk4(p, s, h)


@compiled
def _euler(p: Parameters, s: State, h: float) -> tuple[float, float, float]:
    """Semi-implicit Euler: the new velocity moves the slider."""
    drive = h * s.inputs.v
    if is_rigid_stick(p, s):
        return 0.0, 0.0, drive
    u = s.velocity + h * acceleration_at(p, s, s.spring, s.velocity, s.deflection, s.inputs.v, s.inputs.f)
    return h * u, u, drive


@compiled
def _rk4(p: Parameters, s: State, h: float) -> tuple[float, float, float]:
    """Classical Runge-Kutta; the drive's travel is then Simpson's rule."""
    half = 0.5 * h
    v0, f0 = s.inputs.v, s.inputs.f
    v1, f1 = given_inputs_at(s, s.second, s.fraction + half)
    v2, f2 = given_inputs_at(s, s.second, s.fraction + h)
    drive = h / 6.0 * (v0 + 4.0 * v1 + v2)
    if is_rigid_stick(p, s):
        return 0.0, 0.0, drive
    w, d, ua = s.spring, s.deflection, s.velocity
    a = acceleration_at(p, s, w, ua, d, v0, f0)
    yb, ub = half * ua, ua + half * a
    b = acceleration_at(p, s, w + half * v0 - yb, ub, d + yb, v1, f1)
    yc, uc = half * ub, ua + half * b
    c = acceleration_at(p, s, w + half * v1 - yc, uc, d + yc, v1, f1)
    ye, ue = h * uc, ua + h * c
    e = acceleration_at(p, s, w + h * v1 - ye, ue, d + ye, v2, f2)
    return (h / 6.0 * (ua + 2.0 * (ub + uc) + ue), ua + h / 6.0 * (a + 2.0 * (b + c) + e), drive)


# How long a step may be: a longer one lets a motion grow that the axis itself damps.
#
# A mode is y″ + 2γ y′ + ω² y.  Semi-implicit Euler is stable while h²ω² + 4γh < 4 (Jury's criterion for its step
# matrix, of trace 2 − 2γh − h²ω² and determinant 1 − 2γh); RK4 while |1 + z + z²/2 + z³/6 + z⁴/24| < 1 for both z = hλ.

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
