# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of each mode from its segment start.

Every mode is m y″ + (h + …) y′ + (c + …) y = polynomial of the time, y the travel since the segment start:

| mode             | y′ coefficient | y coefficient | constant part of the right side      |
|------------------|----------------|---------------|---------------------------------------|
| stick, rigid     | y = 0          |               |                                       |
| stick, compliant | h + h_c        | c + c_c       | c w₀ + h v + F_e − c_c δ₀             |
| slip             | h + N b        | c             | c w₀ + h v + F_e − N (mu − b ẋ₀)      |
| coasting         | y′ constant    |               |                                       |
| yielding         | h              | c             | c w₀ + h v + F_e ∓ N mu_k(0)          |

with w = s − x, and b the slope of the friction branch on the present segment of the table.  With a damper on the
slideway there is no h v.  Sines in v and F_e add their own answer, see `sinusoids`.

The deflection of a contact that yields follows N mu_k(0)/c_c with the time constant h_c/c_c.
"""

import math

from ..core.hot_path import compiled, inlined
from ..linear.oscillator import Oscillator, ShortIntegrals, integrals, oscillator, short_integrals
from .codes import ACCELERATING, COASTING, STICK, YIELDING
from .forces import feed_damping, friction_force, friction_line, is_rigid_stick, yielding_force
from .layout import Parameters
from .sinusoids import begin_sinusoids, move_sinusoids, sinusoid_drive_travel, sinusoid_travel
from .slip_series import begin_series, moves_by_series, series_deflection, series_travel
from .smooth_load import begin_load, load_share
from .state_record import State

_SIXTH = 1.0 / 6.0
_LONG = 1e3            # so much longer than the spring's stretch a slide has to be for the balance to be the better one
_LONG_RING = 1e10      # (ω t)², beyond which the third power of the distance from there would tell
_SPLIT = 131073.0      # splits off the upper 36 bits of a number (Dekker 1971)


@inlined
def begin_motion(p: Parameters, s: State) -> None:
    """Set the closed form of the motion from the segment start on."""
    v = s.inputs.v
    mode = s.mode
    if s.sinusoid_count != 0.0:
        begin_sinusoids(p, s, load_share(p, s))
        v = s.inputs.base_v
    damping, stiffness, contact = p.damping, p.stiffness, 0.0
    if mode == COASTING or is_rigid_stick(p, s):
        return
    if moves_by_series(s):
        begin_series(p, s)
        return
    if mode == STICK:
        damping += p.contact_damping
        contact = p.contact_stiffness
    elif mode != YIELDING:
        _, slope, _, psi_slope = friction_line(p, int(s.segment), 0.0)
        if mode == ACCELERATING:
            slope += s.excess * psi_slope
        damping += p.normal_force * slope
    gamma, omega2 = 0.5 * damping / p.mass, (stiffness + contact) / p.mass
    if gamma != s.oscillator.gamma or omega2 != s.oscillator.omega2:
        k = int(mode)
        if gamma != s.cache.oscillators[k].gamma or omega2 != s.cache.oscillators[k].omega2:
            (s.cache.oscillators[k].gamma, s.cache.oscillators[k].omega2, s.cache.oscillators[k].nu,
             s.cache.oscillators[k].slow, s.cache.oscillators[k].fast) = oscillator(gamma, omega2)
        s.oscillator.gamma, s.oscillator.omega2, s.oscillator.nu, s.oscillator.slow, s.oscillator.fast = (
            gamma, omega2, s.cache.oscillators[k].nu, s.cache.oscillators[k].slow, s.cache.oscillators[k].fast)
    force_rate = stiffness * (v - s.velocity) + feed_damping(p) * s.inputs.v_rate + s.inputs.f_rate
    s.jerk = (force_rate - contact * s.velocity) / p.mass
    s.snap = stiffness * s.inputs.v_rate / p.mass


@inlined
def oscillator_of(s: State) -> Oscillator:
    """Return the oscillator of the mode."""
    return Oscillator(s.oscillator.gamma, s.oscillator.omega2, s.oscillator.nu, s.oscillator.slow, s.oscillator.fast)


@inlined
def tick_integrals(s: State, t: float) -> ShortIntegrals:
    """Return `short_integrals` at t, from those at the nearest number of 36 bits.

    Ticks of one length differ by the rounding of their times.  That number is the same for them, and what was computed
    for it is kept; the distance from there is less than 1e-11 of t.  The result depends on t alone, not on what is
    kept.  What has rung for so long that this is part of a turn is evaluated at t.
    """
    if s.oscillator.omega2 * t * t > _LONG_RING:
        return short_integrals(oscillator_of(s), t)
    big = _SPLIT * t
    near = big - (big - t)
    gamma, omega2 = s.oscillator.gamma, s.oscillator.omega2
    if near != s.cache.near.time or gamma != s.cache.near.gamma or omega2 != s.cache.near.omega2:
        s.cache.near.time, s.cache.near.gamma, s.cache.near.omega2 = near, gamma, omega2
        s.cache.near.g, s.cache.near.rate, s.cache.near.first, s.cache.near.second = short_integrals(
            oscillator_of(s), near)
    d = t - near
    g, rate, first = s.cache.near.g, s.cache.near.rate, s.cache.near.first
    second_rate = -2.0 * gamma * rate - omega2 * g
    return ShortIntegrals(g + (rate + 0.5 * second_rate * d) * d, rate + second_rate * d,
                          first + (g + 0.5 * rate * d) * d, s.cache.near.second + (first + 0.5 * g * d) * d)


@compiled
def travel(p: Parameters, s: State, t: float) -> tuple[float, float, float]:
    """Return the slider's travel, velocity and acceleration at t after the segment start."""
    if s.mode == COASTING:
        return s.velocity * t, s.velocity, 0.0
    if is_rigid_stick(p, s):
        return 0.0, 0.0, 0.0
    if moves_by_series(s):
        return series_travel(s, t)
    u, a, jerk, snap = s.velocity, s.acceleration, s.jerk, s.snap
    if snap == 0.0:
        g, rate, first, second = tick_integrals(s, t)
        y, velocity, acceleration = _response(p, s, t, g, rate, first, second)
    else:
        g, rate, first, second, third = integrals(oscillator_of(s), t)
        y = u * t + a * first + jerk * second + snap * third
        velocity = u + a * g + jerk * first + snap * second
        acceleration = a * rate + jerk * g + snap * first
    if s.sinusoid_count != 0.0:
        more = sinusoid_travel(p, s, oscillator_of(s), t, g, rate, first)
        return y + more.y, velocity + more.u, acceleration + more.a
    return y, velocity, acceleration


