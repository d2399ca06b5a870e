# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction that was identified, beside what was measured, as a report shows it."""

import math

import numpy as np

from ...core.arrays import Numbers
from ...plots.known_friction import Band, Bins, KnownFriction, Scatter
from ...runs import Run
from ..identified import Identification
from .friction_band import accelerating_of, half_width, kinetic_of, static_of
from .measured_friction import binned, friction_points, loads_at

_CURVE = 160          # points of a curve
_BEYOND = 1.15        # of the fastest reading, and of the longest rest
_TIME_CONSTANTS = 5.0
_SECOND = 1.0         # s, of static friction that does not grow


def known_friction(run: Run, found: Identification) -> dict[str, KnownFriction]:
    """Return what is known of friction by directions: one without a name where both have the same."""
    if len(found.scene.axis.friction.sides) == 1:
        return {'': _in_direction(run, found, 0.0)}
    return {'forward': _in_direction(run, found, 1.0), 'backward': _in_direction(run, found, -1.0)}


def _in_direction(run: Run, found: Identification, direction: float) -> KnownFriction:
    """Return both curves with their bands, those of the scene to start with, and what was measured."""
    points = friction_points(run, found, direction)
    fastest = float(points.speeds.max(initial=0.0)) or _fastest(run)
    speeds = np.linspace(0.0, _BEYOND * fastest, _CURVE, dtype=np.float64)
    rests, forces = _break_aways(found, direction)
    times = np.linspace(0.0, _longest(found, rests), _CURVE, dtype=np.float64)
    kinetic, static = kinetic_of(speeds, direction), static_of(times, direction)
    return KnownFriction(
        Band(speeds, kinetic(found.scene), half_width(found, kinetic)),
        _accelerating(found, speeds, rests, direction),
        Scatter(speeds, kinetic(found.start)), Scatter(*points), Bins(*binned(points)),
        Band(times, static(found.scene), half_width(found, static)), Scatter(times, static(found.start)),
        Scatter(rests, forces))


def _accelerating(found: Identification, speeds: Numbers, rests: Numbers, direction: float) -> Band | None:
    if found.scene.axis.friction.excess is None:
        return None
    curve = accelerating_of(speeds, float(np.median(rests)) if len(rests) else math.inf, direction)
    return Band(speeds, curve(found.scene), half_width(found, curve))


def _fastest(run: Run) -> float:
    velocity = run.samples['velocity']
    return float(np.nanmax(np.abs(velocity), initial=0.0)) or 1.0


def _break_aways(found: Identification, direction: float) -> tuple[Numbers, Numbers]:
    """Return times at rest and coefficients of the measured break-aways, of a direction, that have both."""
    slips = [slip for slip in found.slips if math.isfinite(slip.stick_time) and math.isfinite(slip.break_away_force)
             and slip.break_away_force * direction >= 0.0]
    loads = loads_at(found, np.array([slip.time for slip in slips], dtype=np.float64))
    rows = [(slip.stick_time, abs(slip.break_away_force) / load) for slip, load in zip(slips, loads) if load > 0.0]
    rests, forces = np.array(rows, dtype=np.float64).reshape(-1, 2).T
    return rests, forces


def _longest(found: Identification, rests: Numbers) -> float:
    law = found.scene.axis.friction.static
    return max(_TIME_CONSTANTS * law.time_constant, _BEYOND * float(rests.max(initial=0.0))) or _SECOND
