# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How late steps began, in figures."""

from array import array

import numpy as np


class Lateness:
    """Takes the lateness of each step, ns; `overruns` are those that began more than a period late."""

    def __init__(self) -> None:
        self.overruns = 0
        self._taken = array('q')

    def add(self, lateness: int) -> None:
        """Take that of a step."""
        self._taken.append(lateness)

    def figures(self) -> dict[str, float]:
        """Return the figures, s."""
        levels = np.percentile(self._taken, (50, 99, 100)) * 1e-9
        return {'lateness_p50': float(levels[0]), 'lateness_p99': float(levels[1]), 'lateness_max': float(levels[2]),
                'overruns': self.overruns / len(self._taken)}
