# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The closed form of a linear mode against 40-digit arithmetic, and its first roots against dense sampling."""

import cmath
import math
import random
from collections.abc import Iterator
from fractions import Fraction
from itertools import pairwise

import mpmath
import mpmath as mp
import pytest

from stickslip_sim.linear.moments import moments
from stickslip_sim.linear.oscillator import Oscillator, bound, impulse, integrals, oscillator
from stickslip_sim.linear.roots import finite_horizon, first_crossing, first_passage, first_zero, householder, safe_step
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

KINDS = ('under-damped', 'over-damped', 'critical', 'no spring', 'no damper', 'unstable', 'soft', 'neither')


def _random_mode(rng: random.Random, kind: str) -> tuple[float, float]:
    omega2 = 10.0 ** rng.uniform(-6, 6)
    omega = math.sqrt(omega2)
    return {
        'under-damped': (omega * rng.uniform(-0.9, 0.99), omega2),
        'over-damped': (omega * rng.choice((-1, 1)) * 10.0 ** rng.uniform(0, 3), omega2),
        'critical': (omega * (1.0 + rng.choice((0.0, 1e-15, -1e-15, 1e-10, -1e-8, 1e-6))), omega2),
        'no spring': (10.0 ** rng.uniform(-4, 4), 0.0),
        'no damper': (0.0, omega2),
        'unstable': (-(10.0 ** rng.uniform(-4, 3)), omega2),
        'soft': (10.0 ** rng.uniform(-4, 4), 10.0 ** rng.uniform(-14, -6)),
        'neither': (0.0, 0.0),
    }[kind]


def _exact(gamma: float, omega2: float, t: float) -> list[mp.mpf]:
    with mp.workdps(40):
        matrix = mp.matrix(5)
        matrix[0, 1], matrix[1, 0], matrix[1, 1] = 1, -mp.mpf(omega2), -2 * mp.mpf(gamma)
        matrix[2, 0] = matrix[3, 2] = matrix[4, 3] = 1
        return list(mp.expm(matrix * mp.mpf(t), method='taylor') * mp.matrix([0, 1, 0, 0, 0]))


@pytest.mark.parametrize('kind', KINDS)
def test_integrals_equal_matrix_exponential(kind: str) -> None:
    rng = random.Random(kind)
    for _ in range(20):
        gamma, omega2 = _random_mode(rng, kind)
        scale = (abs(gamma) + math.sqrt(omega2)) or 1.0
        t = 10.0 ** rng.uniform(-3, 1.2) / scale
        osc = oscillator(gamma, omega2)
        got, want = integrals(osc, t), _exact(gamma, omega2, t)
        growth = math.exp(max(-gamma + math.sqrt(max(gamma * gamma - omega2, 0.0)), 0.0) * t)
        sizes = [min(t, 1.0 / scale) * growth, growth,
                 *(growth * min(t, 1.0 / scale) ** 2 * t ** (k - 2) for k in (2, 3, 4))]
        for k in range(5):
            assert abs(got[k] - want[k]) <= 3e-14 * max(sizes[k], float(abs(want[k]))), (k, gamma, omega2, t)
        assert impulse(osc, t) == pytest.approx(got[:2], rel=1e-12, abs=1e-13 * growth)


@pytest.mark.parametrize('kind', KINDS)
def test_first_zero_is_the_first(kind: str) -> None:
    rng = random.Random(kind)
    for _ in range(50):
        gamma, omega2 = _random_mode(rng, kind)
        osc = oscillator(gamma, omega2)
        scale = (abs(gamma) + math.sqrt(omega2)) or 1.0
        z, rate = rng.choice((0.0, 1.0, 1e-6)), rng.uniform(-3, 3) * scale
        if z == 0.0:
            rate = abs(rate) + scale

        def value(t: float, osc: Oscillator = osc, z: float = z, rate: float = rate) -> float:
            g, slope = impulse(osc, t)
            return float(z * (slope + 2.0 * osc.gamma * g) + rate * g)

        t = first_zero(osc, z, rate + 2.0 * osc.gamma * z)
        end = min(t, 20.0 / scale)
        assert all(value(end * i / 200) > 0.0 for i in range(1, 200))
        if t < 20.0 / scale:
            size = z + abs(rate) / scale
            assert abs(value(t)) <= 1e-12 * size * math.exp(abs(gamma) * t)
            assert value(t * (1.0 + 1e-6)) < 0.0


