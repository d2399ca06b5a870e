# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of ISO 230-4 on circles with a known error, to a picometre."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import ellipe

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.figures.circular import (
    GLITCH_ARC,
    QUADRANTS,
    Circle,
    CircularTest,
    Turn,
    least_squares_circle,
    turns_of,
    zone_width,
)

RADIUS = 0.05   # m
COUNT = 3600
EXACT = 1e-12   # m
NOMINAL = Circle(0.0, 0.0, RADIUS)


def angles(turns: float = 1.0, begin: float = 0.0) -> Numbers:
    return begin + 2.0 * math.pi * np.arange(round(COUNT * turns)) / COUNT


def circle(at: Numbers) -> tuple[Numbers, Numbers]:
    return RADIUS * np.cos(at), RADIUS * np.sin(at)


def turn(x: Numbers, y: Numbers, nominal: Circle = NOMINAL) -> Turn:
    (found,) = turns_of(x, y, nominal)
    return found


class TestClosedForms:
    @pytest.mark.parametrize('gain', [1e-6, 1e-4, 1e-2])
    def test_gain_mismatch_is_an_ellipse(self, gain: float) -> None:
        x, y = circle(angles())
        found = turn((1.0 + gain) * x, y)
        assert found.circular_deviation == pytest.approx(gain * RADIUS, abs=EXACT)
        assert found.largest == pytest.approx(gain * RADIUS, abs=EXACT)
        assert found.smallest == pytest.approx(0.0, abs=EXACT)
        mean = 2.0 / math.pi * RADIUS * (1.0 + gain) * ellipe(1.0 - 1.0 / (1.0 + gain)**2)
        assert least_squares_circle(found.x, found.y).radius == pytest.approx(mean, abs=EXACT)

    @pytest.mark.parametrize('out', [1e-6, 1e-4, 1e-2])
    def test_squareness(self, out: float) -> None:
        """The half axes are the singular values of the shear, which differ by `out` radii."""
        extreme = 0.5 * math.atan2(out, 0.5 * out * out)
        x, y = circle(angles(begin=extreme))
        assert zone_width(x, y + out * x) == pytest.approx(out * RADIUS, abs=EXACT)

    @pytest.mark.parametrize('sense', [1, -1])
    @pytest.mark.parametrize('play', [1e-6, 2e-5])
    def test_backlash_of_one_axis(self, play: float, sense: int) -> None:
        """Behind a reversal x rests until its play is taken up; y goes on."""
        taken_up = math.acos(1.0 - play / RADIUS)
        end = 0.5 * play * math.cos(GLITCH_ARC) + math.sqrt(RADIUS**2 - (0.5 * play * math.sin(GLITCH_ARC))**2)
        arc = math.asin(end / RADIUS * math.sin(GLITCH_ARC))   # of the commanded path
        at = np.sort(np.concatenate([angles(), [taken_up, math.pi + taken_up, arc, math.pi + arc]]))
        commanded = RADIUS * np.cos(at)
        away = np.where(at < math.pi, np.minimum(commanded + 0.5 * play, RADIUS - 0.5 * play),
                        np.maximum(commanded - 0.5 * play, 0.5 * play - RADIUS))
        found = turn(away, sense * RADIUS * np.sin(at))
        high = math.sqrt(RADIUS**2 + RADIUS * play - 0.75 * play**2)
        low = RADIUS - 0.5 * play
        assert found.sense == sense
        assert found.circular_deviation == pytest.approx(high - low, abs=EXACT)
        assert found.largest == pytest.approx(high - RADIUS, abs=EXACT)
        assert found.smallest == pytest.approx(low - RADIUS, abs=EXACT)
        assert found.glitches == pytest.approx({'+x': high - end, '-x': high - end, '+y': 0.0, '-y': 0.0}, abs=EXACT)
        other = turn(away, -sense * RADIUS * np.sin(at))
        test = CircularTest(NOMINAL, (found, other))
        assert test.bidirectional_circular_deviation == pytest.approx(high - low, abs=EXACT)

    def test_an_eccentric_circle_deviates_from_its_nominal_one_only(self) -> None:
        x, y = circle(angles())
        found = turn(x + 3e-6, y - 4e-6)
        assert found.circular_deviation == pytest.approx(0.0, abs=EXACT)
        assert found.largest == pytest.approx(5e-6, abs=1e-11)   # between two points
        assert least_squares_circle(found.x, found.y) == pytest.approx((3e-6, -4e-6, RADIUS), abs=EXACT)

    def test_circles_of_other_sizes_in_either_sense(self) -> None:
        x, y = circle(angles())
        turns = turn(1.0001 * x, 1.0001 * y), turn(0.9999 * x, -0.9999 * y)
        test = CircularTest(NOMINAL, turns)
        assert test.is_bidirectional
        assert [one.circular_deviation for one in turns] == pytest.approx([0.0, 0.0], abs=EXACT)
        assert test.bidirectional_circular_deviation == pytest.approx(2e-4 * RADIUS, abs=EXACT)
        assert test.mean_radial_deviation == pytest.approx(0.0, abs=EXACT)
        grown = CircularTest(Circle(0.0, 0.0, RADIUS - 1e-5), turns)
        assert grown.mean_radial_deviation == pytest.approx(1e-5, abs=EXACT)

    @pytest.mark.parametrize('lobes', [2, 3, 5, 8])
    def test_lobes_and_an_eccentricity_that_hides_them(self, lobes: int) -> None:
        at = angles()
        size = RADIUS + 2e-6 * np.cos(lobes * at)
        x, y = size * np.cos(at) + 1e-4, size * np.sin(at) + 2e-4
        assert zone_width(x, y) == pytest.approx(4e-6, abs=EXACT)


