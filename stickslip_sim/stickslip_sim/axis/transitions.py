# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What happens between two modes: break-away, arrest, the choice of the slip sub-mode, jumps of the inputs.

Ties are decided by where the force moves next: a residual within rounding of zero counts as zero, and the sign of its
rate, then of the rate's rate, decides.
"""

from ..core.hot_path import compiled, inlined
from ..core.types import EventKind
from .layout import Parameters, State
from .motion import (
    ACCELERATING,
    COASTING,
    DECELERATING,
    STICK,
    breakpoint_speed,
    contact_force,
    drive_force,
    feed_damping,
    friction_force,
    friction_line,
    has_branches,
    kinetic_at_rest,
    segment_above,
    segment_below,
    stated_drive_force,
    static_at_once,
    static_limit,
)
from .rows import Events
from .sinusoids import forced_rate

BREAKAWAY = float(EventKind.BREAKAWAY)
COAST = float(EventKind.COAST)
ACCELERATE = float(EventKind.ACCELERATE)
DECELERATE = float(EventKind.DECELERATE)
ARREST = float(EventKind.STICK)
REVERSE = float(EventKind.REVERSE)
KNOT = float(EventKind.KNOT)

_ROUNDING = 8.0 * 2.220446049250313e-16
_MUCH = 16.0     # so much more is lost on a steep segment of the table before the forces know it better
_TIE = 1e-15   # of the friction force: a closed-form acceleration smaller than that is a tie


@inlined
def applied_force(p: Parameters, s: State) -> float:
    """Return F_d + F_e at the segment start."""
    return drive_force(p, s.spring, s.inputs.v, s.velocity) + s.inputs.f


@inlined
def holds_by_drive(p: Parameters) -> bool:
    """Whether F_d + F_e is what the static limit holds: in a rigid contact, and where a compliant one is so judged."""
    return p.compliant == 0.0 or p.judges_drive != 0.0


@inlined
def stick_force(p: Parameters, s: State) -> float:
    """Return the force in stick that ends it at the static limit."""
    return applied_force(p, s) if holds_by_drive(p) else contact_force(p, s.deflection, s.velocity)


@inlined
def force_rounding(p: Parameters, s: State, friction: float) -> float:
    """Return the size of rounding errors in a sum of the forces at the segment start."""
    return _ROUNDING * (p.stiffness * abs(s.spring) + p.damping * (abs(s.inputs.v) + abs(s.velocity)) + abs(s.inputs.f)
                        + p.normal_force * friction)


@inlined
def write_event(p: Parameters, s: State, events: Events, row: int, kind: float, direction: float, friction: float,
                limit: float) -> None:
    """Write a row with the state at the segment start and mu_s = `limit`; who calls it adds the mode that follows."""
    events.rows[row].second = s.second
    events.rows[row].fraction = s.fraction
    events.rows[row].kind = kind
    events.rows[row].direction = direction
    events.rows[row].position = s.origin + s.position
    events.rows[row].velocity = s.velocity
    events.rows[row].drive = s.origin + s.drive
    events.rows[row].drive_force = stated_drive_force(p, drive_force(p, s.spring, s.inputs.v, s.velocity), s.velocity)
    events.rows[row].friction = friction
    events.rows[row].static = limit
    events.rows[row].rest = s.rest


@inlined
def force_rate(p: Parameters, s: State) -> tuple[float, float]:
    """Return the rate of F_d + F_e at constant velocity, and the rate's rate; within rounding of 0 the first is 0."""
    if s.sinusoid_count != 0.0:
        return forced_rate(p, s)
    pushed = feed_damping(p) * s.inputs.v_rate + s.inputs.f_rate
    rate = p.stiffness * (s.inputs.v - s.velocity) + pushed
    if abs(rate) <= _ROUNDING * (p.stiffness * (abs(s.inputs.v) + abs(s.velocity)) + abs(pushed)):
        rate = 0.0
    return rate, p.stiffness * s.inputs.v_rate


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
def band_of(p: Parameters, s: State) -> float:
    """Return B = N e(|ẋ|), the width of the coasting band at the segment start, N."""
    _, _, psi, _ = friction_line(p, int(s.segment), abs(s.velocity))
    return p.normal_force * s.excess * psi


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


