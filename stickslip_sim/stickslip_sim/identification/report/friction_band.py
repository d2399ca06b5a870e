# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction curves of an identified scene, and how well the numbers that were found determine them.

The band is that of the linearised curve: 1.96 √(J C Jᵀ), J its derivatives by what was fitted, C their covariance.
Numbers that the run does not tell are taken as they are.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from ...axis import Friction
from ...core.arrays import Numbers
from ...core.errors import InputError
from ...scene import Scene, scene_from_values
from ...study.variation import changes_at
from ..identified import FOUND, Estimate, Identification
from .identified_scene import OF_SENSORS

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
    ends = [(sign * step, curve(other)) for sign in (1.0, -1.0) if (other := _moved(scene, one, sign * step))]
    if len(ends) < 2:
        ends.append((0.0, curve(scene)))
    (there, value), (here, other_value) = ends[0], ends[-1]
    return np.asarray((value - other_value) / (there - here) * one.standard_deviation if there != here
                      else np.zeros_like(value))


def _moved(scene: Scene, one: Estimate, step: float) -> Scene | None:
    """Return the scene with another value of a number; None where that is none."""
    value = one.value * math.exp(step) if one.logarithmic else one.value + step
    try:
        return scene_from_values({**scene.values, **changes_at(scene.values, [one.name], np.array([value]))})
    except InputError:
        return None
