# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The static limit of an axis: mu_s after a rest time, against a force of either direction."""

from typing import NamedTuple

from ..core.hot_path import inlined
from ..friction.static import static_coefficient
from .layout import Parameters


class StaticNumbers(NamedTuple):
    """The numbers of the static law in one direction: mu_0, mu_inf, tau in s, Kato's exponent."""

    initial: float
    limit: float
    tau: float
    exponent: float


@inlined
def static_numbers(p: Parameters, side: float) -> StaticNumbers:
    """Return the numbers of the static law against a force of this sign."""
    if side < 0.0 and p.sided != 0.0:
        return StaticNumbers(p.backward_initial, p.backward_limit, p.backward_tau, p.backward_exponent)
    return StaticNumbers(p.static_initial, p.static_limit, p.static_tau, p.static_exponent)


@inlined
def static_limit(p: Parameters, rest: float, side: float) -> float:
    """Return mu_s after the rest time, against a force of this sign."""
    of = static_numbers(p, side)
    return static_coefficient(p.static_law, of.initial, of.limit, of.tau, of.exponent,
                              max(rest - p.static_delay, 0.0))


@inlined
def limit_backwards(p: Parameters, rest: float, forwards: float) -> float:
    """Return mu_s backwards after the rest time, given that forwards: the same, where there is no difference."""
    return static_limit(p, rest, -1.0) if p.sided != 0.0 else forwards


@inlined
def lower_limit(p: Parameters, rest: float) -> float:
    """Return mu_s after the rest time, the smaller one of both directions."""
    limit = static_limit(p, rest, 1.0)
    return min(limit, limit_backwards(p, rest, limit))


@inlined
def static_at_once(p: Parameters, side: float) -> float:
    """Return mu_s at rest time 0 against a force of this sign."""
    return p.backward_initial if side < 0.0 else p.static_initial


@inlined
def holds_nothing(p: Parameters) -> bool:
    """Whether the static limit is 0 at any rest time: no normal force, or no static friction."""
    return p.normal_force * max(p.static_limit, p.backward_limit) == 0.0
