# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the arguments of `linear.roots` assume of floating point: overflow, underflow, and when a root is accepted."""

import math
import random
from collections.abc import Iterator

import mpmath as mp
import pytest

from stickslip_sim.linear.oscillator import Oscillator, integrals, oscillator
from stickslip_sim.linear.root_steps import householder
from stickslip_sim.linear.roots import first_passage
from stickslip_sim.linear.zeros import finite_horizon


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
    for seed in range(200):
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
