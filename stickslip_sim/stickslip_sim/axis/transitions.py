# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What happens between two modes: break-away, arrest, the choice of the slip sub-mode, jumps of the inputs.

Ties are decided by where the force moves next: a residual within rounding of zero counts as zero, and the sign of its
rate, then of the rate's rate, decides.
"""

from ..core.jit import compiled, inlined
from ..core.types import EventKind
from .layout import (
    ACCELERATION, COMPLIANT, CONTACT_STIFFNESS, DAMPING, DEFLECTION, DIRECTION, DRIVE, EVENT_DIRECTION, EVENT_DRIVE,
    EVENT_DRIVE_FORCE, EVENT_FRACTION, EVENT_FRICTION, EVENT_KIND, EVENT_MODE, EVENT_POSITION, EVENT_REST, EVENT_SECOND,
    EVENT_STATIC, EVENT_VELOCITY, EXCESS, F, FRACTION, F_RATE, GAMMA, MASS, MODE, NORMAL, ORIGIN, PIECE, POSITION,
    RESIDUAL, REST, SECOND, SPRING, STATIC_INITIAL, STIFFNESS, V, VELOCITY, V_RATE, WAVES,
)
from .motion import (
    ACCELERATING, COASTING, DECELERATING, STICK, contact_force, drive_force, friction_force, friction_line,
    has_branches, is_rigid_stick, kinetic_at_rest, knot_speed, piece_above, piece_below, static_limit,
)
from .waves import forced_rate

BREAKAWAY = float(EventKind.BREAKAWAY)
COAST = float(EventKind.COAST)
ACCELERATE = float(EventKind.ACCELERATE)
DECELERATE = float(EventKind.DECELERATE)
ARREST = float(EventKind.STICK)
REVERSE = float(EventKind.REVERSE)
KNOT = float(EventKind.KNOT)

_ROUNDING = 8.0 * 2.220446049250313e-16
_MUCH = 16.0     # so much more is lost on a steep piece of the table before the forces tell it better
_TIE = 1e-15   # of the friction force: a closed-form acceleration smaller than that is a tie


@inlined
def applied_force(p, s):
    """Return F_d + F_e at the anchor."""
    return drive_force(p, s[SPRING], s[V], s[VELOCITY]) + s[F]


@inlined
def force_rounding(p, s, friction):
    """Return the size of rounding errors in a sum of the forces at the anchor."""
    return _ROUNDING * (p[STIFFNESS] * abs(s[SPRING]) + p[DAMPING] * (abs(s[V]) + abs(s[VELOCITY])) + abs(s[F])
                        + p[NORMAL] * friction)


@inlined
def write_event(p, s, events, row, kind, direction, friction, limit):
    """Write a row with the state at the anchor and mu_s = `limit`; who calls it adds the mode that follows."""
    e = events[row]
    e[EVENT_SECOND] = s[SECOND]
    e[EVENT_FRACTION] = s[FRACTION]
    e[EVENT_KIND] = kind
    e[EVENT_DIRECTION] = direction
    e[EVENT_POSITION] = s[ORIGIN] + s[POSITION]
    e[EVENT_VELOCITY] = s[VELOCITY]
    e[EVENT_DRIVE] = s[ORIGIN] + s[DRIVE]
    e[EVENT_DRIVE_FORCE] = drive_force(p, s[SPRING], s[V], s[VELOCITY])
    e[EVENT_FRICTION] = friction
    e[EVENT_STATIC] = limit
    e[EVENT_REST] = s[REST]


@inlined
def force_rate(p, s):
    """Return the rate of F_d + F_e at constant velocity, and the rate's rate; within rounding of 0 the first is 0."""
    if s[WAVES] != 0.0:
        return forced_rate(p, s)
    pushed = p[DAMPING] * s[V_RATE] + s[F_RATE]
    rate = p[STIFFNESS] * (s[V] - s[VELOCITY]) + pushed
    if abs(rate) <= _ROUNDING * (p[STIFFNESS] * (abs(s[V]) + abs(s[VELOCITY])) + abs(pushed)):
        rate = 0.0
    return rate, p[STIFFNESS] * s[V_RATE]


@inlined
def choose_slip(p, s, residual, lower, tolerance):
    """Set the slip sub-mode from R − B = `residual` and R = `lower`; return False when the slider comes to rest.

    R = ±(F_d + F_e) − N mu_k along the slip and B = N e(|ẋ|), see docs/model.md.  Neither is made from the other: where
    B is large the small one would lose its digits.
    """
    direction = s[DIRECTION]
    speed = abs(s[VELOCITY])
    rate, bend = force_rate(p, s)
    rate *= direction
    bend *= direction
    if abs(residual) <= tolerance:
        residual = 0.0
    if residual > 0.0 or (residual == 0.0 and (rate > 0.0 or (rate == 0.0 and bend > 0.0))):
        s[MODE] = ACCELERATING
        s[PIECE] = piece_above(p, speed)
        s[ACCELERATION] = direction * residual / p[MASS]
        return True
    if speed == 0.0:
        return False
    piece = piece_above(p, speed)
    coefficient, _, psi, _ = friction_line(p, piece, speed)
    band = p[NORMAL] * s[EXCESS] * psi
    if abs(lower) <= min(tolerance, force_rounding(p, s, coefficient)):
        lower = 0.0
    rests_on_edge = lower == 0.0 and ((band > 0.0 and rate > 0.0) or (rate == 0.0 and bend >= 0.0))
    if rests_on_edge or (lower > 0.0 and band > 0.0):
        s[MODE] = COASTING
        s[PIECE] = piece
        s[RESIDUAL] = lower
        s[ACCELERATION] = 0.0
        return True
    s[MODE] = DECELERATING
    s[PIECE] = piece_below(p, speed)
    s[ACCELERATION] = direction * lower / p[MASS]
    return True


