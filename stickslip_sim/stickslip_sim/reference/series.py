# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Power series in τ as lists of coefficients."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from decimal import ROUND_HALF_EVEN, Context, Decimal, DivisionByZero, InvalidOperation, Overflow, localcontext
from typing import TypeVar

import mpmath
from mpmath import mp, mpf

# The numbers of the reference, all of the same number of digits: mpmath's, and decimal's for the power series.
#
# The sums over a series are nearly all of the work, and a sum or product of decimal's, which are made in C, takes a
# tenth of the time of one of mpmath's.  What needs more than sums, products and quotients is in mpmath's.
#
# Each step adds to the state a few roundings of the terms that it sums, and the flow hands them on: after n steps, a
# few n of them.  `summed_rounding` allows ten million, those of some million steps.  It is 10^-5 of what is promised,
# since the working digits are twelve more.

_Number = TypeVar('_Number', mpf, Decimal)
_OF_ALL_STEPS = 7  # digits
_LARGEST = 999_999  # power of ten
_SPARE = 2  # digits: mpmath counts in bits, and its numbers of so many digits are up to a digit finer


@contextmanager
def working(digits: int) -> Iterator[None]:
    """Compute with so many digits; the default context of decimal has no say."""
    context = Context(digits + _SPARE, ROUND_HALF_EVEN, Emin=-_LARGEST, Emax=_LARGEST, clamp=0, flags=[],
                      traps=[InvalidOperation, DivisionByZero, Overflow])
    with mpmath.workdps(digits), localcontext(context):
        yield


def summed_rounding(terms: _Number) -> _Number:
    """Return the rounding that a sum of such terms may hold of all steps up to it."""
    finer: int = 10 ** (mp.dps - _OF_ALL_STEPS)
    return terms / finer


def to_decimal(number: mpf) -> Decimal:
    """Return a finite number of mpmath's as one of decimal's, rounded to the working precision; else ValueError."""
    sign, mantissa, power, _ = number._mpf_
    if power and not mantissa:   # so mpmath writes what is not finite
        raise ValueError(f'a power series has finite numbers, not {number}')
    whole, exponent = Decimal(-mantissa if sign else mantissa), int(power)
    return whole * (1 << exponent) if exponent >= 0 else whole / (1 << -exponent)


def to_binary(number: Decimal) -> mpf:
    """Return a finite number of decimal's as one of mpmath's, rounded to the working precision."""
    exponent = int(number.as_tuple().exponent)
    whole = mpf(int(number.scaleb(-exponent)))
    return whole * 10**exponent if exponent >= 0 else whole / 10**-exponent


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
