# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""mu_s(t⁻) = mu_inf − (mu_inf − mu_0) exp(−t⁻/tau) of docs/model.md, from a delay on, in either direction."""

import math
from dataclasses import replace

import pytest

from stickslip_sim.axis.static_limits import limit_backwards, lower_limit, static_at_once, static_limit
from tests.support.plain_axes import CONVENTIONAL, SIDED, STATIC, parameters

FORWARDS = [(0.0, 0.25), (2.0, 0.5 - 0.25 / math.e), (4.0, 0.5 - 0.25 / math.e ** 2), (math.inf, 0.5)]
BACKWARDS = [(0.0, 0.375), (1.0, 0.75 - 0.375 / math.e), (4.0, 0.75 - 0.375 / math.e ** 4), (math.inf, 0.75)]


@pytest.mark.parametrize(('rest', 'expected'), FORWARDS)
def test_the_limit_rises_with_the_rest_time(rest: float, expected: float) -> None:
    p = parameters()
    assert static_limit(p, rest, 1.0) == pytest.approx(expected, rel=1e-15)
    forwards = static_limit(p, rest, 1.0)
    assert static_limit(p, rest, -1.0) == limit_backwards(p, rest, forwards) == lower_limit(p, rest) == forwards


@pytest.mark.parametrize(('side', 'rest', 'expected'), [*((1.0, *row) for row in FORWARDS),
                                                        *((-1.0, *row) for row in BACKWARDS)])
def test_the_sign_of_the_force_chooses_the_law(side: float, rest: float, expected: float) -> None:
    assert static_limit(parameters(friction=SIDED), rest, side) == pytest.approx(expected, rel=1e-15)


def test_both_limits_and_the_lower_one() -> None:
    """Backwards it is the higher one here; turned round it is the lower one."""
    for friction in (SIDED, SIDED.mirrored):
        p = parameters(friction=friction)
        both = static_limit(p, 1.0, 1.0), static_limit(p, 1.0, -1.0)
        assert limit_backwards(p, 1.0, both[0]) == both[1] != both[0]
        assert lower_limit(p, 1.0) == min(both)


def test_the_limit_rises_from_the_delay_on() -> None:
    late = parameters(friction=replace(CONVENTIONAL, static=replace(STATIC, delay=3.0)))
    assert [static_limit(late, rest, 1.0) for rest in (0.0, 1.0, 3.0)] == [0.25] * 3
    assert static_limit(late, 5.0, -1.0) == static_limit(parameters(), 2.0, -1.0)
    assert static_limit(late, math.inf, 1.0) == 0.5


@pytest.mark.parametrize(('side', 'expected'), [(1.0, 0.25), (-1.0, 0.375), (0.0, 0.25)])
def test_at_once_it_is_that_of_no_rest(side: float, expected: float) -> None:
    """Without a force as forwards, with a rest time too."""
    assert static_limit(parameters(friction=SIDED), 0.0, side) == expected
    assert static_at_once(parameters(friction=SIDED), side) == expected
    assert static_at_once(parameters(), side) == 0.25
