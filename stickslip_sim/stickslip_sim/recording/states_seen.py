# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the states of a run come to, block by block."""

import math
from collections.abc import Sequence

import numpy as np

from ..runs import Columns


class StatesSeen:
    """Takes the states of a run, with their `time`, `step`, `mode` and the fields that must be finite."""

    def __init__(self, finite: Sequence[str] = ()) -> None:
        self._finite = finite
        self.count = 0
        self.are_finite = self.rise = True
        self.begin = self.end = math.nan    # s, of the first and of the last
        self.mode = 0                       # of the first
        self._steps = 0, 0                  # of the first and of the last

    def take(self, block: Columns) -> None:
        """Take the next states, at least one."""
        time, steps = block['time'], block['step']
        self.are_finite &= all(bool(np.isfinite(block[name]).all()) for name in self._finite)
        if not self.count:
            self.begin, self.mode, self._steps = float(time[0]), int(block['mode'][0]), (int(steps[0]), 0)
        elif not time[0] > self.end:
            self.rise = False
        self.rise &= bool((np.diff(time) > 0.0).all())
        self.end, self._steps = float(time[-1]), (self._steps[0], int(steps[-1]))
        self.count += len(time)

    @property
    def missing_steps(self) -> int:
        """How many steps have no state between the first and the last that has."""
        return self._steps[1] - self._steps[0] + 1 - self.count