@inlined
def arrest(p: Parameters, s: State, events: Events, row: int) -> None:
    """End a slip at standstill: stick, or reverse at once where a rigid contact cannot hold the force."""
    s.velocity = 0.0
    friction = s.direction * p.normal_force * kinetic_at_rest(p, s.direction)
    force = applied_force(p, s)
    direction = 1.0 if force > 0.0 else -1.0
    limit = static_at_once(p, direction)
    margin = abs(force) - p.normal_force * limit
    if holds_by_drive(p) and margin > force_rounding(p, s, limit):
        write_event(p, s, events, row, REVERSE, direction, friction, limit)
        break_away(p, s, direction, limit, margin)
    else:
        write_event(p, s, events, row, ARREST, s.direction, friction, static_at_once(p, s.direction))
        rest(p, s)
    events.rows[row].mode = s.mode


@inlined
def release(p: Parameters, s: State, events: Events, row: int) -> None:
    """Begin a slip from stick, where |F| has reached N mu_s(t⁻)."""
    force = stick_force(p, s)
    direction = _direction_out(p, s, force)
    limit = static_limit(p, s.rest, direction)
    margin = direction * force - p.normal_force * limit
    if margin <= force_rounding(p, s, limit):
        margin = 0.0
    friction = direction * p.normal_force * limit
    if s.velocity * direction < 0.0:   # friction turns round: it opposes the motion from now on
        direction = -direction
        margin = -(margin + 2.0 * p.normal_force * limit)
    write_event(p, s, events, row, BREAKAWAY, direction, friction, limit)
    break_away(p, s, direction, limit, margin)
    events.rows[row].mode = s.mode


@compiled
def _direction_out(p: Parameters, s: State, force: float) -> float:
    """Return the direction in which stick breaks: of the nearer limit; where nothing acts yet, of the next derivative.

    The force is nearer to the limit of its own side of the middle between both, which is 0 where they are equal.
    """
    rate, second_rate = force_rate(p, s)
    if p.sided != 0.0:
        force -= 0.5 * p.normal_force * (static_limit(p, s.rest, 1.0) - static_limit(p, s.rest, -1.0))
    push = force if abs(force) > force_rounding(p, s, 0.0) else 0.0
    if push == 0.0 and p.compliant != 0.0:
        push = s.velocity if s.velocity != 0.0 else s.acceleration
    if push == 0.0:
        push = rate if rate != 0.0 else second_rate
    return 1.0 if push > 0.0 else -1.0


@inlined
def turn(p: Parameters, s: State, events: Events, row: int) -> None:
    """Leave a sub-mode where its acceleration vanishes: coast, or pass to the other branch where they coincide."""
    mode = s.mode
    direction = s.direction
    friction = friction_force(p, s, 0.0, s.velocity, 0.0)
    band = band_of(p, s)
    s.acceleration = 0.0
    rate, second_rate = force_rate(p, s)
    slides_steadily = rate == 0.0 and second_rate == 0.0
    if band > 0.0 or slides_steadily:
        if slides_steadily and s.inputs.f_rate == 0.0:
            s.velocity = s.inputs.v
        s.mode = COASTING
        s.residual = band if mode == ACCELERATING else 0.0
        kind = COAST
    elif mode == ACCELERATING:
        enter_branch(p, s, DECELERATING)
        kind = DECELERATE
    else:
        enter_branch(p, s, ACCELERATING)
        kind = ACCELERATE
    write_event(p, s, events, row, kind, direction, friction, static_at_once(p, direction))
    events.rows[row].mode = s.mode


