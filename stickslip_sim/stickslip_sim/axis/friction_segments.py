# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Kinetic friction on the segments of the tables: which segment a speed is on, mu_k and psi along it."""

import math

from ..core.hot_path import inlined
from .codes import ACCELERATING
from .layout import Parameters
from .state_record import State


@inlined
def first_segment(p: Parameters, direction: float) -> int:
    """Return the index of the segment of the tables at standstill, for motion in a direction."""
    return int(p.backward_segment) if direction < 0.0 else 0


@inlined
def segment_above(p: Parameters, direction: float, speed: float) -> int:
    """Return the index of the table's segment that goes up from a speed: a breakpoint belongs to the one above it."""
    segment = first_segment(p, direction)
    while p.segments[segment].end <= speed < math.inf:
        segment += 1
    return segment


@inlined
def segment_below(p: Parameters, direction: float, speed: float) -> int:
    """Return the index of the table's segment that goes down from a speed: a breakpoint belongs to the one below it."""
    segment = segment_above(p, direction, speed)
    return segment - 1 if speed > 0.0 and p.segments[segment].speed == speed else segment


@inlined
def breakpoint_speed(p: Parameters, segment: int) -> float:
    """Return the speed at which a segment begins: 0 at standstill."""
    return p.segments[segment].speed


@inlined
def segment_end(p: Parameters, segment: int) -> float:
    """Return the speed of the breakpoint at which a segment ends, infinity for the last one of its direction."""
    return p.segments[segment].end


@inlined
def friction_line(p: Parameters, segment: int, speed: float) -> tuple[float, float, float, float]:
    """Return mu_k, its slope, psi and its slope at `speed` on a segment of the table."""
    beyond = speed - p.segments[segment].speed
    slope, psi_slope = p.segments[segment].slope, p.segments[segment].psi_slope
    return p.segments[segment].friction + slope * beyond, slope, p.segments[segment].psi + psi_slope * beyond, psi_slope


@inlined
def slip_friction(p: Parameters, s: State) -> tuple[float, float]:
    """Return the coefficient of friction on the present branch and segment as a line: at standstill, and its slope."""
    coefficient, slope, psi, psi_slope = friction_line(p, int(s.segment), 0.0)
    if s.mode == ACCELERATING:
        return coefficient + s.excess * psi, slope + s.excess * psi_slope
    return coefficient, slope


@inlined
def kinetic_at_rest(p: Parameters, direction: float) -> float:
    """Return mu_k(0) in a direction."""
    return p.segments[first_segment(p, direction)].friction


@inlined
def has_branches(p: Parameters) -> bool:
    """Whether friction depends on the sign of the acceleration."""
    return p.branches != 0.0
