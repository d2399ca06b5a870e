# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The inputs of solvers that step: v(t) and F_e(t) at any time, from what `set_inputs` gave them."""

import math

from ..axis.codes import DECELERATING, STICK, YIELDING
from ..axis.forces import applied_force, contact_force, is_rigid_stick, stated_drive_force
from ..axis.layout import Parameters
from ..axis.motion import yielded_deflection
from ..axis.rows import SampleRow, Sinusoids
from ..axis.state_record import State, clear_state
from ..core.hot_path import compiled, inlined
from ..linear.waves import TURN, phase_at


@compiled
def hold_inputs(s: State, second: float, fraction: float, v: float, v_rate: float, f: float, f_rate: float,
                sinusoids: Sinusoids) -> None:
    """Let the inputs be v + v_rate t, f + f_rate t and the sinusoids from a time on."""
    s.given.second, s.given.fraction = second, fraction
    s.given.v, s.given.v_rate, s.given.f, s.given.f_rate = v, v_rate, f, f_rate
    s.given_sinusoids = float(sinusoids.count)
    for k in range(sinusoids.count):
        s.sinusoids[k].frequency, s.sinusoids[k].phase = sinusoids.rows[k].frequency, sinusoids.rows[k].phase
        s.sinusoids[k].v, s.sinusoids[k].f = sinusoids.rows[k].v, sinusoids.rows[k].f


@compiled
def same_inputs(s: State, v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids) -> bool:
    """Whether the inputs hold already and do not change but for the same sinusoids."""
    if (s.given.v != v or s.given.f != f or s.given.v_rate != 0.0 or s.given.f_rate != 0.0 or v_rate != 0.0
            or f_rate != 0.0 or s.given_sinusoids != sinusoids.count):
        return False
    for k in range(sinusoids.count):
        if (s.sinusoids[k].frequency != sinusoids.rows[k].frequency or s.sinusoids[k].phase != sinusoids.rows[k].phase
                or s.sinusoids[k].v != sinusoids.rows[k].v or s.sinusoids[k].f != sinusoids.rows[k].f):
            return False
    return True


@compiled
def inputs_vary(s: State) -> bool:
    """Whether the inputs change by themselves."""
    return s.given.v_rate != 0.0 or s.given.f_rate != 0.0 or s.given_sinusoids != 0.0


@compiled
def given_inputs_at(s: State, second: float, fraction: float) -> tuple[float, float]:
    """Return v and F_e at a time."""
    t = (second - s.given.second) + (fraction - s.given.fraction)
    v = s.given.v + s.given.v_rate * t
    f = s.given.f + s.given.f_rate * t
    for k in range(int(s.given_sinusoids)):
        sine = math.sin(TURN * phase_at(s.sinusoids[k].frequency, s.sinusoids[k].phase, second, fraction))
        v += s.sinusoids[k].v * sine
        f += s.sinusoids[k].f * sine
    return v, f


@compiled
def refresh_inputs(s: State) -> None:
    """Set V, F and their rates to those at the time of the state."""
    s.inputs.v, s.inputs.f = given_inputs_at(s, s.second, s.fraction)
    s.inputs.v_rate, s.inputs.f_rate = s.given.v_rate, s.given.f_rate
    for k in range(int(s.given_sinusoids)):
        frequency = s.sinusoids[k].frequency
        slope = TURN * frequency * math.cos(TURN * phase_at(frequency, s.sinusoids[k].phase, s.second, s.fraction))
        s.inputs.v_rate += s.sinusoids[k].v * slope
        s.inputs.f_rate += s.sinusoids[k].f * slope


# How a state begins, and how it takes another contact, for solvers that step.

@compiled
def begin_state(s: State, position: float, velocity: float, rest: float, stretch: float, deflection: float) -> None:
    """Set the state at time 0: in stick, or slipping with E = 0 on some branch."""
    clear_state(s)
    s.origin, s.velocity, s.mode = position, velocity, STICK
    s.drive = s.spring = stretch
    s.deflection = deflection
    if is_stuck(velocity, deflection):
        s.rest = rest
    else:
        s.direction = 1.0 if velocity > 0.0 else -1.0
        s.mode = DECELERATING


@inlined
def is_stuck(velocity: float, deflection: float) -> bool:
    """Whether a start is in stick: at rest, or in a compliant contact that carries a force, in which it rings."""
    return velocity == 0.0 or deflection != 0.0


@inlined
def held_force(p: Parameters, s: State) -> float:
    """Return what the contact carries at the segment start, or would where the interface of one that yields stood."""
    return applied_force(p, s) if is_rigid_stick(p, s) else contact_force(p, s.deflection, s.velocity)


@compiled
def change_contact(new: Parameters, s: State, force: float) -> None:
    """Let a slider that does not slip go on with the contact of other parameters; at rest that carries `force`, N."""
    if s.mode != STICK and s.mode != YIELDING:
        return
    if new.compliant != 0.0:
        s.deflection = (force - new.contact_damping * s.velocity) / new.contact_stiffness
    else:
        s.velocity = 0.0
        s.deflection = 0.0


# The row of a sample, for every solver.

@inlined
def write_sample(p: Parameters, s: State, second: float, fraction: float, t: float, y: float, u: float, a: float,
                 drive: float, v: float, drive_force: float, force: float, friction: float, out: SampleRow) -> None:
    """Fill a row (`types.Sample` names the columns): t, travel y and drive travel since the state s, the rest at t."""
    stuck = s.mode == STICK
    out.second = second
    out.fraction = fraction
    out.mode = s.mode
    out.direction = s.direction
    out.position = s.origin + (s.position + y)
    out.velocity = u
    out.acceleration = a
    out.drive = s.origin + (s.drive + drive)
    out.drive_velocity = v
    out.drive_force = stated_drive_force(p, drive_force, u)
    out.external = force
    out.friction = friction
    out.coefficient = abs(friction) / p.normal_force if p.normal_force > 0.0 else 0.0
    out.deflection = s.deflection + y if stuck and p.compliant != 0.0 else 0.0
    if s.mode == YIELDING:
        out.deflection = yielded_deflection(p, s, t)
    out.rest = s.rest + t if stuck else 0.0