@inlined
def enter_branch(p: Parameters, s: State, mode: float) -> None:
    """Begin to accelerate or decelerate with no acceleration yet."""
    s.mode = mode
    speed = abs(s.velocity)
    s.segment = (segment_above(p, s.direction, speed) if mode == ACCELERATING
                 else segment_below(p, s.direction, speed))
    s.acceleration = 0.0


@inlined
def leave_coast(p: Parameters, s: State, events: Events, row: int, kind: float) -> None:
    """Leave the coasting band: upwards to accelerate, downwards to decelerate."""
    write_event(p, s, events, row, kind, s.direction, applied_force(p, s), static_at_once(p, s.direction))
    enter_branch(p, s, ACCELERATING if kind == ACCELERATE else DECELERATING)
    events.rows[row].mode = s.mode


@compiled
def cross_breakpoint(p: Parameters, s: State, events: Events, row: int, before: float) -> None:
    """Go on along the next segment of the friction table; the speed is that of the breakpoint, exactly.

    So is the acceleration of the balance of forces there, but for their rounding; that of the closed form is off by the
    rounding of how it began, `before`, and of what the segment gave to it.  The one that is off less is taken.
    """
    lost = p.mass * (abs(before) + 2.0 * abs(s.oscillator.gamma * s.velocity))
    step = 1.0 if s.mode == ACCELERATING else -1.0
    upper = int(s.segment + (1.0 if step > 0.0 else 0.0))
    speed = breakpoint_speed(p, upper)
    coefficient, _, psi, _ = friction_line(p, upper, speed)
    if s.mode == ACCELERATING:
        coefficient += s.excess * psi
    friction = s.direction * p.normal_force * coefficient
    s.velocity = s.direction * speed
    write_event(p, s, events, row, KNOT, s.direction, friction, static_at_once(p, s.direction))
    s.segment += step
    if lost > _MUCH * p.normal_force * coefficient and _ROUNDING * lost > _MUCH * force_rounding(p, s, coefficient):
        s.acceleration = (applied_force(p, s) - friction) / p.mass
    if step * s.direction * s.acceleration < 0.0:   # the speed peaks here: a tie, which the force's rate decides
        s.acceleration = 0.0
    events.rows[row].mode = s.mode


@inlined
def apply_inputs(p: Parameters, s: State, events: Events, row: int) -> bool:
    """Choose the mode anew after a jump of an input or a parameter; return True if that wrote an event."""
    mode = s.mode
    if mode == STICK:
        return _press_stick(p, s, events, row)
    direction = s.direction
    if direction * s.velocity < 0.0:   # standstill is due, and passed by rounding alone
        s.velocity = 0.0
    speed = abs(s.velocity)
    coefficient, _, psi, _ = friction_line(p, segment_above(p, direction, speed), speed)
    upper = coefficient + s.excess * psi
    push = direction * applied_force(p, s)
    residual, lower = push - p.normal_force * upper, push - p.normal_force * coefficient
    if not choose_slip(p, s, residual, lower, force_rounding(p, s, upper)):
        arrest(p, s, events, row)
        return True
    if s.mode == mode:
        return False
    kind = COAST if s.mode == COASTING else (ACCELERATE if s.mode == ACCELERATING else DECELERATE)
    friction = friction_force(p, s, 0.0, s.velocity, applied_force(p, s))
    write_event(p, s, events, row, kind, direction, friction, static_at_once(p, direction))
    events.rows[row].mode = s.mode
    return True


@inlined
def _press_stick(p: Parameters, s: State, events: Events, row: int) -> bool:
    force = stick_force(p, s)
    if p.compliant != 0.0:
        s.acceleration = (applied_force(p, s) - contact_force(p, s.deflection, s.velocity)) / p.mass
    if abs(force) <= p.normal_force * static_at_once(p, force):
        return False
    limit = static_limit(p, s.rest, force)
    if abs(force) - p.normal_force * limit <= force_rounding(p, s, limit):
        return False
    release(p, s, events, row)
    return True
