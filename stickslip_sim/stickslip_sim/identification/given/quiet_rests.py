# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The measured force on a slider, with less of the sensor's noise in it while the slider rests.

In a simulation, noise makes the slider break away early: at the first reading above static friction, before the force
itself gets there.  At rest the force moves nothing, so smoothing it there changes only the moment of the break-away.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...core.arrays import Numbers
from .input_readings import LINE, InputReadings
from .motions import MeasuredMotion
from .readings import SensorReadings
from .sensor_noise import noise_of, quantum_of

_LENGTHS = 5, 9, 17, 33, 65   # readings in a parabola: the longest one that follows the force is taken
_CHANCE = 4.0   # standard deviations of a mean square: residuals of a parabola up to that are noise


def with_quiet_rests(measurement: SensorReadings, motions: Sequence[MeasuredMotion]) -> SensorReadings:
    """Return the measurement with its force smoothed while the slider rests; `force_readings` stay as they are.

    Each rest is taken to last until the slider has gone a tenth of its next motion: smoothing does no harm there, and
    the `begin` of a motion may come before the break-away.
    """
    readings = measurement.force_readings
    if readings is None or not motions:
        return measurement
    times = measurement.times
    ends = [times[0], *(motion.end for motion in motions)]
    begins = [*(motion.passed[0] for motion in motions), times[-1]]
    at_rest = np.any([(times >= end) & (times <= begin) for end, begin in zip(ends, begins, strict=True)], axis=0)
    values = np.where(at_rest, _smoothed(readings.values), readings.values)
    return replace(measurement, force=InputReadings(times, values, LINE).profile())


def _smoothed(values: Numbers) -> Numbers:
    """Return readings (n,) smoothed by parabolas, each as long as it follows them, so that a step stays a step."""
    from scipy.ndimage import uniform_filter1d  # both take a while, and only a measured force needs them
    from scipy.signal import savgol_filter

    variance, found = noise_of(values, quantum_of(values))**2, values
    for length in (length for length in _LENGTHS if length < len(values)):
        smooth = savgol_filter(values, length, 2)
        left = uniform_filter1d((values - smooth)**2, length)
        found = np.where(left <= (1.0 + _CHANCE * (2.0 / length)**0.5) * variance, smooth, found)
    return np.asarray(found)
