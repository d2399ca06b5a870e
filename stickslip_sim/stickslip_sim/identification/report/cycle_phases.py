# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where in its cycle a reading stands: a share of the time from one measured break-away to the next."""

import math

import numpy as np

from ...core.arrays import Numbers
from ..identified import Identification


def measured_break_aways(found: Identification) -> Numbers:
    """Return the times of the measured break-aways, s."""
    return np.array([slip.time for slip in found.slips if math.isfinite(slip.time)], dtype=np.float64)


def phases(found: Identification, times: Numbers) -> Numbers:
    """Return the share of the cycle at each time (n,), NaN before the first break-away and after the last."""
    begins = measured_break_aways(found)
    shares = np.full(len(times), np.nan)
    if len(begins) > 1:
        cycle = np.searchsorted(begins, times, side='right') - 1
        inside = (cycle >= 0) & (cycle < len(begins) - 1)
        begin, end = begins[cycle[inside]], begins[cycle[inside] + 1]
        shares[inside] = (times[inside] - begin) / (end - begin)
    return shares


def slip_share(found: Identification) -> float:
    """Return the share of a cycle after which its slip has ended, in the median; 0 where it is not known."""
    begins = measured_break_aways(found)
    sticks = np.array([slip.stick_time for slip in found.slips if math.isfinite(slip.time)], dtype=np.float64)[1:]
    periods = np.diff(begins)
    known = np.isfinite(sticks) & (sticks < periods)
    return float(np.median(1.0 - sticks[known] / periods[known])) if known.any() else 0.0


def usual_cycles(found: Identification, count: int = 2) -> tuple[float, float]:
    """Return from when to when some cycles are that take as long as most do, s; without cycles the last tenth."""
    times, begins = found.channels[0].times, measured_break_aways(found)
    lengths = begins[count:] - begins[:-count]
    if not len(lengths):
        return float(times[-1] - 0.1 * (times[-1] - times[0])), float(times[-1])
    usual = int(np.abs(lengths - np.median(lengths)).argmin())
    margin = 0.05 * lengths[usual]
    return (max(float(begins[usual] - margin), float(times[0])),
            min(float(begins[usual + count] + margin), float(times[-1])))