@inlined
def _response(p: Parameters, s: State, t: float, g: float, rate: float, first: float, second: float
             ) -> tuple[float, float, float]:
    """Return travel, velocity and acceleration without ramp and sinusoids, from `short_integrals` at t.

    Once a radian of the motion, or a time constant, is over, they are read off the velocity that it settles at: a
    contact that is held for a year does not creep, and its ring-down loses no digits.
    """
    u, a, jerk = s.velocity, s.acceleration, s.jerk
    acceleration = a * rate + jerk * g
    if not (s.oscillator.omega2 * t * t >= 1.0 if s.oscillator.nu > 0.0 else s.oscillator.slow * t <= -1.0):
        return u * t + a * first + jerk * second, u + a * g + jerk * first, acceleration
    settled = s.inputs.base_v if s.sinusoid_count != 0.0 else s.inputs.v
    if s.mode == STICK or s.inputs.f_rate != 0.0 or s.inputs.v_rate != 0.0:
        contact = p.contact_stiffness if s.mode == STICK else 0.0
        pushed = p.stiffness * settled + feed_damping(p) * s.inputs.v_rate + s.inputs.f_rate
        settled = pushed / (p.stiffness + contact)
    free, damping = u - settled, 2.0 * s.oscillator.gamma
    return (settled * t + (free * (g + damping * first) + a * first),
            settled + (free * (rate + damping * g) + a * g), acceleration)


