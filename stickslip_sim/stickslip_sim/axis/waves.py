# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Sines in the inputs: v(t) and F_e(t) get A sin(2π f t + phase) each, t being simulation time.

They stand in the state behind its other numbers, one record a wave.  V and F of the state are totals at the anchor;
BASE_V and BASE_F are what is left of them without the waves.  With α = h A_v + A_F, a wave changes F_d + F_e by

    c ∫ v dt + h v + F_e,   whose rate is   c A_v sin φ + α w cos φ = Im[(c A_v + i w α) e^{iφ}];

that complex amplitude at the anchor is the wave's pull, N/s.  Phases are taken from the absolute time, so that they do
not depend on how a run is split.
"""

import math

from ..core.jit import compiled
from ..linear.waves import TURN, phase_at, turns, wave_response
from .layout import (
    BASE_F, BASE_V, DAMPING, F, FRACTION, F_RATE, MASS, SECOND, STATE_SIZE, STIFFNESS, V, VELOCITY, V_RATE, WAVES,
    WAVE_COSINE, WAVE_F, WAVE_FREQUENCY, WAVE_INPUTS, WAVE_PHASE, WAVE_PULL_IM, WAVE_PULL_RE, WAVE_SINE, WAVE_SIZE,
    WAVE_TURNS, WAVE_V,
)

_ROUNDING = 8.0 * 2.220446049250313e-16


@compiled
def load_waves(s, waves):
    """Put the waves into the state and add them to the inputs at the anchor."""
    count = len(waves) // WAVE_INPUTS
    s[WAVES] = float(count)
    for k in range(count):
        at = STATE_SIZE + WAVE_SIZE * k
        for i in range(WAVE_INPUTS):
            s[at + i] = waves[WAVE_INPUTS * k + i]
    s[BASE_V], s[BASE_F] = s[V], s[F]
    if count > 0:
        _add_waves(s)


@compiled
def same_waves(s, v, f, waves):
    """Whether these are the waves of the state, on top of v and f."""
    if s[BASE_V] != v or s[BASE_F] != f or s[WAVES] * WAVE_INPUTS != len(waves):
        return False
    for i in range(len(waves)):
        if s[STATE_SIZE + WAVE_SIZE * (i // WAVE_INPUTS) + i % WAVE_INPUTS] != waves[i]:
            return False
    return True


@compiled
def move_waves(s, t):
    """Bring the inputs to the anchor's new time, t after the old one."""
    s[BASE_V] += s[V_RATE] * t
    s[BASE_F] += s[F_RATE] * t
    _add_waves(s)


@compiled
def _add_waves(s):
    s[V], s[F] = s[BASE_V], s[BASE_F]
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        phase = phase_at(s[at + WAVE_FREQUENCY], s[at + WAVE_PHASE], s[SECOND], s[FRACTION])
        s[at + WAVE_TURNS] = phase
        s[at + WAVE_SINE] = math.sin(TURN * phase)
        s[at + WAVE_COSINE] = math.cos(TURN * phase)
        s[V] += s[at + WAVE_V] * s[at + WAVE_SINE]
        s[F] += s[at + WAVE_F] * s[at + WAVE_SINE]


@compiled
def inputs_at(s, second, fraction, t):
    """Return v and F_e at the time second + fraction, t after the anchor."""
    v, f = s[BASE_V] + s[V_RATE] * t, s[BASE_F] + s[F_RATE] * t
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        sine = math.sin(TURN * phase_at(s[at + WAVE_FREQUENCY], s[at + WAVE_PHASE], second, fraction))
        v += s[at + WAVE_V] * sine
        f += s[at + WAVE_F] * sine
    return v, f


@compiled
def begin_waves(p, s):
    """Set the pull of each wave at the anchor."""
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        re = p[STIFFNESS] * s[at + WAVE_V]
        im = TURN * s[at + WAVE_FREQUENCY] * (p[DAMPING] * s[at + WAVE_V] + s[at + WAVE_F])
        sine, cosine = s[at + WAVE_SINE], s[at + WAVE_COSINE]
        s[at + WAVE_PULL_RE] = re * cosine - im * sine
        s[at + WAVE_PULL_IM] = re * sine + im * cosine


