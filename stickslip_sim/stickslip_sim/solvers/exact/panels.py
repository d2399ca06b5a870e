# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The works of a short motion under sines, by Gauss and Legendre's rule over the powers."""

import math
from typing import NamedTuple

from ...axis.codes import STICK, YIELDING
from ...axis.friction_segments import kinetic_at_rest, slip_friction
from ...axis.layout import Parameters
from ...axis.motion import drive_travel, travel
from ...axis.sinusoids import inputs_at
from ...axis.slip_series import series_deflection
from ...axis.smooth_load import normal_force_at
from ...axis.state_record import State
from ...core.hot_path import compiled

# eight nodes of Gauss and Legendre's rule
_NODES = (-0.96028985649753623168, -0.79666647741362673959, -0.52553240991632898582, -0.18343464249564980494,
          0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959, 0.96028985649753623168)
_WEIGHTS = (0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734, 0.36268378337836198297,
            0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915)
_RADIANS = 1.5      # of a panel: the error for a product of two sinusoids is then below 1e-15


class Works(NamedTuple):
    """Works from the segment start on, J: the first two are positive when they give, the others when they take."""

    drive: float
    external: float
    friction: float
    damper: float    # of the drive
    contact: float   # the contact's damper


@compiled
def panels(p: Parameters, s: State, t: float, rate: float) -> Works:
    """Return the works of a moving mode up to t, from eight nodes a panel; `rate` is its fastest rate, rad/s."""
    drive, external, friction, damper, contact = 0.0, 0.0, 0.0, 0.0, 0.0
    count = math.floor(rate * t / _RADIANS) + 1.0
    half = 0.5 * t / count
    panel = 0.0
    while panel < count:
        for i in range(8):
            weight = half * _WEIGHTS[i]
            at = half * (2.0 * panel + 1.0 + _NODES[i])
            of_drive, of_force, of_friction, of_damper, of_contact = _powers(p, s, at)
            drive += weight * of_drive
            external += weight * of_force
            friction += weight * of_friction
            damper += weight * of_damper
            contact += weight * of_contact
        panel += 1.0
    return Works(drive, external, friction, damper, contact)


@compiled
def _powers(p: Parameters, s: State, t: float) -> Works:
    y, u, _ = travel(p, s, t)
    v, force = s.inputs.v + s.inputs.v_rate * t, s.inputs.f + s.inputs.f_rate * t
    if s.sinusoid_count != 0.0:
        v, force = inputs_at(s, s.second, s.fraction + t, t)
    ahead = p.feed_share * v - u
    drive_force = p.stiffness * (s.spring + (drive_travel(s, t) - y)) + p.feed_share * p.damping * ahead
    friction, contact = 0.0, 0.0
    if s.mode == STICK:
        contact = p.contact_damping * u * u
    else:
        normal, _ = normal_force_at(p, s, t)
        if s.mode == YIELDING:
            _, rate = series_deflection(s, t)
            friction = s.direction * normal * kinetic_at_rest(p, s.direction) * (u - rate)
            contact = p.contact_damping * rate * rate
        else:
            steady, slope = slip_friction(p, s)
            friction = normal * (s.direction * steady + slope * u) * u
    return Works(drive_force * v, force * u, friction, p.damping * ahead * ahead, contact)
