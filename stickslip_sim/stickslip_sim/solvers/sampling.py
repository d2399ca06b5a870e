# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The row of a sample, for every solver."""

from ..axis.layout import COMPLIANT, DEFLECTION, DIRECTION, DRIVE, MODE, NORMAL, ORIGIN, POSITION, REST
from ..axis.motion import STICK
from ..core.jit import inlined


@inlined
def write_sample(p, s, second, fraction, t, y, u, a, drive, v, pull, force, friction, out):
    """Fill a row (`types.Sample` names the columns): t, travel y and drive travel since the state s, the rest at t."""
    stuck = s[MODE] == STICK
    out[0] = second
    out[1] = fraction
    out[2] = s[MODE]
    out[3] = s[DIRECTION]
    out[4] = s[ORIGIN] + (s[POSITION] + y)
    out[5] = u
    out[6] = a
    out[7] = s[ORIGIN] + (s[DRIVE] + drive)
    out[8] = v
    out[9] = pull
    out[10] = force
    out[11] = friction
    out[12] = abs(friction) / p[NORMAL] if p[NORMAL] > 0.0 else 0.0
    out[13] = s[DEFLECTION] + y if stuck and p[COMPLIANT] != 0.0 else 0.0
    out[14] = s[REST] + t if stuck else 0.0
