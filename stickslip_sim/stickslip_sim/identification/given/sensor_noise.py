# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a sensor resolves, estimated from its readings alone, and how much each of them says.

A reading of an encoder that counts in steps q is off by up to q/2.  While the axis rests all its readings are off by
the same: a hundred equal readings in a row say no more than one.  So each of L equal readings in a row weighs 1/L.
"""

import numpy as np

from ...core.arrays import Numbers

_MAD = 1.4826          # standard deviation of a normal distribution over its median absolute deviation
_THIRD = 20.0**0.5     # of a third difference over that of a reading
_GRID = 0.02           # of a step: so far from a whole number of steps readings may be
_SMALLEST = 1e-7       # of the range of the readings: no sensor is taken to be better
SMALLEST_FORCE = 1e-4  # the same of a force: no model of friction follows it more closely


def quantum_of(readings: Numbers) -> float:
    """Return the step in which a sensor counts, in its unit; 0 where it counts in none that shows."""
    steps = np.unique(np.abs(np.diff(readings)))
    steps = steps[steps > 1e-12 * max(float(np.ptp(readings)), 1e-300)]
    if len(steps) < 2:
        return float(steps[0]) if len(steps) else 0.0
    quantum = float(steps[0])
    if steps[-1] / quantum > 1e7:
        return 0.0
    for _ in range(2):   # the least difference of many is rounded; the mean of all is not
        counts = np.rint(steps / quantum)
        quantum = float(np.dot(steps, counts)) / float(np.dot(counts, counts))
    counts = np.rint(steps / quantum)
    small = counts < 1e3
    is_even = bool(np.all(np.abs(steps[small] / quantum - counts[small]) < _GRID))
    return quantum if is_even and int(small.sum()) > 1 else 0.0


def noise_of(readings: Numbers, quantum: float, smallest: float = _SMALLEST) -> float:
    """Return the standard deviation of the noise in readings, that of counting in steps `quantum` included.

    It is at least `smallest`, a share of their range.
    """
    return max(own_noise_of(readings, quantum), smallest * float(np.ptp(readings)))


def own_noise_of(readings: Numbers, quantum: float) -> float:
    """Return the same without a least one for sensors of a wide range."""
    third = np.diff(readings, 3)
    spread: float = _MAD * float(np.median(np.abs(third - np.median(third)))) / _THIRD if len(third) else 0.0
    return max(spread, quantum / float(np.sqrt(12.0)))


def weights_of(readings: Numbers, quantum: float) -> Numbers:
    """Return how much each reading says: 1, or 1/L where L in a row are equal and the sensor counts in steps."""
    if quantum == 0.0:
        return np.ones(len(readings))
    starts = np.flatnonzero(np.diff(readings) != 0.0) + 1
    edges = np.concatenate([[0], starts, [len(readings)]])
    lengths = np.diff(edges)
    return np.repeat(1.0 / lengths, lengths)
