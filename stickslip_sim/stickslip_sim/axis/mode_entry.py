# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How a mode begins: which sub-mode a slip takes, its excess E, and stick at standstill.

Ties are decided by where the force moves next: a residual within rounding of zero counts as zero, and the sign of its
rate, then of the rate's rate, decides.
"""

from ..core.hot_path import inlined
from .codes import ACCELERATING, COASTING, DECELERATING, STICK
from .forces import applied_force, force_rate, force_rounding, holds_by_drive
from .friction_segments import friction_line, has_branches, kinetic_at_rest, segment_above, segment_below
from .layout import Parameters
from .state_record import State

_TIE = 1e-15   # of the friction force: a closed-form acceleration smaller than that is a tie


@inlined
def choose_slip(p: Parameters, s: State, residual: float, lower: float, tolerance: float) -> bool:
    """Set the slip sub-mode from R − B = `residual` and R = `lower`; return False when the slider comes to rest.

    R = ±(F_d + F_e) − N mu_k along the slip and B = N e(|ẋ|), see docs/model.md.  Neither is made from the other: where
    B is large the small one would lose its digits.
    """
    direction = s.direction
    speed = abs(s.velocity)
    rate, second_rate = force_rate(p, s)
    rate *= direction
    second_rate *= direction
    if abs(residual) <= tolerance:
        residual = 0.0
    if residual > 0.0 or (residual == 0.0 and (rate > 0.0 or (rate == 0.0 and second_rate > 0.0))):
        s.mode = ACCELERATING
        s.segment = segment_above(p, direction, speed)
        s.acceleration = direction * residual / p.mass
        return True
    if speed == 0.0:
        return False
    segment = segment_above(p, direction, speed)
    coefficient, _, psi, _ = friction_line(p, segment, speed)
    band = p.normal_force * s.excess * psi
    if abs(lower) <= min(tolerance, force_rounding(p, s, coefficient)):
        lower = 0.0
    rests_on_edge = lower == 0.0 and ((band > 0.0 and rate > 0.0) or (rate == 0.0 and second_rate >= 0.0))
    if rests_on_edge or (lower > 0.0 and band > 0.0):
        s.mode = COASTING
        s.segment = segment
        s.residual = lower
        s.acceleration = 0.0
        return True
    s.mode = DECELERATING
    s.segment = segment_below(p, direction, speed)
    s.acceleration = direction * lower / p.mass
    return True


@inlined
def enter_branch(p: Parameters, s: State, mode: float) -> None:
    """Begin to accelerate or decelerate with no acceleration yet."""
    s.mode = mode
    speed = abs(s.velocity)
    s.segment = (segment_above(p, s.direction, speed) if mode == ACCELERATING
                 else segment_below(p, s.direction, speed))
    s.acceleration = 0.0


@inlined
def break_away(p: Parameters, s: State, direction: float, limit: float, margin: float) -> None:
    """Begin a slip at the friction coefficient `limit`; `margin` is how far the force is beyond it along the slip, N.

    The excess E of this slip makes friction continuous; without acceleration dependence, or at a speed where psi has
    ended, friction drops to mu_k at once.
    """
    speed = abs(s.velocity)
    coefficient, _, psi, _ = friction_line(p, segment_above(p, direction, speed), speed)
    s.excess = 0.0
    s.direction = direction
    tolerance = force_rounding(p, s, limit)
    if not holds_by_drive(p):
        margin += direction * p.mass * s.acceleration
        tolerance = _TIE * p.normal_force * limit
    residual = lower = margin + p.normal_force * (limit - coefficient)
    if has_branches(p) and psi > 0.0 and limit >= coefficient:
        s.excess = (limit - coefficient) / psi
        residual = margin
    s.rest = 0.0
    s.deflection = 0.0
    if not choose_slip(p, s, residual, lower, tolerance):
        rest(p, s)


@inlined
def rest(p: Parameters, s: State) -> None:
    """Begin to stick at standstill."""
    s.mode = STICK
    s.rest = 0.0
    s.velocity = 0.0
    s.acceleration = 0.0
    s.deflection = 0.0
    if p.compliant != 0.0:
        friction = s.direction * p.normal_force * kinetic_at_rest(p, s.direction) * p.arrest_share
        s.deflection = friction / p.contact_stiffness
        s.acceleration = (applied_force(p, s) - friction) / p.mass
    s.direction = 0.0
