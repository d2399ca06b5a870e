# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The closed integrals of the energy account against many digits."""

import cmath
import math
import random
from fractions import Fraction

import mpmath
import mpmath as mp
import pytest

from stickslip_sim.linear.moments import moments
from stickslip_sim.linear.oscillator import Oscillator, integrals, oscillator
from stickslip_sim.linear.waves import (
    TURN,
    cycle_within,
    phase_at,
    ramped_integral,
    swept_integral,
    turns,
    wave_integral,
    wave_moment,
    wave_products,
    wave_response,
)

KINDS = ('no damper', 'under-damped', 'near critical', 'over-damped', 'growing', 'no spring')


def _exact(gamma: float, omega2: float, x: float, rate: float, k0: float, k1: float, t: float) -> list[mp.mpf]:
    """Return x, x′, ∫x, ∫∫x, ∫∫∫x and ∫x² at t, by exponentials of matrices."""
    matrix = mp.matrix(7)
    matrix[0, 1], matrix[1, 0], matrix[1, 1], matrix[1, 2] = 1, -mp.mpf(omega2), -2 * mp.mpf(gamma), 1
    matrix[2, 3] = matrix[4, 0] = matrix[5, 4] = matrix[6, 5] = 1
    begin = mp.matrix([x, rate, k0, k1, 0, 0, 0])
    end = mp.expm(matrix * mp.mpf(t), method='taylor') * begin
    pairs = [(a, b) for a in range(4) for b in range(a, 4)]
    results = mp.matrix(11)
    for i, (a, b) in enumerate(pairs):
        for j in range(4):
            results[i, pairs.index((min(j, b), max(j, b)))] += matrix[a, j]
            results[i, pairs.index((min(a, j), max(a, j)))] += matrix[b, j]
    results[10, 0] = 1
    start = mp.matrix([begin[a] * begin[b] for a, b in pairs] + [0])
    total = (mp.expm(results * mp.mpf(t), method='taylor') * start)[10]
    return [end[0], end[1], end[4], end[5], end[6], total]


def _mode(rng: random.Random, kind: str) -> tuple[float, float]:
    omega = 10.0 ** rng.uniform(-2, 3)
    return {'no damper': (0.0, omega * omega),
            'under-damped': (omega * rng.uniform(0.0, 0.99), omega * omega),
            'near critical': (omega * (1.0 + rng.choice((0.0, 1e-15, -1e-12, 1e-8, -1e-4, 1e-3))), omega * omega),
            'over-damped': (omega * 10.0 ** rng.uniform(0.1, 8.0), omega * omega),
            'growing': (-omega * 10.0 ** rng.uniform(-4, 0.5), omega * omega),
            'no spring': (omega, 0.0)}[kind]


@pytest.mark.parametrize('kind', KINDS)
def test_the_moments_of_a_motion(kind: str) -> None:
    rng = random.Random(kind)
    for _ in range(8):
        gamma, omega2 = _mode(rng, kind)
        fastest = abs(gamma) + math.sqrt(abs(gamma * gamma - omega2))
        t = 10.0 ** rng.uniform(-5, 1) / fastest
        x, rate, k0, k1 = (rng.uniform(-1, 1) * fastest ** power for power in range(4))
        k1 *= rng.choice((0.0, 1.0))
        with mp.workdps(60):
            exact = _exact(gamma, omega2, x, rate, k0, k1, t)
        size = abs(x) + abs(rate) * t + abs(k0) * t * t + abs(k1) * t ** 3     # of |x|, at most
        size *= math.exp(max(-2.0 * gamma * t, 0.0))
        found = moments(oscillator(gamma, omega2), x, rate, k0, k1, t)
        scales = (size, size * (1.0 / t + fastest), size * t, size * t * t / 2, size * t ** 3 / 6, size * size * t)
        for value, wanted, scale in zip(found, exact, scales, strict=True):
            assert abs(value - float(wanted)) <= 2e-12 * scale, (gamma, omega2, t)


