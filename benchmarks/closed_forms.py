# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Classical results on stick-slip in closed form, which tests/solvers/exact/test_classics.py holds the engine to.

m ẍ = c (v t − x) + h (v − ẋ) − F, with ω = √(c/m), ζ = h/(2 √(cm)) and s = √(1 − ζ²).  Friction drops by ΔF as the slip
begins; A = ΔF/(v √(cm)) is that drop over what the feed v stands for.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

from scipy.optimize import brentq

from stickslip_sim.study.critical import SliderOnDrive


class CoulombCycle(NamedTuple):
    """The limit cycle of constant static and kinetic friction without damping: times s, speed m/s, jump m."""

    slip_time: float
    stick_time: float
    period: float
    peak_speed: float
    jump: float


def coulomb_cycle(slider: SliderOnDrive, drop: float, feed: float) -> CoulombCycle:
    """Return the cycle for a drop of friction ΔF (N) and a feed v (m/s), h = 0."""
    a = drop / (feed * slider.impedance)
    slip = 2.0 / slider.frequency * (math.pi - math.atan(a))
    stick = 2.0 * drop / (slider.stiffness * feed)
    return CoulombCycle(slip, stick, slip + stick, feed * (1.0 + math.hypot(1.0, a)), feed * (slip + stick))


def slip_speed(slider: SliderOnDrive, drop: float, feed: float, time: float) -> float:
    """Return ẋ (m/s) at a time (s) after the break-away, under constant kinetic friction and 0 <= ζ < 1."""
    zeta = slider.damping_ratio
    s, a = math.sqrt(1.0 - zeta * zeta), drop / (feed * slider.impedance)
    phase = s * slider.frequency * time
    sinusoid = math.cos(phase) - (a - zeta) / s * math.sin(phase)
    return feed * (1.0 - math.exp(-zeta * slider.frequency * time) * sinusoid)


def light_damping_feed(slider: SliderOnDrive, drop: float) -> float:
    """Return the usual estimate of v_c (m/s), the limit of small ζ: ΔF/√(4π ζ c m)."""
    return drop / (math.sqrt(4.0 * math.pi * slider.damping_ratio) * slider.impedance)


def healing_stick_time(grown: Callable[[float], float], stiffness: float, feed: float) -> float:
    """Return the stick time t (s) of the cycle, c v t = 2 ΔS(t), h = 0; `grown` is ΔS (N), concave and bounded."""
    end = 2.0 * grown(math.inf) / (stiffness * feed)
    return float(brentq(lambda t: 2.0 * grown(t) - stiffness * feed * t, 1e-9 * end, end, xtol=1e-300, rtol=1e-15))


def swing_ratio(slider: SliderOnDrive, slope: float) -> float:
    """Return what half a swing about steady sliding leaves of the last one, friction falling by `slope` σ N s/m.

    exp(−π γ/√(ω² − γ²)) with γ = (h − σ)/(2 m): it grows where σ > h.
    """
    gamma = 0.5 * (slider.damping - slope) / slider.mass
    return math.exp(-math.pi * gamma / math.sqrt(slider.frequency ** 2 - gamma * gamma))


class Swing(NamedTuple):
    """A forced oscillation under P cos(w t + phase) that is at +amplitude at t = 0; amplitude in P/c, phase in rad."""

    amplitude: float
    phase: float


def den_hartog(ratio: float, friction: float) -> Swing:
    """Return the steady oscillation without stops, for r = w/ω and constant friction in P (Den Hartog 1931), h = 0.

    X = √(V² − f² U²), V = 1/(1 − r²), U = sin(π/r)/(r (1 + cos(π/r))).
    """
    v = 1.0 / (1.0 - ratio * ratio)
    u = math.tan(0.5 * math.pi / ratio) / ratio
    amplitude = math.sqrt(v * v - friction * friction * u * u)
    return Swing(amplitude, math.atan2(-friction * u / v, amplitude / v))
