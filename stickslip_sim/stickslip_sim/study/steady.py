# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Steady sliding at the speed of the drive, and whether it lasts.

m ẍ = c (s − x) + h (v − ẋ) + F_e − N mu_k(ẋ): disturbances of ẋ = v die out where h + N mu_k′(v) > 0 and grow where it
is negative, at any mass and stiffness.
"""

from collections.abc import Mapping

import numpy as np

from ..axis import Axis
from .point_figures import Numbers


def sliding_slope(axis: Axis, inputs: Mapping[str, Numbers]) -> Numbers:
    """Return h + N mu_k′(|v|), N s/m, for each of `inputs` as of `batch.run_batch`; NaN where the drive rests."""
    damping = inputs.get('drive_damping', np.array(axis.drive_damping))
    normal = inputs.get('normal_force', np.array(axis.normal_force))
    slopes = np.array([*map(axis.friction.kinetic.slope, np.abs(inputs['drive_velocity']).tolist())])
    found: Numbers = np.where(inputs['drive_velocity'] == 0.0, np.nan, damping + normal * slopes)
    return found