def test_a_slow_motion_beside_a_fast_one_keeps_its_digits() -> None:
    """Over-damped 1e8 times: ∫x² of a contact that creeps for a millisecond, a second, a year."""
    gamma, omega2 = 1e10, 1e4
    for t in (1e-9, 1e-3, 1.0, 3e7):
        with mp.workdps(60):
            nu = mp.sqrt(mp.mpf(gamma) ** 2 - omega2)
            slow, fast = -omega2 / (gamma + nu), -(gamma + nu)
            level = mp.mpf(2.0) / omega2
            b = slow * level / (fast - slow)
            a = -level - b
            rates = ((level, mp.mpf(0)), (a, slow), (b, fast))
            exact = sum(c * d * (mp.expm1((k + j) * t) / (k + j) if k + j else t) for c, k in rates for d, j in rates)
        found = moments(oscillator(gamma, omega2), 0.0, 0.0, 2.0, 0.0, t)[5]
        assert found == pytest.approx(float(exact), rel=1e-13, abs=0.0)


def test_a_motion_that_faded_long_ago_keeps_its_digits() -> None:
    """Over-damped with eigenvalues -1e9 and -2e9, nothing that pushes: what is left of it does not grow with time."""
    near, far, t = -1e9, -2e9, 100.0
    rate, x = -3e8, 1.0
    c = (rate - near * x) / (far - near)
    a = x - c
    _, _, first, second, third, square = moments(Oscillator(1.5e9, 2e18, -5e8, near, far), x, rate, 0.0, 0.0, t)
    once = a / -near + c / -far
    twice = a / near ** 2 + c / far ** 2
    assert first == pytest.approx(once, rel=1e-13, abs=0.0)
    assert second == pytest.approx(once * t - twice, rel=1e-13, abs=0.0)
    assert third == pytest.approx(0.5 * once * t * t - twice * t, rel=1e-13, abs=0.0)
    exact = -0.5 * a * a / near - 2.0 * a * c / (near + far) - 0.5 * c * c / far
    assert square == pytest.approx(exact, rel=1e-13, abs=0.0)


@pytest.mark.parametrize('span', [1e-9, 1e-3, 0.3, 1.0, 30.0, 1e4, 1e9])
def test_the_integrals_of_waves(span: float) -> None:
    rng = random.Random(7)
    for apart in (0.0, 1e-12, 1e-6, 1e-2, 0.4, 3.0):
        frequency, t = 3.0, span / (3.0 * TURN)
        other = frequency * (1.0 + apart * rng.uniform(0.5, 1.0))
        cycle, cycle_other = cycle_within(frequency, t), cycle_within(other, t)
        w, w_other = TURN * frequency, TURN * other
        zero, zero_other = wave_integral(frequency, cycle, t), wave_integral(other, cycle_other, t)
        sinusoid = cmath.exp(1j * TURN * cycle)
        same, sum_ = wave_products(frequency, cycle, other, cycle_other, t)
        with mp.workdps(50):
            a, b = 2j * mp.pi * mp.mpf(frequency), 2j * mp.pi * mp.mpf(other)
            expected = {'zero': _wave(a, t), 'same': _wave(a - b, t), 'sum': _wave(a + b, t),
                        'one': (t * mp.exp(a * t) - _wave(a, t)) / a,
                        'swept': (_wave(a, t) - t) / a, 'ramped': (_wave(a + b, t) - _wave(a, t)) / b}
        found = {'zero': zero, 'same': same, 'sum': sum_, 'one': wave_moment(w, sinusoid, zero, t),
                 'swept': swept_integral(w, 1.0, 0.0, zero, wave_moment(w, sinusoid, zero, t), t),
                 'ramped': ramped_integral(w, sinusoid, zero, w_other, zero_other, sum_, t)}
        for name, value in found.items():
            scale = max(abs(complex(expected[name])), {'one': t / w, 'swept': t / w}.get(name, 1.0 / w)
                        if w * t > 1.0 else 0.0)
            if name == 'ramped' and w * t > 1.0:
                scale = max(scale, 1.0 / (w * w))
            assert abs(value - complex(expected[name])) <= 4e-14 * scale, (name, apart)


def _wave(rate: mp.mpc, t: float) -> mp.mpc:
    return mp.expm1(rate * t) / rate if rate else mp.mpf(t)


# The closed-form answer to a sine, against 40 digits, and phases at late times.

def _answer(gamma: float, omega2: float, frequency: float, t: float) -> tuple[float, ...]:
    osc = oscillator(gamma, omega2)
    g, rate, first, _, _ = integrals(osc, t)
    found: tuple[float, ...] = wave_response(osc, TURN * frequency, turns(frequency, t), t, g, rate, first)
    return found


def _exact_waves(gamma: float, omega2: float, frequency: float, t: float) -> list[mpmath.mpc]:
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
    for _ in range(600):
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
        found, exact = _answer(gamma, omega2, frequency, t), _exact_waves(gamma, omega2, frequency, t)
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
