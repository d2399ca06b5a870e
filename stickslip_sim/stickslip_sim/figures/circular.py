# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The circular test of two axes in the terms of ISO 230-4: how far a path is from a circle, and its quadrant glitches.

Radial deviations F are taken about the centre of the nominal circle; the zones of G and G(b) have the centre that makes
them narrowest.  Counterclockwise is from +x to +y.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.optimize import linprog

from ..core.arrays import Numbers

QUADRANTS = '+x', '+y', '-x', '-y'       # where a path crosses them, one axis reverses
SENSES = {1: 'counterclockwise', -1: 'clockwise'}
GLITCH_ARC = math.radians(15.0)          # after the crossing, in which a glitch is looked for
_QUARTER, _TURN = 0.5 * math.pi, 2.0 * math.pi
_SHORT = math.radians(1.0)               # that a whole turn may lack
_MOST_CUTS = 200
_EPSILON = float(np.finfo(np.float64).eps)


class Circle(NamedTuple):
    """Centre and radius, m."""

    x: float
    y: float
    radius: float


def least_squares_circle(x: Numbers, y: Numbers) -> Circle:
    """Return the circle whose distances to the points have the least sum of squares, m."""
    middle_x, middle_y = float(x.mean()), float(y.mean())
    size = float(np.hypot(x - middle_x, y - middle_y).max()) or 1.0
    u, v = (x - middle_x) / size, (y - middle_y) / size
    a, b, c = np.linalg.lstsq(np.column_stack([2.0 * u, 2.0 * v, np.ones(len(u))]), u * u + v * v, rcond=None)[0]
    radius = math.sqrt(max(c + a * a + b * b, 0.0))
    for _ in range(50):      # Gauss and Newton
        distance = np.hypot(u - a, v - b)
        jacobian = np.column_stack([(a - u) / distance, (b - v) / distance, np.full(len(u), -1.0)])
        step = np.linalg.lstsq(jacobian, radius - distance, rcond=None)[0]
        a, b, radius = a + step[0], b + step[1], radius + step[2]
        if np.abs(step).max() < 4.0 * _EPSILON:
            break
    return Circle(middle_x + size * float(a), middle_y + size * float(b), size * float(radius))


def zone_width(x: Numbers, y: Numbers) -> float:
    """Return the least distance of two concentric circles that have all points between them, m.

    A linear programme over the few points that matter finds the step of the centre; it is made anew about each centre.
    """
    best_x, best_y, _ = least_squares_circle(x, y)
    distance = np.hypot(x - best_x, y - best_y)
    best, rows = float(np.ptp(distance)), [int(distance.argmax()), int(distance.argmin())]
    reach = best                         # of a step, where the distances are about linear
    for _ in range(_MOST_CUTS):
        unit_x, unit_y = (x[rows] - best_x) / distance[rows], (y[rows] - best_y) / distance[rows]
        if reach <= _EPSILON * float(distance.max()):
            break
        step_x, step_y, least = _narrowing(unit_x, unit_y, distance[rows], reach)
        if best - least <= max(1e-10 * best, 2.0 * _EPSILON * float(distance.max())):
            break
        tried = np.hypot(x - (best_x + step_x), y - (best_y + step_y))
        rows += [row for row in (int(tried.argmax()), int(tried.argmin())) if row not in rows]
        if float(np.ptp(tried)) < best:
            best_x, best_y, distance, best = best_x + step_x, best_y + step_y, tried, float(np.ptp(tried))
        elif {int(tried.argmax()), int(tried.argmin())} <= {*rows[:-2]}:
            reach *= 0.5
    return best


def _narrowing(unit_x: Numbers, unit_y: Numbers, distance: Numbers, reach: float) -> tuple[float, float, float]:
    """Return the step of the centre (m) that narrows the zone of some points most, and the width then, linearised."""
    level, ones, none = float(distance.mean()), np.ones(len(distance)), np.zeros(len(distance))
    off = (distance - level) / reach     # about 1, as the tolerances of the solver are absolute
    upper, lower = np.column_stack([-unit_x, -unit_y, -ones, none]), np.column_stack([unit_x, unit_y, none, ones])
    found = linprog([0.0, 0.0, 1.0, -1.0], np.vstack([upper, lower]), np.concatenate([-off, off]),
                    bounds=[(-1.0, 1.0), (-1.0, 1.0), (None, None), (None, None)],
                    options={'primal_feasibility_tolerance': 1e-10, 'dual_feasibility_tolerance': 1e-10})
    return float(found.x[0]) * reach, float(found.x[1]) * reach, float(found.fun) * reach


