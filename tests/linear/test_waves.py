# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The closed-form answer to a sine, against 40 digits, and phases at late times."""

import math
import random
from fractions import Fraction

import mpmath
import pytest

from stickslip_sim.linear.oscillator import integrals, oscillator
from stickslip_sim.linear.waves import TURN, phase_at, turns, wave_response


def _answer(gamma: float, omega2: float, frequency: float, t: float) -> tuple[float, ...]:
    osc = oscillator(gamma, omega2)
    g, rate, first, _, _ = integrals(osc, t)
    found: tuple[float, ...] = wave_response(osc, TURN * frequency, turns(frequency, t), t, g, rate, first)
    return found


def _exact(gamma: float, omega2: float, frequency: float, t: float) -> list[mpmath.mpc]:
    """Return I, I′ and K at a time as sums over the roots of the characteristic polynomial, moved apart by 1e-60."""
    with mpmath.workdps(150):
        w = mpmath.mpf(TURN) * mpmath.mpf(frequency)   # the engine's w, not 2πf
        c, d, time = mpmath.mpf(gamma), mpmath.mpf(omega2), mpmath.mpf(t)
        root = mpmath.sqrt(c * c - d)
        scale = abs(c) + abs(root) + w
        nodes = [-c + root, -c - root + scale * mpmath.mpf(10) ** -40, mpmath.mpc(0, w) + scale * mpmath.mpf(10) ** -41]

        def difference(points: list[mpmath.mpc], weight: int) -> mpmath.mpc:
            return mpmath.fsum(mpmath.exp(z * time) * z ** weight / mpmath.fprod(z - o for o in points if o is not z)
                               for z in points)

        zero = scale * mpmath.mpf(10) ** -42
        return [difference(nodes, 0), difference(nodes, 1), difference([*nodes, zero], 0)]


def _cases() -> list[tuple[float, float, float, float]]:
    rng = random.Random(5)
    cases = []
    for _ in range(1500):
        omega = rng.choice((0.0, 10 ** rng.uniform(-3, 4)))
        gamma = rng.choice((0.0, 1.0, 1.0 + 1e-9, rng.uniform(-0.2, 0.3), 10 ** rng.uniform(-3, 3))) * (omega or 1.0)
        frequency = rng.choice((omega / TURN or 0.1, (omega or 1.0) / TURN * (1.0 + 10 ** rng.uniform(-15, -1)),
                                10 ** rng.uniform(-4, 4), 10 ** rng.uniform(-4, 4)))
        scale = rng.choice((omega or 1.0, abs(gamma) or 1.0, TURN * frequency))
        t = 10 ** rng.uniform(-3, 2) / scale
        if -gamma * t < 30.0 and max(omega, TURN * frequency) * t < 200.0:
            cases.append((gamma, omega * omega, frequency, t))
    return cases


def test_answer_to_a_wave_is_right_to_rounding() -> None:
    """Resonance, critical damping, no spring, no damper and growing modes included; errors by the size of each sum."""
    worst = 0.0
    for gamma, omega2, frequency, t in _cases():
        found, exact = _answer(gamma, omega2, frequency, t), _exact(gamma, omega2, frequency, t)
        for n, value in enumerate(exact):
            error = abs(complex(found[2 * n], found[2 * n + 1]) - complex(value)) / float(abs(value))
            # the exponents of the eigenvalues are products that are rounded once
            worst = max(worst, error / (1.0 + 0.1 * (abs(gamma) + omega2 ** 0.5 + TURN * frequency) * t))
    assert worst < 1e-13


def test_phase_at_late_times() -> None:
    rng = random.Random(2)
    for _ in range(500):
        frequency, phase = 10 ** rng.uniform(-9, 6), rng.uniform(-1, 1)
        second, fraction = float(rng.randint(0, 10 ** 10)), rng.random()
        exact = Fraction(frequency) * (Fraction(second) + Fraction(fraction)) + Fraction(phase)
        error = (Fraction(phase_at(frequency, phase, second, fraction)) - exact) % 1
        assert min(error, 1 - error) < 1e-15


def test_undamped_resonance_grows_for_ever() -> None:
    """I of e^{iwt} on itself: t e^{iwt}/(2iw) − sin(wt)/(2iw²)."""
    w = TURN * 3.0
    for t in (1e-6, 0.1, 10.0, 1e4):
        cycle = TURN * turns(3.0, t)
        found = _answer(0.0, w * w, 3.0, t)
        expected = (t * complex(math.cos(cycle), math.sin(cycle)) - math.sin(cycle) / w) / complex(0.0, 2.0 * w)
        if w * t > 0.1:
            assert complex(found[0], found[1]) == pytest.approx(expected, rel=1e-11)
