# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One step of each method, with stick or slip and its direction frozen within the step.

The branches of friction are the set-valued law of docs/model.md, evaluated wherever the force is: along the slip,
friction = N mu_k + min(max(R, 0), N e) with R = ±(F_d + F_e) − N mu_k.  Choosing a branch by the sign of the last
acceleration instead chatters where the branches lie apart, and converges to another motion.  Beyond standstill within a
step the first segment of the table is continued.
"""

import math

from ...axis.codes import STICK, YIELDING
from ...axis.forces import contact_force, drive_force, is_rigid_stick, yielding_force
from ...axis.friction_segments import breakpoint_speed, friction_line, segment_end
from ...axis.layout import Parameters
from ...axis.state_record import State
from ...core.hot_path import compiled
from ..inputs import given_inputs_at

EULER, RK4 = 0.0, 1.0


@compiled
def segment_near(p: Parameters, segment: int, speed: float) -> int:
    """Return `friction_segments.segment_above` of a speed, looking around from a segment of the same direction."""
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
