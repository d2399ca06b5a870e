# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The forces on the slider: of the drive, the contact and friction; their rounding and rates at the segment start."""

from ..core.hot_path import inlined
from .codes import ACCELERATING, COASTING, STICK, YIELDING
from .friction_segments import friction_line, kinetic_at_rest
from .layout import Parameters
from .sinusoids import forced_rate
from .state_record import State

ROUNDING = 8.0 * 2.220446049250313e-16   # of the terms of a sum of forces


@inlined
def drive_force(p: Parameters, spring: float, v: float, u: float) -> float:
    """Return F_d = c (s − x) + h (v − ẋ); with a damper on the slideway what it gives is in it, too."""
    return p.stiffness * spring + p.damping * (p.feed_share * v - u)


@inlined
def stated_drive_force(p: Parameters, force: float, u: float) -> float:
    """Return F_d as it is reported, from that of `drive_force`: a damper on the slideway is no part of it."""
    return force if p.feed_share != 0.0 else force + p.damping * u


@inlined
def feed_damping(p: Parameters) -> float:
    """Return the part of h that acts on the drive's velocity, N s/m."""
    return p.damping * p.feed_share


@inlined
def ground_damping(p: Parameters) -> float:
    """Return the part of h that acts on the slider's velocity alone, N s/m."""
    return p.damping - feed_damping(p)


@inlined
def contact_force(p: Parameters, deflection: float, u: float) -> float:
    """Return F_c = c_c δ + h_c ẋ of the compliant contact."""
    return p.contact_stiffness * deflection + p.contact_damping * u


@inlined
def is_rigid_stick(p: Parameters, s: State) -> bool:
    """Whether the slider stands still in a rigid contact."""
    return s.mode == STICK and p.compliant == 0.0


@inlined
def friction_force(p: Parameters, s: State, deflection: float, u: float, applied: float) -> float:
    """Return the friction force at velocity u in the present mode, under `applied` = F_d + F_e."""
    mode = s.mode
    if mode == COASTING or is_rigid_stick(p, s):
        return applied
    if mode == STICK:
        return contact_force(p, deflection, u)
    if mode == YIELDING:
        return yielding_force(p, s)
    coefficient, _, psi, _ = friction_line(p, int(s.segment), abs(u))
    if mode == ACCELERATING:
        coefficient += s.excess * psi
    return s.direction * p.normal_force * coefficient


@inlined
def yielding_force(p: Parameters, s: State) -> float:
    """Return the force of a contact that yields, N mu_k(0) along its direction."""
    return s.direction * p.normal_force * kinetic_at_rest(p, s.direction)


@inlined
def applied_force(p: Parameters, s: State) -> float:
    """Return F_d + F_e at the segment start."""
    return drive_force(p, s.spring, s.inputs.v, s.velocity) + s.inputs.f


@inlined
def holds_by_drive(p: Parameters) -> bool:
    """Whether F_d + F_e is what the static limit holds: in a rigid contact, and in a compliant one that ends by it."""
    return p.compliant == 0.0 or p.ends_by_drive != 0.0


@inlined
def stick_force(p: Parameters, s: State) -> float:
    """Return the force in stick that ends it at the static limit."""
    return applied_force(p, s) if holds_by_drive(p) else contact_force(p, s.deflection, s.velocity)


@inlined
def band_of(p: Parameters, s: State) -> float:
    """Return B = N e(|ẋ|), the width of the coasting band at the segment start, N."""
    _, _, psi, _ = friction_line(p, int(s.segment), abs(s.velocity))
    return p.normal_force * s.excess * psi


@inlined
def force_rounding(p: Parameters, s: State, friction: float) -> float:
    """Return the size of rounding errors in a sum of the forces at the segment start."""
    return ROUNDING * (p.stiffness * abs(s.spring) + p.damping * (abs(s.inputs.v) + abs(s.velocity)) + abs(s.inputs.f)
                       + p.normal_force * friction)


@inlined
def force_rate(p: Parameters, s: State) -> tuple[float, float]:
    """Return the rate of F_d + F_e at constant velocity, and the rate's rate; within rounding of 0 the first is 0."""
    if s.sinusoid_count != 0.0:
        return forced_rate(p, s)
    pushed = feed_damping(p) * s.inputs.v_rate + s.inputs.f_rate
    rate = p.stiffness * (s.inputs.v - s.velocity) + pushed
    if abs(rate) <= ROUNDING * (p.stiffness * (abs(s.inputs.v) + abs(s.velocity)) + abs(pushed)):
        rate = 0.0
    return rate, p.stiffness * s.inputs.v_rate
