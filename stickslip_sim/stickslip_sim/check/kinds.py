# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What can be limited: every figure with its unit and what a limit on it must say."""

from collections.abc import Callable
from dataclasses import dataclass

from ..scene import Parameter
from . import measures
from .measures import LimitMeasure

FARTHEST = 1e12   # m, like the positions of a scene
TIMING_LIMIT = 'timing'

TARGET = Parameter('target', 'double', None, 'm', 'where the slider is to go', low=-FARTHEST, high=FARTHEST)
_BAND = Parameter('band', 'double', None, 'm', 'either side of the target', low=0.0, low_open=True, high=FARTHEST)
_CYCLES = Parameter('cycles', 'integer', 1, '', 'at the end of the window', low=1, high=1e6)


@dataclass(frozen=True)
class Kind:
    """A figure; `measure` makes what measures it of a part of a run and the values of `settings` by name."""

    name: str
    unit: str
    measure: Callable[..., LimitMeasure]
    settings: tuple[Parameter, ...] = ()

    @property
    def maximum(self) -> Parameter:
        """What a limit may be."""
        whole = not self.unit
        return Parameter('max', 'integer' if whole else 'double', None, self.unit, 'largest value that passes', low=0.0,
                         high=1e9 if whole else FARTHEST, required=True)


KINDS = {kind.name: kind for kind in (
    Kind('following_error', 'm', measures.FollowingError),
    Kind('end_position_error', 'm', measures.EndPositionError, (TARGET,)),
    Kind('overshoot', 'm', measures.Overshoot, (TARGET,)),
    Kind('settling_time', 's', measures.SettlingTime, (TARGET, _BAND)),
    Kind('sticks', '', measures.Sticks),
    Kind('longest_stick', 's', measures.LongestStick),
    Kind('limit_cycle_amplitude', 'm', measures.LimitCycleAmplitude, (_CYCLES,)),
    Kind('peak_speed', 'm/s', measures.PeakSpeed),
)}
