# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A moving mode under sines in two parts: its steady answer to each sinusoid, and the rest of the motion.

The steady answer is Im[X e^(iwt)]; the rest obeys the equation without sinusoids.  Near resonance both grow beyond all
bounds, and cancel.
"""

import math
from typing import NamedTuple

from ...axis.codes import STICK
from ...axis.forces import feed_damping, ground_damping
from ...axis.layout import Parameters
from ...axis.state_record import State
from ...core.hot_path import compiled
from ...linear.moments import moments
from ...linear.oscillator import Oscillator
from ...linear.wave_products import cycle_within, mirrored, over
from ...linear.waves import TURN

_NEAR = 1.0         # up to which its phase is taken from that of the oscillator
_CLOSE = 0.07       # (|γ| + |w − ν|) t up to which a sinusoid is interpolated


class SinusoidAnswer(NamedTuple):
    """A sinusoid, and the steady answer to it at phase 0."""

    frequency: float    # Hz
    cycle: float        # turns within the time
    phase: complex      # factor at the segment start
    v: float            # m/s, amplitude
    f: float            # N, amplitude
    at_x: complex       # m/s, amplitude of x
    lead: complex       # m/s, amplitude of v − ẋ
    against: complex    # what the integral of the rest is divided by


class Rest(NamedTuple):
    """x without the steady answers, x″ + 2γ x′ + ω² x = k₀ + k₁ t: how it begins and ends, and its integrals."""

    k0: float
    k1: float
    x: float
    rate: float
    end: float
    end_rate: float
    once: float     # ∫x
    twice: float    # ∫∫x
    thrice: float   # ∫∫∫x
    square: float   # ∫x²


@compiled
def answer_to(p: Parameters, s: State, osc: Oscillator, k: int, t: float, shift: float, slope: float
           ) -> SinusoidAnswer:
    """Return a sinusoid and the answer to it.

    What distinguishes a sinusoid near resonance from the oscillator's own is taken once: phases and divisor agree on it
    to the last digit.
    """
    gamma, _, nu, near, far = osc
    frequency, phase, v, f = given_sinusoid(s, k)
    apart = TURN * frequency - nu
    near_resonance = nu * t > 1.0 and (abs(gamma) + abs(apart)) * t < _NEAR
    if shift != 0.0 and is_close(osc, TURN * frequency, t):
        frequency += shift
        apart += TURN * shift
    cycle = cycle_within(frequency, t)
    if near_resonance:
        cycle = (math.atan2(math.sin(nu * t), math.cos(nu * t)) + apart * t) / TURN
    w = TURN * frequency
    feed = p.damping * p.feed_share
    resisting = p.damping - feed    # what acts on the slider's velocity alone
    divisor = complex(gamma, apart) * complex(gamma, w + nu) if nu > 0.0 else complex(-near, w) * complex(-far, w)
    against = mirrored(divisor)
    if s.mode == STICK:
        at_x = over(complex(p.stiffness * v, (feed * v + f) * w), p.mass * divisor)
        resisting += p.contact_damping
        lead = complex((p.contact_stiffness - p.mass * w * w) * v, (resisting * v - f) * w)
        return SinusoidAnswer(frequency, cycle, phase, v, f, at_x, over(lead, p.mass * divisor), against)
    resisting += p.normal_force * slope
    lead = over(complex(-p.mass * w * w * v, (resisting * v - f) * w), p.mass * divisor)
    return SinusoidAnswer(frequency, cycle, phase, v, f, lead, lead, against)


@compiled
def is_close(osc: Oscillator, w: float, t: float) -> bool:
    """Whether a sinusoid stays close to the oscillator's own within t."""
    gamma, _, nu, _, _ = osc
    return nu > 0.0 and (abs(gamma) + abs(w - nu)) * t < _CLOSE


@compiled
def given_sinusoid(s: State, k: int) -> tuple[float, complex, float, float]:
    """Return frequency and phase factor of a sinusoid at the segment start, and its amplitudes of v and F_e."""
    phase = complex(s.sinusoids[k].cosine, s.sinusoids[k].sine)
    return s.sinusoids[k].frequency, phase, s.sinusoids[k].v, s.sinusoids[k].f


@compiled
def rest_of(p: Parameters, s: State, osc: Oscillator, t: float, shift: float, slope: float) -> Rest:
    """Return the motion without the steady answers to the sinusoids."""
    stuck = s.mode == STICK
    v0, v1, f1 = s.inputs.base_v, s.inputs.v_rate, s.inputs.f_rate
    if stuck:
        k0, k1 = (p.stiffness * v0 + feed_damping(p) * v1 + f1) / p.mass, p.stiffness * v1 / p.mass
        x, rate = s.velocity, s.acceleration
    else:
        k0, k1 = ((p.normal_force * slope + ground_damping(p)) * v1 - f1) / p.mass, 0.0
        x, rate = s.inputs.v - s.velocity, v1 - s.acceleration
    for k in range(int(s.sinusoid_count)):
        one = answer_to(p, s, osc, k, t, shift, slope)
        at_rate = one.at_x if stuck else one.at_x - one.v
        x -= (one.phase * one.at_x).imag
        rate -= TURN * one.frequency * (one.phase * at_rate).real
    end, end_rate, once, twice, thrice, square = moments(osc, x, rate, k0, k1, t)
    return Rest(k0, k1, x, rate, end, end_rate, once, twice, thrice, square)