@inlined
def band_of(p, s):
    """Return B = N e(|ẋ|), the width of the coasting band at the anchor, N."""
    _, _, psi, _ = friction_line(p, int(s[PIECE]), abs(s[VELOCITY]))
    return p[NORMAL] * s[EXCESS] * psi


@inlined
def break_away(p, s, direction, limit, margin):
    """Begin a slip at the friction coefficient `limit`; `margin` is how far the force is beyond it along the slip, N.

    The excess E of this slip makes friction continuous; without acceleration dependence, or at a speed where psi has
    ended, friction drops to mu_k at once.
    """
    speed = abs(s[VELOCITY])
    coefficient, _, psi, _ = friction_line(p, piece_above(p, speed), speed)
    s[EXCESS] = 0.0
    s[DIRECTION] = direction
    tolerance = force_rounding(p, s, limit)
    if p[COMPLIANT] != 0.0:
        margin += direction * p[MASS] * s[ACCELERATION]
        tolerance = _TIE * p[NORMAL] * limit
    residual = lower = margin + p[NORMAL] * (limit - coefficient)
    if has_branches(p) and psi > 0.0 and limit >= coefficient:
        s[EXCESS] = (limit - coefficient) / psi
        residual = margin
    s[REST] = 0.0
    s[DEFLECTION] = 0.0
    if not choose_slip(p, s, residual, lower, tolerance):
        rest(p, s)


@inlined
def rest(p, s):
    """Begin to stick at standstill."""
    s[MODE] = STICK
    s[REST] = 0.0
    s[VELOCITY] = 0.0
    s[ACCELERATION] = 0.0
    s[DEFLECTION] = 0.0
    if p[COMPLIANT] != 0.0:
        friction = s[DIRECTION] * p[NORMAL] * kinetic_at_rest(p)
        s[DEFLECTION] = friction / p[CONTACT_STIFFNESS]
        s[ACCELERATION] = (applied_force(p, s) - friction) / p[MASS]
    s[DIRECTION] = 0.0


@inlined
def arrest(p, s, events, row):
    """End a slip at standstill: stick, or reverse at once where a rigid contact cannot hold the force."""
    s[VELOCITY] = 0.0
    friction = s[DIRECTION] * p[NORMAL] * kinetic_at_rest(p)
    force = applied_force(p, s)
    limit = static_limit(p, 0.0)
    margin = abs(force) - p[NORMAL] * limit
    if p[COMPLIANT] == 0.0 and margin > force_rounding(p, s, limit):
        direction = 1.0 if force > 0.0 else -1.0
        write_event(p, s, events, row, REVERSE, direction, friction, limit)
        break_away(p, s, direction, limit, margin)
    else:
        write_event(p, s, events, row, ARREST, s[DIRECTION], friction, limit)
        rest(p, s)
    events[row][EVENT_MODE] = s[MODE]


@inlined
def release(p, s, events, row):
    """Begin a slip from stick, where |F| has reached N mu_s(t⁻)."""
    force = applied_force(p, s) if is_rigid_stick(p, s) else contact_force(p, s[DEFLECTION], s[VELOCITY])
    limit = static_limit(p, s[REST])
    direction = _way_out(p, s, force)
    margin = abs(force) - p[NORMAL] * limit
    if margin <= force_rounding(p, s, limit):
        margin = 0.0
    friction = direction * p[NORMAL] * limit
    if s[VELOCITY] * direction < 0.0:   # friction turns round: it opposes the motion from now on
        direction = -direction
        margin = -(margin + 2.0 * p[NORMAL] * limit)
    write_event(p, s, events, row, BREAKAWAY, direction, friction, limit)
    break_away(p, s, direction, limit, margin)
    events[row][EVENT_MODE] = s[MODE]


@compiled
def _way_out(p, s, force):
    """Return the way that stick breaks; where nothing holds and nothing pulls yet, that of the next derivative."""
    rate, bend = force_rate(p, s)
    way = force if abs(force) > force_rounding(p, s, 0.0) else 0.0
    if way == 0.0 and p[COMPLIANT] != 0.0:
        way = s[VELOCITY] if s[VELOCITY] != 0.0 else s[ACCELERATION]
    if way == 0.0:
        way = rate if rate != 0.0 else bend
    return 1.0 if way > 0.0 else -1.0


