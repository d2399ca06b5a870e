# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of each mode from its anchor, and the forces along it.

Every mode is m y″ + (h + …) y′ + (c + …) y = polynomial of the time, y the travel since the anchor:

| mode             | y′ coefficient | y coefficient | constant part of the right side      |
|------------------|----------------|---------------|---------------------------------------|
| stick, rigid     | y = 0          |               |                                       |
| stick, compliant | h + h_c        | c + c_c       | c w₀ + h v + F_e − c_c δ₀             |
| slip             | h + N b        | c             | c w₀ + h v + F_e − N (mu − b ẋ₀)      |
| coasting         | y′ constant    |               |                                       |

with w = s − x, and b the slope of the friction branch on the present piece of the table.  Sines in v and F_e add
their own answer, see `waves`.
"""

from ..core.jit import compiled, inlined
from ..friction.static import static_coefficient
from ..linear.oscillator import integrals, oscillator, short_integrals
from ..core.types import Mode
from .layout import (
    ACCELERATION, AT, AT_FIRST, AT_G, AT_RATE, AT_SECOND, BASE_V, BRANCHES, COMPLIANT, CONTACT_DAMPING,
    CONTACT_STIFFNESS, DAMPING, DEFLECTION, DIRECTION, DRIVE, EXCESS, F, FAST, FRACTION, F_RATE, GAMMA, NEAR,
    NEAR_FIRST, NEAR_G, NEAR_GAMMA, NEAR_OMEGA2, NEAR_RATE, NEAR_SECOND, JERK, KEPT, KEPT_SIZE, KNOTS, KNOT_SIZE, MASS,
    MODE, NEXT, NORMAL, NU, OMEGA2, PIECE, POSITION, REST, SECOND, SLOW, SNAP, SPRING, STATIC_EXPONENT, STATIC_INITIAL,
    STATIC_LAW, STATIC_LIMIT, STATIC_TAU, STIFFNESS, TABLE, V, VELOCITY, V_RATE, WAVES,
)
from .waves import begin_waves, move_waves, wave_drive_travel, wave_travel

# floats: numba would compile a function anew for every integer constant that it is called with
STICK = float(Mode.STICK)
ACCELERATING = float(Mode.ACCELERATING)
COASTING = float(Mode.COASTING)
DECELERATING = float(Mode.DECELERATING)

TICK = 0.1             # s; a search no longer than that begins with a bound, which mostly ends it
STAMP = 2.0 ** -51     # s, more than the time of an event is rounded by
_SIXTH = 1.0 / 6.0
_LONG = 1e3            # so much longer than the spring's stretch a slide has to be for the balance to be the better one
_LONG_RING = 1e10      # (ω t)², beyond which the third power of the way from there would tell
_SPLIT = 131073.0      # splits off the upper 36 bits of a number (Dekker 1971)


@inlined
def static_limit(p, rest):
    """Return mu_s after the rest time."""
    return static_coefficient(p[STATIC_LAW], p[STATIC_INITIAL], p[STATIC_LIMIT], p[STATIC_TAU], p[STATIC_EXPONENT],
                              rest)


@inlined
def piece_above(p, speed):
    """Return the index of the piece of the table that goes up from a speed: a knot belongs to the piece above it."""
    piece = 0
    for i in range(1, int(p[KNOTS])):
        if p[TABLE + KNOT_SIZE * i] <= speed:
            piece = i
    return piece


@inlined
def piece_below(p, speed):
    """Return the index of the piece of the table that goes down from a speed: a knot belongs to the piece below it."""
    piece = piece_above(p, speed)
    return piece - 1 if piece > 0 and p[TABLE + KNOT_SIZE * piece] == speed else piece


@inlined
def knot_speed(p, piece):
    """Return the speed of a knot."""
    return p[TABLE + KNOT_SIZE * piece]


@inlined
def friction_line(p, piece, speed):
    """Return mu_k, its slope, psi and its slope at `speed` on a piece of the table."""
    at = TABLE + KNOT_SIZE * piece
    beyond, slope, psi_slope = speed - p[at], p[at + 3], p[at + 4]
    return p[at + 1] + slope * beyond, slope, p[at + 2] + psi_slope * beyond, psi_slope


@inlined
def is_rigid_stick(p, s):
    """Whether the slider stands still in a rigid contact."""
    return s[MODE] == STICK and p[COMPLIANT] == 0.0


@inlined
def kinetic_at_rest(p):
    """Return mu_k(0)."""
    return p[TABLE + 1]


@inlined
def begin_motion(p, s):
    """Set the closed form of the motion from the anchor on."""
    v = s[V]
    if s[WAVES] != 0.0:
        begin_waves(p, s)
        v = s[BASE_V]
    mode = s[MODE]
    damping, stiffness, contact = p[DAMPING], p[STIFFNESS], 0.0
    if mode == COASTING or is_rigid_stick(p, s):
        return
    if mode == STICK:
        damping += p[CONTACT_DAMPING]
        contact = p[CONTACT_STIFFNESS]
    else:
        _, slope, _, psi_slope = friction_line(p, int(s[PIECE]), 0.0)
        if mode == ACCELERATING:
            slope += s[EXCESS] * psi_slope
        damping += p[NORMAL] * slope
    gamma, omega2 = 0.5 * damping / p[MASS], (stiffness + contact) / p[MASS]
    if gamma != s[GAMMA] or omega2 != s[OMEGA2]:
        at = KEPT + KEPT_SIZE * int(mode)
        if gamma != s[at] or omega2 != s[at + 1]:
            s[at], s[at + 1], s[at + 2], s[at + 3], s[at + 4] = oscillator(gamma, omega2)
        s[GAMMA], s[OMEGA2], s[NU], s[SLOW], s[FAST] = gamma, omega2, s[at + 2], s[at + 3], s[at + 4]
    pull = stiffness * (v - s[VELOCITY]) + p[DAMPING] * s[V_RATE] + s[F_RATE]
    s[JERK] = (pull - contact * s[VELOCITY]) / p[MASS]
    s[SNAP] = stiffness * s[V_RATE] / p[MASS]


@inlined
def oscillator_of(s):
    """Return the oscillator of the mode."""
    return s[GAMMA], s[OMEGA2], s[NU], s[SLOW], s[FAST]


@inlined
def tick_integrals(s, t):
    """Return `short_integrals` at t, from those at the nearest number of 36 bits.

    Ticks of one length differ by the rounding of their times.  That number is the same for them, and what was computed
    for it is kept; the way from there is less than 1e-11 of t.  The result depends on t alone, not on what is kept.
    What has rung for so long that this is part of a turn is evaluated at t.
    """
    if s[OMEGA2] * t * t > _LONG_RING:
        return short_integrals(oscillator_of(s), t)
    big = _SPLIT * t
    near = big - (big - t)
    gamma, omega2 = s[GAMMA], s[OMEGA2]
    if near != s[NEAR] or gamma != s[NEAR_GAMMA] or omega2 != s[NEAR_OMEGA2]:
        s[NEAR], s[NEAR_GAMMA], s[NEAR_OMEGA2] = near, gamma, omega2
        s[NEAR_G], s[NEAR_RATE], s[NEAR_FIRST], s[NEAR_SECOND] = short_integrals(oscillator_of(s), near)
    d = t - near
    g, rate, first = s[NEAR_G], s[NEAR_RATE], s[NEAR_FIRST]
    bend = -2.0 * gamma * rate - omega2 * g
    return (g + (rate + 0.5 * bend * d) * d, rate + bend * d, first + (g + 0.5 * rate * d) * d,
            s[NEAR_SECOND] + (first + 0.5 * g * d) * d)


@compiled
def travel(p, s, t):
    """Return the slider's travel, velocity and acceleration at t after the anchor."""
    if s[MODE] == COASTING:
        return s[VELOCITY] * t, s[VELOCITY], 0.0
    if is_rigid_stick(p, s):
        return 0.0, 0.0, 0.0
    u, a, jerk, snap = s[VELOCITY], s[ACCELERATION], s[JERK], s[SNAP]
    if snap == 0.0:
        g, rate, first, second = tick_integrals(s, t)
        y, velocity, acceleration = _response(p, s, t, g, rate, first, second)
    else:
        g, rate, first, second, third = integrals(oscillator_of(s), t)
        y = u * t + a * first + jerk * second + snap * third
        velocity = u + a * g + jerk * first + snap * second
        acceleration = a * rate + jerk * g + snap * first
    if s[WAVES] != 0.0:
        more = wave_travel(p, s, oscillator_of(s), t, g, rate, first)
        return y + more[0], velocity + more[1], acceleration + more[2]
    return y, velocity, acceleration


