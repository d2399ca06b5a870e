# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The first event of a motion that is a power series (`axis.slip_series`): of a slip under N(t), or a yield.

A guard is a polynomial in τ, positive until its event, and the true one differs from it by less than δ: the bound of
the series, and rounding.  Its first root is certain by its coefficients in Bernstein's form on an interval, between the
least and the largest of which it stays:

1. All above −δ: the guard falls nowhere below −δ in the interval.
2. The last below −δ, and one change of sign (or none): exactly one root (Descartes' rule), found by Newton's step
   inside a bracket.
3. Else the interval is halved, the left half first.  What follows on an interval that is clear is twice as long.

A guard that begins at exactly 0, as the acceleration of a break-away does, is divided by τ.  In a slip the acceleration
alone needs this: up to its root the speed is monotone, so that its value there shows whether a breakpoint, or
standstill, was passed before.  A contact that yields ends where the interface stands still, or where the slider begins
to move along the force.

In floating point: what falls below 0 by less than δ is no event, and an interval that no number halves holds a root.
"""

import math

from ...axis.codes import ACCELERATING, ARREST, BREAKAWAY, COAST, YIELDING
from ...axis.forces import force_rounding, kinetic_at_rest
from ...axis.layout import Parameters
from ...axis.state_record import HIGHEST_ORDER, State
from ...core.hot_path import compiled, inlined
from ...linear.roots import EPSILON, ITERATIONS
from .forced import passed_kind, speed_gap

RENEWAL = -1.0          # in place of an `types.EventKind`: a new segment start, and no event
_NARROW = 2.0 ** -44    # of an interval that is not halved any more


@compiled
def series_event(p: Parameters, s: State) -> None:
    """Set the event that ends the motion, or the renewal of its series at their end."""
    s.next.searched = math.inf
    s.cache.at.time = -1.0
    if s.mode == YIELDING:
        _yielding(p, s)
        return
    sense = s.direction if s.mode == ACCELERATING else -s.direction
    gap = speed_gap(p, s)
    if gap <= 0.0:
        _set_event(s, 0.0, passed_kind(p, s))
        return
    for k in range(HIGHEST_ORDER):
        s.scratch[k].guard = sense * (k + 1.0) * s.series[k + 1].u
    root = _first_root(s, HIGHEST_ORDER - 1)
    until = min(root, 1.0)
    if _gained(s, sense, until) >= gap:
        _set_event(s, _passing(s, sense, gap, until), passed_kind(p, s))
    else:
        _set_event(s, until, COAST if root <= 1.0 else RENEWAL)


@compiled
def _yielding(p: Parameters, s: State) -> None:
    """Set the end of a yield: stick where its interface stands still, slip where the slider moves along the force."""
    direction, share = s.direction, 1.0 / s.series_end
    for k in range(HIGHEST_ORDER + 1):
        s.scratch[k].guard = -direction * s.series[k].u
    slips = _first_root(s, HIGHEST_ORDER)
    for k in range(HIGHEST_ORDER):
        s.scratch[k].guard = direction * (s.series[k].u - (k + 1.0) * s.series[k + 1].deflection * share)
    if p.contact_damping > 0.0:   # it begins on the limit: a tie, which the next term decides
        tie = force_rounding(p, s, kinetic_at_rest(p, direction)) / p.contact_damping
        if abs(s.scratch[0].guard) <= tie:
            s.scratch[0].guard = 0.0
    sticks = _first_root(s, HIGHEST_ORDER - 1)
    if min(slips, sticks) > 1.0:
        _set_event(s, 1.0, RENEWAL)
    elif sticks <= slips:
        _set_event(s, sticks, ARREST)
    else:
        _set_event(s, slips, BREAKAWAY)


@inlined
def _set_event(s: State, at: float, kind: float) -> None:
    s.next.time = at * s.series_end
    s.next.kind = kind


@inlined
def _gained(s: State, sense: float, at: float) -> float:
    """Return what the speed has gained up to τ = `at`."""
    total = 0.0
    for i in range(HIGHEST_ORDER):
        total = (total + s.series[HIGHEST_ORDER - i].u) * at
    return sense * total


@compiled
def _passing(s: State, sense: float, gap: float, until: float) -> float:
    """Return when the speed, monotone up to there, has gained the gap: Newton's step inside a bracket."""
    low, high, at = 0.0, until, until
    for _ in range(ITERATIONS):
        s.iterations += 1.0
        value = gap - _gained(s, sense, at)
        if value > 0.0:
            low = at
        else:
            high = at
        slope, power = 0.0, 1.0
        for k in range(HIGHEST_ORDER):
            slope += s.scratch[k].guard * power
            power *= at
        guess = at + value / slope if slope > 0.0 else math.inf
        if not low < guess < high:
            guess = 0.5 * (low + high)
            if guess <= low or guess >= high:
                return high
        if abs(guess - at) <= EPSILON * at:
            return guess
        at = guess
    return at


@compiled
def _first_root(s: State, degree: int) -> float:
    """Return the first τ in [0, 1] at which the guard has fallen below −δ for certain, infinity if there is none."""
    first, size = 0, 0.0
    while first < degree and s.scratch[first].guard == 0.0:
        first += 1
    for k in range(first, degree + 1):
        size += abs(s.scratch[k].guard)
    begin = s.scratch[first].guard
    slack = s.series_error + 8.0 * degree * EPSILON * size
    if (first > 0 and begin < 0.0) or begin < -slack:
        return 0.0
    if begin - (size - abs(begin)) > 0.0:
        return math.inf
    low, high = 0.0, 1.0
    while True:
        s.iterations += 1.0
        least, last, changes = _controls(s, first, degree, low, high)
        if least > -slack:
            if high == 1.0:
                return math.inf
            low, high = high, min(high + 2.0 * (high - low), 1.0)
        elif last < -slack and changes <= 1:
            return _root(s, first, degree, low, high)
        else:
            if high - low <= _NARROW:
                return high
            high = 0.5 * (low + high)


@compiled
def _controls(s: State, first: int, degree: int, low: float, high: float) -> tuple[float, float, int]:
    """Return the least and the last of Bernstein's coefficients of guard/τ^first on an interval, and sign changes."""
    size = degree - first
    for k in range(size + 1):
        s.scratch[k].control = s.scratch[first + k].guard
    if low > 0.0:
        for i in range(size):
            for j in range(size - i):
                s.scratch[size - 1 - j].control += low * s.scratch[size - j].control
    width, power, choices = high - low, 1.0, 1.0
    for k in range(size + 1):
        s.scratch[k].control *= power / choices
        power *= width
        choices *= (size - k) / (k + 1.0)
    for i in range(size):
        for j in range(size - i):
            s.scratch[size - j].control += s.scratch[size - 1 - j].control
    least, changes = s.scratch[0].control, 0
    before = s.scratch[0].control
    for k in range(1, size + 1):
        now = s.scratch[k].control
        least = min(least, now)
        if (before < 0.0) != (now < 0.0):
            changes += 1
        before = now
    return least, before, changes


@compiled
def _root(s: State, first: int, degree: int, low: float, high: float) -> float:
    """Return the one root of guard/τ^first between low and high, where it has fallen: Newton's step in a bracket."""
    at = low
    for _ in range(ITERATIONS):
        s.iterations += 1.0
        value, slope = 0.0, 0.0
        for i in range(degree - first + 1):
            slope = slope * at + value
            value = value * at + s.scratch[degree - i].guard
        if value > 0.0:
            low = at
        else:
            high = at
        guess = at - value / slope if slope < 0.0 else math.inf
        if abs(guess - at) <= EPSILON * at:
            return guess if low <= guess <= high else at
        if not low < guess < high:
            guess = 0.5 * (low + high)
            if guess <= low or guess >= high:
                return high
        at = guess
    return at