@inlined
def turn(p, s, events, row):
    """Leave a sub-mode where its acceleration vanishes: coast, or pass to the other branch where they coincide."""
    mode = s[MODE]
    direction = s[DIRECTION]
    friction = friction_force(p, s, 0.0, s[VELOCITY], 0.0)
    band = band_of(p, s)
    s[ACCELERATION] = 0.0
    rate, bend = force_rate(p, s)
    slides_steadily = rate == 0.0 and bend == 0.0
    if band > 0.0 or slides_steadily:
        if slides_steadily and s[F_RATE] == 0.0:
            s[VELOCITY] = s[V]
        s[MODE] = COASTING
        s[RESIDUAL] = band if mode == ACCELERATING else 0.0
        kind = COAST
    elif mode == ACCELERATING:
        enter_branch(p, s, DECELERATING)
        kind = DECELERATE
    else:
        enter_branch(p, s, ACCELERATING)
        kind = ACCELERATE
    write_event(p, s, events, row, kind, direction, friction, p[STATIC_INITIAL])
    events[row][EVENT_MODE] = s[MODE]


@inlined
def enter_branch(p, s, mode):
    """Begin to accelerate or decelerate with no acceleration yet."""
    s[MODE] = mode
    speed = abs(s[VELOCITY])
    s[PIECE] = piece_above(p, speed) if mode == ACCELERATING else piece_below(p, speed)
    s[ACCELERATION] = 0.0


@inlined
def leave_coast(p, s, events, row, kind):
    """Leave the coasting band: upwards to accelerate, downwards to decelerate."""
    write_event(p, s, events, row, kind, s[DIRECTION], applied_force(p, s), p[STATIC_INITIAL])
    enter_branch(p, s, ACCELERATING if kind == ACCELERATE else DECELERATING)
    events[row][EVENT_MODE] = s[MODE]


@compiled
def cross_knot(p, s, events, row, before):
    """Go on along the next piece of the friction table; the speed is that of the knot, exactly.

    So is the acceleration of the balance of forces there, but for their rounding; that of the closed form is off by the
    rounding of how it began, `before`, and of what the piece gave to it.  The one that is off less is taken.
    """
    lost = p[MASS] * (abs(before) + 2.0 * abs(s[GAMMA] * s[VELOCITY]))
    step = 1.0 if s[MODE] == ACCELERATING else -1.0
    knot = int(s[PIECE] + (1.0 if step > 0.0 else 0.0))
    speed = knot_speed(p, knot)
    coefficient, _, psi, _ = friction_line(p, knot, speed)
    if s[MODE] == ACCELERATING:
        coefficient += s[EXCESS] * psi
    friction = s[DIRECTION] * p[NORMAL] * coefficient
    s[VELOCITY] = s[DIRECTION] * speed
    write_event(p, s, events, row, KNOT, s[DIRECTION], friction, p[STATIC_INITIAL])
    s[PIECE] += step
    if lost > _MUCH * p[NORMAL] * coefficient and _ROUNDING * lost > _MUCH * force_rounding(p, s, coefficient):
        s[ACCELERATION] = (applied_force(p, s) - friction) / p[MASS]
    if step * s[DIRECTION] * s[ACCELERATION] < 0.0:   # the speed peaks here: a tie, which the force's rate decides
        s[ACCELERATION] = 0.0
    events[row][EVENT_MODE] = s[MODE]


@inlined
def apply_inputs(p, s, events, row):
    """Choose the mode anew after a jump of an input or a parameter at the anchor; return True if it wrote an event."""
    mode = s[MODE]
    if mode == STICK:
        return _press_stick(p, s, events, row)
    direction = s[DIRECTION]
    speed = abs(s[VELOCITY])
    coefficient, _, psi, _ = friction_line(p, piece_above(p, speed), speed)
    upper = coefficient + s[EXCESS] * psi
    push = direction * applied_force(p, s)
    residual, lower = push - p[NORMAL] * upper, push - p[NORMAL] * coefficient
    if not choose_slip(p, s, residual, lower, force_rounding(p, s, upper)):
        arrest(p, s, events, row)
        return True
    if s[MODE] == mode:
        return False
    kind = COAST if s[MODE] == COASTING else (ACCELERATE if s[MODE] == ACCELERATING else DECELERATE)
    friction = friction_force(p, s, 0.0, s[VELOCITY], applied_force(p, s))
    write_event(p, s, events, row, kind, direction, friction, p[STATIC_INITIAL])
    events[row][EVENT_MODE] = s[MODE]
    return True


@inlined
def _press_stick(p, s, events, row):
    if p[COMPLIANT] != 0.0:
        force = contact_force(p, s[DEFLECTION], s[VELOCITY])
        s[ACCELERATION] = (applied_force(p, s) - force) / p[MASS]
    else:
        force = applied_force(p, s)
    if abs(force) <= p[NORMAL] * p[STATIC_INITIAL]:
        return False
    limit = static_limit(p, s[REST])
    if abs(force) - p[NORMAL] * limit <= force_rounding(p, s, limit):
        return False
    release(p, s, events, row)
    return True