@pytest.mark.parametrize('seed', [0, 1, 2])
def test_the_zone_is_the_narrowest_of_any_centre(seed: int) -> None:
    """As a search from several starts finds it; the centre of the least squares has a wider one."""
    random = np.random.default_rng(seed)
    at = 2.0 * math.pi * np.arange(40) / 40
    size = RADIUS + 1e-5 * random.standard_normal(40)
    x, y = size * np.cos(at), size * np.sin(at)

    def width(centre: Numbers) -> float:
        return 1e5 * float(np.ptp(np.hypot(x - 1e-5 * centre[0], y - 1e-5 * centre[1])))

    options = {'xatol': 1e-12, 'fatol': 1e-13, 'maxiter': 4000}
    searched = min(minimize(width, 0.3 * random.standard_normal(2), method='Nelder-Mead', options=options).fun
                   for _ in range(8))
    assert zone_width(x, y) == pytest.approx(1e-5 * searched, abs=EXACT)
    middle = least_squares_circle(x, y)
    assert zone_width(x, y) < 0.99 * float(np.ptp(np.hypot(x - middle.x, y - middle.y)))


class TestGlitches:
    @pytest.mark.parametrize('height', [3e-6, -2e-6])
    @pytest.mark.parametrize('sense', [1, -1])
    @pytest.mark.parametrize(('number', 'quadrant'), [*enumerate(QUADRANTS)])
    def test_a_spike_behind_one_crossing(self, number: int, quadrant: str, sense: int, height: float) -> None:
        at = angles(2.0)
        after = (at - 0.5 * math.pi * (number if sense > 0 else -number)) % (2.0 * math.pi)
        size = RADIUS + height * np.maximum(1.0 - np.abs(after / math.radians(5.0) - 1.0), 0.0)
        found = turn(size * np.cos(at), sense * size * np.sin(at))
        expected = dict.fromkeys(QUADRANTS, 0.0) | {quadrant: height}
        assert found.glitches == pytest.approx(expected, abs=EXACT)

    def test_the_last_crossing_counts(self) -> None:
        at = angles(3.0)
        size = RADIUS + np.where(at < 4.0 * math.pi, 1e-5, 1e-6) * np.exp(-(np.degrees(at) % 360.0 - 5.0)**2)
        found = turn(size * np.cos(at), size * np.sin(at))
        assert found.glitches['+x'] == pytest.approx(1e-6, abs=1e-15)


class TestTurns:
    def test_both_senses_of_one_path(self) -> None:
        at = np.concatenate([angles(1.4), angles(1.4)[::-1]])
        turns = turns_of(*circle(at), NOMINAL)
        assert [one.sense for one in turns] == [1, -1]
        for one in turns:
            assert len(one.x) == COUNT
            assert all(before < after for before, after in pairwise(one.angle.tolist()))

    def test_less_than_a_turn_is_none(self) -> None:
        assert turns_of(*circle(angles(0.9)), NOMINAL) == []
        assert turns_of(np.zeros(9), np.zeros(9), NOMINAL) == []

    def test_a_run_in_from_the_centre_is_no_part_of_it(self) -> None:
        x, y = circle(angles(1.2))
        found = turn(np.concatenate([np.linspace(0.0, RADIUS, 50), x]), np.concatenate([np.zeros(50), y]))
        assert (found.largest, found.smallest) == pytest.approx((0.0, 0.0), abs=EXACT)