def test_first_zero_of_a_start_at_zero_is_half_a_period() -> None:
    assert first_zero(oscillator(3.0, 1000.0), 0.0, 2.0) == pytest.approx(math.pi / math.sqrt(991.0), rel=1e-15)
    assert first_zero(oscillator(50.0, 1000.0), 0.0, 2.0) == math.inf
    assert first_zero(oscillator(50.0, 1000.0), 0.0, -2.0) == first_zero(oscillator(3.0, 1000.0), 0.0, -2.0) == 0.0


@pytest.mark.parametrize('snap', [0.0, 0.3, 40.0, -40.0])
def test_first_passage_misses_nothing(snap: float) -> None:
    """Against dense sampling; with gaps that the peak passes by a relative 1e-10, or misses by as much."""
    rng = random.Random(str(snap))
    for _ in range(150):
        gamma, omega2 = _random_mode(rng, rng.choice(KINDS))
        osc = oscillator(gamma, omega2)
        scale = (abs(gamma) + math.sqrt(omega2)) or 1.0
        horizon = 6.0 / scale
        rate, jerk = rng.choice((0.0, 1.0)), rng.uniform(-2, 2) * scale
        if rate == 0.0:
            jerk = abs(jerk) + 0.1 * scale
        bend = snap * scale * scale if omega2 > 0.0 else 0.0

        def r(t: float, osc: Oscillator = osc, rate: float = rate, jerk: float = jerk,
              bend: float = bend) -> float:
            g, _, first, second, _ = integrals(osc, t)
            return float(rate * g + jerk * first + bend * second)

        turn, passed, *_ = first_passage(osc, rate, jerk, bend, math.inf, horizon, 0.0)
        end = min(turn, horizon)
        assert not passed
        values = [r(end * i / 300) for i in range(301)]
        assert all(b > a for a, b in pairwise(values[:-1]))
        peak = r(end)
        for gap, reached in ((0.5 * peak, True), (peak * (1 - 1e-10), True), (peak * (1 + 1e-10), False)):
            guess = rng.choice((0.0, rng.uniform(0.0, 2.0) * end))
            t, passed, *_ = first_passage(osc, rate, jerk, bend, gap, horizon, guess)
            assert passed == reached
            if passed:
                assert abs(r(t) - gap) <= 1e-14 * max(1.0, math.exp(-gamma * t)) * (peak + scale * end / scale**2)
            else:
                assert t == (turn if turn <= horizon else math.inf)


@pytest.mark.parametrize(('value', 'slope', 'bend', 'time'), [
    (1.0, 0.0, 0.0, math.inf), (1.0, -2.0, 0.0, 0.5), (0.0, -1.0, 5.0, 0.0), (0.0, 1.0, -2.0, 1.0),
    (0.0, 0.0, -1.0, 0.0), (0.0, 0.0, 1.0, math.inf), (0.0, 0.0, 0.0, math.inf), (1.0, -1.0, 0.5, math.inf),
    (1.0, -3.0, 4.0, 0.5), (3.0, 1.0, -2.0, 0.5 * (1.0 + math.sqrt(13.0))), (2.0, 0.0, -4.0, 1.0),
])
def test_first_crossing_of_a_parabola(value: float, slope: float, bend: float, time: float) -> None:
    assert first_crossing(value, slope, bend) == pytest.approx(time, rel=1e-15)


def test_safe_steps_never_pass_the_root_and_converge_quadratically() -> None:
    t, steps = 0.0, 0
    while steps < 50:
        step = safe_step(max(math.cos(t) - 0.25, 0.0), -math.sin(t), 1.0)
        t, steps = t + step, steps + 1
        assert t <= math.acos(0.25) * (1.0 + 1e-15)
        if step < 1e-15:
            break
    assert t == pytest.approx(math.acos(0.25), rel=1e-15)
    assert steps < 9


