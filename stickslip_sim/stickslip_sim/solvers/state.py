# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How a state begins, and how it takes another contact, for solvers that step."""

from ..axis.layout import (
    COMPLIANT, CONTACT_DAMPING, CONTACT_STIFFNESS, DEFLECTION, DIRECTION, MODE, ORIGIN, REST, STATE_SIZE, VELOCITY,
)
from ..axis.motion import DECELERATING, STICK
from ..core.jit import compiled


@compiled
def begin_state(s, position, velocity, rest):
    """Set the state at time 0, the spring unstretched: at rest, or slipping with E = 0 on some branch."""
    for i in range(STATE_SIZE):
        s[i] = 0.0
    s[ORIGIN], s[VELOCITY], s[MODE] = position, velocity, STICK
    if velocity == 0.0:
        s[REST] = rest
    else:
        s[DIRECTION] = 1.0 if velocity > 0.0 else -1.0
        s[MODE] = DECELERATING


@compiled
def change_contact(new, s, force):
    """Let a stuck slider go on with the contact of other parameters; a compliant one carries the same force, N."""
    if s[MODE] != STICK:
        return
    if new[COMPLIANT] != 0.0:
        s[DEFLECTION] = (force - new[CONTACT_DAMPING] * s[VELOCITY]) / new[CONTACT_STIFFNESS]
    else:
        s[VELOCITY] = 0.0
        s[DEFLECTION] = 0.0
