# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Sines in the inputs: v(t) and F_e(t) get A sin(2π f t + phase) each, t being simulation time.

They stand in the state behind its other numbers, one record a sinusoid.  v and f of the state are totals at the segment
start; `base_v` and `base_f` are what is left of them without the sinusoids.  With α = h A_v + A_F, without h
where the damper is on the slideway, a sinusoid changes F_d + F_e by

    c ∫ v dt + h v + F_e,   whose rate is   c A_v sin φ + α w cos φ = Im[(c A_v + i w α) e^{iφ}];

that complex amplitude at the segment start is the sinusoid's force rate, N/s.  Phases are taken from the absolute time,
so that they do not depend on how a run is split.
"""

import math
from typing import NamedTuple

from ..core.hot_path import compiled
from ..linear.oscillator import Oscillator
from ..linear.waves import TURN, phase_at, turns, wave_response
from .layout import Parameters
from .rows import Sinusoids
from .state_record import State

_ROUNDING = 8.0 * 2.220446049250313e-16


class SinusoidTravel(NamedTuple):
    """What the sinusoids add to a motion, and the sizes of the sums, for bounds of their rounding."""

    y: float        # m, travel
    u: float        # m/s
    a: float        # m/s²
    jerk: float     # m/s³
    size_y: float   # m
    size_u: float   # m/s
    size_a: float   # m/s²


@compiled
def load_sinusoids(s: State, given: Sinusoids) -> None:
    """Put the sinusoids into the state and add them to the inputs at the segment start."""
    s.sinusoid_count = float(given.count)
    for k in range(given.count):
        s.sinusoids[k].frequency, s.sinusoids[k].phase = given.rows[k].frequency, given.rows[k].phase
        s.sinusoids[k].v, s.sinusoids[k].f, s.sinusoids[k].n = given.rows[k].v, given.rows[k].f, given.rows[k].n
    s.inputs.base_v, s.inputs.base_f = s.inputs.v, s.inputs.f
    if given.count > 0:
        _add_sinusoids(s)


@compiled
def same_sinusoids(s: State, v: float, f: float, given: Sinusoids) -> bool:
    """Whether these are the sinusoids of the state, on top of v and f."""
    if s.inputs.base_v != v or s.inputs.base_f != f or s.sinusoid_count != given.count:
        return False
    for k in range(given.count):
        if (s.sinusoids[k].frequency != given.rows[k].frequency or s.sinusoids[k].phase != given.rows[k].phase
                or s.sinusoids[k].v != given.rows[k].v or s.sinusoids[k].f != given.rows[k].f
                or s.sinusoids[k].n != given.rows[k].n):
            return False
    return True


@compiled
def move_sinusoids(s: State, t: float) -> None:
    """Bring the inputs to the new time of the segment start, t after the old one."""
    s.inputs.base_v += s.inputs.v_rate * t
    s.inputs.base_f += s.inputs.f_rate * t
    _add_sinusoids(s)


@compiled
def _add_sinusoids(s: State) -> None:
    s.inputs.v, s.inputs.f = s.inputs.base_v, s.inputs.base_f
    for k in range(int(s.sinusoid_count)):
        phase = phase_at(s.sinusoids[k].frequency, s.sinusoids[k].phase, s.second, s.fraction)
        s.sinusoids[k].turns = phase
        s.sinusoids[k].sine = math.sin(TURN * phase)
        s.sinusoids[k].cosine = math.cos(TURN * phase)
        s.inputs.v += s.sinusoids[k].v * s.sinusoids[k].sine
        s.inputs.f += s.sinusoids[k].f * s.sinusoids[k].sine


@compiled
def inputs_at(s: State, second: float, fraction: float, t: float) -> tuple[float, float]:
    """Return v and F_e at the time second + fraction, t after the segment start."""
    v, f = s.inputs.base_v + s.inputs.v_rate * t, s.inputs.base_f + s.inputs.f_rate * t
    for k in range(int(s.sinusoid_count)):
        sine = math.sin(TURN * phase_at(s.sinusoids[k].frequency, s.sinusoids[k].phase, second, fraction))
        v += s.sinusoids[k].v * sine
        f += s.sinusoids[k].f * sine
    return v, f


@compiled
def begin_sinusoids(p: Parameters, s: State, share: float) -> None:
    """Set the force rate of each sinusoid at the segment start; a normal force takes its `share`."""
    for k in range(int(s.sinusoid_count)):
        re = p.stiffness * s.sinusoids[k].v
        im = TURN * s.sinusoids[k].frequency * (p.damping * p.feed_share * s.sinusoids[k].v + s.sinusoids[k].f
                                                - share * s.sinusoids[k].n)
        sine, cosine = s.sinusoids[k].sine, s.sinusoids[k].cosine
        s.sinusoids[k].force_rate_re = re * cosine - im * sine
        s.sinusoids[k].force_rate_im = re * sine + im * cosine


@compiled
def sinusoid_travel(p: Parameters, s: State, osc: Oscillator, t: float, g: float, rate: float, first: float
               ) -> SinusoidTravel:
    """Return what the sinusoids add to the motion of a moving mode at t."""
    y, u, a, jerk = 0.0, 0.0, 0.0, 0.0
    size_y, size_u, size_a = 0.0, 0.0, 0.0
    for k in range(int(s.sinusoid_count)):
        re, im = s.sinusoids[k].force_rate_re / p.mass, s.sinusoids[k].force_rate_im / p.mass
        frequency = s.sinusoids[k].frequency
        w = TURN * frequency
        u_re, u_im, a_re, a_im, y_re, y_im = wave_response(osc, w, turns(frequency, t), t, g, rate, first)
        y += re * y_im + im * y_re
        u += re * u_im + im * u_re
        a += re * a_im + im * a_re
        jerk += re * w * a_re + im * (rate - w * a_im)
        size = abs(re) + abs(im)
        size_y += size * (abs(y_re) + abs(y_im))
        size_u += size * (abs(u_re) + abs(u_im))
        size_a += size * (abs(a_re) + abs(a_im))
    return SinusoidTravel(y, u, a, jerk, size_y, size_u, size_a)


@compiled
def sinusoid_drive_travel(s: State, t: float) -> float:
    """Return how far the sinusoids move the drive within t: A/w (cos θ − cos(θ + w t)) without its cancellation."""
    travel = 0.0
    for k in range(int(s.sinusoid_count)):
        frequency = s.sinusoids[k].frequency
        half = 0.5 * turns(frequency, t)
        travel += (s.sinusoids[k].v * math.sin(TURN * half) * math.sin(TURN * (s.sinusoids[k].turns + half))
                   / (0.5 * TURN * frequency))
    return travel


@compiled
def sinusoid_force(p: Parameters, s: State, share: float, t: float) -> tuple[float, float, float]:
    """Return what the sinusoids add to F_d + F_e within t under a still slider, its rate, and the size of the sum.

    A normal force takes its `share`.
    """
    force, rate, size = 0.0, 0.0, 0.0
    for k in range(int(s.sinusoid_count)):
        frequency = s.sinusoids[k].frequency
        w = TURN * frequency
        cycle = turns(frequency, t)
        half, middle = 0.5 * cycle, TURN * (s.sinusoids[k].turns + 0.5 * cycle)
        stiff = p.stiffness * s.sinusoids[k].v
        damped = p.damping * p.feed_share * s.sinusoids[k].v + s.sinusoids[k].f - share * s.sinusoids[k].n
        chord = 2.0 * math.sin(TURN * half)
        force += chord * (stiff / w * math.sin(middle) + damped * math.cos(middle))
        size += abs(chord) * (abs(stiff) / w + abs(damped))
        phase = TURN * (s.sinusoids[k].turns + cycle)
        rate += stiff * math.sin(phase) + w * damped * math.cos(phase)
    return force, rate, size


@compiled
def forced_rate(p: Parameters, s: State) -> tuple[float, float]:
    """Return the rate of F_d + F_e at constant velocity, and the first of its rates that is not 0 (up to the fourth).

    Both count as 0 within rounding.  A transition asks before `begin_motion` has set the force rates of its instant.
    """
    begin_sinusoids(p, s, 0.0)
    damping = p.damping * p.feed_share
    base = p.stiffness * (s.inputs.base_v - s.velocity) + damping * s.inputs.v_rate + s.inputs.f_rate
    size = (p.stiffness * (abs(s.inputs.base_v) + abs(s.velocity)) + damping * abs(s.inputs.v_rate)
            + abs(s.inputs.f_rate))
    rate = _rate_of_order(s, 0, base, size)
    ramp = p.stiffness * s.inputs.v_rate
    second_rate = _rate_of_order(s, 1, ramp, abs(ramp))
    order = 2
    while second_rate == 0.0 and order < 4:
        second_rate = _rate_of_order(s, order, 0.0, 0.0)
        order += 1
    return rate, second_rate


@compiled
def _rate_of_order(s: State, order: int, total: float, size: float) -> float:
    """Return the total and the sinusoids' rate of this order (0: the rate itself), 0 within rounding."""
    for k in range(int(s.sinusoid_count)):
        re, im = s.sinusoids[k].force_rate_re, s.sinusoids[k].force_rate_im
        w = TURN * s.sinusoids[k].frequency
        for _ in range(order):
            re, im = -w * im, w * re
        total += im
        size += abs(re) + abs(im)
    return total if abs(total) > _ROUNDING * size else 0.0


@compiled
def fastest_sinusoid(s: State) -> float:
    """Return the largest angular frequency of the sinusoids, rad/s."""
    rate = 0.0
    for k in range(int(s.sinusoid_count)):
        rate = max(rate, TURN * s.sinusoids[k].frequency)
    return rate
