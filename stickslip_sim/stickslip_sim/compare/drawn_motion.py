# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of a run as it is drawn."""

from collections.abc import Iterable

import numpy as np

from ..plots.paper_panels import DrawnMotion, DrawnSpan
from ..runs import Columns, Run
from .drawn import in_order
from .look import look_at
from .windows import drawn_stretches


def drawn_motion(run: Run) -> DrawnMotion:
    """Return what is drawn of a run: its first cycles, its last complete slip, its last complete cycle."""
    stretches, seen = drawn_stretches(run), look_at(run)
    columns = in_order(_of_stretches(seen.before, stretches.all), seen.drawn)
    return DrawnMotion(columns, *stretches, seen.ranges)


def _of_stretches(before: Columns, stretches: Iterable[DrawnSpan]) -> Columns:
    """Return the states before events in stretches, with one more on either side."""
    time = before['time']
    chosen = np.zeros(len(time), dtype=np.bool_)
    for begin, end in stretches:
        chosen[max(int(np.searchsorted(time, begin, 'right')) - 1, 0):int(np.searchsorted(time, end)) + 1] = True
    return {name: column[chosen] for name, column in before.items()}
