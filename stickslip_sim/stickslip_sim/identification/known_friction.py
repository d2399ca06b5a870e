# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction that was identified, beside what was measured, as a report shows it."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from ..axis import Friction
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..plots.characteristics import Band, Bins, KnownFriction, Scatter
from ..runs import Run
from ..scene import Scene
from ..study.points import scene_at
from .identified import FOUND, Estimate, Identification, moved
from .identified_scene import OF_SENSORS
from .measured_friction import binned, friction_points, loads_at

# The friction curves of an identified scene, and how well the numbers that were found determine them.
#
# The band is that of the linearised curve: 1.96 √(J C Jᵀ), J its derivatives by what was fitted, C their covariance.
# Numbers that the run does not tell are taken as they are.

FrictionCurveOf = Callable[[Scene], Numbers]

_STEP = 0.05        # of a standard deviation
_QUANTILE = 1.959963984540054
_LIMITED = 0.2      # of the value: beyond, a step of a logarithm is no small one


def half_width(found: Identification, curve: FrictionCurveOf) -> Numbers:
    """Return half the width of the 95 % band of a curve that a scene has; 0 where nothing that was found moves it.

    NaN of a model that a test rejects, of whose error nothing is known.
    """
    if not found.fits:
        return np.full_like(curve(found.scene), np.nan)
    free = [k for k, one in enumerate(found.estimates) if _is_known(one)]
    if not free:
        return np.zeros_like(curve(found.scene))
    slopes = np.stack([_slope(found.scene, found.estimates[k], curve) for k in free], axis=-1)
    inner = np.asarray(found.correlation)[np.ix_(free, free)]
    inner = np.where(np.isfinite(inner), inner, np.eye(len(free)))
    return np.asarray(_QUANTILE * np.sqrt(np.maximum(np.einsum('ij,jk,ik->i', slopes, inner, slopes), 0.0)))


def kinetic_of(speeds: Numbers, direction: float = 1.0) -> FrictionCurveOf:
    """Return the curve of kinetic friction over speeds, m/s, in a direction."""
    return lambda scene: np.array([scene.axis.friction.along(direction).kinetic.coefficient(speed)
                                   for speed in speeds.tolist()])


def accelerating_of(speeds: Numbers, rest_time: float, direction: float = 1.0) -> FrictionCurveOf:
    """Return the accelerating branch over speeds, m/s, of a slip after a time at rest, s, in a direction."""
    def curve(scene: Scene) -> Numbers:
        friction = scene.axis.friction.along(direction)
        excess = friction.static.coefficient(rest_time) - friction.kinetic.coefficient(0.0)
        return kinetic_of(speeds, direction)(scene) + max(excess, 0.0) * _shape(friction, speeds.tolist())
    return curve


def static_of(rest_times: Numbers, direction: float = 1.0) -> FrictionCurveOf:
    """Return the curve of static friction over times at rest, s, against a force in a direction."""
    return lambda scene: np.array([scene.axis.friction.along(direction).static.coefficient(time)
                                   for time in rest_times.tolist()])


def _shape(friction: Friction, speeds: Sequence[float]) -> Numbers:
    if friction.excess is None:
        return np.zeros(len(speeds))
    return np.array([friction.excess.fraction(speed) for speed in speeds])


def _is_known(one: Estimate) -> bool:
    return (one.kind == FOUND and not one.name.startswith(OF_SENSORS) and one.name.startswith('friction.')
            and 0.0 < one.standard_deviation < math.inf)


def _slope(scene: Scene, one: Estimate, curve: FrictionCurveOf) -> Numbers:
    """Return the derivative of a curve by a number, times its standard deviation; one-sided at the end of a range."""
    step = _STEP * one.standard_deviation
    if one.logarithmic:
        step = min(step, _LIMITED)
    ends = [(sign * step, curve(other)) for sign in (1.0, -1.0) if (other := _scene_with(scene, one, sign * step))]
    if len(ends) < 2:
        ends.append((0.0, curve(scene)))
    (there, value), (here, other_value) = ends[0], ends[-1]
    return np.asarray((value - other_value) / (there - here) * one.standard_deviation if there != here
                      else np.zeros_like(value))


def _scene_with(scene: Scene, one: Estimate, step: float) -> Scene | None:
    """Return the scene with another value of a number; None where that is none."""
    try:
        return scene_at(scene.values, [one.name], np.array([moved(one, step)]))
    except InputError:
        return None


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