@pytest.mark.parametrize('kind', ['under-damped', 'over-damped', 'critical', 'no damper'])
def test_bound_holds_for_all_later_times(kind: str) -> None:
    rng = random.Random(kind)
    for _ in range(100):
        gamma, omega2 = _random_mode(rng, kind)
        gamma = abs(gamma)
        osc = oscillator(gamma, omega2)
        z, rate = rng.uniform(-1, 1), rng.uniform(-5, 5) * math.sqrt(omega2)
        ceiling = bound(osc, z, rate)
        for i in range(200):
            g, slope = impulse(osc, i * 0.05 / math.sqrt(omega2))
            assert abs(z * (slope + 2.0 * gamma * g) + rate * g) <= ceiling * (1.0 + 1e-12)


# What the arguments of `linear.roots` assume of floating point: overflow, underflow, and when a root is accepted.

def exact_passage(gamma: float, omega2: float, rate: float, jerk: float, gap: float, near: float) -> float:
    """Return the root near a time of r(t) = gap, in 60 digits: r = rate g + jerk G₁ from both eigenvalues."""
    with mp.workdps(60):
        nu = mp.sqrt(mp.mpc(mp.mpf(gamma) ** 2 - mp.mpf(omega2)))
        one, two = -mp.mpf(gamma) + nu, -mp.mpf(gamma) - nu

        def value(t: mp.mpf) -> mp.mpf:
            g = (mp.exp(one * t) - mp.exp(two * t)) / (one - two)
            first = (mp.expm1(one * t) / one - mp.expm1(two * t) / two) / (one - two)
            return mp.re(rate * g + jerk * first) - mp.mpf(gap)

        off = mp.mpf(2) ** -40
        return float(mp.findroot(value, (near * (1 - off), near * (1 + off))))


def growing(rng: random.Random) -> tuple[Oscillator, float, float, float]:
    """Return a growing slip (over-damped, critical or not), its acceleration, how that changes, and its growth."""
    growth = 10.0 ** rng.uniform(0.0, 6.0)
    omega2 = rng.choice((0.01, 0.9, 1.5, 1.0 + 10.0 ** rng.uniform(-13.0, -5.0))) * growth * growth
    osc = oscillator(-growth, omega2)
    rate = 10.0 ** rng.uniform(-3.0, 1.0)
    return osc, rate, rng.uniform(0.1, 1.0) * rate * growth, growth


@pytest.mark.parametrize('seed', range(40))
def test_a_guess_far_up_a_growing_slip_leads_to_the_root(seed: int) -> None:
    """(a) From where the derivatives are 1e80 to 1e250, as the last stay in the mode may suggest."""
    osc, rate, jerk, growth = growing(random.Random(seed))
    rng = random.Random(seed + 1000)
    gap = 10.0 ** rng.uniform(-8.0, 0.0)
    slow = growth if osc.nu > 0.0 else osc.slow
    want, passed, *_ = first_passage(osc, rate, jerk, 0.0, gap, math.inf, 0.0)
    for exponent in (200.0, 236.0, 240.0, 300.0, 590.0, 599.0):
        t, reached, *_ = first_passage(osc, rate, jerk, 0.0, gap, math.inf, exponent / slow)
        assert reached == passed
        assert t == pytest.approx(want, rel=1e-14)
    if passed:
        assert want == pytest.approx(exact_passage(osc.gamma, osc.omega2, rate, jerk, gap, want), rel=1e-13)
        assert want < finite_horizon(osc, math.inf)


def fading() -> Iterator[tuple[Oscillator, float, float, float]]:
    """Yield slips critically damped but for 1e-5 to 1e-13, with a gap by a share below jerk/ω², where r settles."""
    for seed in range(100):
        rng = random.Random(seed)
        omega = 10.0 ** rng.uniform(-1.0, 3.0)
        gamma = omega * (1.0 + rng.choice((-1.0, 1.0)) * 10.0 ** rng.uniform(-13.0, -5.0))
        osc = oscillator(gamma, omega * omega)
        rate = 10.0 ** rng.uniform(-3.0, 1.0)
        jerk = rng.uniform(-0.9, 2.0) * rate * omega
        if jerk > 0.0:
            yield osc, rate, jerk, jerk / (omega * omega) * (1.0 - 10.0 ** rng.uniform(-12.0, -0.1))


