# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What simulators on a fixed grid of time share: inputs and events are looked at once a step, compiled.

An event that falls within a step is acted on at its end, as in every simulator without event location.
"""

import math

from .always_compiled import always_compiled
from .automaton import (
    ACCELERATING,
    COASTING,
    DIRECTION,
    F,
    F_RATE,
    Q_BAND,
    Q_BAND_SLOPE,
    Q_BREAKPOINT_ABOVE,
    Q_BREAKPOINT_BELOW,
    Q_DIRECTION,
    Q_INITIAL,
    Q_LOWER,
    Q_LOWER_SLOPE,
    Q_MODE,
    Q_NORMAL,
    SPEED_SCALE,
    STICK,
    TIME,
    U,
    V,
    V_RATE,
    applied,
    contact,
    force_scale,
    is_compliant,
    static_margin,
)
from .resets import KNOT, classify, move, note, reset, start


@always_compiled
def begin(p, m, w, at_start, pieces, events):
    """Set the automaton at time 0; return the number of events there."""
    kind = start(p, m, w, at_start[0], at_start[1], at_start[2], pieces[0, 1], pieces[0, 2], pieces[0, 3], pieces[0, 4])
    return note(events, 0, m, kind, m[DIRECTION])


@always_compiled
def look(q, w, per_mass, t, x, u):
    """Return ẍ at τ = t, and the guard that has fallen there, or −1; one sum of the forces serves both.

    `per_mass` is 1/m, kg⁻¹: what a loop takes out of itself.
    """
    mode, direction = q[Q_MODE], q[Q_DIRECTION]
    force = applied(q, w, t, x, u)
    if mode == STICK:
        held = contact(q, x, u) if is_compliant(q) else force
        return (force - held) * per_mass, 0 if breaks(q, w, t, x, u, held) else -1
    speed = direction * u
    lower = direction * force - (q[Q_LOWER] + q[Q_LOWER_SLOPE] * speed)
    band = q[Q_BAND] + q[Q_BAND_SLOPE] * speed
    if mode == ACCELERATING:
        return direction * (lower - band) * per_mass, _first(lower - band, q[Q_BREAKPOINT_ABOVE] - speed, q)
    if mode == COASTING:
        return 0.0, 1 if band - lower < -force_scale(q) else 0 if lower < -force_scale(q) else -1
    stopped = speed < -SPEED_SCALE
    return direction * lower * per_mass, 2 if stopped else _first(-lower, speed - q[Q_BREAKPOINT_BELOW], q)


@always_compiled
def breaks(q, w, t, x, u, held):
    """Whether a contact that is held by a force breaks away at τ = t."""
    # the static limit only grows from its initial value: below that, its law need not be asked
    return abs(held) > q[Q_NORMAL] * q[Q_INITIAL] and static_margin(q, w, t, x, u) < -force_scale(q)


@always_compiled
def _first(force, speed, q):
    """Return which of two guards has fallen, one of force and one of speed, or −1."""
    return 1 if speed < -SPEED_SCALE else 0 if force < -force_scale(q) else -1


@always_compiled
def next_piece(pieces, piece):
    """Return when the inputs go over to their next piece; a step that ends within rounding of it counts as there."""
    return pieces[piece + 1, 0] * (1.0 - 1e-14) if piece + 1 < len(pieces) else math.inf


@always_compiled
def act(p, m, w, pieces, piece, fallen, time, x, u, events, rows):
    """Act at the end of a step, `time`, on a fallen guard (−1: none) and on inputs that go over to their next piece.

    Return the rows in use and the piece; the state from there on stands in `m`.
    """
    move(p, m, w, time - m[TIME], x, u)
    m[TIME] = time
    if fallen >= 0:
        kind, direction = reset(p, m, w, fallen)
        if kind == KNOT:
            m[U] = u   # it is passed, not stopped at
        rows = note(events, rows, m, kind, direction)
    while rows >= 0 and next_piece(pieces, piece) <= time:
        piece += 1
        late = time - pieces[piece, 0]
        m[V], m[V_RATE] = pieces[piece, 1] + pieces[piece, 2] * late, pieces[piece, 2]
        m[F], m[F_RATE] = pieces[piece, 3] + pieces[piece, 4] * late, pieces[piece, 4]
        was = m[DIRECTION]
        kind = classify(p, m, w)
        rows = note(events, rows, m, kind, m[DIRECTION] if m[DIRECTION] != 0.0 else was)
    return rows, piece