@compiled
def wave_travel(p, s, osc, t, g, rate, first):
    """Return what the waves add to the travel, velocity, acceleration and jerk of a moving mode at t.

    Then the sizes of the sums of the first three, for bounds of their rounding.
    """
    y, u, a, jerk = 0.0, 0.0, 0.0, 0.0
    size_y, size_u, size_a = 0.0, 0.0, 0.0
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        re, im = s[at + WAVE_PULL_RE] / p[MASS], s[at + WAVE_PULL_IM] / p[MASS]
        w = TURN * s[at + WAVE_FREQUENCY]
        u_re, u_im, a_re, a_im, y_re, y_im = wave_response(osc, w, turns(s[at + WAVE_FREQUENCY], t), t, g, rate, first)
        y += re * y_im + im * y_re
        u += re * u_im + im * u_re
        a += re * a_im + im * a_re
        jerk += re * w * a_re + im * (rate - w * a_im)
        size = abs(re) + abs(im)
        size_y += size * (abs(y_re) + abs(y_im))
        size_u += size * (abs(u_re) + abs(u_im))
        size_a += size * (abs(a_re) + abs(a_im))
    return y, u, a, jerk, size_y, size_u, size_a


@compiled
def wave_drive_travel(s, t):
    """Return how far the waves move the drive within t: A/w (cos θ − cos(θ + w t)) without its cancellation."""
    travel = 0.0
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        frequency = s[at + WAVE_FREQUENCY]
        half = 0.5 * turns(frequency, t)
        travel += (s[at + WAVE_V] * math.sin(TURN * half) * math.sin(TURN * (s[at + WAVE_TURNS] + half))
                   / (0.5 * TURN * frequency))
    return travel


@compiled
def wave_force(p, s, t):
    """Return what the waves add to F_d + F_e within t under a still slider, its rate at t, and the size of the sum."""
    force, rate, size = 0.0, 0.0, 0.0
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        frequency = s[at + WAVE_FREQUENCY]
        w = TURN * frequency
        cycle = turns(frequency, t)
        half, middle = 0.5 * cycle, TURN * (s[at + WAVE_TURNS] + 0.5 * cycle)
        stiff, damped = p[STIFFNESS] * s[at + WAVE_V], p[DAMPING] * s[at + WAVE_V] + s[at + WAVE_F]
        chord = 2.0 * math.sin(TURN * half)
        force += chord * (stiff / w * math.sin(middle) + damped * math.cos(middle))
        size += abs(chord) * (abs(stiff) / w + abs(damped))
        phase = TURN * (s[at + WAVE_TURNS] + cycle)
        rate += stiff * math.sin(phase) + w * damped * math.cos(phase)
    return force, rate, size


@compiled
def forced_rate(p, s):
    """Return the rate of F_d + F_e at constant velocity, and the first of its rates that is not 0 (up to the fourth).

    Both count as 0 within rounding.  A transition asks before `begin_motion` has set the pulls of its instant.
    """
    begin_waves(p, s)
    base = p[STIFFNESS] * (s[BASE_V] - s[VELOCITY]) + p[DAMPING] * s[V_RATE] + s[F_RATE]
    size = p[STIFFNESS] * (abs(s[BASE_V]) + abs(s[VELOCITY])) + p[DAMPING] * abs(s[V_RATE]) + abs(s[F_RATE])
    rate = _wave_rate(s, 0, base, size)
    ramp = p[STIFFNESS] * s[V_RATE]
    bend = _wave_rate(s, 1, ramp, abs(ramp))
    order = 2
    while bend == 0.0 and order < 4:
        bend = _wave_rate(s, order, 0.0, 0.0)
        order += 1
    return rate, bend


@compiled
def _wave_rate(s, order, total, size):
    """Return the total and the waves' rate of this order (0: the rate itself), 0 within rounding."""
    for k in range(int(s[WAVES])):
        at = STATE_SIZE + WAVE_SIZE * k
        re, im = s[at + WAVE_PULL_RE], s[at + WAVE_PULL_IM]
        w = TURN * s[at + WAVE_FREQUENCY]
        for _ in range(order):
            re, im = -w * im, w * re
        total += im
        size += abs(re) + abs(im)
    return total if abs(total) > _ROUNDING * size else 0.0


@compiled
def fastest_wave(s):
    """Return the largest angular frequency of the waves, rad/s."""
    rate = 0.0
    for k in range(int(s[WAVES])):
        rate = max(rate, TURN * s[STATE_SIZE + WAVE_SIZE * k + WAVE_FREQUENCY])
    return rate
