"""First root of a power series on an interval, proved by Bernstein coefficients.

A guard is a function g(τ) = Σ c_k τ^k on [0, h], positive while the mode lasts.  Written in the
Bernstein basis of [0, h], the number of sign changes of its coefficients bounds its number of roots
(Descartes): none proves there is no root, one proves there is exactly one; otherwise the interval is
halved, left half first.  No crossing and no grazing minimum can be stepped over.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from mpmath import mp, mpf

Series = list[mpf]

_HALF = mpf(0.5)


def value(coefficients: Sequence[mpf], tau: mpf) -> mpf:
    """Return Σ c_k τ^k (Horner)."""
    total = mpf(0)
    for c in reversed(coefficients):
        total = total * tau + c
    return total


def derivative(coefficients: Sequence[mpf]) -> Series:
    """Return the coefficients of d/dτ Σ c_k τ^k."""
    return [k * c for k, c in enumerate(coefficients)][1:]


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


def first_root(guard: Sequence[mpf], h: mpf, scale: mpf, time_scale: mpf) -> mpf | None:
    """Return the first τ in [0, h] at which the guard falls below zero, or None.

    Leading coefficients that vanish against ``scale`` (a tie on entry) are divided out, so that the sign of
    the first derivative which differs from zero decides: negative is a root at 0, positive is no root there.
    """
    lead = _leading(guard, scale, time_scale)
    if lead == len(guard):
        return None
    if guard[lead] < 0:
        return mpf(0)
    unit = _trimmed(scaled(guard[lead:], h))
    if unit[0] > reach(unit):
        return None
    s = _isolate(unit)
    return None if s is None else s * h


def _leading(guard: Sequence[mpf], scale: mpf, time_scale: mpf) -> int:
    """Return the index of the first coefficient with |c_k| T^k above rounding."""
    limit = scale * mpf(10) ** (18 - mp.dps)
    for k, c in enumerate(guard):
        if abs(c) > limit:
            return k
        limit = limit / time_scale
    return len(guard)


def _trimmed(unit: Series) -> Series:
    """Drop trailing terms that cannot be seen at the working precision."""
    floor = max(abs(d) for d in unit) * mpf(10) ** (-mp.dps - 5)
    n = len(unit)
    while n > 1 and abs(unit[n - 1]) <= floor:
        n -= 1
    return unit[:n]


def bernstein(unit: Sequence[mpf]) -> Series:
    """Return Bernstein coefficients b_j = Σ_{k<=j} C(j,k)/C(n,k) d_k of Σ d_k s^k on [0, 1].

    Δ^k b_0 = d_k / C(n,k), so the b_j follow from a table of differences by additions alone.
    """
    n = len(unit) - 1
    diffs, binomial = [], 1
    for k, d in enumerate(unit):
        diffs.append(d / binomial)
        binomial = binomial * (n - k) // (k + 1)
    out = []
    while diffs:
        out.append(diffs[0])
        diffs = [a + b for a, b in itertools.pairwise(diffs)]
    # each pass turned Δ^k b_j into Δ^k b_{j+1}
    return out


def _halve(b: Series) -> tuple[Series, Series]:
    """Split at the middle (de Casteljau)."""
    left, right, row = [b[0]], [b[-1]], b
    while len(row) > 1:
        row = [(p + q) * _HALF for p, q in itertools.pairwise(row)]
        left.append(row[0])
        right.append(row[-1])
    return left, right[::-1]


def _sign_changes(b: Series) -> int:
    signs = [c > 0 for c in b if c]
    return sum(p != q for p, q in itertools.pairwise(signs))


def _isolate(unit: Series) -> mpf | None:
    """Return the first root in (0, 1] of Σ d_k s^k with d_0 > 0."""
    stack = [(bernstein(unit), mpf(0), mpf(1))]
    slope = derivative(unit)
    while stack:
        b, low, width = stack.pop()
        changes = _sign_changes(b)
        if b[0] <= 0:
            return low
        if changes == 0:
            continue
        if changes == 1:
            return _refine(unit, slope, low, low + width)
        width *= _HALF
        if width < mpf(10) ** (-mp.dps // 2):
            return low + width  # a double root to working precision: the guard is reached
        left, right = _halve(b)
        stack.append((right, low + width, width))
        stack.append((left, low, width))
    return None


def _refine(p: Series, slope: Series, low: mpf, high: mpf) -> mpf:
    """Return the only root in [low, high] (p falls): Newton kept inside the bracket."""
    tiny = mpf(10) ** (4 - mp.dps)
    x = (low + high) * _HALF
    for _ in range(400):
        y = value(p, x)
        if y > 0:
            low = x
        elif y < 0:
            high = x
        else:
            return x
        rate = value(slope, x)
        step = y / rate if rate else mpf(0)
        guess = x - step
        if abs(step) <= tiny and low <= guess <= high:
            return guess
        if high - low <= tiny * high:
            return high
        x = guess if rate and low < guess < high else (low + high) * _HALF
    raise ArithmeticError('the root was bracketed but not refined')
