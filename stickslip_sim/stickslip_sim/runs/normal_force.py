# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The normal force on the slideway as a column beside the samples of a run, where it varies."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..scene import Scene
from .run import Columns

LOAD_COLUMN = 'normal_force'


def normal_force_of(scene: Scene, times: NDArray[np.float64]) -> Columns:
    """Return the column of the normal force at times (s), N, as the scene has it; none where it does not vary."""
    return {} if scene.normal_load is None else {LOAD_COLUMN: scene.normal_force.values_at(times)}


def recorded_normal_force(scene: Scene, samples: Columns, is_changed: bool) -> Columns:
    """Return the column of a recorded run, as `normal_force_of`.

    Where a parameter was changed it is friction over its coefficient, NaN where that is 0.
    """
    column = normal_force_of(scene, samples['time'])
    if not column or not is_changed:
        return column
    coefficient: NDArray[Any] = samples['friction_coefficient']
    with np.errstate(all='ignore'):
        ratio = np.abs(samples['friction_force']) / coefficient
    return {LOAD_COLUMN: np.where(coefficient > 0.0, ratio, np.nan)}
