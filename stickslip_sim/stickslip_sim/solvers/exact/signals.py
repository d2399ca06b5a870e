# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the guards watch under sines: the force on a still slider, the contact force, or the acceleration of a slip.

Each is a polynomial, a free motion and the answer to the sinusoids: a *signal* f with f(t), f′(t), and a bound on |f″|
over the next stretch, its reach (`signal_readings.Reading`).

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
from ...axis.smooth_load import load_share
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from ...linear.oscillator import Oscillator
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
