# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the guards watch under sines: the force on a still slider, the contact force, or the acceleration of a slip.

Each is a polynomial, a free motion and the answer to the sinusoids: a *signal* f with f(t), f′(t), and a bound on |f″|
over the next stretch, its reach (`Reading`).

* The force on a still or coasting slider has no free motion: |f″| is at most the sum of its amplitudes times w².
* Otherwise z = f″ obeys the oscillator's equation with the sinusoids as forcing.  A sinusoid off resonance leaves its
  steady amplitude, and the free motion that is left has the bound of `oscillator`; a sinusoid near resonance is bounded
  by ∫|forcing of z| |g|, which grows with the time and needs no division by what vanishes there.

"""

import math
from typing import NamedTuple

from ...axis.codes import ACCELERATING, COASTING, STICK
from ...axis.forces import applied_force, feed_damping
from ...axis.layout import Parameters
from ...axis.sinusoids import sinusoid_force, sinusoid_travel
from ...axis.smooth_load import load_share
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...linear.oscillator import Oscillator, amplitude, integrals, short_integrals
from ...linear.waves import TURN

_NEAR_RESONANCE = 0.25   # |ω² − w² + 2iγw| below this part of ω² + w²


class GuardSignal(NamedTuple):
    """What a guard watches, and what bounds its second derivative.

    start + rate t + second t²/2 is its polynomial; y₀ and `free_u` belong to the free motion of a contact (but for the
    sinusoids); mean and amplitude are those of the steady answer, `free` is how it begins off that; `z` is the free
    part of f″.
    """

    sense: float       # 1 or −1: the sign of what is watched
    start: float
    rate: float
    second: float
    y0: float
    free_u: float
    mean: float
    amplitude: float
    free: float
    free_rate: float
    z: float
    z_rate: float
    curvature: float   # bound of the steady part of f″
    resonant: float    # forcing of the rest
    fastest: float     # rad/s, the highest angular frequency
    share: float       # that the normal force takes of what is watched, as `load_share` has it


@compiled
def is_still(p: Parameters, s: State) -> bool:
    """Whether the slider has no motion of its own: rigid stick and coasting."""
    return s.mode == COASTING or (s.mode == STICK and p.compliant == 0.0)


@compiled
def signal_of(p: Parameters, s: State, osc: Oscillator) -> GuardSignal:
    """Return the signal of the present mode."""
    if is_still(p, s):
        return _force_signal(p, s)
    if s.mode == STICK:
        return _contact_signal(p, s, osc)
    return _slip_signal(p, s, osc)


@compiled
def _force_signal(p: Parameters, s: State) -> GuardSignal:
    sense, start = 1.0, applied_force(p, s)
    if s.mode == COASTING:
        sense, start = s.direction, s.residual
    mean, swing, curvature, fastest = 0.0, 0.0, 0.0, 0.0
    for k in range(int(s.sinusoid_count)):
        w = TURN * s.sinusoids[k].frequency
        re, im = s.sinusoids[k].force_rate_re, s.sinusoids[k].force_rate_im
        size = math.sqrt(re * re + im * im)
        mean += re / w
        swing += size / w
        curvature += size * w
        fastest = max(fastest, w)
    feed = feed_damping(p)
    share = load_share(p, s)
    rate = sense * (p.stiffness * (s.inputs.base_v - s.velocity) + feed * s.inputs.v_rate + s.inputs.f_rate
                    - share * p.normal_rate)
    second = sense * p.stiffness * s.inputs.v_rate
    return GuardSignal(sense=sense, start=start, rate=rate, second=second, y0=0.0, free_u=0.0,
                       mean=start + sense * mean, amplitude=swing, free=0.0, free_rate=0.0, z=0.0, z_rate=0.0,
                       curvature=abs(second) + curvature, resonant=0.0,
                       fastest=fastest if fastest > 0.0 else math.inf, share=share)


@compiled
def _contact_signal(p: Parameters, s: State, osc: Oscillator) -> GuardSignal:
    stiffness, damping = p.contact_stiffness, p.contact_damping
    gamma, omega2 = osc.gamma, osc.omega2
    u, a = s.velocity, s.acceleration
    y2 = s.snap / omega2
    y1 = u + (s.jerk - 2.0 * gamma * y2) / omega2
    y0 = (a + 2.0 * gamma * (u - y1) - y2) / omega2
    start = stiffness * (s.deflection + y0) + damping * y1
    rate, second = stiffness * y1 + damping * y2, stiffness * y2
    a1, a2, a3 = _acceleration_rates(p, s, osc)
    mass = inertia(p)
    swing, free, free_rate, curvature, z, z_rate, resonant, fastest, lag = _steady(p, s, osc, damping, stiffness, mass)
    if mass != 0.0:
        start += mass * y2
        free += mass * a
        free_rate += mass * a1
        z += mass * a2
        z_rate += mass * a3
    mean = start + stiffness * lag / omega2
    free += stiffness * s.deflection + damping * u - mean
    free_rate += stiffness * u + damping * a - rate
    z += stiffness * a + damping * a1 - second
    z_rate += stiffness * a1 + damping * a2
    return GuardSignal(sense=1.0, start=start, rate=rate, second=second, y0=y0, free_u=u - y1, mean=mean,
                       amplitude=swing, free=free, free_rate=free_rate, z=z, z_rate=z_rate,
                       curvature=abs(second) + curvature, resonant=resonant,
                       fastest=fastest if fastest > 0.0 else math.sqrt(omega2), share=0.0)


@compiled
def _slip_signal(p: Parameters, s: State, osc: Oscillator) -> GuardSignal:
    sense = s.direction if s.mode == ACCELERATING else -s.direction
    _, a2, a3 = _acceleration_rates(p, s, osc)
    _, _, _, curvature, z, z_rate, resonant, fastest, _ = _steady(p, s, osc, 0.0, -1.0, 0.0)
    return GuardSignal(sense=sense, start=0.0, rate=0.0, second=0.0, y0=0.0, free_u=0.0, mean=0.0, amplitude=math.inf,
                       free=0.0, free_rate=0.0, z=z + a2, z_rate=z_rate + a3, curvature=curvature, resonant=resonant,
                       fastest=fastest, share=0.0)


@inlined
def inertia(p: Parameters) -> float:
    """Return what the acceleration of a compliant stick adds to the force that ends it, kg."""
    return p.mass if p.ends_by_drive != 0.0 else 0.0


@compiled
def _acceleration_rates(p: Parameters, s: State, osc: Oscillator) -> tuple[float, float, float]:
    """Return the first three rates of the acceleration at the segment start."""
    gamma, omega2 = osc.gamma, osc.omega2
    first, second, third = s.jerk - 2.0 * gamma * s.acceleration, s.snap, 0.0
    for k in range(int(s.sinusoid_count)):
        w = TURN * s.sinusoids[k].frequency
        first += s.sinusoids[k].force_rate_im / p.mass
        second += w * s.sinusoids[k].force_rate_re / p.mass
        third -= w * w * s.sinusoids[k].force_rate_im / p.mass
    second -= 2.0 * gamma * first + omega2 * s.acceleration
    return first, second, third - 2.0 * gamma * second - omega2 * first


@compiled
def _steady(p: Parameters, s: State, osc: Oscillator, damping: float, stiffness: float, mass: float
           ) -> tuple[float, float, float, float, float, float, float, float, float]:
    """Return the sums over the sinusoids of the steady answer X = B W/(ω² − w² + 2iγw) and its rates.

    W = damping − i stiffness/w + i mass w for a contact; the acceleration of a slip (stiffness −1, no damping) has
    W = i w.  They are |X|, −Im X, −(Im X)′; off resonance w²|X|, −(Im X)″, −(Im X)‴, else the forcing w²|B W|; the
    highest w; Re B/w.
    """
    gamma, omega2 = osc.gamma, osc.omega2
    swing, free, free_rate, curvature, z, z_rate = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    resonant, fastest, lag = 0.0, 0.0, 0.0
    for k in range(int(s.sinusoid_count)):
        w = TURN * s.sinusoids[k].frequency
        b_re, b_im = s.sinusoids[k].force_rate_re / p.mass, s.sinusoids[k].force_rate_im / p.mass
        turned = w if stiffness < 0.0 else mass * w - stiffness / w
        re, im = b_re * damping - b_im * turned, b_re * turned + b_im * damping
        d_re, d_im = omega2 - w * w, 2.0 * gamma * w
        size = d_re * d_re + d_im * d_im
        force = math.sqrt(re * re + im * im)
        fastest = max(fastest, w)
        lag += b_re / w
        if size > 0.0:
            re, im = (re * d_re + im * d_im) / size, (im * d_re - re * d_im) / size
            swing += force / math.sqrt(size)
            free -= im
            free_rate -= w * re
        else:
            swing = math.inf
        if math.sqrt(size) > _NEAR_RESONANCE * (omega2 + w * w):
            curvature += w * w * force / math.sqrt(size)
            z += w * w * im
            z_rate += w * w * w * re
        else:
            resonant += w * w * force
    return swing, free, free_rate, curvature, z, z_rate, resonant, fastest, lag


# A signal (see `signals`) at a time: value, rate, and a bound on its second derivative over the next stretch.

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
