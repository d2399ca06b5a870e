# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How a state begins, and how it takes another contact, for solvers that step."""

from ..axis.codes import DECELERATING, STICK, YIELDING
from ..axis.forces import applied_force, contact_force, is_rigid_stick
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


@inlined
def held_force(p: Parameters, s: State) -> float:
    """Return what the contact carries at the segment start, or would where the interface of one that yields stood."""
    return applied_force(p, s) if is_rigid_stick(p, s) else contact_force(p, s.deflection, s.velocity)


@compiled
def change_contact(new: Parameters, s: State, force: float) -> None:
    """Let a slider that does not slip go on with the contact of other parameters; at rest that carries `force`, N."""
    if s.mode != STICK and s.mode != YIELDING:
        return
    if new.compliant != 0.0:
        s.deflection = (force - new.contact_damping * s.velocity) / new.contact_stiffness
    else:
        s.velocity = 0.0
        s.deflection = 0.0
