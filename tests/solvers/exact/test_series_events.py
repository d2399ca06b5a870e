# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The first root of a guard that is a polynomial, and what its certainty assumes of floating point.

Each bound is held from both sides: nothing that rounding makes is an event, and what falls by more than the bound is.
"""

import math
import random
from fractions import Fraction

import pytest

from stickslip_sim.axis import InitialState
from stickslip_sim.axis.state_record import HIGHEST_ORDER, State
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.types import EventKind
from stickslip_sim.reference import simulate as simulate_reference
from stickslip_sim.solvers.exact.series_events import _controls, _first_root
from tests.support.axes import COMPLIANT, instant, make, paper_axis

EPSILON = 2.0 ** -52


def guard(coefficients: list[Fraction], error: float = 0.0) -> tuple[State, float]:
    """Return a state with this guard in its scratch, and the sum of the sizes of its coefficients."""
    s = State()
    s.series_error = error
    for k, one in enumerate(coefficients):
        s.scratch[k].guard = float(one)
    return s, float(sum(map(abs, coefficients)))


def times(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    found = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, one in enumerate(a):
        for k, other in enumerate(b):
            found[i + k] += one * other
    return found


def factor(rng: random.Random, degree: int) -> list[Fraction]:
    """Return a polynomial that is positive on [0, 1], of the sizes that a series has."""
    rest = [Fraction(rng.uniform(-1.0, 1.0) / math.factorial(k)) for k in range(1, degree + 1)]
    return [Fraction(1) + sum(map(abs, rest), Fraction(0)), *rest]


def at_place(rng: random.Random) -> Fraction:
    return Fraction(rng.uniform(0.02, 0.98))


@pytest.mark.parametrize('seed', range(30))
def test_a_guard_that_touches_0_is_no_event(seed: int) -> None:
    """A double root: rounding takes the guard below 0, or Bernstein's coefficients, by less than the slack."""
    rng = random.Random(seed)
    place = at_place(rng)
    s, _ = guard(times([place * place, -2 * place, Fraction(1)], factor(rng, HIGHEST_ORDER - 3)))
    assert _first_root(s, HIGHEST_ORDER - 1) == math.inf
    assert s.iterations < 200.0   # narrow where it touches, and wider behind


@pytest.mark.parametrize('seed', range(30))
def test_a_guard_that_falls_by_more_than_the_bound_is_an_event(seed: int) -> None:
    """However short: it is below −δ between two roots, 3e-6 of the interval apart and less, and the first is found."""
    rng = random.Random(seed)
    place, other = at_place(rng), factor(rng, HIGHEST_ORDER - 3)
    touching = times([place * place, -2 * place, Fraction(1)], other)
    _, size = guard(touching)
    depth = 4.0 * 8.0 * HIGHEST_ORDER * EPSILON * size
    s, _ = guard([touching[0] - Fraction(depth), *touching[1:]])
    found = _first_root(s, HIGHEST_ORDER - 1)
    half = math.sqrt(depth / float(sum(c * place ** k for k, c in enumerate(other))))
    assert 0.3 * half < float(place) - found < 2.0 * half


@pytest.mark.parametrize('share', [0.5, 4.0])
def test_the_error_of_a_series_is_slack(share: float) -> None:
    """What falls below 0 by half of what the series is off by is no event, what falls by four times is one."""
    error = 1e-6
    place, depth = Fraction(3, 8), Fraction(share * error)
    s, _ = guard([place * place - depth, -2 * place, Fraction(1)], error)
    assert (_first_root(s, 2) < math.inf) is (share > 1.0)


@pytest.mark.parametrize('seed', range(20))
def test_the_first_of_two_near_roots_is_found(seed: int) -> None:
    """Halving separates them, the left half first."""
    rng = random.Random(seed)
    low = at_place(rng) * Fraction(9, 10)
    for apart in (Fraction(1, 2 ** 5), Fraction(1, 2 ** 12), Fraction(1, 2 ** 17)):
        s, _ = guard(times([low * (low + apart), -2 * low - apart, Fraction(1)], factor(rng, HIGHEST_ORDER - 3)))
        found = _first_root(s, HIGHEST_ORDER - 1)
        assert found == pytest.approx(float(low), abs=1e-12 / float(apart))


