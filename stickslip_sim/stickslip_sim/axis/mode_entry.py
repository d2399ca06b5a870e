# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How a mode begins: which sub-mode a slip takes, its excess E, stick at standstill, and a contact that yields.

Ties are decided by where the force moves next: a residual within rounding of zero counts as zero, and the sign of its
rate, then of the rate's rate, decides.
"""

import math

from ..core.hot_path import inlined
from .codes import ACCELERATING, COASTING, DECELERATING, STICK, YIELDING
from .forces import (
    ROUNDING,
    applied_force,
    begin_stick,
    contact_force,
    first_segment,
    force_rate,
    force_rounding,
    friction_line,
    has_branches,
    holds_by_drive,
    holds_nothing,
    kinetic_at_rest,
    segment_above,
    segment_below,
    yielding_force,
)
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
    segment = segment_above(p, direction, speed)
    coefficient, _, psi, _ = friction_line(p, segment, speed)
    upper_rate = rate - s.inputs.n_rate * (coefficient + s.excess * psi)
    if abs(residual) <= tolerance:
        residual = 0.0
    if residual > 0.0 or (residual == 0.0 and (upper_rate > 0.0 or (upper_rate == 0.0 and second_rate > 0.0))):
        s.mode = ACCELERATING
        s.segment = segment
        s.acceleration = direction * residual / p.mass
        return True
    if speed == 0.0:
        return False
    rate -= s.inputs.n_rate * coefficient
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
        begin_stick(p, s)
        rest(p, s)


@inlined
def rest(p: Parameters, s: State) -> None:
    """Begin to stick at standstill.

    A contact that holds nothing does not move under a force within rounding of 0 (`unbalanced`).
    """
    s.mode = STICK
    s.rest = 0.0
    s.velocity = 0.0
    s.acceleration = 0.0
    s.deflection = 0.0
    if p.compliant != 0.0:
        friction = s.direction * p.normal_force * kinetic_at_rest(p, s.direction) * p.arrest_share
        s.deflection = friction / p.contact_stiffness
        s.acceleration = unbalanced(p, s, friction) / p.mass
    s.direction = 0.0


@inlined
def unbalanced(p: Parameters, s: State, held: float) -> float:
    """Return F_d + F_e − F_c in compliant stick, which is 0 where nothing is held and it is no more than rounding."""
    residual = applied_force(p, s) - held
    if not holds_nothing(p) or s.velocity != 0.0:
        return residual
    rounding = limit_rounding(p, s, 0.0) if p.ends_by_drive != 0.0 else ROUNDING * s.swing
    return 0.0 if abs(residual) <= rounding else residual


@inlined
def note_swing(p: Parameters, s: State) -> None:
    """Keep, at a standstill, the largest force on a slider that nothing holds: of its rounding the swing dies out."""
    s.swing = max(s.swing, abs(applied_force(p, s))) if holds_nothing(p) else 0.0


@inlined
def limit_rounding(p: Parameters, s: State, limit: float) -> float:
    """Return the rounding of a force beside N mu_s = N `limit`: where nothing is held, that of the swing, too."""
    rounding = force_rounding(p, s, limit)
    return max(rounding, ROUNDING * s.swing) if holds_nothing(p) else rounding


@inlined
def yields(p: Parameters, s: State, side: float, limit: float) -> bool:
    """Whether a contact whose force is at N mu_s = N `limit` of a side yields: unless the slider moves to that side.

    A velocity within rounding of 0 counts as 0; then the force beyond the limit says where it moves next, and in a tie
    the rate of that.  See docs/model.md.
    """
    if holds_by_drive(p):
        return False
    tolerance = force_rounding(p, s, limit)
    if abs(s.velocity) * math.sqrt(p.mass * (p.stiffness + p.contact_stiffness)) > tolerance:
        return side * s.velocity < 0.0
    beyond = side * applied_force(p, s) - p.normal_force * limit
    if abs(beyond) > tolerance:
        return beyond < 0.0
    rate, _ = force_rate(p, s)
    return side * rate < s.inputs.n_rate * limit


@inlined
def begin_yielding(p: Parameters, s: State, side: float) -> None:
    """Let the contact yield, or go on to yield under new inputs: its force is N mu_k(0), which δ follows.

    Without a damper δ jumps.
    """
    s.mode = YIELDING
    s.direction = side
    s.segment = float(first_segment(p, side))
    s.excess = 0.0
    s.rest = 0.0
    if p.contact_damping == 0.0:
        s.deflection = yielding_force(p, s) / p.contact_stiffness
    s.acceleration = (applied_force(p, s) - yielding_force(p, s)) / p.mass


@inlined
def keeps_yielding(p: Parameters, s: State) -> bool:
    """Whether a contact that yields slides on: at rest it would carry more than N mu_k(0), in a tie soon."""
    coefficient = kinetic_at_rest(p, s.direction)
    held = s.direction * contact_force(p, s.deflection, s.velocity)
    beyond = held - p.normal_force * coefficient
    acceleration = (applied_force(p, s) - yielding_force(p, s)) / p.mass
    sizes = p.contact_stiffness * abs(s.deflection) + p.contact_damping * abs(s.velocity)
    if abs(beyond) > force_rounding(p, s, coefficient) + ROUNDING * sizes:
        return beyond > 0.0
    rate = s.direction * (p.contact_stiffness * s.velocity + p.contact_damping * acceleration)
    return rate > s.inputs.n_rate * coefficient
