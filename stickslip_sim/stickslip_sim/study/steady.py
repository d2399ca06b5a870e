# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Steady sliding at the speed of the drive, and whether it lasts.

m ẍ = c (s − x) + h (v − ẋ) + F_e − N mu_k(ẋ): disturbances of ẋ = v die out where h + N mu_k′(v) > 0 and grow where it
is negative, at any mass and stiffness.

At a breakpoint each swing is half on either side.  With γ = (h + N mu_k′)/2m below and above it, a turn multiplies the
swing by exp(−π γ/√(ω² − γ²)) of both halves: it grows exactly where the two γ have a negative sum, so that their mean
counts.  A side without half swings, |γ| ≥ ω, decides alone.
"""

from collections.abc import Mapping

import numpy as np

from ..axis import Axis
from ..core.arrays import Numbers


def sliding_slope(axis: Axis, inputs: Mapping[str, Numbers]) -> Numbers:
    """Return h + N mu_k′(v), N s/m, for each of `inputs` as of `batch.run_batch`; NaN where the drive rests."""
    def given(name: str) -> Numbers:
        return inputs.get(name, np.array(getattr(axis, name)))

    below, above = np.array([axis.friction.along(v).kinetic.slopes(abs(v))
                             for v in inputs['drive_velocity'].tolist()]).reshape(-1, 2).T
    low, high = (given('drive_damping') + given('normal_force') * side
                 for side in (np.minimum(below, above), np.maximum(below, above)))
    swings = 2.0 * np.sqrt(given('drive_stiffness') * given('mass'))
    found = np.where(low <= -swings, low, np.where(high >= swings, high, 0.5 * (low + high)))
    result: Numbers = np.where(inputs['drive_velocity'] == 0.0, np.nan, found)
    return result
