# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The forces on the slider: of the drive, the contact and friction; their rounding and rates at the segment start."""

import math
from typing import NamedTuple

from ..core.hot_path import compiled, inlined
from ..friction.static import static_coefficient, stick_factor
from .codes import ACCELERATING, COASTING, STICK, YIELDING
from .layout import Parameters
from .sinusoids import forced_rate
from .state_record import State

# Kinetic friction on the segments of the tables: which segment a speed is on, mu_k and psi along it.

@inlined
def first_segment(p: Parameters, direction: float) -> int:
    """Return the index of the segment of the tables at standstill, for motion in a direction."""
    return int(p.backward_segment) if direction < 0.0 else 0


@inlined
def segment_above(p: Parameters, direction: float, speed: float) -> int:
    """Return the index of the table's segment that goes up from a speed: a breakpoint belongs to the one above it."""
    segment = first_segment(p, direction)
    while p.segments[segment].end <= speed < math.inf:
        segment += 1
    return segment


@inlined
def segment_below(p: Parameters, direction: float, speed: float) -> int:
    """Return the index of the table's segment that goes down from a speed: a breakpoint belongs to the one below it."""
    segment = segment_above(p, direction, speed)
    return segment - 1 if speed > 0.0 and p.segments[segment].speed == speed else segment


@inlined
def breakpoint_speed(p: Parameters, segment: int) -> float:
    """Return the speed at which a segment begins: 0 at standstill."""
    return p.segments[segment].speed


@inlined
def segment_end(p: Parameters, segment: int) -> float:
    """Return the speed of the breakpoint at which a segment ends, infinity for the last one of its direction."""
    return p.segments[segment].end


@inlined
def friction_line(p: Parameters, segment: int, speed: float) -> tuple[float, float, float, float]:
    """Return mu_k, its slope, psi and its slope at `speed` on a segment of the table."""
    beyond = speed - p.segments[segment].speed
    slope, psi_slope = p.segments[segment].slope, p.segments[segment].psi_slope
    return p.segments[segment].friction + slope * beyond, slope, p.segments[segment].psi + psi_slope * beyond, psi_slope


@inlined
def slip_friction(p: Parameters, s: State) -> tuple[float, float]:
    """Return the coefficient of friction on the present branch and segment as a line: at standstill, and its slope."""
    coefficient, slope, psi, psi_slope = friction_line(p, int(s.segment), 0.0)
    if s.mode == ACCELERATING:
        return coefficient + s.excess * psi, slope + s.excess * psi_slope
    return coefficient, slope


@inlined
def kinetic_at_rest(p: Parameters, direction: float) -> float:
    """Return mu_k(0) in a direction."""
    return p.segments[first_segment(p, direction)].friction


@inlined
def has_branches(p: Parameters) -> bool:
    """Whether friction depends on the sign of the acceleration."""
    return p.branches != 0.0


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


# The static limit of an axis: mu_s after a rest time, against a force of either direction.

class StaticNumbers(NamedTuple):
    """The numbers of the static law in one direction: mu_0, mu_inf, tau in s, Kato's exponent."""

    initial: float
    limit: float
    tau: float
    exponent: float


@inlined
def static_numbers(p: Parameters, side: float) -> StaticNumbers:
    """Return the numbers of the static law against a force of this sign."""
    if side < 0.0 and p.sided != 0.0:
        return StaticNumbers(p.stick_backward_initial, p.stick_backward_limit, p.backward_tau, p.backward_exponent)
    return StaticNumbers(p.stick_initial, p.stick_limit, p.static_tau, p.static_exponent)


@inlined
def static_limit(p: Parameters, rest: float, side: float) -> float:
    """Return mu_s after the rest time, against a force of this sign."""
    of = static_numbers(p, side)
    return static_coefficient(p.static_law, of.initial, of.limit, of.tau, of.exponent,
                              max(rest - p.static_delay, 0.0))


@inlined
def limit_backwards(p: Parameters, rest: float, forwards: float) -> float:
    """Return mu_s backwards after the rest time, given that forwards: the same, where there is no difference."""
    return static_limit(p, rest, -1.0) if p.sided != 0.0 else forwards


@inlined
def lower_limit(p: Parameters, rest: float) -> float:
    """Return mu_s after the rest time, the smaller one of both directions."""
    limit = static_limit(p, rest, 1.0)
    return min(limit, limit_backwards(p, rest, limit))


@inlined
def static_at_once(p: Parameters, side: float) -> float:
    """Return mu_s at rest time 0 against a force of this sign."""
    return p.stick_backward_initial if side < 0.0 else p.stick_initial


@inlined
def take_stick(p: Parameters, s: State) -> None:
    """Let the parameters have the static law of the state's stick."""
    if p.drawn_sticks != s.sticks + 1.0:
        _draw_stick(p, s.sticks)


@inlined
def begin_stick(p: Parameters, s: State) -> None:
    """Let the next stick have a static law of its own, where that scatters."""
    if p.scatter != 0.0:
        s.sticks += 1.0
        _draw_stick(p, s.sticks)


@compiled
def _draw_stick(p: Parameters, stick: float) -> None:
    p.drawn_sticks = stick + 1.0
    p.stick_initial, p.stick_limit = p.static_initial, p.static_limit
    p.stick_backward_initial, p.stick_backward_limit = p.backward_initial, p.backward_limit
    if p.scatter == 0.0 and p.scatter_run == 0.0:
        return
    factor = stick_factor(p.seed, p.scatter, p.scatter_run, stick)
    p.stick_initial = max(factor * p.static_initial, kinetic_at_rest(p, 1.0))
    p.stick_limit = max(factor * p.static_limit, p.stick_initial)
    p.stick_backward_initial = max(factor * p.backward_initial, kinetic_at_rest(p, -1.0))
    p.stick_backward_limit = max(factor * p.backward_limit, p.stick_backward_initial)


@inlined
def holds_nothing(p: Parameters) -> bool:
    """Whether the static limit is 0 at any rest time: no normal force, or no static friction."""
    return p.normal_force * max(p.static_limit, p.backward_limit) == 0.0
