# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a run still obeys itself: by the ends of the mode that it is in, and by its balance of energy.

The engine goes from root to root.  A root that is none leaves a state off the limit that it was to reach; one that was
passed over leaves a state beyond the ends of its mode; an overflow leaves the balance open.  A run with an account is
checked at each event, before that is written, and at its end; one that is off ends there, and has no figures to give.
What is allowed is far above rounding, and far below what a figure would show.
"""

import math

from ...axis.codes import ACCELERATE, ACCELERATING, COAST, COASTING, STICK, YIELDING
from ...axis.forces import (
    band_of,
    breakpoint_speed,
    contact_force,
    drive_force,
    friction_line,
    holds_by_drive,
    limit_backwards,
    segment_end,
    static_at_once,
    static_limit,
    take_stick,
)
from ...axis.layout import Parameters
from ...axis.motion import drive_travel, spring_after, travel
from ...axis.sinusoids import inputs_at
from ...axis.smooth_load import normal_force_at, take_load
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from .works import balance

ALLOWED = 1e-6   # of the throughput of energy; of the forces that add up; of the speeds that were passed
_ROUNDING = 64.0 * 2.220446049250313e-16   # of forces that add up
_TIME = 8.0 * 2.220446049250313e-16        # of a time


@compiled
def event_is_sound(p: Parameters, s: State, begin: float) -> bool:
    """Whether the state at an event, in a mode that began at the velocity `begin`, is where that says, in balance."""
    if s.mode == STICK:
        sound = _holds(p, s, s.next.time, s.spring, s.deflection, s.velocity, s.acceleration, s.inputs.v, s.inputs.f,
                       s.rest, 1.0)
    elif s.mode == COASTING:
        end = band_of(p, s) if s.next.kind == ACCELERATE else 0.0
        sound = _coasts(p, s, 0.0, s.spring, s.inputs.v, s.inputs.f, end, end)
    else:
        sound = s.mode == YIELDING or _slips(p, s, s.velocity, begin, s.next.kind != COAST)
    return sound and _balances(p, s, 0.0, s.spring, s.inputs.v, s.velocity, begin, s.inputs.f)


@compiled
def is_sound(p: Parameters, s: State, second: float, fraction: float) -> bool:
    """Whether the state at a time between the segment start and the next event is within its mode, and in balance."""
    t = (second - s.second) + (fraction - s.fraction)
    take_load(p, s)
    take_stick(p, s)
    y, u, a = travel(p, s, t)
    p.normal_force, _ = normal_force_at(p, s, t)
    v, force = s.inputs.v + s.inputs.v_rate * t, s.inputs.f + s.inputs.f_rate * t
    if s.sinusoid_count != 0.0:
        v, force = inputs_at(s, second, fraction, t)
    spring = spring_after(p, s, t, drive_travel(s, t), y, u, a)
    if s.mode == STICK:
        sound = _holds(p, s, t, spring, s.deflection + y, u, a, v, force, s.rest + t, 0.0)
    elif s.mode == COASTING:
        sound = _coasts(p, s, t, spring, v, force, 0.0, band_of(p, s))
    else:
        sound = s.mode == YIELDING or _slips(p, s, u, s.velocity, False)
    take_load(p, s)
    return sound and _balances(p, s, t, spring, v, u, s.velocity, force)


@inlined
def _holds(p: Parameters, s: State, t: float, spring: float, deflection: float, u: float, a: float, v: float,
           force: float, rest: float, share: float) -> bool:
    """Whether the force in stick is at most N mu_s of its direction, and at least `share` of that, either way."""
    held = drive_force(p, spring, v, u) + force
    limit = static_limit(p, rest, 1.0)
    top, bottom = p.normal_force * limit, p.normal_force * limit_backwards(p, rest, limit)
    slack = ALLOWED * _forces(p, spring, v, u, force, max(top, bottom)) + _ROUNDING * s.swing
    if not holds_by_drive(p):   # what a stiff one does within the rounding of the time
        held = contact_force(p, deflection, u)
        slack += _TIME * t * (p.contact_stiffness * abs(u) + p.contact_damping * abs(a))
    return -bottom - slack <= held <= top + slack and (share * top - slack <= held or share * bottom - slack <= -held)


@inlined
def _coasts(p: Parameters, s: State, t: float, spring: float, v: float, force: float, low: float, high: float) -> bool:
    """Whether the residual while coasting is between two ends of its band.

    It began at one of them; the spring's stretch is the difference of two paths, and knows that end no better.
    """
    u = s.velocity
    friction = p.normal_force * friction_line(p, int(s.segment), abs(u))[0]
    residual = s.direction * (drive_force(p, spring, v, u) + force) - friction
    slack = ALLOWED * _forces(p, spring, v, u, force, p.normal_force * static_at_once(p, s.direction))
    slack += _ROUNDING * p.stiffness * _path(s, t, v, u)
    return low - slack <= residual <= high + slack


@inlined
def _slips(p: Parameters, s: State, u: float, begin: float, at_an_end: bool) -> bool:
    """Whether the speed of a slip is on its segment of the table, or at the end of it to which it goes."""
    speed, segment = s.direction * u, int(s.segment)
    slack = ALLOWED * (abs(u) + abs(begin) + abs(s.inputs.v))
    low = breakpoint_speed(p, segment)
    if at_an_end:
        end = segment_end(p, segment) if s.mode == ACCELERATING else low
        return abs(speed - end) <= slack
    return low - slack <= speed <= segment_end(p, segment) + slack


@inlined
def _balances(p: Parameters, s: State, t: float, spring: float, v: float, u: float, begin: float,
              force: float) -> bool:
    """Whether the balance of energy is open by no more than a share of what went through, or than forces round to.

    A load that comes and goes within one stick goes through without a trace: what the spring holds at the limit counts.
    What rounding leaves of the forces at the velocity `begin`, where the motion began, is lost along its whole path.
    """
    left, scale = balance(p, s, t)
    top = p.normal_force * max(p.stick_limit, p.stick_backward_limit)
    if p.stiffness > 0.0:
        scale = max(scale, 0.5 * top * top / p.stiffness)
    fastest = max(abs(u), abs(begin))
    forces = _forces(p, spring, v, fastest, force, top)
    if s.mode != STICK and s.mode != COASTING:   # on a steep segment of the table
        forces += 2.0 * p.mass * abs(s.oscillator.gamma) * (abs(v) + fastest)
    return left <= ALLOWED * scale + _ROUNDING * forces * _path(s, t, v, u) and scale < math.inf


@inlined
def _path(s: State, t: float, v: float, u: float) -> float:
    """Return how far drive and slider went, m."""
    return abs(s.drive) + abs(s.position) + (abs(v) + abs(u)) * t


@inlined
def _forces(p: Parameters, spring: float, v: float, u: float, force: float, friction: float) -> float:
    """Return the size of the forces that add up."""
    return p.stiffness * abs(spring) + p.damping * (abs(v) + abs(u)) + abs(force) + friction
