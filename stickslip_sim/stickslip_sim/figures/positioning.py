# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The positioning test of an axis as ISO 230-2:2014 has it: targets that are approached from both sides.

Standard uncertainties are estimated with n - 1, and count twice (A) and four times (R), as the standard has it.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers


class Approaches(NamedTuple):
    """Where an axis came to rest at a target (m), less the target, from below it and from above it, m."""

    target: float
    forward: Numbers
    backward: Numbers


class PositionFigures(NamedTuple):
    """What the approaches to one target come to, m; s is NaN with a single one."""

    target: float
    mean_forward: float
    mean_backward: float
    s_forward: float
    s_backward: float

    @property
    def mean(self) -> float:
        """Mean bi-directional deviation."""
        return 0.5 * (self.mean_forward + self.mean_backward)

    @property
    def reversal(self) -> float:
        """B_i."""
        return self.mean_forward - self.mean_backward

    @property
    def repeatability(self) -> float:
        """R_i."""
        forward, backward = self.s_forward, self.s_backward
        if math.isnan(forward + backward):
            return math.nan
        return max(2.0 * forward + 2.0 * backward + abs(self.reversal), 4.0 * forward, 4.0 * backward)


class PositioningFigures(NamedTuple):
    """The figures of the axis, m; those with s are NaN unless each target has two approaches from either side."""

    positioning_accuracy: float              # A
    positioning_accuracy_forward: float
    positioning_accuracy_backward: float
    positioning_repeatability: float         # R
    positioning_repeatability_forward: float
    positioning_repeatability_backward: float
    systematic_positioning_error: float      # E
    systematic_positioning_error_forward: float
    systematic_positioning_error_backward: float
    mean_positioning_error: float            # M
    reversal_error: float                    # B
    mean_reversal_error: float


def position_figures(approaches: Approaches) -> PositionFigures:
    """Return the figures of one target with at least one approach from either side."""
    both = approaches.forward, approaches.backward
    return PositionFigures(approaches.target, *(float(np.mean(one)) for one in both),
                           *(float(np.std(one, ddof=1)) if len(one) > 1 else math.nan for one in both))


def positioning_figures(positions: Sequence[PositionFigures]) -> PositioningFigures:
    """Return the figures of an axis from those of its targets, at least one."""
    def span(of: Callable[[float, float], tuple[float, float]], *ways: str) -> float:
        ends = [of(getattr(one, f'mean_{way}'), getattr(one, f's_{way}')) for one in positions for way in ways]
        return float(np.max([high for _, high in ends]) - np.min([low for low, _ in ends]))   # keeps NaN

    def widened(mean: float, s: float) -> tuple[float, float]:
        return mean - 2.0 * s, mean + 2.0 * s

    def plain(mean: float, _: float) -> tuple[float, float]:
        return mean, mean

    ways = ('forward', 'backward'), ('forward',), ('backward',)
    means, reversals = [one.mean for one in positions], [one.reversal for one in positions]
    return PositioningFigures._make((
        *(span(widened, *way) for way in ways),
        *(float(np.max(column)) for column in ([one.repeatability for one in positions],
                                               [4.0 * one.s_forward for one in positions],
                                               [4.0 * one.s_backward for one in positions])),
        *(span(plain, *way) for way in ways),
        max(means) - min(means), max(map(abs, reversals)), sum(reversals) / len(reversals)))
