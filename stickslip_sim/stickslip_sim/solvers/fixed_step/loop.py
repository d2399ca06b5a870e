# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The loop: from grid point to grid point; transitions are looked for at their ends only.

The grid is k · step from time 0, counted in whole ticks, so that it does not drift.  A jump of an input or a parameter
between two points ends a step early, there, and takes effect at once; the next step leads back to the grid.  A sample
between two points is a step of its own from the last one, which changes nothing.  So the motion does not depend on how
often it is asked for.
"""

from ...axis.layout import (
    ACCELERATION, DEFLECTION, DIRECTION, DRIVE, EVENT_MODE, EXCESS, F, FRACTION, GRID_SECOND, GRID_TICKS, LEAD, MASS,
    METHOD, MODE, NORMAL, PIECE, POSITION, REST, SECOND, SECOND_TICKS, SPRING, STATIC_INITIAL, STEP_TICKS, V, VELOCITY,
)
from ...axis.motion import (
    ACCELERATING, COASTING, DECELERATING, STICK, contact_force, drive_force, friction_line, is_rigid_stick,
    static_limit,
)
from ...axis.transitions import (
    ACCELERATE, COAST, DECELERATE, applied_force, arrest, force_rounding, release, write_event,
)
from ...core.jit import compiled
from .. import DONE, FULL, OUT_OF_RANGE
from ..inputs import hold_inputs, inputs_at, inputs_vary, refresh_inputs, same_inputs
from ..sampling import write_sample
from ..state import begin_state, change_contact
from .steps import friction_at, piece_near, step

_BAND = 0.5   # of a step of the deceleration by N mu_s(0): stops are noted, on the average, when they happen

_FAR = 1e100   # m, m/s: so far that forces overflow soon


@compiled
def start(p, s, position, velocity, rest, v, v_rate, f, f_rate, waves, events, row, method, step_ticks, second_ticks):
    """Set the state at time 0, as the exact engine does; a step lasts step_ticks / second_ticks seconds."""
    begin_state(s, position, velocity, rest)
    s[METHOD], s[STEP_TICKS], s[SECOND_TICKS] = method, step_ticks, second_ticks
    hold_inputs(s, 0.0, 0.0, v, v_rate, f, f_rate, waves)
    refresh_inputs(s)
    if velocity == 0.0:
        return _look(p, s, events, row)
    residual, _, tolerance = _residual(p, s)
    s[MODE] = _sub_mode(s[MODE], residual, 0.0, tolerance)
    return row


@compiled
def advance(p, s, second, fraction, events, row):
    """Go to the last grid point that is not after a time; return the rows in use and how it ended."""
    while True:
        ticks = s[GRID_TICKS] + s[STEP_TICKS]
        whole = s[GRID_SECOND]
        if ticks >= s[SECOND_TICKS]:
            ticks -= s[SECOND_TICKS]
            whole += 1.0
        part = ticks / s[SECOND_TICKS]
        if (whole - second) + (part - fraction) > 0.0:
            return row, DONE
        if row >= len(events):
            return row, FULL
        if not _move(p, s, whole, part, s[STEP_TICKS] / s[SECOND_TICKS] - s[LEAD]):
            return row, OUT_OF_RANGE
        s[GRID_SECOND], s[GRID_TICKS], s[LEAD] = whole, ticks, 0.0
        row = _look(p, s, events, row)


@compiled
def set_inputs(p, s, second, fraction, v, v_rate, f, f_rate, waves, events, row):
    """Let the inputs be others from a time on, up to which the state was advanced."""
    if same_inputs(s, v, v_rate, f, f_rate, waves):
        return row
    _catch_up(p, s, second, fraction)
    hold_inputs(s, second, fraction, v, v_rate, f, f_rate, waves)
    refresh_inputs(s)
    return _look(p, s, events, row)


@compiled
def set_parameters(p, new, s, second, fraction, events, row):
    """Let the axis have other parameters from a time on, up to which the state was advanced with the old ones."""
    _catch_up(p, s, second, fraction)
    change_contact(new, s, friction_at(p, s, applied_force(p, s), s[VELOCITY], s[DEFLECTION]))
    s[PIECE] = 0.0
    return _look(new, s, events, row)


@compiled
def sample(p, s, second, fraction, out):
    """Fill a row with the state at a time from that of the state on, before the next grid point."""
    t = (second - s[SECOND]) + (fraction - s[FRACTION])
    y, u, drive = 0.0, s[VELOCITY], 0.0
    if t > 0.0:
        y, u, drive = step(p, s, t)
    v, f = inputs_at(s, second, fraction)
    pull = drive_force(p, s[SPRING] + (drive - y), v, u)
    applied = pull + f
    friction = friction_at(p, s, applied, u, s[DEFLECTION] + y)
    write_sample(p, s, second, fraction, t, y, u, (applied - friction) / p[MASS], drive, v, pull, f, friction, out)


@compiled
def _move(p, s, second, fraction, h):
    """Bring the state to a time, h later; return False, and leave it, where the numbers end."""
    y, u, drive = step(p, s, h)
    if not abs(y) + abs(u) + abs(drive) < _FAR:   # nor where it is no number
        return False
    if s[MODE] == STICK:
        s[REST] += h
        s[DEFLECTION] += y
    s[POSITION] += y
    s[DRIVE] += drive
    s[SPRING] += drive - y
    s[VELOCITY] = u
    s[SECOND], s[FRACTION] = second, fraction
    if inputs_vary(s):
        refresh_inputs(s)
    return True


@compiled
def _catch_up(p, s, second, fraction):
    t = (second - s[SECOND]) + (fraction - s[FRACTION])
    if t > 0.0 and _move(p, s, second, fraction, t):
        s[LEAD] += t


@compiled
def _look(p, s, events, row):
    """Make the transition that is due at the state, if any; return the rows in use."""
    if s[MODE] == STICK:
        return _look_at_stick(p, s, events, row)
    residual, band, tolerance = _residual(p, s)
    if _has_stopped(p, s, residual):
        arrest(p, s, events, row)
        return row + 1
    mode = _sub_mode(s[MODE], residual, band, tolerance)
    if mode == s[MODE]:
        return row
    applied = applied_force(p, s)
    kind = ACCELERATE if mode == ACCELERATING else (COAST if mode == COASTING else DECELERATE)
    friction = friction_at(p, s, applied, s[VELOCITY], 0.0)
    write_event(p, s, events, row, kind, s[DIRECTION], friction, p[STATIC_INITIAL])
    s[MODE] = mode
    events[row][EVENT_MODE] = mode
    return row + 1


@compiled
def _look_at_stick(p, s, events, row):
    applied = applied_force(p, s)
    force = applied if is_rigid_stick(p, s) else contact_force(p, s[DEFLECTION], s[VELOCITY])
    limit = static_limit(p, s[REST])
    margin = abs(force) - p[NORMAL] * limit
    if margin <= 0.0 or margin <= force_rounding(p, s, limit):
        return row
    s[ACCELERATION] = (applied - force) / p[MASS]
    release(p, s, events, row)
    return row + 1


@compiled
def _residual(p, s):
    """Return R along the slip, the width B of the coasting band, and the rounding of R, N (docs/model.md)."""
    speed = s[DIRECTION] * s[VELOCITY]
    piece = piece_near(p, int(s[PIECE]), speed)
    s[PIECE] = float(piece)
    coefficient, _, psi, _ = friction_line(p, piece, speed)
    return (s[DIRECTION] * applied_force(p, s) - p[NORMAL] * coefficient, p[NORMAL] * s[EXCESS] * psi,
            force_rounding(p, s, coefficient))


@compiled
def _has_stopped(p, s, residual):
    """Whether a slip ends: it was reversed, or it slows down in Karnopp's band and friction could hold it at rest."""
    speed = s[DIRECTION] * s[VELOCITY]
    if speed < 0.0:
        return True
    holds = p[NORMAL] * static_limit(p, 0.0)
    band = _BAND * s[STEP_TICKS] / s[SECOND_TICKS] * holds / p[MASS]
    at_rest = drive_force(p, s[SPRING], s[V], 0.0) + s[F]
    return residual < 0.0 and speed < band and abs(at_rest) <= holds


@compiled
def _sub_mode(mode, residual, band, tolerance):
    """Return the sub-mode of slip; within rounding of a border it stays what it was."""
    if residual - band > tolerance:
        return ACCELERATING
    if residual < -tolerance:
        return DECELERATING
    if tolerance < residual < band - tolerance:
        return COASTING
    return mode
