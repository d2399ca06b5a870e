# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What happens between two smooth pieces of the motion: start, event, jump of an input; written once for all peers."""

import math

from ...axis.layout import (
    BRANCHES,
    COMPLIANT,
    CONTACT_STIFFNESS,
    DAMPING,
    NORMAL,
    STATIC_INITIAL,
    STATIC_LIMIT,
    STATIC_TAU,
    STIFFNESS,
)
from ...core.types import EventKind
from .automaton import (
    ACCELERATING,
    COASTING,
    DECELERATING,
    DEFLECTION,
    DIRECTION,
    EXCESS,
    F,
    FORCE_ROUNDING,
    F_RATE,
    MODE,
    REST,
    S,
    SEGMENT,
    STICK,
    TIME,
    TURN,
    U,
    V,
    V_RATE,
    X,
    always_compiled,
    applied,
    breakpoint_at,
    contact,
    friction_at_rest,
    friction_lines,
    inputs,
    is_compliant,
    motion_of,
    segment_of,
    static_coefficient,
    static_margin,
)

BREAKAWAY, COAST, ACCELERATE = float(EventKind.BREAKAWAY), float(EventKind.COAST), float(EventKind.ACCELERATE)
DECELERATE, ARREST = float(EventKind.DECELERATE), float(EventKind.STICK)
REVERSE, KNOT = float(EventKind.REVERSE), float(EventKind.KNOT)


@always_compiled
def start(p, m, w, position, velocity, rest, v, v_rate, f, f_rate):
    """Set the automaton at time 0, the spring unstretched; return the kind of an event there, or −1."""
    m[:] = 0.0
    m[X] = m[S] = position
    m[U] = velocity
    m[REST] = rest if velocity == 0.0 else 0.0
    m[V], m[V_RATE], m[F], m[F_RATE] = v, v_rate, f, f_rate
    if velocity == 0.0:
        return classify(p, m, w)
    m[DIRECTION] = math.copysign(1.0, velocity)
    m[MODE] = ACCELERATING
    choose_slip(p, m, w)
    return -1.0


@always_compiled
def static_at(p, rest):
    """Return mu_s(t⁻)."""
    return static_coefficient(p[STATIC_INITIAL], p[STATIC_LIMIT], p[STATIC_TAU], rest)


@always_compiled
def kinetic_and_shape(p, segment, speed):
    """Return mu_k and psi at a speed, along a segment of the table."""
    mu, mu_slope, psi, psi_slope = friction_lines(p, segment)
    return mu + mu_slope * speed, psi + psi_slope * speed


@always_compiled
def move(p, m, w, t, x, u):
    """Move the reset to τ = t, where the integrator arrived at (x, ẋ)."""
    s, _, _ = inputs(motion_of(p, m), w, t)
    if m[MODE] == STICK:
        m[REST] += t
        m[DEFLECTION] += x - m[X]
    m[TIME] += t
    m[X], m[U], m[S] = x, u, s
    m[V] += m[V_RATE] * t
    m[F] += m[F_RATE] * t


@always_compiled
def choose_slip(p, m, w):
    """Set the slip sub-mode from R and B, ties by where the force moves next; a slider without speed may stick."""
    direction, speed = m[DIRECTION], abs(m[U])
    segment = segment_of(p, speed, True)
    mu, psi = kinetic_and_shape(p, segment, speed)
    force = applied(motion_of(p, m), w, 0.0, m[X], m[U])
    lower = direction * force - p[NORMAL] * mu
    band = p[NORMAL] * m[EXCESS] * psi
    tie = FORCE_ROUNDING * (abs(force) + p[NORMAL] * mu + band)
    rising = direction * _force_rate(p, m, w) > 0.0
    if lower > band + tie or (abs(lower - band) <= tie and rising):
        m[MODE], m[SEGMENT] = ACCELERATING, segment
    elif speed == 0.0:
        _stick(p, m)
    elif band > 0.0 and (lower > tie or (abs(lower) <= tie and rising)):
        m[MODE], m[SEGMENT] = COASTING, segment
    else:
        m[MODE], m[SEGMENT] = DECELERATING, segment_of(p, speed, False)


@always_compiled
def _force_rate(p, m, w):
    """Return d(F_d + F_e)/dt at constant velocity; without one, a sixteenth of its second derivative."""
    _, v, _ = inputs(motion_of(p, m), w, 0.0)
    rate = p[STIFFNESS] * (v - m[U]) + p[DAMPING] * m[V_RATE] + m[F_RATE]
    for i in range(0, len(w), 4):
        turn = TURN * w[i]
        rate += turn * math.cos(turn * m[TIME] + TURN * w[i + 1]) * (p[DAMPING] * w[i + 2] + w[i + 3])
    return rate if rate != 0.0 else p[STIFFNESS] * m[V_RATE] / 16.0


@always_compiled
def _break_away(p, m, w, direction, coefficient):
    """Begin a slip at a coefficient; the excess makes friction continuous where branches are distinguished."""
    speed = abs(m[U])
    mu, psi = kinetic_and_shape(p, segment_of(p, speed, True), speed)
    m[EXCESS] = 0.0
    if p[BRANCHES] != 0.0 and psi > 0.0:
        m[EXCESS] = max(coefficient - mu, 0.0) / psi
    m[DIRECTION] = direction
    m[REST] = m[DEFLECTION] = 0.0
    choose_slip(p, m, w)


