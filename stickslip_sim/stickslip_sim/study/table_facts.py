# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Critical values that a given table of friction decides: by a breakpoint, or by the straight segment between two.

Sliding is lost by the slope of mu_k at the drive's speed.  On a table that slope is the same all along a segment and
jumps at a breakpoint; so a critical feed lies on a breakpoint, wherever a smooth curve through the same points would
have it.  With a smooth law its own slope decides, and it has none of this.
"""

import math
from typing import NamedTuple

import numpy as np

from ..scene import Scene
from .points import Values, scene_at

_MOVING = ('drive.velocity', 'friction.kinetic.velocities', 'friction.kinetic.backward.velocities')
_CLOSE = 2.0   # times the accuracy: the value is the middle of what is left open


class TableFact(NamedTuple):
    """A critical `value` from rest or `from_sliding`: the drive's speed is that of a breakpoint, or in a segment.

    `breakpoint` counts from 0 in the velocities of friction.kinetic in the direction of the drive, None: in the segment
    from `low` to `high`, m/s.
    """

    from_sliding: bool
    value: float
    breakpoint: int | None
    low: float
    high: float
    table: str     # the parameter that has the breakpoints


def table_fact(values: Values, name: str, value: float, accuracy: float, from_sliding: bool) -> TableFact | None:
    """Return what the table of mu_k has to do with a critical value of a parameter; None where nothing.

    From rest the motion passes through many segments: there only a breakpoint counts, and only where the parameter
    moves the drive past it.
    """
    if not from_sliding and not name.startswith(_MOVING):
        return None
    scene = scene_at(values, [name], np.array([value]))
    kinetic = scene.axis.friction.along(scene.drive.values[0]).kinetic
    speeds = kinetic.velocities
    if kinetic.law is not None or len(speeds) < 2:
        return None
    speed, table = abs(scene.drive.values[0]), _table_of(scene)
    for k, at in enumerate(speeds[1:], 1):
        if abs(speed - at) <= _CLOSE * accuracy * at:
            return TableFact(from_sliding, value, k, at, at, table)
    above = sum(at <= speed for at in speeds)
    high = speeds[above] if above < len(speeds) else math.inf
    return TableFact(from_sliding, value, None, speeds[above - 1], high, table) if from_sliding else None


def _table_of(scene: Scene) -> str:
    """Return the parameter with the breakpoints of mu_k in the direction of the drive."""
    back = 'friction.kinetic.backward.velocities'
    return back if scene.drive.values[0] < 0.0 and back in scene.values else 'friction.kinetic.velocities'


def breakpoints_between(scene: Scene) -> int:
    """Return how many breakpoints, rest and the last one apart, a given table of mu_k has."""
    kinetic = scene.axis.friction.along(scene.drive.values[0]).kinetic
    return max(len(kinetic.velocities) - 2, 0) if kinetic.law is None else 0
