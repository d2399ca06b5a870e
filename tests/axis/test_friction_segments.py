# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""mu_k and psi are linear between breakpoints, mu_k goes on with its last slope, and each direction has its tables."""

from dataclasses import replace

import pytest

from stickslip_sim.axis.codes import ACCELERATING, DECELERATING
from stickslip_sim.axis.friction_segments import (
    breakpoint_speed,
    friction_line,
    has_branches,
    kinetic_at_rest,
    segment_above,
    segment_below,
    segment_end,
    slip_friction,
)
from stickslip_sim.friction import ExcessTable
from tests.support.plain_axes import CONVENTIONAL, FRICTION, SIDED, parameters, slip

# speed in m/s, mu_k, psi: by hand from the tables of `plain_axes`
FORWARDS = [(0.0, 0.25, 1.0), (0.125, 0.1875, 0.75), (0.25, 0.125, 0.5), (0.375, 0.09375, 0.25), (0.5, 0.0625, 0.0),
            (0.75, 0.0625 + 0.5 * 0.25, 0.0)]
BACKWARDS = [(0.0, 0.125, 1.0), (0.0625, 0.078125, 0.5), (0.125, 0.03125, 0.0), (1.0, 0.03125, 0.0)]


@pytest.mark.parametrize(('direction', 'speed', 'coefficient', 'psi'),
                         [*((1.0, *row) for row in FORWARDS), *((-1.0, *row) for row in BACKWARDS)])
def test_the_line_through_a_speed_is_that_of_the_tables(direction: float, speed: float, coefficient: float, psi: float
                                                        ) -> None:
    """Of the segment above and of the one below alike: both meet at a breakpoint."""
    p = parameters(friction=SIDED)
    for segment in (segment_above(p, direction, speed), segment_below(p, direction, speed)):
        found, _, share, _ = friction_line(p, segment, speed)
        assert (found, share) == (coefficient, psi)
        assert breakpoint_speed(p, segment) <= speed <= segment_end(p, segment)


def test_a_breakpoint_parts_the_segments() -> None:
    p = parameters()
    above, below = segment_above(p, 1.0, 0.25), segment_below(p, 1.0, 0.25)
    assert (breakpoint_speed(p, above), segment_end(p, below)) == (0.25, 0.25)
    assert [friction_line(p, segment, 0.25)[1::2] for segment in (below, above)] == [(-0.5, -2.0), (-0.25, -2.0)]
    assert segment_below(p, 1.0, 0.0) == segment_above(p, 1.0, 0.0)
    assert segment_below(p, 1.0, 0.3) == segment_above(p, 1.0, 0.3) == above


def test_both_directions_have_one_table_unless_they_differ() -> None:
    p = parameters()
    assert [segment_above(p, -1.0, speed) for speed, *_ in FORWARDS] == [segment_above(p, 1.0, speed)
                                                                         for speed, *_ in FORWARDS]
    assert (kinetic_at_rest(p, 1.0), kinetic_at_rest(p, -1.0)) == (0.25, 0.25)
    p = parameters(friction=SIDED)
    assert [kinetic_at_rest(p, direction) for direction in (1.0, 0.0, -1.0)] == [0.25, 0.25, 0.125]


@pytest.mark.parametrize(('mode', 'at_rest', 'slope'), [(DECELERATING, 0.25, -0.5),
                                                        (ACCELERATING, 0.25 + 0.125, -0.5 - 0.125 * 2.0)])
def test_the_branch_of_a_slip_is_a_line(mode: float, at_rest: float, slope: float) -> None:
    """mu_k on the lower branch, mu_k + E psi on the upper one."""
    p = parameters()
    assert slip_friction(p, slip(p, mode, 0.125, excess=0.125)) == (at_rest, slope)


def test_the_excess_has_breakpoints_of_its_own() -> None:
    """psi falls to a quarter at 0.25 m/s, so that its line from there begins at 0.5; mu_k + E psi, E = 0.5."""
    p = parameters(friction=replace(FRICTION, excess=ExcessTable((0.0, 0.25, 0.5), (1.0, 0.25, 0.0))))
    assert slip_friction(p, slip(p, ACCELERATING, 0.375, excess=0.5)) == (0.1875 + 0.5 * 0.5, -0.25 - 0.5 * 1.0)


def test_the_conventional_friction_has_one_branch() -> None:
    assert has_branches(parameters())
    assert not has_branches(parameters(friction=CONVENTIONAL))
