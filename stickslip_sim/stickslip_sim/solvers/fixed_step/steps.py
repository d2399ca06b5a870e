# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One step of each method, with stick or slip and its direction frozen within the step.

The branches of friction are the set-valued law of docs/model.md, evaluated wherever the force is: along the slip,
friction = N mu_k + min(max(R, 0), N e) with R = ±(F_d + F_e) − N mu_k.  Choosing a branch by the sign of the last
acceleration instead chatters where the branches lie apart, and converges to another motion.  Beyond standstill within a
step the first piece of the table is continued.
"""

from ...axis.layout import (
    DEFLECTION, DIRECTION, EXCESS, F, FRACTION, KNOTS, MASS, METHOD, MODE, NORMAL, PIECE, SECOND, SPRING, V, VELOCITY,
)
from ...axis.motion import STICK, contact_force, drive_force, friction_line, is_rigid_stick, knot_speed
from ...core.jit import compiled
from ..inputs import inputs_at

EULER, RK4 = 0.0, 1.0


@compiled
def piece_near(p, piece, speed):
    """Return `motion.piece_above` of a speed, looking around from a piece."""
    while piece + 1 < p[KNOTS] and knot_speed(p, piece + 1) <= speed:
        piece += 1
    while piece > 0 and knot_speed(p, piece) > speed:
        piece -= 1
    return piece


@compiled
def friction_at(p, s, applied, u, deflection):
    """Return the friction force at velocity u under `applied` = F_d + F_e, N."""
    if s[MODE] == STICK:
        return applied if is_rigid_stick(p, s) else contact_force(p, deflection, u)
    speed = s[DIRECTION] * u
    coefficient, _, psi, _ = friction_line(p, piece_near(p, int(s[PIECE]), speed), speed)
    lower = p[NORMAL] * coefficient
    rest = min(max(s[DIRECTION] * applied - lower, 0.0), p[NORMAL] * s[EXCESS] * psi)
    return s[DIRECTION] * (lower + rest)


@compiled
def acceleration_at(p, s, spring, u, deflection, v, f):
    """Return the acceleration of a moving mode, m/s²."""
    applied = drive_force(p, spring, v, u) + f
    return (applied - friction_at(p, s, applied, u, deflection)) / p[MASS]


@compiled
def step(p, s, h):
    """Return travel, velocity and travel of the drive after a step of h from the state."""
    return _euler(p, s, h) if s[METHOD] == EULER else _rk4(p, s, h)


@compiled
def _euler(p, s, h):
    """Semi-implicit Euler: the new velocity moves the slider."""
    drive = h * s[V]
    if is_rigid_stick(p, s):
        return 0.0, 0.0, drive
    u = s[VELOCITY] + h * acceleration_at(p, s, s[SPRING], s[VELOCITY], s[DEFLECTION], s[V], s[F])
    return h * u, u, drive


@compiled
def _rk4(p, s, h):
    """Classical Runge-Kutta; the drive's travel is then Simpson's rule."""
    half = 0.5 * h
    v0, f0 = s[V], s[F]
    v1, f1 = inputs_at(s, s[SECOND], s[FRACTION] + half)
    v2, f2 = inputs_at(s, s[SECOND], s[FRACTION] + h)
    drive = h / 6.0 * (v0 + 4.0 * v1 + v2)
    if is_rigid_stick(p, s):
        return 0.0, 0.0, drive
    w, d, ua = s[SPRING], s[DEFLECTION], s[VELOCITY]
    a = acceleration_at(p, s, w, ua, d, v0, f0)
    yb, ub = half * ua, ua + half * a
    b = acceleration_at(p, s, w + half * v0 - yb, ub, d + yb, v1, f1)
    yc, uc = half * ub, ua + half * b
    c = acceleration_at(p, s, w + half * v1 - yc, uc, d + yc, v1, f1)
    ye, ue = h * uc, ua + h * c
    e = acceleration_at(p, s, w + h * v1 - ye, ue, d + ye, v2, f2)
    return (h / 6.0 * (ua + 2.0 * (ub + uc) + ue), ua + h / 6.0 * (a + 2.0 * (b + c) + e), drive)
