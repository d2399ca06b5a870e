# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A smooth falling shape as a piecewise-linear table: few breakpoints, a proven error, and next to no bias.

The table p stays within `tolerance` of the shape g for every z >= 0; p(0) = g(0) = 1, and p ends at 0, the limit of g.
One walk from z = 0 on lays each line as far as it goes.  Where g is convex a breakpoint lies one tolerance below g and
the line touches g + tolerance/2 (where g is concave, above and below change places): so the error of each line,
a parabola in first order, has zero mean.  Friction that is too high in the middle of a line and too low at its ends
takes the same energy out of a slip, and the motion is off by much less than with breakpoints on the curve.

The line from a breakpoint that touches the edge of that band has a closed condition with one root, since its left side
is monotone; where it leaves the band is another.  No sampling: between inflections p − g has its extremes at the
breakpoints and where the slope of g is that of the line, and `table_error` finds them anew from the finished table.
"""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

from .shapes import Shape

_BEND = 0.5        # of the tolerance, on the other side in the middle of a line: parabolas of zero mean
_BEND_FIRST = 1 / 3   # the same for the first line, which begins on the curve
_COARSEST = 0.25   # a tolerance beyond it asks for nothing: the table is as for this one
_MARGIN = 0.999    # of the tolerance is used; the rest is for rounding, also of a viscous part at high speed

Breakpoint = tuple[float, float]


def shape_table(shape: Shape, tolerance: float, most: int) -> list[Breakpoint] | None:
    """Return breakpoints (z, p) with |p − g| <= `tolerance` for all z, p(0) = 1 and p = 0 at the last and beyond.

    None when it takes more than `most` breakpoints.
    """
    allowed = min(tolerance, _COARSEST) * _MARGIN
    breakpoints = [(0.0, 1.0)]
    bend = _BEND_FIRST
    while breakpoints[-1][1] > 0.0:
        if len(breakpoints) == most:
            return None
        breakpoints.append(_next_breakpoint(shape, breakpoints[-1], allowed, bend * allowed))
        bend = _BEND
    return breakpoints


def table_error(value: Callable[[float], float], slope: Callable[[float], float], inflection: float,
                breakpoints: Sequence[Breakpoint]) -> float:
    """Return max |p − f| of a curve f up to the last breakpoint, from its value, slope and inflection (0: none)."""
    worst = 0.0
    for (x0, y0), (x1, y1) in pairwise(breakpoints):
        rise = (y1 - y0) / (x1 - x0)

        def excess(x: float, rise: float = rise) -> float:
            return slope(x) - rise

        borders = [x0, inflection, x1] if x0 < inflection < x1 else [x0, x1]
        points = list(borders)
        points += [root(excess, a, excess(a), b, excess(b)) for a, b in pairwise(borders)
                   if (excess(a) < 0.0) != (excess(b) < 0.0)]
        worst = max(worst, *(abs(y0 + rise * (x - x0) - value(x)) for x in points))
    return worst


def root(f: Callable[[float], float], a: float, fa: float, b: float, fb: float) -> float:
    """Return a root of f between a and b, where f has different signs (Illinois, halving where that fails)."""
    for _ in range(200):
        if b - a <= 1e-15 * abs(b) or fb == 0.0:
            break
        x = (a * fb - b * fa) / (fb - fa)
        if not a < x < b:   # also when a value is infinite
            x = a + 0.5 * (b - a)
            if not a < x < b:
                break
        fx = f(x)
        if fx == 0.0:
            return x
        if (fx < 0.0) == (fb < 0.0):
            b, fb, fa = x, fx, 0.5 * fa
        else:
            a, fa, fb = x, fx, 0.5 * fb
    return b


def _next_breakpoint(shape: Shape, breakpoint: Breakpoint, allowed: float, bend: float) -> Breakpoint:
    """Return the end of the longest line from a breakpoint."""
    z, p = breakpoint
    concave = z < shape.inflection
    if not concave and p <= allowed:   # the tail: a line to 0 that ends where g < allowed stays in the band
        return shape.reach(0.25 * allowed), 0.0
    touch, rise = _tangent(shape, breakpoint, bend, concave)

    def above(x: float) -> float:
        return p + rise * (x - z) - shape.value(x)

    if touch < shape.inflection:
        back = _where(lambda x: rise - shape.slope(x), shape.inflection, shape.inflection)
        if above(back) >= allowed:
            end = root(lambda x: above(x) - allowed, touch, above(touch) - allowed, back, above(back) - allowed)
            return end, p + rise * (end - z)
        touch = back
    end = _where(lambda x: above(x) + allowed, touch, touch - z)
    fall = z - p / rise   # where the line is at 0
    return (fall, 0.0) if fall <= end else (end, p + rise * (end - z))


def _tangent(shape: Shape, breakpoint: Breakpoint, bend: float, concave: bool) -> tuple[float, float]:
    """Return where the line from a breakpoint touches the edge g ± bend of its inner side, and its slope.

    A breakpoint beyond that edge (the first one after the inflection may be) takes the tangent of g at its place.
    """
    z, p = breakpoint
    sign = -1.0 if concave else 1.0

    def gap(x: float) -> float:
        return sign * (shape.value(x) + shape.slope(x) * (z - x) - p) + bend

    if sign * (shape.value(z) - p) + bend <= 0.0:
        return z, shape.slope(z)
    if concave and gap(shape.inflection) > 0.0:
        return shape.inflection, shape.slope(shape.inflection)   # the steepest line that there is
    touch = _where(gap, z, (shape.inflection - z) if concave else max(z, 1e-3), sign * (shape.value(z) - p) + bend)
    return touch, (shape.value(touch) + sign * bend - p) / (touch - z)   # a slope may jump within rounding of `touch`


def _where(f: Callable[[float], float], start: float, step: float, first: float | None = None) -> float:
    """Return where f, positive at `start` (its value there is `first`) and then falling, vanishes beyond it."""
    a, fa = start, f(start) if first is None else first
    step = step if step > 0.0 else 1e-3
    while True:
        b = start + step
        fb = f(b)
        if fb <= 0.0:
            return root(f, a, fa, b, fb)
        if b > 1e300 or math.isinf(b):
            return b
        a, fa, step = b, fb, 2.0 * step