def test_a_slip_that_dies_out_before_its_turn_keeps_its_root() -> None:
    """(b) The turn is up to 1e7 time constants away, where rates are 0 or below 1e-308."""
    found = 0
    for osc, rate, jerk, gap in fading():
        want, passed, *_ = first_passage(osc, rate, jerk, 0.0, gap, 1e9 / osc.gamma, 0.0)
        assert passed
        for horizon in (want + 4.0 * allowed(osc, rate, jerk, want), 10.0 * want, 1e4 * want):
            for guess in (0.0, 0.3 * want, 40.0 * want, 700.0 / osc.gamma, 1e4 / osc.gamma):
                t, reached, *_ = first_passage(osc, rate, jerk, 0.0, gap, horizon, guess)
                assert reached
                assert t <= horizon
                assert abs(t - want) <= allowed(osc, rate, jerk, want)
        assert abs(want - exact_passage(osc.gamma, osc.omega2, rate, jerk, gap, want)) <= allowed(osc, rate, jerk, want)
        found += 1
    assert found > 50


def allowed(osc: Oscillator, rate: float, jerk: float, t: float) -> float:
    """Return how far rounding of the terms of r moves a root."""
    g, slope, first, _, _ = integrals(osc, t)
    terms: float = abs(rate * g) + abs(jerk * first)
    speed: float = abs(rate * slope + jerk * g)
    return 1e-14 * terms / speed + 1e-14 * t


def test_a_step_is_the_same_at_any_scale() -> None:
    """(a, b) Powers of two up to the ends of the range change no bit: no product in it leaves the range."""
    rng = random.Random(7)
    for _ in range(500):
        value, slope = rng.uniform(-1.0, 1.0), rng.uniform(0.1, 2.0)
        change, third = rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0)
        step, _ = householder(value, slope, change, third)
        for exponent in (-900, -500, -330, 330, 500, 900):
            k = 2.0 ** exponent
            assert householder(k * value, k * slope, k * change, k * third)[0] == step
        assert householder(0.0, slope, change, third)[0] == 0.0


def test_a_root_is_accepted_where_the_value_is_rounding() -> None:
    """(c) At every root that is reported the value is within rounding of the terms, with any guess."""
    rng = random.Random(3)
    for _ in range(2000):
        omega = 10.0 ** rng.uniform(-2.0, 4.0)
        damping = rng.choice((rng.uniform(-3.0, 3.0), 1.0 + 10.0 ** rng.uniform(-13, -5)))
        osc = oscillator(omega * damping, omega * omega)
        rate, jerk = 10.0 ** rng.uniform(-3.0, 2.0), rng.uniform(-2.0, 2.0)
        jerk *= rate * omega
        gap, guess = rate / omega * 10.0 ** rng.uniform(-12.0, 3.0), 10.0 ** rng.uniform(-6.0, 4.0) / omega
        t, passed, *_ = first_passage(osc, rate, jerk, 0.0, gap, 1e6 / omega, guess)
        if passed:
            g, slope, first, _, _ = integrals(osc, t)
            speed = rate * slope + jerk * g
            terms = abs(rate * g) + abs(jerk * first) + abs(speed * t)
            assert abs(rate * g + jerk * first - gap) <= 1e-13 * terms, (osc, rate, jerk, gap, guess, t)


# The closed integrals of the energy account against many digits.

MOMENT_KINDS = ('no damper', 'under-damped', 'near critical', 'over-damped', 'growing', 'no spring')


def _exact_moments(gamma: float, omega2: float, x: float, rate: float, k0: float, k1: float, t: float) -> list[mp.mpf]:
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


@pytest.mark.parametrize('kind', MOMENT_KINDS)
def test_the_moments_of_a_motion(kind: str) -> None:
    rng = random.Random(kind)
    for _ in range(5):
        gamma, omega2 = _mode(rng, kind)
        fastest = abs(gamma) + math.sqrt(abs(gamma * gamma - omega2))
        t = 10.0 ** rng.uniform(-5, 1) / fastest
        x, rate, k0, k1 = (rng.uniform(-1, 1) * fastest ** power for power in range(4))
        k1 *= rng.choice((0.0, 1.0))
        with mp.workdps(60):
            exact = _exact_moments(gamma, omega2, x, rate, k0, k1, t)
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
    for _ in range(300):
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