@inlined
def _response(p, s, t, g, rate, first, second):
    """Return travel, velocity and acceleration without ramp and waves, from `short_integrals` at t.

    Once a radian of the motion, or a time constant, is over, they are read off the velocity that it settles at: a
    contact that is held for a year does not creep, and its ring-down loses no digits.
    """
    u, a, jerk = s[VELOCITY], s[ACCELERATION], s[JERK]
    acceleration = a * rate + jerk * g
    if not (s[OMEGA2] * t * t >= 1.0 if s[NU] > 0.0 else s[SLOW] * t <= -1.0):
        return u * t + a * first + jerk * second, u + a * g + jerk * first, acceleration
    settled = s[BASE_V] if s[WAVES] != 0.0 else s[V]
    if s[MODE] == STICK or s[F_RATE] != 0.0 or s[V_RATE] != 0.0:
        contact = p[CONTACT_STIFFNESS] if s[MODE] == STICK else 0.0
        settled = (p[STIFFNESS] * settled + p[DAMPING] * s[V_RATE] + s[F_RATE]) / (p[STIFFNESS] + contact)
    free, damping = u - settled, 2.0 * s[GAMMA]
    return (settled * t + (free * (g + damping * first) + a * first),
            settled + (free * (rate + damping * g) + a * g), acceleration)


