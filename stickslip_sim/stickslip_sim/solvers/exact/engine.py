# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Advance a state to a time, event by event; read it in between; change its inputs.

The anchor moves only at events and at jumps of an input.  Times between are read off the closed form, so that the
motion does not depend on how often it is asked for.

Arrays: `p` parameters of the axis, `s` state (both `axis.layout`), `events` a table of rows.  All functions change `s`
in place and return the number of rows in use; `advance` also tells how it ended.
"""

import math

from ...axis.layout import (
    ACCELERATION, ACCOUNTING, AT, COMPLIANT, CONTACT_DAMPING, CONTACT_STIFFNESS, DEFLECTION, DIRECTION, F, FRACTION,
    F_RATE, NEAR, LAST, MASS, MODE, NEXT, NEXT_KIND, NORMAL, ORIGIN, PROGRESS, REST, SEARCHED, SECOND, STATE_SIZE,
    STORED_AT_START, V, VELOCITY, V_RATE, WAVES,
)
from ...axis.motion import (
    COASTING, STAMP, STICK, begin_motion, drive_force, drive_travel, friction_force, friction_line, move_anchor,
    piece_above, spring_after, travel,
)
from ...axis.transitions import (
    ARREST, BREAKAWAY, COAST, KNOT, applied_force, apply_inputs, arrest, choose_slip, cross_knot, force_rounding,
    leave_coast, release, turn,
)
from ...axis.waves import inputs_at, load_waves, same_waves
from ...core.jit import compiled, inlined
from .. import DONE, FULL, NO_PROGRESS, UNSOUND
from ..sampling import write_sample
from .account import book_contact, book_parameters, book_works, read_account
from .judge import event_is_sound
from .search import find_event
from .works import contact_energy, stored_energy

_SAME_INSTANT = 64   # events without progress in time; a sound model needs three


@compiled
def start(p, s, position, velocity, rest, v, v_rate, f, f_rate, waves, events, row):
    """Set the state at time 0: the spring unstretched, at rest (it may break away at once) or sliding."""
    accounting = s[ACCOUNTING]
    for i in range(STATE_SIZE):
        s[i] = 0.0
    s[ACCOUNTING] = accounting
    s[NEAR] = -1.0
    s[ORIGIN] = position
    s[VELOCITY] = velocity
    s[REST] = rest
    s[V], s[V_RATE], s[F], s[F_RATE] = v, v_rate, f, f_rate
    load_waves(s, waves)
    s[MODE] = STICK
    s[STORED_AT_START] = 0.5 * p[MASS] * velocity * velocity
    if velocity == 0.0:
        row = _apply(p, s, events, row)
    else:
        s[REST] = 0.0
        s[DIRECTION] = 1.0 if velocity > 0.0 else -1.0
        speed = abs(velocity)
        coefficient, _, _, _ = friction_line(p, piece_above(p, speed), speed)
        residual = s[DIRECTION] * applied_force(p, s) - p[NORMAL] * coefficient
        choose_slip(p, s, residual, residual, force_rounding(p, s, coefficient))
    _begin(p, s)
    return row


@compiled
def advance(p, s, second, fraction, events, row):
    """Bring the state to a time, which is not before its anchor; return the rows in use and how it ended."""
    same_instant = 0
    while True:
        t = (second - s[SECOND]) + (fraction - s[FRACTION])
        reach = t + STAMP
        if s[SEARCHED] < reach:
            find_event(p, s, reach)
        due = s[NEXT]
        if due > reach:
            return row, DONE
        if not due >= 0.0:   # given up, or no number
            return row, NO_PROGRESS
        later = s[FRACTION] + due
        whole = 0.0 if later < 1.0 else math.floor(later)
        if (s[SECOND] + whole - second) + ((later - whole) - fraction) > 0.0:
            return row, DONE   # its time, as it is written down, is still to come
        if row >= len(events):
            return row, FULL
        same_instant = same_instant + 1 if due == 0.0 else 0
        if same_instant > _SAME_INSTANT:
            return row, NO_PROGRESS
        if not _pass_event(p, s, due, s[SECOND] + whole, later - whole, events, row):
            return row, UNSOUND
        row += 1
        _begin(p, s)


@inlined
def _pass_event(p, s, due, second, fraction, events, row):
    """Go through the event that is due; return False, and stay before it, when the run is no longer sound."""
    mode, begin, acceleration = int(s[MODE]), s[VELOCITY], s[ACCELERATION]
    accounting = s[ACCOUNTING] != 0.0
    if accounting:
        book_works(p, s, due)
    move_anchor(p, s, second, fraction, due)
    if accounting and not event_is_sound(p, s, begin):
        return False
    s[LAST + mode] = due if s[NEXT_KIND] != COAST else 0.0
    contact = contact_energy(p, s, 0.0) if accounting else 0.0
    _transition(p, s, events, row, acceleration)
    if accounting:
        book_contact(p, s, contact)
    return True


@compiled
def set_inputs(p, s, second, fraction, v, v_rate, f, f_rate, waves, events, row):
    """Let the inputs be v + v_rate t, f + f_rate t and waves from a time on, up to which the state was advanced."""
    steady = s[V_RATE] == 0.0 and s[F_RATE] == 0.0 and v_rate == 0.0 and f_rate == 0.0
    if s[WAVES] == 0.0 and len(waves) == 0:
        if steady and s[V] == v and s[F] == f:
            return row
    elif steady and same_waves(s, v, f, waves):
        return row
    _anchor_at(p, s, second, fraction)
    s[V], s[V_RATE], s[F], s[F_RATE] = v, v_rate, f, f_rate
    load_waves(s, waves)
    row = _apply(p, s, events, row)
    _begin(p, s)
    return row


@compiled
def set_parameters(p, new, s, second, fraction, events, row):
    """Let the axis have other parameters from a time on, up to which the state was advanced with the old ones."""
    _anchor_at(p, s, second, fraction)
    stored = stored_energy(p, s, 0.0)
    if s[MODE] == STICK and new[COMPLIANT] != 0.0:
        force = friction_force(p, s, s[DEFLECTION], s[VELOCITY], applied_force(p, s))
        s[DEFLECTION] = (force - new[CONTACT_DAMPING] * s[VELOCITY]) / new[CONTACT_STIFFNESS]
    if s[MODE] == STICK and new[COMPLIANT] == 0.0:
        s[VELOCITY] = 0.0
        s[DEFLECTION] = 0.0
    if s[ACCOUNTING] != 0.0:
        book_parameters(new, s, stored)
    row = _apply(new, s, events, row)
    _begin(new, s)
    return row


@compiled
def sample(p, s, second, fraction, out):
    """Fill a row with the state at a time between the anchor and the next event (`types.Sample` names the columns)."""
    t = (second - s[SECOND]) + (fraction - s[FRACTION])
    y, u, a = travel(p, s, t)
    drive = drive_travel(s, t)
    v = s[V] + s[V_RATE] * t
    force = s[F] + s[F_RATE] * t
    if s[WAVES] != 0.0:
        v, force = inputs_at(s, second, fraction, t)
    pull = drive_force(p, spring_after(p, s, t, drive, y, u, a), v, u)
    friction = friction_force(p, s, s[DEFLECTION] + y, u, pull + force)
    write_sample(p, s, second, fraction, t, y, u, a, drive, v, pull, force, friction, out)


@compiled
def energy(p, s, second, fraction, out):
    """Fill a row with the energies up to a time between the anchor and the next event (`energy.EnergyBalance`)."""
    t = (second - s[SECOND]) + (fraction - s[FRACTION])
    read_account(p, s, t, out)


@inlined
def _begin(p, s):
    begin_motion(p, s)
    s[SEARCHED] = -1.0
    s[PROGRESS] = 0.0
    s[NEXT] = math.inf
    s[AT] = -1.0


@inlined
def _apply(p, s, events, row):
    contact = contact_energy(p, s, 0.0)
    if apply_inputs(p, s, events, row):
        row += 1
    if s[ACCOUNTING] != 0.0:
        book_contact(p, s, contact)
    return row


@inlined
def _anchor_at(p, s, second, fraction):
    t = (second - s[SECOND]) + (fraction - s[FRACTION])
    if s[ACCOUNTING] != 0.0:
        book_works(p, s, t)
    move_anchor(p, s, second, fraction, t)


@inlined
def _transition(p, s, events, row, before):
    kind = s[NEXT_KIND]
    if kind == BREAKAWAY:
        release(p, s, events, row)
    elif kind == ARREST:
        arrest(p, s, events, row)
    elif kind == KNOT:
        cross_knot(p, s, events, row, before)
    elif s[MODE] == COASTING:
        leave_coast(p, s, events, row, kind)
    else:
        turn(p, s, events, row)
