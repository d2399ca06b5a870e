# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The loop: from grid point to grid point; transitions are looked for at their ends only.

The grid is k · step from time 0, counted in whole ticks, so that it does not drift.  A jump of an input or a parameter
between two points ends a step early, there, and takes effect at once; the next step leads back to the grid.  A sample
between two points is a step of its own from the last one, which changes nothing.  So the motion does not depend on how
often it is asked for.
"""

from ...axis.codes import ACCELERATE, ACCELERATING, COAST, COASTING, DECELERATE, DECELERATING, STICK, YIELDING
from ...axis.forces import (
    applied_force,
    drive_force,
    first_segment,
    force_rounding,
    friction_line,
    static_at_once,
    static_limit,
    stick_force,
    take_stick,
)
from ...axis.layout import Parameters
from ...axis.mode_entry import limit_rounding
from ...axis.motion import yielded_deflection
from ...axis.rows import Events, SampleRow, Sinusoids
from ...axis.state_record import State
from ...axis.transitions import apply_inputs, arrest, release, write_event
from ...core.hot_path import compiled
from .. import DONE, FULL, OUT_OF_RANGE
from ..stepping import (
    begin_state,
    change_contact,
    given_inputs_at,
    held_force,
    hold_inputs,
    inputs_vary,
    refresh_inputs,
    same_inputs,
    write_sample,
)
from .steps import friction_at, segment_near, step

_BAND = 0.5   # of a step of the deceleration by N mu_s(0): stops are noted, on the average, when they happen

_FAR = 1e100   # m, m/s: so far that forces overflow soon


@compiled
def start(p: Parameters, s: State, position: float, velocity: float, rest: float, stretch: float, deflection: float,
          v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids, events: Events, row: int,
          method: float, step_ticks: float, second_ticks: float) -> int:
    """Set the state at time 0, as the exact engine does; a step lasts step_ticks / second_ticks seconds."""
    begin_state(s, position, velocity, rest, stretch, deflection)
    s.grid.method, s.grid.step_ticks, s.grid.second_ticks = method, step_ticks, second_ticks
    hold_inputs(s, 0.0, 0.0, v, v_rate, f, f_rate, sinusoids)
    refresh_inputs(s)
    if s.mode == STICK:
        return _look(p, s, events, row)
    s.segment = float(first_segment(p, s.direction))
    residual, _, tolerance = _residual(p, s)
    s.mode = _sub_mode(s.mode, residual, 0.0, tolerance)
    return row


@compiled
def advance(p: Parameters, s: State, second: float, fraction: float, events: Events, row: int) -> tuple[int, int]:
    """Go to the last grid point that is not after a time; return the rows in use and how it ended."""
    while True:
        ticks = s.grid.ticks + s.grid.step_ticks
        whole = s.grid.second
        if ticks >= s.grid.second_ticks:
            ticks -= s.grid.second_ticks
            whole += 1.0
        part = ticks / s.grid.second_ticks
        if (whole - second) + (part - fraction) > 0.0:
            return row, DONE
        if row >= events.count:
            return row, FULL
        if not _move(p, s, whole, part, s.grid.step_ticks / s.grid.second_ticks - s.grid.lead):
            return row, OUT_OF_RANGE
        s.grid.second, s.grid.ticks, s.grid.lead = whole, ticks, 0.0
        row = _look(p, s, events, row)


@compiled
def set_inputs(p: Parameters, s: State, second: float, fraction: float, v: float, v_rate: float, f: float,
               f_rate: float, sinusoids: Sinusoids, events: Events, row: int) -> int:
    """Let the inputs be others from a time on, up to which the state was advanced."""
    if same_inputs(s, v, v_rate, f, f_rate, sinusoids):
        return row
    _catch_up(p, s, second, fraction)
    hold_inputs(s, second, fraction, v, v_rate, f, f_rate, sinusoids)
    refresh_inputs(s)
    return _look(p, s, events, row)


@compiled
def set_parameters(p: Parameters, new: Parameters, s: State, second: float, fraction: float, events: Events, row: int
                  ) -> int:
    """Let the axis have other parameters from a time on, up to which the state was advanced with the old ones."""
    _catch_up(p, s, second, fraction)
    change_contact(new, s, held_force(p, s))
    s.segment = float(first_segment(new, s.direction))
    take_stick(new, s)
    if s.mode == YIELDING:
        return row + 1 if apply_inputs(new, s, events, row) else row
    return _look(new, s, events, row)


@compiled
def set_load(p: Parameters, s: State, second: float, fraction: float, normal_force: float, _normal_rate: float,
             v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids, events: Events, row: int) -> int:
    """Let the normal force and the inputs be others at once from a time on, up to which the state was advanced."""
    _catch_up(p, s, second, fraction)
    p.normal_force = normal_force
    hold_inputs(s, second, fraction, v, v_rate, f, f_rate, sinusoids)
    refresh_inputs(s)
    return _look(p, s, events, row)


@compiled
def sample(p: Parameters, s: State, second: float, fraction: float, out: SampleRow) -> None:
    """Fill a row with the state at a time from that of the state on, before the next grid point."""
    t = (second - s.second) + (fraction - s.fraction)
    y, u, drive = 0.0, s.velocity, 0.0
    if t > 0.0:
        y, u, drive = step(p, s, t)
    v, f = given_inputs_at(s, second, fraction)
    of_drive = drive_force(p, s.spring + (drive - y), v, u)
    applied = of_drive + f
    friction = friction_at(p, s, applied, u, s.deflection + y)
    write_sample(p, s, second, fraction, t, y, u, (applied - friction) / p.mass, drive, v, of_drive, f, friction, out)


@compiled
def _move(p: Parameters, s: State, second: float, fraction: float, h: float) -> bool:
    """Bring the state to a time, h later; return False, and leave it, where the numbers end."""
    y, u, drive = step(p, s, h)
    if not abs(y) + abs(u) + abs(drive) < _FAR:   # nor where it is no number
        return False
    if s.mode == STICK:
        s.rest += h
        s.deflection += y
    elif s.mode == YIELDING:
        s.deflection = yielded_deflection(p, s, h)
    s.position += y
    s.drive += drive
    s.spring += drive - y
    s.velocity = u
    s.second, s.fraction = second, fraction
    if inputs_vary(s):
        refresh_inputs(s)
    return True


@compiled
def _catch_up(p: Parameters, s: State, second: float, fraction: float) -> None:
    t = (second - s.second) + (fraction - s.fraction)
    if t > 0.0 and _move(p, s, second, fraction, t):
        s.grid.lead += t


@compiled
def _look(p: Parameters, s: State, events: Events, row: int) -> int:
    """Make the transition that is due at the state, if any; return the rows in use."""
    take_stick(p, s)
    if s.mode == STICK:
        return _look_at_stick(p, s, events, row)
    if s.mode == YIELDING:
        return _look_at_yielding(p, s, events, row)
    residual, band, tolerance = _residual(p, s)
    if _has_stopped(p, s, residual):
        arrest(p, s, events, row)
        return row + 1
    mode = _sub_mode(s.mode, residual, band, tolerance)
    if mode == s.mode:
        return row
    applied = applied_force(p, s)
    kind = ACCELERATE if mode == ACCELERATING else (COAST if mode == COASTING else DECELERATE)
    friction = friction_at(p, s, applied, s.velocity, 0.0)
    write_event(p, s, events, row, kind, s.direction, friction, static_at_once(p, s.direction))
    s.mode = mode
    events.rows[row].mode = mode
    return row + 1


@compiled
def _look_at_stick(p: Parameters, s: State, events: Events, row: int) -> int:
    applied = applied_force(p, s)
    force = stick_force(p, s)
    limit = static_limit(p, s.rest, force)
    margin = abs(force) - p.normal_force * limit
    if margin <= 0.0 or margin <= limit_rounding(p, s, limit):
        return row
    s.acceleration = (applied - friction_at(p, s, applied, s.velocity, s.deflection)) / p.mass
    release(p, s, events, row)
    return row + 1


@compiled
def _look_at_yielding(p: Parameters, s: State, events: Events, row: int) -> int:
    if s.direction * s.velocity > 0.0:
        release(p, s, events, row)
        return row + 1
    return row + 1 if apply_inputs(p, s, events, row) else row


@compiled
def _residual(p: Parameters, s: State) -> tuple[float, float, float]:
    """Return R along the slip, the width B of the coasting band, and the rounding of R, N (docs/model.md)."""
    speed = s.direction * s.velocity
    segment = segment_near(p, int(s.segment), speed)
    s.segment = float(segment)
    coefficient, _, psi, _ = friction_line(p, segment, speed)
    return (s.direction * applied_force(p, s) - p.normal_force * coefficient, p.normal_force * s.excess * psi,
            force_rounding(p, s, coefficient))


@compiled
def _has_stopped(p: Parameters, s: State, residual: float) -> bool:
    """Whether a slip ends: it was reversed, or it slows down in Karnopp's band and friction could hold it at rest."""
    speed = s.direction * s.velocity
    if speed < 0.0:
        return True
    at_rest = drive_force(p, s.spring, s.inputs.v, 0.0) + s.inputs.f
    holds = p.normal_force * static_at_once(p, at_rest)
    band = _BAND * s.grid.step_ticks / s.grid.second_ticks * holds / p.mass
    return residual < 0.0 and speed < band and abs(at_rest) <= holds


@compiled
def _sub_mode(mode: float, residual: float, band: float, tolerance: float) -> float:
    """Return the sub-mode of slip; within rounding of a border it stays what it was."""
    if residual - band > tolerance:
        return ACCELERATING
    if residual < -tolerance:
        return DECELERATING
    if tolerance < residual < band - tolerance:
        return COASTING
    return mode
