# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How a state begins, and how it takes another contact, for solvers that step."""

from ..axis.codes import DECELERATING, STICK
from ..axis.layout import Parameters
from ..axis.state_record import State, clear_state
from ..core.hot_path import compiled, inlined


@compiled
def begin_state(s: State, position: float, velocity: float, rest: float, stretch: float, deflection: float) -> None:
    """Set the state at time 0: in stick, or slipping with E = 0 on some branch."""
    clear_state(s)
    s.origin, s.velocity, s.mode = position, velocity, STICK
    s.drive = s.spring = stretch
    s.deflection = deflection
    if is_stuck(velocity, deflection):
        s.rest = rest
    else:
        s.direction = 1.0 if velocity > 0.0 else -1.0
        s.mode = DECELERATING


@inlined
def is_stuck(velocity: float, deflection: float) -> bool:
    """Whether a start is in stick: at rest, or in a compliant contact that carries a force, in which it rings."""
    return velocity == 0.0 or deflection != 0.0


@compiled
def change_contact(new: Parameters, s: State, force: float) -> None:
    """Let a stuck slider go on with the contact of other parameters; a compliant one carries the same force, N."""
    if s.mode != STICK:
        return
    if new.compliant != 0.0:
        s.deflection = (force - new.contact_damping * s.velocity) / new.contact_stiffness
    else:
        s.velocity = 0.0
        s.deflection = 0.0
