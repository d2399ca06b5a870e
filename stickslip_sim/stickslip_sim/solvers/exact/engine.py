# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Advance a state to a time, event by event; read it in between; change its inputs.

The segment start moves only at events, at jumps of an input, and just before the break-away of a contact that has rung
for long (`search`).  Times between are read off the closed form, so that the motion does not depend on how often it is
asked for.

Records: `p` parameters of the axis (`axis.layout`), `s` state (`axis.state_record`), `events` a table of rows.  All
functions change `s` in place and return the number of rows in use; `advance` also says how it ended.
"""

import math

from ...axis.codes import ARREST, BREAKAWAY, COAST, COASTING, KNOT, STICK, YIELDING
from ...axis.forces import (
    applied_force,
    drive_force,
    force_rounding,
    friction_force,
    friction_line,
    segment_above,
    take_stick,
)
from ...axis.layout import Parameters
from ...axis.mode_entry import choose_slip
from ...axis.motion import begin_motion, drive_travel, move_start, spring_after, travel
from ...axis.rows import EnergyRow, Events, SampleRow, Sinusoids
from ...axis.sinusoids import inputs_at, load_sinusoids, same_sinusoids
from ...axis.slip_series import series_deflection
from ...axis.smooth_load import begin_load, normal_force_at, take_load
from ...axis.state_record import State, clear_state
from ...axis.transitions import apply_inputs, arrest, cross_breakpoint, leave_coast, release, turn
from ...core.hot_path import compiled, inlined
from .. import DONE, FULL, NO_PROGRESS, OUT_OF_RANGE, UNSOUND
from ..stepping import is_stuck, write_sample
from .search import STAMP, find_event
from .series_events import RENEWAL
from .soundness import event_is_sound
from .works import book_contact, book_parameters, book_works, contact_energy, read_account, stored_energy

_SAME_INSTANT = 64   # events without progress in time; a sound model needs three


@compiled
def start(p: Parameters, s: State, position: float, velocity: float, rest: float, stretch: float, deflection: float,
          v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids, events: Events, row: int) -> int:
    """Set the state at time 0: in stick (it may break away at once) or, moving without a deflection, sliding."""
    accounting = s.accounting
    clear_state(s)
    s.accounting = accounting
    s.cache.near.time = -1.0
    s.origin = position
    s.velocity = velocity
    s.rest = rest
    s.drive = s.spring = stretch
    s.deflection = deflection
    s.inputs.v, s.inputs.v_rate, s.inputs.f, s.inputs.f_rate = v, v_rate, f, f_rate
    s.inputs.base_n = p.normal_force
    _load_inputs(p, s, sinusoids)
    s.mode = STICK
    s.stored_at_start = stored_energy(p, s, 0.0)
    if is_stuck(velocity, deflection):
        row = _apply(p, s, events, row)
    else:
        s.rest = 0.0
        s.direction = 1.0 if velocity > 0.0 else -1.0
        speed = abs(velocity)
        coefficient, _, _, _ = friction_line(p, segment_above(p, s.direction, speed), speed)
        residual = s.direction * applied_force(p, s) - p.normal_force * coefficient
        choose_slip(p, s, residual, residual, force_rounding(p, s, coefficient))
    _begin(p, s)
    return row


@compiled
def advance(p: Parameters, s: State, second: float, fraction: float, events: Events, row: int) -> tuple[int, int]:
    """Bring the state to a time, which is not before its segment start; return the rows in use and how it ended."""
    same_instant = 0
    take_load(p, s)
    take_stick(p, s)
    while True:
        t = (second - s.second) + (fraction - s.fraction)
        reach = t + STAMP
        if s.next.searched < reach:
            find_event(p, s, reach)
        due = s.next.time
        if due > reach:
            return row, DONE
        if not due >= 0.0:   # given up, or no number
            return row, NO_PROGRESS
        later = s.fraction + due
        whole = 0.0 if later < 1.0 else math.floor(later)
        if (s.second + whole - second) + ((later - whole) - fraction) > 0.0:
            return row, DONE   # its time, as it is written down, is still to come
        if s.next.kind == RENEWAL:
            _start_at(p, s, s.second + whole, later - whole)
            _begin(p, s)
            continue
        if row >= events.count:
            return row, FULL
        same_instant = same_instant + 1 if due == 0.0 else 0
        if same_instant > _SAME_INSTANT:
            return row, NO_PROGRESS
        if not _pass_event(p, s, due, s.second + whole, later - whole, events, row):
            return row, UNSOUND
        row += 1
        _begin(p, s)


@inlined
def _pass_event(p: Parameters, s: State, due: float, second: float, fraction: float, events: Events, row: int) -> bool:
    """Go through the event that is due; return False, and stay before it, when the run is no longer sound."""
    mode, begin, acceleration = int(s.mode), s.velocity, s.acceleration
    accounting = s.accounting != 0.0
    if accounting:
        book_works(p, s, due)
    move_start(p, s, second, fraction, due)
    if accounting and not event_is_sound(p, s, begin):
        return False
    s.cache.last[mode] = due if s.next.kind != COAST else 0.0
    contact = contact_energy(p, s, 0.0) if accounting else 0.0
    make_transition(p, s, events, row, acceleration)
    if accounting:
        book_contact(p, s, contact)
    return True


@compiled
def set_inputs(p: Parameters, s: State, second: float, fraction: float, v: float, v_rate: float, f: float,
               f_rate: float, sinusoids: Sinusoids, events: Events, row: int) -> int:
    """Let the inputs be v + v_rate t, f + f_rate t and sinusoids from a time on, up to which the state was advanced."""
    steady = s.inputs.v_rate == 0.0 and s.inputs.f_rate == 0.0 and v_rate == 0.0 and f_rate == 0.0
    if s.sinusoid_count == 0.0 and sinusoids.count == 0:
        if steady and s.inputs.v == v and s.inputs.f == f:
            return row
    elif steady and same_sinusoids(s, v, f, sinusoids):
        return row
    _start_at(p, s, second, fraction)
    s.inputs.v, s.inputs.v_rate, s.inputs.f, s.inputs.f_rate = v, v_rate, f, f_rate
    _load_inputs(p, s, sinusoids)
    row = _apply(p, s, events, row)
    _begin(p, s)
    return row


@compiled
def set_parameters(p: Parameters, new: Parameters, s: State, second: float, fraction: float, events: Events, row: int
                  ) -> int:
    """Let the axis have other parameters from a time on, up to which the state was advanced with the old ones."""
    _start_at(p, s, second, fraction)
    s.inputs.base_n = new.normal_force
    begin_load(new, s)
    take_stick(new, s)
    stored = stored_energy(p, s, 0.0)
    if s.mode == STICK and new.compliant != 0.0:
        force = friction_force(p, s, s.deflection, s.velocity, applied_force(p, s))
        s.deflection = (force - new.contact_damping * s.velocity) / new.contact_stiffness
    if s.mode == STICK and new.compliant == 0.0:
        s.velocity = 0.0
        s.deflection = 0.0
    if s.accounting != 0.0:
        book_parameters(new, s, stored)
    row = _apply(new, s, events, row)
    _begin(new, s)
    return row


@compiled
def set_load(p: Parameters, s: State, second: float, fraction: float, normal_force: float, normal_rate: float, v: float,
             v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids, events: Events, row: int) -> int:
    """Let the normal force and the inputs be others from a time on, up to which the state was advanced; both at once.

    Position, velocity, rest time and the deflection of the contact stay: the limit and the friction lines move.
    """
    _start_at(p, s, second, fraction)
    p.normal_force = s.inputs.base_n = normal_force
    p.normal_rate = normal_rate
    s.inputs.v, s.inputs.v_rate, s.inputs.f, s.inputs.f_rate = v, v_rate, f, f_rate
    _load_inputs(p, s, sinusoids)
    row = _apply(p, s, events, row)
    _begin(p, s)
    return row


@compiled
def sample(p: Parameters, s: State, second: float, fraction: float, out: SampleRow) -> None:
    """Fill a row with the state at a time before the next event."""
    t = (second - s.second) + (fraction - s.fraction)
    y, u, a = travel(p, s, t)
    drive = drive_travel(s, t)
    v = s.inputs.v + s.inputs.v_rate * t
    force = s.inputs.f + s.inputs.f_rate * t
    if s.sinusoid_count != 0.0:
        v, force = inputs_at(s, second, fraction, t)
    of_drive = drive_force(p, spring_after(p, s, t, drive, y, u, a), v, u)
    p.normal_force, _ = normal_force_at(p, s, t)
    friction = friction_force(p, s, s.deflection + y, u, of_drive + force)
    write_sample(p, s, second, fraction, t, y, u, a, drive, v, of_drive, force, friction, out)
    if s.mode == YIELDING:
        out.deflection, _ = series_deflection(s, t)
    take_load(p, s)


@compiled
def step(p: Parameters, s: State, from_second: float, from_fraction: float, second: float, fraction: float,
         is_commanded: bool, v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids, events: Events,
         out: SampleRow) -> tuple[int, int]:
    """Advance from one time to another, where `is_commanded` under new inputs, and fill a row; return as `advance`."""
    row = 0
    if is_commanded:
        row = set_inputs(p, s, from_second, from_fraction, v, v_rate, f, f_rate, sinusoids, events, row)
    row, ended = advance(p, s, second, fraction, events, row)
    if ended == DONE:
        sample(p, s, second, fraction, out)
        moves = (out.position + out.velocity + out.acceleration + out.drive + out.drive_velocity + out.drive_force
                 + out.external + out.friction)
        if moves - moves != 0.0:    # inf or nan
            ended = OUT_OF_RANGE
    return row, ended


@compiled
def energy(p: Parameters, s: State, second: float, fraction: float, out: EnergyRow) -> None:
    """Fill a row with the energies up to a time before the next event (`energy.EnergyBalance`)."""
    t = (second - s.second) + (fraction - s.fraction)
    take_load(p, s)
    read_account(p, s, t, out)


@inlined
def _load_inputs(p: Parameters, s: State, sinusoids: Sinusoids) -> None:
    load_sinusoids(s, sinusoids)
    begin_load(p, s)
    take_stick(p, s)


@inlined
def _begin(p: Parameters, s: State) -> None:
    begin_motion(p, s)
    s.next.searched = -1.0
    s.next.progress = 0.0
    s.next.time = math.inf
    s.cache.at.time = -1.0


@inlined
def _apply(p: Parameters, s: State, events: Events, row: int) -> int:
    contact = contact_energy(p, s, 0.0)
    if apply_inputs(p, s, events, row):
        row += 1
    if s.accounting != 0.0:
        book_contact(p, s, contact)
    return row


@inlined
def _start_at(p: Parameters, s: State, second: float, fraction: float) -> None:
    t = (second - s.second) + (fraction - s.fraction)
    if s.accounting != 0.0:
        book_works(p, s, t)
    move_start(p, s, second, fraction, t)


@inlined
def make_transition(p: Parameters, s: State, events: Events, row: int, before: float) -> None:
    """Go over to the mode that follows on the event that is due; `before` is the acceleration just before it."""
    kind = s.next.kind
    if kind == BREAKAWAY:
        release(p, s, events, row)
    elif kind == ARREST:
        arrest(p, s, events, row)
    elif kind == KNOT:
        cross_breakpoint(p, s, events, row, before)
    elif s.mode == COASTING:
        leave_coast(p, s, events, row, kind)
    else:
        turn(p, s, events, row)
