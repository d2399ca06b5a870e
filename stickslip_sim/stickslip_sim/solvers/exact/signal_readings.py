# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A signal (see `signals`) at a time: value, rate, and a bound on its second derivative over the next stretch."""

import math
from typing import NamedTuple

from ...axis.codes import STICK
from ...axis.layout import Parameters
from ...axis.sinusoids import sinusoid_force, sinusoid_travel
from ...axis.state_record import State
from ...core.hot_path import compiled
from ...linear.oscillator import Oscillator, amplitude, integrals, short_integrals
from .signals import GuardSignal, inertia, is_still

_ROUNDING = 8.0 * 2.220446049250313e-16


class Reading(NamedTuple):
    """A signal at a time."""

    value: float
    rate: float
    curvature: float   # bound on |f″| over the next stretch,
    reach: float       # s, how long that is
    size: float        # of the free motion: |it| <= size exp(−decay d)
    decay: float       # 1/s
    noise: float       # size of rounding of the value
    gained: float      # m/s, speed since the segment start; 0 but in a slip


@compiled
def read_signal(p: Parameters, s: State, osc: Oscillator, signal: GuardSignal, t: float) -> Reading:
    """Return a signal at t."""
    if is_still(p, s):
        return _read_force(p, s, signal, t)
    if s.mode == STICK:
        return _read_contact(p, s, osc, signal, t)
    return _read_slip(p, s, osc, signal, t)


@compiled
def _read_force(p: Parameters, s: State, signal: GuardSignal, t: float) -> Reading:
    sense, start, rate, second = signal.sense, signal.start, signal.rate, signal.second
    force, force_rate, size = sinusoid_force(p, s, signal.share, t)
    ramp = (rate + 0.5 * second * t) * t
    return Reading(value=start + ramp + sense * force, rate=rate + second * t + sense * force_rate,
                   curvature=signal.curvature, reach=math.inf, size=0.0, decay=0.0,
                   noise=_ROUNDING * (abs(start) + abs(rate * t) + abs(second * t * t) + size), gained=0.0)


@compiled
def _read_contact(p: Parameters, s: State, osc: Oscillator, signal: GuardSignal, t: float) -> Reading:
    stiffness, damping = p.contact_stiffness, p.contact_damping
    gamma, omega2 = osc.gamma, osc.omega2
    start, rate, second, y0, free_u = signal.start, signal.rate, signal.second, signal.y0, signal.free_u
    g, slope, first, _ = short_integrals(osc, t)
    y = free_u * g - y0 * (slope + 2.0 * gamma * g)
    v = free_u * slope + omega2 * y0 * g
    acc = -2.0 * gamma * v - omega2 * y
    more = sinusoid_travel(p, s, osc, t, g, slope, first)
    free, free_rate = _free_motion(osc, signal.free, signal.free_rate, g, slope)
    size, decay = amplitude(osc, free, free_rate)
    reach, curvature = _curvature(osc, signal, t, g, slope)
    force = start + (rate + 0.5 * second * t) * t + stiffness * (y + more.y) + damping * (v + more.u)
    force_rate = rate + second * t + stiffness * (v + more.u) + damping * (acc + more.a)
    noise = abs(start) + abs(rate * t) + abs(second * t * t)
    noise += stiffness * (abs(y) + more.size_y) + damping * (abs(v) + more.size_u)
    mass = inertia(p)
    if mass != 0.0:
        force += mass * (acc + more.a)
        force_rate += mass * (more.jerk - 2.0 * gamma * acc - omega2 * v)
        noise += mass * (abs(acc) + more.size_a)
    return Reading(value=force, rate=force_rate, curvature=curvature, reach=reach, size=size, decay=decay,
                   noise=_ROUNDING * noise, gained=0.0)


@compiled
def _read_slip(p: Parameters, s: State, osc: Oscillator, signal: GuardSignal, t: float) -> Reading:
    sense = signal.sense
    a, jerk, snap = s.acceleration, s.jerk, s.snap
    g, slope, first, second, _ = integrals(osc, t)
    more = sinusoid_travel(p, s, osc, t, g, slope, first)
    slope_rate = -2.0 * osc.gamma * slope - osc.omega2 * g
    reach, curvature = _curvature(osc, signal, t, g, slope)
    return Reading(value=sense * (a * slope + jerk * g + snap * first + more.a),
                   rate=sense * (a * slope_rate + jerk * slope + snap * g + more.jerk),
                   curvature=curvature, reach=reach, size=math.inf, decay=0.0,
                   noise=_ROUNDING * (abs(a * slope) + abs(jerk * g) + abs(snap * first) + more.size_a),
                   gained=sense * (a * g + jerk * first + snap * second + more.u))


@compiled
def _free_motion(osc: Oscillator, z: float, rate: float, g: float, slope: float) -> tuple[float, float]:
    """Return the value and rate at t of the free motion that starts with z and its rate."""
    return z * (slope + 2.0 * osc.gamma * g) + rate * g, rate * slope - osc.omega2 * z * g


@compiled
def _curvature(osc: Oscillator, signal: GuardSignal, t: float, g: float, slope: float) -> tuple[float, float]:
    """Return (reach, bound): |f″| from t to t + reach stays below the bound."""
    gamma, _, nu, slow, _ = osc
    z, rate = _free_motion(osc, signal.z, signal.z_rate, g, slope)
    growth = max(-gamma if nu > 0.0 else slow, 0.0)
    reach = max(t, 2.0 / signal.fastest)
    if growth > 0.0:
        reach = min(reach, 1.0 / growth)
    drift = abs(rate + gamma * z) if nu > 0.0 else abs(rate - slow * z)
    lasting = reach if nu == 0.0 else min(reach, 1.0 / nu if nu > 0.0 else -0.5 / nu)
    decay = gamma if nu > 0.0 else -slow
    if decay > 0.0:
        lasting = min(lasting, 0.36787944117144233 / decay)
    until = t + reach
    stored = 0.5 * until * until       # bound on the integral of |g| up to then, without growth
    if nu > 0.0:
        stored = min(stored, until / nu)
        if gamma > 0.0:
            stored = min(stored, 1.0 / (gamma * nu))
    bound = (abs(z) + drift * lasting) * math.exp(growth * reach)
    forced = signal.resonant * stored * math.exp(growth * until) if signal.resonant > 0.0 else 0.0
    return reach, signal.curvature + bound + forced
