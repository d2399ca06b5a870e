# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Static friction from the measured break-aways alone: the force that each one took, over the normal force."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...core.arrays import Numbers
from ..given.measured_inputs import travelled
from ..given.readings import SensorReadings
from ..trial.axis_model import AxisModel
from ..trial.slip_features import MeasuredSlip, rest_force

_SHARE = 0.02   # of a coefficient: so well it is known


class MeasuredBreakAway(NamedTuple):
    """A measured break-away: the `rest` before it, s, the `coefficient` of friction, and whether it is forwards."""

    rest: float
    coefficient: float
    forwards: bool


def friction_at_break_aways(model: AxisModel, values: Numbers, measurement: SensorReadings,
                            slips: Sequence[MeasuredSlip]) -> list[MeasuredBreakAway]:
    """Return the break-aways of slips, of which the force was measured or follows from the stretch of the spring.

    A coefficient below 0 is that of no break-away: with these values the force is against the motion.
    """
    dynamics = model.dynamics(values)
    if dynamics is None:
        return []
    initial, axis = dynamics.initial, dynamics.axis
    zero, gain = model.gain(values, 'drive_force')
    offset, scale = model.gain(values, 'position')
    found = []
    for slip in slips:
        begin, direction = slip.motion.begin, slip.motion.direction
        rest = begin - slip.rest_begin + (initial.rest_time if slip.before is None else 0.0)
        force = (rest_force(measurement, begin, slip.rest_begin, begin) - zero) / gain
        if np.isnan(force):
            gone = float(travelled(dynamics.drive, np.array([begin]))[0])
            stretch = initial.stretch + gone - ((slip.motion.start - offset) / scale - initial.position)
            force = axis.drive_stiffness * stretch + axis.drive_damping * dynamics.drive.value_at(begin)
        normal = axis.normal_force + (dynamics.load.value_at(begin) if dynamics.load else 0.0)
        coefficient = direction * (force + dynamics.force.value_at(begin)) / normal
        found.append(MeasuredBreakAway(rest, coefficient, direction > 0.0))
    return found


def static_residuals(model: AxisModel, measured: Sequence[MeasuredBreakAway], values: Numbers) -> Numbers:
    """Return by how much measured coefficients are larger than those of the law with trial values, in what is known."""
    dynamics = model.dynamics(values)
    if dynamics is None:
        return np.full(len(measured), np.nan)
    friction = dynamics.axis.friction
    sides = {True: friction.static, False: (friction.backward or friction).static}
    fitted = np.array([sides[one.forwards].coefficient(one.rest) for one in measured])
    right = np.array([one.coefficient for one in measured])
    return np.asarray((right - fitted) / (_SHARE * np.maximum(np.abs(right), _SHARE * fitted)))
