# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The row of a sample, for every solver."""

from ..axis.codes import STICK, YIELDING
from ..axis.forces import stated_drive_force
from ..axis.layout import Parameters
from ..axis.motion import yielded_deflection
from ..axis.rows import SampleRow
from ..axis.state_record import State
from ..core.hot_path import inlined


@inlined
def write_sample(p: Parameters, s: State, second: float, fraction: float, t: float, y: float, u: float, a: float,
                 drive: float, v: float, drive_force: float, force: float, friction: float, out: SampleRow) -> None:
    """Fill a row (`types.Sample` names the columns): t, travel y and drive travel since the state s, the rest at t."""
    stuck = s.mode == STICK
    out.second = second
    out.fraction = fraction
    out.mode = s.mode
    out.direction = s.direction
    out.position = s.origin + (s.position + y)
    out.velocity = u
    out.acceleration = a
    out.drive = s.origin + (s.drive + drive)
    out.drive_velocity = v
    out.drive_force = stated_drive_force(p, drive_force, u)
    out.external = force
    out.friction = friction
    out.coefficient = abs(friction) / p.normal_force if p.normal_force > 0.0 else 0.0
    out.deflection = s.deflection + y if stuck and p.compliant != 0.0 else 0.0
    if s.mode == YIELDING:
        out.deflection = yielded_deflection(p, s, t)
    out.rest = s.rest + t if stuck else 0.0