@inlined
def travel_at(p, s):
    """Return `travel` for the time AT of the last evaluation."""
    return _response(p, s, s[AT], s[AT_G], s[AT_RATE], s[AT_FIRST], s[AT_SECOND])


@inlined
def travel_to_event(p, s, t):
    """Return `travel` for the time of the next event, or where its search ended: from the last evaluation there."""
    y, v, acceleration = travel_at(p, s)
    d = t - s[AT]
    if d == 0.0:
        return y, v, acceleration
    bend = s[JERK] * s[AT_RATE] - s[ACCELERATION] * (2.0 * s[GAMMA] * s[AT_RATE] + s[OMEGA2] * s[AT_G])
    snap = -2.0 * s[GAMMA] * bend - s[OMEGA2] * acceleration
    return (y + (v + (0.5 * acceleration + _SIXTH * bend * d) * d) * d,
            v + (acceleration + (0.5 * bend + _SIXTH * snap * d) * d) * d,
            acceleration + (bend + 0.5 * snap * d) * d)


@inlined
def drive_travel(s, t):
    """Return how far the drive moves within t after the anchor."""
    if s[WAVES] != 0.0:
        return (s[BASE_V] + 0.5 * s[V_RATE] * t) * t + wave_drive_travel(s, t)
    return (s[V] + 0.5 * s[V_RATE] * t) * t


@inlined
def spring_after(p, s, t, drive, y, u, a):
    """Return the stretch of the spring at t after the anchor, where drive and slider have moved by `drive` and y.

    After a long slide that is the small difference of two long ways; the balance of forces has it with all its digits.
    """
    stretch = s[SPRING] + (drive - y)
    if abs(drive) <= _LONG * abs(stretch) or s[MODE] == STICK or p[STIFFNESS] == 0.0 or s[WAVES] != 0.0:
        return stretch
    v = s[V] + s[V_RATE] * t
    if s[MODE] == COASTING:
        return s[SPRING] + (0.5 * (s[V] + v) - u) * t
    force = friction_force(p, s, 0.0, u, 0.0) + p[MASS] * a - (s[F] + s[F_RATE] * t)
    return (force - p[DAMPING] * (v - u)) / p[STIFFNESS]


@inlined
def move_anchor(p, s, second, fraction, t):
    """Move the anchor by t, to the time (second, fraction), along the present mode."""
    drive = drive_travel(s, t)
    if s[MODE] == COASTING:
        y, u, a = s[VELOCITY] * t, s[VELOCITY], 0.0
    elif is_rigid_stick(p, s):
        y, u, a = 0.0, 0.0, 0.0
    elif s[AT] >= 0.0 and (t == s[NEXT] or t == s[AT]):
        y, u, a = travel_to_event(p, s, t)
    else:
        y, u, a = travel(p, s, t)
    if s[MODE] == STICK:
        s[REST] += t
        s[DEFLECTION] += y
    s[SPRING] = spring_after(p, s, t, drive, y, u, a)
    s[POSITION] += y
    s[DRIVE] += drive
    s[VELOCITY] = u
    s[ACCELERATION] = a
    s[V] += s[V_RATE] * t
    s[F] += s[F_RATE] * t
    s[SECOND] = second
    s[FRACTION] = fraction
    if s[WAVES] != 0.0:
        move_waves(s, t)


@inlined
def drive_force(p, spring, v, u):
    """Return F_d = c (s − x) + h (v − ẋ)."""
    return p[STIFFNESS] * spring + p[DAMPING] * (v - u)


@inlined
def contact_force(p, deflection, u):
    """Return F_c = c_c δ + h_c ẋ of the compliant contact."""
    return p[CONTACT_STIFFNESS] * deflection + p[CONTACT_DAMPING] * u


@inlined
def friction_force(p, s, deflection, u, applied):
    """Return the friction force at velocity u in the present mode, under `applied` = F_d + F_e."""
    mode = s[MODE]
    if mode == COASTING or is_rigid_stick(p, s):
        return applied
    if mode == STICK:
        return contact_force(p, deflection, u)
    coefficient, _, psi, _ = friction_line(p, int(s[PIECE]), abs(u))
    if mode == ACCELERATING:
        coefficient += s[EXCESS] * psi
    return s[DIRECTION] * p[NORMAL] * coefficient


@inlined
def slip_friction(p, s):
    """Return the coefficient of friction on the present branch and piece as a line: at standstill, and its slope."""
    coefficient, slope, psi, psi_slope = friction_line(p, int(s[PIECE]), 0.0)
    if s[MODE] == ACCELERATING:
        return coefficient + s[EXCESS] * psi, slope + s[EXCESS] * psi_slope
    return coefficient, slope


@inlined
def has_branches(p):
    """Whether friction depends on the sign of the acceleration."""
    return p[BRANCHES] != 0.0
