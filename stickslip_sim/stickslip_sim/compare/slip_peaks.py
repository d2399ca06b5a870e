# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The largest acceleration in each slip."""

from collections.abc import Mapping, Sequence

import numpy as np

from ..runs import Run
from .drawn import complete_slips, within
from .run_part import RunPart

SLIP_PEAKS = 'slip peaks'   # the watch


def slip_peaks(part: RunPart) -> dict[float, float]:
    """Return the largest |ẍ| of each complete slip of a part, m/s², by its start, s."""
    return {begin.time: float(np.abs(within(part, begin.time, end.time)['acceleration']).max())
            for begin, end in complete_slips(part.events)}


def peak_accelerations(run: Run, found: Sequence[Mapping[float, float]]) -> list[float]:
    """Return the largest |ẍ| in the slip of each cycle, m/s²."""
    peaks = {begin: peak for each in found for begin, peak in each.items()}
    return [peaks[cycle.begin] for cycle in run.cycles()]
