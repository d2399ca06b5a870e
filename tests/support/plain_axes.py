# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An axis whose numbers are powers of two, so that its forces are exact, and states of it in plain Python."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from stickslip_sim.axis import Axis, CompliantContact, Friction, RigidContact, pack
from stickslip_sim.axis.codes import DECELERATING
from stickslip_sim.axis.forces import segment_above, segment_below
from stickslip_sim.axis.layout import Parameters
from stickslip_sim.axis.rows import EventRow, Events
from stickslip_sim.axis.state_record import State
from stickslip_sim.axis.transitions import apply_inputs
from stickslip_sim.friction import ExcessTable, KineticTable, StaticLaw, StaticLawKind

# N mu_k is 16 N at rest, 8 N at 0.25 m/s, 4 N at 0.5 m/s and 8 N at 0.625 m/s; N mu_s rises from 16 N to 32 N.
STATIC = StaticLaw(StaticLawKind.EXPONENTIAL, 0.25, 0.5, 2.0)
KINETIC = KineticTable((0.0, 0.25, 0.5), (0.25, 0.125, 0.0625), end_slope=0.5)
EXCESS = ExcessTable((0.0, 0.5), (1.0, 0.0))
FRICTION = Friction(STATIC, KINETIC, EXCESS)
CONVENTIONAL = Friction(STATIC, KINETIC, None)
COMPLIANT = CompliantContact(4096.0, 64.0)
AXIS = Axis(2.0, 1024.0, 32.0, 64.0, RigidContact(), FRICTION)

# Backwards mu_s rises from 0.375 to 0.75 within half the time, and N mu_k is 8 N at rest, 2 N at 0.125 m/s.
BACKWARD = Friction(replace(STATIC, initial=0.375, limit=0.75, time_constant=1.0),
                    KineticTable((0.0, 0.125), (0.125, 0.03125)), ExcessTable((0.0, 0.125), (1.0, 0.0)))
SIDED = replace(FRICTION, backward=BACKWARD)


def parameters(axis: Axis = AXIS, **changes: Any) -> Parameters:
    """Return the parameters of an axis with some of its fields changed."""
    return Parameters(pack(replace(axis, **changes)))


def state(**numbers: float) -> State:
    """Return a state with these numbers, those of the inputs (v, v_rate, f, f_rate) too, and all others 0."""
    made = State()
    made.cache.at.time = -1.0   # nothing was evaluated yet
    for name, number in numbers.items():
        setattr(made.inputs if hasattr(made.inputs, name) else made, name, number)
    made.inputs.base_v, made.inputs.base_f = made.inputs.v, made.inputs.f
    return made


def slip(p: Parameters, mode: float, velocity: float, *, direction: float = 1.0, push: float = 0.0, excess: float = 0.0,
         **numbers: float) -> State:
    """Return a slip at `direction` × `velocity`, under F_d + F_e = `direction` × `push`; `numbers` as for `state`.

    The external force makes up for what the drive does not push.
    """
    made = state(mode=mode, direction=direction, velocity=direction * velocity, excess=excess, **numbers)
    find = segment_below if mode == DECELERATING else segment_above
    made.segment = find(p, direction, velocity)
    pushed_by_drive = (p.stiffness * made.spring
                       + p.damping * (p.feed_share * made.inputs.v - made.velocity))   # docs/model.md: F_d
    made.inputs.f = made.inputs.base_f = direction * push - pushed_by_drive
    return made


def ended(transition: Callable[..., object], p: Parameters, s: State, *more: float) -> EventRow:
    """Make a transition; return its event."""
    events = Events(1)
    transition(p, s, events, 0, *more)
    return events.rows[0]


def applied(p: Parameters, s: State) -> EventRow | None:
    """Apply the inputs that the state has; return the event if there is one."""
    events = Events(1)
    return events.rows[0] if apply_inputs(p, s, events, 0) else None
