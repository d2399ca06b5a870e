# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""First root of a power series on an interval, proved by Bernstein coefficients.

A guard is a function g(τ) = Σ c_k τ^k on [0, h], positive while the mode lasts.  Written in the
Bernstein basis of [0, h], the number of sign changes of its coefficients bounds its number of roots
(Descartes): none proves there is no root, one proves there is exactly one; otherwise the interval is
halved, left half first.  No crossing and no grazing minimum can be stepped over.  A guard that is zero within the
rounding it has gathered has touched zero, and not fallen below, so that rounding does not decide.

On the unit interval everything is in fixed point: whole numbers in units of 2^-bits of the largest
coefficient, with as many bits more than the working precision as the sums can lose.
"""

from __future__ import annotations

import itertools
import operator
from collections.abc import Sequence
from decimal import Decimal

from mpmath import ldexp, mp, mpf

from .series import reach, scaled, summed_rounding, to_decimal

_SPARE = 28  # bits, against the rounding of some thousand sums
_DIGITS = 0.302  # in a bit, and a little more
_NEWTON = 400  # steps; bisection alone needs as many as there are bits
_ZERO = mpf(0)


def first_root(guard: Sequence[Decimal], h: mpf, scale: mpf, time_scale: mpf, rounding: mpf = _ZERO) -> mpf | None:
    """Return the first τ in [0, h] at which the guard, known to `rounding`, falls below zero, or None.

    Leading coefficients that vanish against ``scale`` (a tie on entry) are divided out, so that the sign of
    the first derivative which differs from zero decides: negative is a root at 0, positive is no root there.
    """
    time = to_decimal(time_scale)
    lead = _leading(guard, to_decimal(max(scale * mpf(10) ** (18 - mp.dps), rounding)), time)
    if lead == len(guard):
        return None
    if guard[lead] < 0:
        return mpf(0)
    unit = scaled(guard[lead:], h)
    way = reach(unit)
    if unit[0] > way:
        return None
    s = first_unit_root(unit, max(to_decimal(rounding) / time**lead, summed_rounding(unit[0] + way)))
    return None if s is None else s * h


def _leading(guard: Sequence[Decimal], limit: Decimal, time: Decimal) -> int:
    """Return the index of the first coefficient with |c_k| T^k above the limit."""
    for k, c in enumerate(guard):
        if abs(c) > limit:
            return k
        limit = limit / time
    return len(guard)


def first_unit_root(unit: Sequence[Decimal], rounding: Decimal) -> mpf | None:
    """Return the first root in (0, 1] of Σ d_k s^k with d_0 > 0 behind which it falls below -rounding."""
    bits = mp.prec + _SPARE + len(unit)  # a sum of n + 1 terms in Bernstein form grows by 2^n at the most
    places = int(_DIGITS * bits) + 1
    up, one = places - 1 - max(map(abs, unit)).adjusted(), 10**places
    whole = [(int(d.scaleb(up)) << bits) // one for d in unit]
    while len(whole) > 1 and not whole[-1]:
        whole.pop()
    margin = (int(rounding.scaleb(up)) << bits) // one + 1
    below = _isolate([whole[0] + margin, *whole[1:]], bits)
    return None if below is None else ldexp(mpf(_refine(whole, 0, below, below, bits)), -bits)


def bernstein(unit: Sequence[int]) -> list[int]:
    """Return Bernstein coefficients b_j = Σ_{k<=j} C(j,k)/C(n,k) d_k of Σ d_k s^k on [0, 1].

    Δ^k b_0 = d_k / C(n,k), so the b_j follow from a table of differences by additions alone.
    """
    n = len(unit) - 1
    diffs, binomial = [], 1
    for k, d in enumerate(unit):
        diffs.append(d // binomial)
        binomial = binomial * (n - k) // (k + 1)
    out = []
    while diffs:
        out.append(diffs[0])
        diffs = _sums(diffs)
    # each pass turned Δ^k b_j into Δ^k b_{j+1}
    return out


def _halve(b: list[int]) -> tuple[list[int], list[int]]:
    """Split at the middle (de Casteljau)."""
    left, right, row = [b[0]], [b[-1]], b
    for halvings in range(1, len(b)):
        row = _sums(row)
        left.append(row[0] >> halvings)
        right.append(row[-1] >> halvings)
    return left, right[::-1]


def _sums(row: list[int]) -> list[int]:
    """Return the sums of neighbours; most of the work of the reference is here."""
    return list(map(operator.add, row, row[1:]))


def _sign_changes(b: list[int]) -> int:
    signs = [c > 0 for c in b if c]
    return sum(p != q for p, q in itertools.pairwise(signs))


def _isolate(unit: list[int], bits: int) -> int | None:
    """Return the first root in (0, 1], in units of 2^-bits."""
    stack = [(bernstein(unit), 0, 1 << bits)]
    finest = 1 << (bits - mp.prec // 2)
    while stack:
        b, low, width = stack.pop()
        if b[0] <= 0:
            return low
        changes = _sign_changes(b)
        if changes == 0:
            continue
        if changes == 1:
            return _refine(unit, low, low + width, low + (width >> 1), bits)
        width >>= 1
        if width < finest:
            return low + width  # a double root to working precision: the guard is reached
        left, right = _halve(b)
        stack.append((right, low + width, width))
        stack.append((left, low, width))
    return None


def _refine(p: list[int], low: int, high: int, x: int, bits: int) -> int:
    """Return the root in [low, high] that Newton, kept inside the bracket, comes to from x (p falls)."""
    slope = [k * c for k, c in enumerate(p)][1:]
    tiny = 1 << (bits - mp.prec)
    for _ in range(_NEWTON):
        y = _horner(p, x, bits)
        if y > 0:
            low = x
        elif y < 0:
            high = x
        else:
            return x
        rate = _horner(slope, x, bits)
        guess = x - (y << bits) // rate if rate else low
        if rate and abs(guess - x) <= tiny and low <= guess <= high:
            return guess
        if high - low <= tiny:
            return high
        x = guess if rate and low < guess < high else (low + high) >> 1
    raise ArithmeticError('the root was bracketed but not refined')


def _horner(p: list[int], x: int, bits: int) -> int:
    total = 0
    for c in reversed(p):
        total = (total * x >> bits) + c
    return total
