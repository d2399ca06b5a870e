"""What simulators on a fixed grid of time share: inputs and events are looked at once a step, compiled.

An event that falls within a step is acted on at its end, as in every simulator without event location.
"""

import math

from ...compiled import always_compiled
from .automaton import (
    DIRECTION, F, F_RATE, Q_MODE, STICK, TIME, U, V, V_RATE, guard_scales, guards, is_compliant, rates,
)
from .resets import KNOT, classify, move, note, reset, start


@always_compiled
def begin(p, m, w, at_start, pieces, events):
    """Set the automaton at time 0; return the number of events there."""
    kind = start(p, m, w, at_start[0], at_start[1], at_start[2], pieces[0, 1], pieces[0, 2], pieces[0, 3], pieces[0, 4])
    return note(events, 0, m, kind, m[DIRECTION])


@always_compiled
def acceleration(q, w, t, x, u):
    """Return ẍ at τ = t."""
    return rates(q, w, t, x, u)[1]


@always_compiled
def holds(q):
    """Whether the slider stands still in a rigid contact."""
    return q[Q_MODE] == STICK and not is_compliant(q)


@always_compiled
def fallen_guard(q, w, t, x, u):
    """Return the guard that has fallen at τ = t, or −1."""
    first, second, third = guards(q, w, t, x, u)
    scales = guard_scales(q)
    if third < -scales[2]:
        return 2
    if second < -scales[1]:
        return 1
    return 0 if first < -scales[0] else -1


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