@always_compiled
def _stick(p, m):
    m[MODE] = STICK
    m[REST] = m[U] = 0.0
    m[DEFLECTION] = 0.0
    if p[COMPLIANT] != 0.0:
        m[DEFLECTION] = m[DIRECTION] * p[NORMAL] * friction_at_rest(p) / p[CONTACT_STIFFNESS]
    m[DIRECTION] = 0.0


@always_compiled
def reset(p, m, w, guard):
    """Go over to what follows when a guard has fallen at the reset; return (kind, direction of the slip)."""
    mode = m[MODE]
    if mode == STICK:
        return _release(p, m, w)
    direction = m[DIRECTION]
    if mode == COASTING:
        m[MODE] = DECELERATING if guard == 0 else ACCELERATING
        m[SEGMENT] = segment_of(p, abs(m[U]), guard == 1)
        return DECELERATE if guard == 0 else ACCELERATE, direction
    if guard == 1:
        _cross_breakpoint(p, m)
        return KNOT, direction
    if guard == 2:
        return _arrest(p, m, w)
    return _turn(p, m), direction


@always_compiled
def _release(p, m, w):
    q = motion_of(p, m)
    force = contact(q, m[X], m[U]) if is_compliant(q) else applied(q, w, 0.0, m[X], m[U])
    direction = math.copysign(1.0, force)
    if m[U] * direction < 0.0:
        direction = -direction
    _break_away(p, m, w, direction, static_at(p, m[REST]))
    return BREAKAWAY, direction


@always_compiled
def _cross_breakpoint(p, m):
    step = 1.0 if m[MODE] == ACCELERATING else -1.0
    m[U] = m[DIRECTION] * breakpoint_at(p, m[SEGMENT] + (1.0 if step > 0.0 else 0.0))
    m[SEGMENT] += step


@always_compiled
def _arrest(p, m, w):
    m[U] = 0.0
    force = applied(motion_of(p, m), w, 0.0, m[X], 0.0)
    limit = p[STATIC_INITIAL]
    if p[COMPLIANT] == 0.0 and abs(force) > p[NORMAL] * limit * (1.0 + FORCE_ROUNDING):
        direction = math.copysign(1.0, force)
        _break_away(p, m, w, direction, limit)
        return REVERSE, direction
    direction = m[DIRECTION]
    _stick(p, m)
    return ARREST, direction


@always_compiled
def _turn(p, m):
    """Leave a sub-mode where its acceleration vanishes."""
    _, psi = kinetic_and_shape(p, m[SEGMENT], abs(m[U]))
    if m[EXCESS] * psi > 0.0:
        m[MODE] = COASTING
        return COAST
    rises = m[MODE] == DECELERATING
    m[MODE] = ACCELERATING if rises else DECELERATING
    m[SEGMENT] = segment_of(p, abs(m[U]), rises)
    return ACCELERATE if rises else DECELERATE


@always_compiled
def classify(p, m, w):
    """Choose the mode anew after a jump of an input; return the kind of the event that this is, or −1."""
    mode = m[MODE]
    if mode == STICK:
        guard = static_margin(motion_of(p, m), w, 0.0, m[X], m[U])
        tie = FORCE_ROUNDING * p[NORMAL] * max(p[STATIC_LIMIT], p[STATIC_INITIAL])
        if guard >= -tie:
            return -1.0
        kind, _ = _release(p, m, w)
        return kind
    choose_slip(p, m, w)
    if m[MODE] == mode:
        return -1.0
    if m[MODE] == COASTING:
        return COAST
    if m[MODE] == STICK:
        return ARREST
    return ACCELERATE if m[MODE] == ACCELERATING else DECELERATE


@always_compiled
def enter_piece(p, m, w, begin, pieces, k):
    """Begin a piece of the inputs, the first with the start; return the event that this is: (kind or −1, direction)."""
    was = m[DIRECTION]
    if k == 0:
        kind = start(p, m, w, begin[0], begin[1], begin[2], pieces[0, 1], pieces[0, 2], pieces[0, 3], pieces[0, 4])
    else:
        m[V], m[V_RATE], m[F], m[F_RATE] = pieces[k, 1], pieces[k, 2], pieces[k, 3], pieces[k, 4]
        kind = classify(p, m, w)
    return kind, m[DIRECTION] if m[DIRECTION] != 0.0 else was


@always_compiled
def end_of_piece(pieces, k, duration):
    """Return when a piece of the inputs ends, s."""
    return pieces[k + 1, 0] if k + 1 < len(pieces) else duration


@always_compiled
def note(events, rows, m, kind, direction):
    """Write an event at the reset, if it is one; return the rows in use, −1 when the table is full."""
    if kind < 0.0:
        return rows
    if rows >= len(events):
        return -1
    e = events[rows]
    e[0], e[1], e[2], e[3], e[4] = m[TIME], kind, direction, m[X], m[U]
    return rows + 1