@pytest.mark.parametrize('seed', range(20))
def test_of_three_roots_the_first_is_found(seed: int) -> None:
    """The guard ends below 0, but falls through it twice."""
    rng = random.Random(seed)
    low, middle, high = sorted(Fraction(rng.uniform(0.02, 0.98)) for _ in range(3))
    cubic = times(times([low, Fraction(-1)], [middle, Fraction(-1)]), [high, Fraction(-1)])
    s, _ = guard(times(cubic, factor(rng, HIGHEST_ORDER - 4)))
    assert _first_root(s, HIGHEST_ORDER - 1) == pytest.approx(float(low), abs=1e-9)


@pytest.mark.parametrize('seed', range(20))
def test_a_guard_that_begins_at_0_is_divided_by_its_powers(seed: int) -> None:
    rng = random.Random(seed)
    place, other = at_place(rng), factor(rng, HIGHEST_ORDER - 4)
    for zeros in (1, 2):
        rising = times([Fraction(0)] * zeros + [place, Fraction(-1)], other)
        s, _ = guard(rising)
        assert _first_root(s, len(rising) - 1) == pytest.approx(float(place), rel=1e-13)
        s, _ = guard([-one for one in rising])
        assert _first_root(s, len(rising) - 1) == 0.0


@pytest.mark.parametrize('seed', range(20))
def test_rounding_of_the_coefficients_is_below_the_slack(seed: int) -> None:
    """Against fractions: on the whole interval, and where it was halved fourteen times, which adds nothing up."""
    rng = random.Random(seed)
    polynomial = times([at_place(rng), Fraction(-1)], factor(rng, HIGHEST_ORDER - 2))
    s, size = guard(polynomial)
    given = [Fraction(s.scratch[k].guard) for k in range(HIGHEST_ORDER)]
    for halvings in (0, 1, 5, 14):
        width = 0.5 ** halvings
        low = rng.randrange(2 ** halvings) * width
        least, last, _ = _controls(s, 0, HIGHEST_ORDER - 1, low, low + width)
        right = bernstein(given, Fraction(low), Fraction(width))
        slack = 8.0 * (HIGHEST_ORDER - 1) * EPSILON * size
        assert abs(Fraction(least) - min(right)) <= slack
        assert abs(Fraction(last) - right[-1]) <= slack
        assert all(abs(s.scratch[k].control - one) <= slack for k, one in enumerate(right))


def bernstein(polynomial: list[Fraction], low: Fraction, width: Fraction) -> list[Fraction]:
    """Return Bernstein's coefficients on [low, low + width]."""
    n = len(polynomial) - 1
    moved = [sum((polynomial[i] * math.comb(i, k) * low ** (i - k) for i in range(k, n + 1)), Fraction(0)) * width ** k
             for k in range(n + 1)]
    return [sum((moved[i] * Fraction(math.comb(k, i), math.comb(n, i)) for i in range(k + 1)), Fraction(0))
            for k in range(n + 1)]


def test_under_a_constant_normal_force_a_start_in_mid_swing_can_yield() -> None:
    """The spring throws back a slider that moves back: c_c ẋ + h_c ẍ > 0, and F_c rises to the limit while ẋ < 0."""
    axis = paper_axis(COMPLIANT)
    start = InitialState(velocity=-0.02, stretch=0.01, deflection=2e-4)
    events = make(axis, 0.0, 0.0, start).advance(instant(0.02))
    first = events[0]
    assert (first.kind, first.direction) == (EventKind.YIELD, 1)
    assert -0.02 < first.velocity < 0.0
    assert first.friction_force == pytest.approx(axis.normal_force * 0.24, rel=1e-12)
    right = simulate_reference(axis, start, constant(0.0), constant(0.0), 0.02, digits=30).events
    assert [(event.kind, event.mode, event.direction) for event in events] == [
        (event.kind, event.mode, event.direction) for event in right]
    assert [event.time for event in events] == pytest.approx([event.time for event in right], abs=1e-14)
