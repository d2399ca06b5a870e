# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What happens between two modes: break-away, yielding, arrest, turns of a slip, breakpoints, jumps of the inputs.

Each writes the row of its event and begins the mode that follows (`mode_entry`).
"""

from ..core.hot_path import compiled, inlined
from .codes import (
    ACCELERATE,
    ACCELERATING,
    ARREST,
    BREAKAWAY,
    COAST,
    COASTING,
    DECELERATE,
    DECELERATING,
    KNOT,
    REVERSE,
    STICK,
    YIELD,
    YIELDING,
)
from .forces import (
    ROUNDING,
    applied_force,
    band_of,
    begin_stick,
    breakpoint_speed,
    contact_force,
    drive_force,
    force_rate,
    force_rounding,
    friction_force,
    friction_line,
    holds_by_drive,
    kinetic_at_rest,
    segment_above,
    stated_drive_force,
    static_at_once,
    static_limit,
    stick_force,
    yielding_force,
)
from .layout import Parameters
from .mode_entry import (
    begin_yielding,
    break_away,
    choose_slip,
    enter_branch,
    keeps_yielding,
    limit_rounding,
    note_swing,
    rest,
    unbalanced,
    yields,
)
from .rows import Events
from .state_record import State

_MUCH = 16.0     # so much more is lost on a steep segment of the table before the forces know it better


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
def arrest(p: Parameters, s: State, events: Events, row: int) -> None:
    """End a slip at standstill: stick, or reverse at once where a rigid contact cannot hold the force.

    Or end yielding where it no longer slides: stick, with velocity and deflection as they are.
    """
    if s.mode == YIELDING:   # with the force N mu_k(0), by no rounding more or less: it may be the limit
        s.deflection = (yielding_force(p, s) - p.contact_damping * s.velocity) / p.contact_stiffness
        _hold_again(p, s, events, row)
        return
    s.velocity = 0.0
    begin_stick(p, s)
    note_swing(p, s)
    friction = s.direction * p.normal_force * kinetic_at_rest(p, s.direction)
    force = applied_force(p, s)
    direction = 1.0 if force > 0.0 else -1.0
    limit = static_at_once(p, direction)
    margin = abs(force) - p.normal_force * limit
    if holds_by_drive(p) and margin > limit_rounding(p, s, limit):
        write_event(p, s, events, row, REVERSE, direction, friction, limit)
        break_away(p, s, direction, limit, margin)
    else:
        write_event(p, s, events, row, ARREST, s.direction, friction, static_at_once(p, s.direction))
        rest(p, s)
    events.rows[row].mode = s.mode


@inlined
def release(p: Parameters, s: State, events: Events, row: int) -> None:
    """End stick where |F| has reached N mu_s(t⁻): slip, or yield; or begin the slip that yielding ends with."""
    if s.mode == YIELDING:
        _let_go(p, s, events, row)
        return
    force = stick_force(p, s)
    direction = _direction_out(p, s, force)
    limit = static_limit(p, s.rest, direction)
    if yields(p, s, direction, limit):
        write_event(p, s, events, row, YIELD, direction, force, limit)
        begin_yielding(p, s, direction)
        events.rows[row].mode = YIELDING
        return
    margin = direction * force - p.normal_force * limit
    if margin <= force_rounding(p, s, limit):
        margin = 0.0
    friction = direction * p.normal_force * limit
    if s.velocity * direction < 0.0:
        if holds_by_drive(p):   # friction turns round: it opposes the motion from now on
            direction = -direction
            margin = -(margin + 2.0 * p.normal_force * limit)
        else:   # by rounding alone
            s.velocity = 0.0
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
def _hold_again(p: Parameters, s: State, events: Events, row: int) -> None:
    begin_stick(p, s)
    held = contact_force(p, s.deflection, s.velocity)
    write_event(p, s, events, row, ARREST, s.direction, held, static_at_once(p, s.direction))
    events.rows[row].mode = s.mode = STICK
    s.direction = 0.0
    s.acceleration = (applied_force(p, s) - held) / p.mass


@inlined
def _let_go(p: Parameters, s: State, events: Events, row: int) -> None:
    """Begin a slip where a slider that moved against the force of its contact has come to a stop; friction stays."""
    s.velocity = 0.0
    friction = yielding_force(p, s)
    s.acceleration = (applied_force(p, s) - friction) / p.mass
    write_event(p, s, events, row, BREAKAWAY, s.direction, friction, static_at_once(p, s.direction))
    break_away(p, s, s.direction, kinetic_at_rest(p, s.direction), 0.0)
    events.rows[row].mode = s.mode


@inlined
def turn(p: Parameters, s: State, events: Events, row: int) -> None:
    """Leave a sub-mode where its acceleration vanishes: coast, or pass to the other branch where they coincide."""
    mode = s.mode
    direction = s.direction
    friction = friction_force(p, s, 0.0, s.velocity, 0.0)
    band = band_of(p, s)
    s.acceleration = 0.0
    rate, second_rate = force_rate(p, s)
    slides_steadily = rate == 0.0 and second_rate == 0.0 and s.inputs.n_rate == 0.0
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
    if lost > _MUCH * p.normal_force * coefficient and ROUNDING * lost > _MUCH * force_rounding(p, s, coefficient):
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
    if mode == YIELDING:
        return _press_yielding(p, s, events, row)
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
        s.acceleration = unbalanced(p, s, contact_force(p, s.deflection, s.velocity)) / p.mass
    if abs(force) <= p.normal_force * static_at_once(p, force):
        return False
    limit = static_limit(p, s.rest, force)
    if abs(force) - p.normal_force * limit <= limit_rounding(p, s, limit):
        return False
    release(p, s, events, row)
    return True


@inlined
def _press_yielding(p: Parameters, s: State, events: Events, row: int) -> bool:
    direction = s.direction
    if holds_by_drive(p):   # another contact since, which does not yield
        s.mode, s.direction = STICK, 0.0
        begin_stick(p, s)
        if not _press_stick(p, s, events, row):
            held = friction_force(p, s, s.deflection, s.velocity, applied_force(p, s))
            write_event(p, s, events, row, ARREST, direction, held, static_at_once(p, direction))
            events.rows[row].mode = STICK
        return True
    if keeps_yielding(p, s):
        begin_yielding(p, s, direction)
        return False
    _hold_again(p, s, events, row)
    return True
