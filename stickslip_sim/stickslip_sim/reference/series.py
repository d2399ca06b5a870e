# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Power series in τ as lists of coefficients."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal

from mpmath import mpf

from .precision import to_binary, to_decimal

Series = list[Decimal]
_ZERO, _ONE = Decimal(0), Decimal(1)


def series(*coefficients: mpf) -> Series:
    """Return the series of these coefficients."""
    return [to_decimal(c) for c in coefficients]


def value(coefficients: Sequence[Decimal], tau: mpf) -> mpf:
    """Return Σ c_k τ^k (Horner)."""
    total, at = _ZERO, to_decimal(tau)
    for c in reversed(coefficients):
        total = total * at + c
    return to_binary(total)


def derivative(coefficients: Sequence[Decimal]) -> Series:
    """Return the coefficients of d/dτ Σ c_k τ^k."""
    return [k * c for k, c in enumerate(coefficients)][1:]


def integral(coefficients: Sequence[Decimal]) -> Series:
    """Return the coefficients of ∫ Σ c_k τ^k from 0."""
    return [_ZERO, *(c / k for k, c in enumerate(coefficients, 1))]


def combine(*terms: tuple[mpf, Sequence[Decimal]]) -> Series:
    """Return the coefficients of Σ a_i p_i(τ) for pairs (a_i, p_i)."""
    total = [_ZERO] * max(len(p) for _, p in terms)
    for number, of in terms:
        if factor := to_decimal(number):
            for k, c in enumerate(of):
                total[k] += factor * c
    return total


def product(p: Sequence[Decimal], q: Sequence[Decimal]) -> Series:
    """Return the coefficients of p(τ) q(τ)."""
    total = [_ZERO] * (len(p) + len(q) - 1)
    for j, factor in enumerate(p):
        if factor:
            for k, c in enumerate(q, j):
                total[k] += factor * c
    return total


def scaled(coefficients: Sequence[Decimal], h: mpf) -> Series:
    """Return the coefficients c_k h^k of the same function on the unit interval."""
    out, power, ratio = [], _ONE, to_decimal(h)
    for c in coefficients:
        out.append(c * power)
        power *= ratio
    return out


def reach(unit: Sequence[Decimal]) -> Decimal:
    """Return Σ_{k>=1} |d_k|, a bound of |p(s) - p(0)| on the unit interval."""
    return sum(map(abs, unit[1:]), _ZERO)
