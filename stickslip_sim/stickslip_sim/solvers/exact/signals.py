# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the guards watch under sines: the force on a still slider, the contact force, or the acceleration of a slip.

Each is a polynomial, a free motion and the answer to the waves: a *signal* f with f(t), f′(t), and a bound on |f″| over
the next stretch, its reach.

* The force on a still or coasting slider has no free motion: |f″| is at most the sum of its amplitudes times w².
* Otherwise z = f″ obeys the oscillator's equation with the waves as forcing.  A wave off resonance leaves its steady
  amplitude, and the free motion that is left has the bound of `oscillator`; a wave near resonance is bounded by
  ∫|forcing of z| |g|, which grows with the time and needs no division by what vanishes there.

A signal is a tuple (sense, f₀, rate, bend, y₀, free u, mean, S, free, free rate, z, z rate, M, resonant, w):
f₀ + rate t + bend t²/2 its polynomial, y₀ and free u the free motion of a contact (but for the waves); mean and S the
mean and the amplitude of the steady answer, `free` how it begins off that; z and z rate the free part of f″, M the
bound of its steady part, `resonant` the forcing of the rest; w the highest angular frequency.
"""

import math

from ...axis.layout import (
    ACCELERATION, BASE_V, COMPLIANT, CONTACT_DAMPING, CONTACT_STIFFNESS, DAMPING, DEFLECTION, DIRECTION, F_RATE, JERK,
    MASS, MODE, RESIDUAL, SNAP, STATE_SIZE, STIFFNESS, VELOCITY, V_RATE, WAVES, WAVE_FREQUENCY, WAVE_PULL_IM,
    WAVE_PULL_RE, WAVE_SIZE,
)
from ...axis.motion import ACCELERATING, COASTING, STICK
from ...axis.transitions import applied_force
from ...axis.waves import wave_force, wave_travel
from ...core.jit import compiled
from ...linear.oscillator import amplitude, integrals, short_integrals
from ...linear.waves import TURN

_ROUNDING = 8.0 * 2.220446049250313e-16
_NEAR_RESONANCE = 0.25   # |ω² − w² + 2iγw| below this part of ω² + w²


@compiled
def is_still(p, s):
    """Whether the slider has no motion of its own: rigid stick and coasting."""
    return s[MODE] == COASTING or (s[MODE] == STICK and p[COMPLIANT] == 0.0)


@compiled
def signal_of(p, s, osc):
    """Return the signal of the present mode."""
    if is_still(p, s):
        return _force_signal(p, s)
    if s[MODE] == STICK:
        return _contact_signal(p, s, osc)
    return _slip_signal(p, s, osc)


@compiled
def _force_signal(p, s):
    sense, start = 1.0, applied_force(p, s)
    if s[MODE] == COASTING:
        sense, start = s[DIRECTION], s[RESIDUAL]
    mean, swing, curvature, fastest = 0.0, 0.0, 0.0, 0.0
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        w = TURN * s[at + WAVE_FREQUENCY]
        size = math.sqrt(s[at + WAVE_PULL_RE] * s[at + WAVE_PULL_RE] + s[at + WAVE_PULL_IM] * s[at + WAVE_PULL_IM])
        mean += s[at + WAVE_PULL_RE] / w
        swing += size / w
        curvature += size * w
        fastest = max(fastest, w)
    rate = sense * (p[STIFFNESS] * (s[BASE_V] - s[VELOCITY]) + p[DAMPING] * s[V_RATE] + s[F_RATE])
    bend = sense * p[STIFFNESS] * s[V_RATE]
    return (sense, start, rate, bend, 0.0, 0.0, start + sense * mean, swing, 0.0, 0.0, 0.0, 0.0, abs(bend) + curvature,
            0.0, fastest)


@compiled
def _contact_signal(p, s, osc):
    stiffness, damping = p[CONTACT_STIFFNESS], p[CONTACT_DAMPING]
    gamma, omega2 = osc[0], osc[1]
    u, a = s[VELOCITY], s[ACCELERATION]
    y2 = s[SNAP] / omega2
    y1 = u + (s[JERK] - 2.0 * gamma * y2) / omega2
    y0 = (a + 2.0 * gamma * (u - y1) - y2) / omega2
    start = stiffness * (s[DEFLECTION] + y0) + damping * y1
    rate, bend = stiffness * y1 + damping * y2, stiffness * y2
    a1, a2, _ = _acceleration_rates(p, s, osc)
    swing, free, free_rate, curvature, z, z_rate, resonant, fastest, lag = _steady(p, s, osc, damping, stiffness)
    mean = start + stiffness * lag / omega2
    free += stiffness * s[DEFLECTION] + damping * u - mean
    free_rate += stiffness * u + damping * a - rate
    z += stiffness * a + damping * a1 - bend
    z_rate += stiffness * a1 + damping * a2
    return (1.0, start, rate, bend, y0, u - y1, mean, swing, free, free_rate, z, z_rate, abs(bend) + curvature,
            resonant, fastest)


@compiled
def _slip_signal(p, s, osc):
    sense = s[DIRECTION] if s[MODE] == ACCELERATING else -s[DIRECTION]
    _, a2, a3 = _acceleration_rates(p, s, osc)
    _, _, _, curvature, z, z_rate, resonant, fastest, _ = _steady(p, s, osc, 0.0, -1.0)
    return (sense, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, math.inf, 0.0, 0.0, z + a2, z_rate + a3, curvature, resonant, fastest)


@compiled
def _acceleration_rates(p, s, osc):
    """Return the first three rates of the acceleration at the anchor."""
    gamma, omega2 = osc[0], osc[1]
    first, second, third = s[JERK] - 2.0 * gamma * s[ACCELERATION], s[SNAP], 0.0
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        w = TURN * s[at + WAVE_FREQUENCY]
        first += s[at + WAVE_PULL_IM] / p[MASS]
        second += w * s[at + WAVE_PULL_RE] / p[MASS]
        third -= w * w * s[at + WAVE_PULL_IM] / p[MASS]
    second -= 2.0 * gamma * first + omega2 * s[ACCELERATION]
    return first, second, third - 2.0 * gamma * second - omega2 * first


@compiled
def _steady(p, s, osc, damping, stiffness):
    """Return the sums over the waves of the steady answer X = B W/(ω² − w² + 2iγw) and its rates.

    W = damping − i stiffness/w for a contact; the acceleration of a slip (stiffness −1, no damping) has W = i w.  They
    are |X|, −Im X, −(Im X)′; off resonance w²|X|, −(Im X)″, −(Im X)‴, else the forcing w²|B W|; the highest w; Re B/w.
    """
    gamma, omega2 = osc[0], osc[1]
    swing, free, free_rate, curvature, z, z_rate = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    resonant, fastest, lag = 0.0, 0.0, 0.0
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        w = TURN * s[at + WAVE_FREQUENCY]
        b_re, b_im = s[at + WAVE_PULL_RE] / p[MASS], s[at + WAVE_PULL_IM] / p[MASS]
        turned = w if stiffness < 0.0 else -stiffness / w
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


@compiled
def read_signal(p, s, osc, signal, t):
    """Return at t (f, f′, bound on |f″|, its reach, size and decay of the free motion, rounding, speed gained)."""
    if is_still(p, s):
        return _read_force(p, s, signal, t)
    if s[MODE] == STICK:
        return _read_contact(p, s, osc, signal, t)
    return _read_slip(p, s, osc, signal, t)


@compiled
def _read_force(p, s, signal, t):
    sense, start, rate, bend = signal[:4]
    force, force_rate, size = wave_force(p, s, t)
    ramp = (rate + 0.5 * bend * t) * t
    return (start + ramp + sense * force, rate + bend * t + sense * force_rate, signal[12], math.inf, 0.0, 0.0,
            _ROUNDING * (abs(start) + abs(rate * t) + abs(bend * t * t) + size), 0.0)


@compiled
def _read_contact(p, s, osc, signal, t):
    stiffness, damping = p[CONTACT_STIFFNESS], p[CONTACT_DAMPING]
    gamma, omega2 = osc[0], osc[1]
    _, start, rate, bend, y0, free_u = signal[:6]
    g, slope, first, _ = short_integrals(osc, t)
    y = free_u * g - y0 * (slope + 2.0 * gamma * g)
    v = free_u * slope + omega2 * y0 * g
    acc = -2.0 * gamma * v - omega2 * y
    more = wave_travel(p, s, osc, t, g, slope, first)
    free, free_rate = _free_motion(osc, signal[8], signal[9], g, slope)
    size, decay = amplitude(osc, free, free_rate)
    reach, curvature = _curvature(osc, signal, t, g, slope)
    return (start + (rate + 0.5 * bend * t) * t + stiffness * (y + more[0]) + damping * (v + more[1]),
            rate + bend * t + stiffness * (v + more[1]) + damping * (acc + more[2]), curvature, reach, size, decay,
            _ROUNDING * (abs(start) + abs(rate * t) + abs(bend * t * t) + stiffness * (abs(y) + more[4])
                         + damping * (abs(v) + more[5])), 0.0)


@compiled
def _read_slip(p, s, osc, signal, t):
    sense = signal[0]
    a, jerk, snap = s[ACCELERATION], s[JERK], s[SNAP]
    g, slope, first, second, _ = integrals(osc, t)
    more = wave_travel(p, s, osc, t, g, slope, first)
    bend = -2.0 * osc[0] * slope - osc[1] * g
    reach, curvature = _curvature(osc, signal, t, g, slope)
    return (sense * (a * slope + jerk * g + snap * first + more[2]),
            sense * (a * bend + jerk * slope + snap * g + more[3]), curvature, reach, math.inf, 0.0,
            _ROUNDING * (abs(a * slope) + abs(jerk * g) + abs(snap * first) + more[6]),
            sense * (a * g + jerk * first + snap * second + more[1]))


@compiled
def _free_motion(osc, z, rate, g, slope):
    """Return the value and rate at t of the free motion that starts with z and its rate."""
    return z * (slope + 2.0 * osc[0] * g) + rate * g, rate * slope - osc[1] * z * g


@compiled
def _curvature(osc, signal, t, g, slope):
    """Return (reach, bound): |f″| from t to t + reach stays below the bound."""
    gamma, _, nu, slow, _ = osc
    z, rate = _free_motion(osc, signal[10], signal[11], g, slope)
    growth = max(-gamma if nu > 0.0 else slow, 0.0)
    reach = max(t, 2.0 / signal[14])
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
    return reach, signal[12] + bound + (signal[13] * stored * math.exp(growth * until) if signal[13] > 0.0 else 0.0)
