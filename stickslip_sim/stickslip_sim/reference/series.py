# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Power series in τ as lists of coefficients."""

from __future__ import annotations

from collections.abc import Sequence

from mpmath import mpf

Series = list[mpf]


def value(coefficients: Sequence[mpf], tau: mpf) -> mpf:
    """Return Σ c_k τ^k (Horner)."""
    total = mpf(0)
    for c in reversed(coefficients):
        total = total * tau + c
    return total


def derivative(coefficients: Sequence[mpf]) -> Series:
    """Return the coefficients of d/dτ Σ c_k τ^k."""
    return [k * c for k, c in enumerate(coefficients)][1:]


def integral(coefficients: Sequence[mpf]) -> Series:
    """Return the coefficients of ∫ Σ c_k τ^k from 0."""
    return [mpf(0), *(c / (k + 1) for k, c in enumerate(coefficients))]


def combine(*terms: tuple[mpf, Sequence[mpf]]) -> Series:
    """Return the coefficients of Σ a_i p_i(τ) for pairs (a_i, p_i)."""
    total = [mpf(0)] * max(len(p) for _, p in terms)
    for factor, series in terms:
        if factor:
            for k, c in enumerate(series):
                total[k] += factor * c
    return total


def scaled(coefficients: Sequence[mpf], h: mpf) -> Series:
    """Return the coefficients c_k h^k of the same function on the unit interval."""
    out, power = [], mpf(1)
    for c in coefficients:
        out.append(c * power)
        power *= h
    return out


def reach(unit: Sequence[mpf]) -> mpf:
    """Return Σ_{k>=1} |d_k|, a bound of |p(s) - p(0)| on the unit interval."""
    return sum((abs(d) for d in unit[1:]), mpf(0))