@inlined
def travel_at(p: Parameters, s: State) -> tuple[float, float, float]:
    """Return `travel` for the time AT of the last evaluation."""
    return _response(p, s, s.cache.at.time, s.cache.at.g, s.cache.at.rate, s.cache.at.first, s.cache.at.second)


@inlined
def travel_to_event(p: Parameters, s: State, t: float) -> tuple[float, float, float]:
    """Return `travel` for the time of the next event, or where its search ended: from the last evaluation there."""
    y, v, acceleration = travel_at(p, s)
    d = t - s.cache.at.time
    if d == 0.0:
        return y, v, acceleration
    gamma, omega2 = s.oscillator.gamma, s.oscillator.omega2
    second_rate = s.jerk * s.cache.at.rate - s.acceleration * (2.0 * gamma * s.cache.at.rate + omega2 * s.cache.at.g)
    snap = -2.0 * gamma * second_rate - omega2 * acceleration
    return (y + (v + (0.5 * acceleration + _SIXTH * second_rate * d) * d) * d,
            v + (acceleration + (0.5 * second_rate + _SIXTH * snap * d) * d) * d,
            acceleration + (second_rate + 0.5 * snap * d) * d)


@inlined
def yielded_deflection(p: Parameters, s: State, t: float) -> float:
    """Return δ at t after the segment start of a contact that yields under a constant N, m."""
    settled = yielding_force(p, s) / p.contact_stiffness
    if p.contact_damping == 0.0:
        return settled
    return settled + (s.deflection - settled) * math.exp(-p.contact_stiffness / p.contact_damping * t)


@inlined
def drive_travel(s: State, t: float) -> float:
    """Return how far the drive moves within t after the segment start."""
    if s.sinusoid_count != 0.0:
        return (s.inputs.base_v + 0.5 * s.inputs.v_rate * t) * t + sinusoid_drive_travel(s, t)
    return (s.inputs.v + 0.5 * s.inputs.v_rate * t) * t


@inlined
def spring_after(p: Parameters, s: State, t: float, drive: float, y: float, u: float, a: float) -> float:
    """Return the stretch of the spring at t after the segment start; drive and slider have moved by `drive` and y.

    After a long slide that is the small difference of two long travels; the balance of forces has it with all its
    digits.
    """
    stretch = s.spring + (drive - y)
    if (abs(drive) <= _LONG * abs(stretch) or s.mode == STICK or p.stiffness == 0.0 or s.sinusoid_count != 0.0
            or moves_by_series(s)):
        return stretch
    v = s.inputs.v + s.inputs.v_rate * t
    if s.mode == COASTING:
        return s.spring + (0.5 * (s.inputs.v + v) - u) * t
    force = friction_force(p, s, 0.0, u, 0.0) + p.mass * a - (s.inputs.f + s.inputs.f_rate * t)
    return (force - p.damping * (p.feed_share * v - u)) / p.stiffness


@inlined
def move_start(p: Parameters, s: State, second: float, fraction: float, t: float) -> None:
    """Move the segment start by t, to the time (second, fraction), along the present mode."""
    drive = drive_travel(s, t)
    if s.mode == COASTING:
        y, u, a = s.velocity * t, s.velocity, 0.0
    elif is_rigid_stick(p, s):
        y, u, a = 0.0, 0.0, 0.0
    elif s.cache.at.time >= 0.0 and (t == s.next.time or t == s.cache.at.time):
        y, u, a = travel_to_event(p, s, t)
    else:
        y, u, a = travel(p, s, t)
    if s.mode == STICK:
        s.rest += t
        s.deflection += y
    elif s.mode == YIELDING:
        s.deflection, _ = series_deflection(s, t)
    s.spring = spring_after(p, s, t, drive, y, u, a)
    s.position += y
    s.drive += drive
    s.velocity = u
    s.acceleration = a
    s.inputs.v += s.inputs.v_rate * t
    s.inputs.f += s.inputs.f_rate * t
    s.second = second
    s.fraction = fraction
    if s.sinusoid_count != 0.0 or s.is_loaded != 0.0:
        move_sinusoids(s, t)
    if s.is_loaded != 0.0:
        s.inputs.base_n += p.normal_rate * t
        begin_load(p, s)
