# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Drive spring and damper from a measured drive force alone: F = c stretch + h (v − ẋ) is linear in both."""

import numpy as np

from ...core.arrays import Numbers
from ..given.measured_inputs import travelled
from ..given.motions import track_of
from ..given.readings import SensorReadings
from ..trial.axis_model import AxisModel

_STIFFNESS, _DAMPING = 'axis.drive_stiffness', 'axis.drive_damping'
_WELL = 0.1    # of a number: its standard deviation, beyond which it is not taken


def direct_drive(model: AxisModel, values: Numbers, measurement: SensorReadings) -> dict[str, float]:
    """Return stiffness and damping of the drive, those that a measured force determines; others are as in `values`.

    Nothing without a measured force, or where the inputs are not known.
    """
    force = measurement.channel('drive_force')
    dynamics = model.dynamics(values)
    if force is None or measurement.channel('position') is None or dynamics is None:
        return {}
    track = track_of(measurement, dynamics.drive)
    offset, scale = model.gain(values, 'position')
    gone = travelled(dynamics.drive, track.times)
    position = (track.position - offset) / scale
    stretch = dynamics.initial.stretch + gone - (position - dynamics.initial.position)
    speed = np.gradient(gone, track.times) - track.velocity / scale
    zero, gain = model.gain(values, 'drive_force')
    measured = np.interp(track.times, measurement.times, force.values) - zero
    slopes = np.stack([gain * stretch, gain * speed, np.ones(len(speed))], axis=1)   # the start may be another one
    found, *_ = np.linalg.lstsq(slopes, measured, rcond=None)
    left = measured - slopes @ found
    errors = np.sqrt(np.diag(np.linalg.pinv(slopes.T @ slopes)) * float(left @ left) / len(left))
    return {name: float(value) for name, value, error in zip((_STIFFNESS, _DAMPING), found, errors)
            if value > 0.0 and error < _WELL * value}