@dataclass(frozen=True, eq=False)
class Turn:
    """The last whole turn of a path in one sense; `angle` (rad) rises in that sense, from +x on counterclockwise."""

    sense: int
    angle: Numbers
    x: Numbers                   # m
    y: Numbers                   # m
    deviation: Numbers           # m, radial: distance from the nominal centre less the nominal radius
    glitches: dict[str, float]   # m, by quadrant

    @property
    def largest(self) -> float:
        """F max, m."""
        return float(self.deviation.max())

    @property
    def smallest(self) -> float:
        """F min, m."""
        return float(self.deviation.min())

    @cached_property
    def circular_deviation(self) -> float:
        """G, m."""
        return zone_width(self.x, self.y)


@dataclass(frozen=True, eq=False)
class CircularTest:
    """The turns of a circular test, one of a sense, at least one."""

    nominal: Circle
    turns: tuple[Turn, ...]

    @property
    def is_bidirectional(self) -> bool:
        """Whether there is a turn in either sense."""
        return len(self.turns) == len(SENSES)

    @cached_property
    def bidirectional_circular_deviation(self) -> float:
        """G(b), m: the zone of both turns."""
        return zone_width(*self._both)

    @cached_property
    def mean_radial_deviation(self) -> float:
        """D, m: the radius of the least-squares circle of both turns less the nominal radius."""
        return least_squares_circle(*self._both).radius - self.nominal.radius

    @property
    def _both(self) -> tuple[Numbers, Numbers]:
        return np.concatenate([turn.x for turn in self.turns]), np.concatenate([turn.y for turn in self.turns])


def turns_of(x: Numbers, y: Numbers, nominal: Circle) -> list[Turn]:
    """Return the last whole turn of a path (m) in each sense that has one."""
    away_x, away_y = x - nominal.x, y - nominal.y
    angle = np.unwrap(np.arctan2(away_y, away_x))
    deviation = np.hypot(away_x, away_y) - nominal.radius
    found = {}
    for first, last, sense in _stretches(angle):
        rising = sense * angle[first:last + 1]
        if rising.max() - rising[0] < _TURN - _SHORT:
            continue
        rows = first + np.flatnonzero(rising > rising[-1] - _TURN + 1e-9)
        glitches = dict(_glitches(rising, deviation[first:last + 1], sense))
        found[sense] = Turn(sense, sense * angle[rows], x[rows], y[rows], deviation[rows], glitches)
    return [found[sense] for sense in SENSES if sense in found]


def _stretches(angle: Numbers) -> Iterator[tuple[int, int, int]]:
    """Yield where the angle begins and ends to go one way, but for less than a quarter back, and which."""
    away = np.flatnonzero(np.abs(angle - angle[0]) > _QUARTER)
    first, sense = 0, int(np.sign(angle[away[0]] - angle[0])) if away.size else 0
    while sense:
        rising = sense * angle[first:]
        back = np.flatnonzero(np.maximum.accumulate(rising) - rising > _QUARTER)
        last = first + int(rising[:back[0]].argmax() if back.size else len(rising) - 1)
        yield first, last, sense
        first, sense = last, -sense if back.size else 0


def _glitches(rising: Numbers, deviation: Numbers, sense: int) -> Iterator[tuple[str, float]]:
    """Yield the glitch where each quadrant was crossed last, with all of its arc."""
    for number, quadrant in enumerate(QUADRANTS):
        place = sense * number * _QUARTER
        crossed = place + _TURN * math.floor((rising[-1] - GLITCH_ARC - place) / _TURN)
        if crossed < rising[0] - 1e-9:
            continue
        yield quadrant, arc_glitch(rising, deviation, crossed)


def arc_glitch(angle: Numbers, deviation: Numbers, crossed: float) -> float:
    """Return the glitch on the arc behind an angle where a quadrant is crossed, m: outwards > 0, inwards < 0.

    It is how far the radial deviation on the arc passes those at both ends of it; `angle` (rad) rises.
    """
    first, last = np.searchsorted(angle, [crossed, crossed + GLITCH_ARC])
    begin, end = np.interp([crossed, crossed + GLITCH_ARC], angle, deviation)
    arc = deviation[first:last]
    out, inside = arc.max(initial=begin) - max(begin, end), min(begin, end) - arc.min(initial=begin)
    return float(max(out, 0.0) if out >= inside else -max(inside, 0.0)) + 0.0    # no -0.0
