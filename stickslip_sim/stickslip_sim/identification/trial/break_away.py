# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""When a slip begins, and at which drive force: by one rule for what was measured and for what is simulated.

A slip begins without any speed, which no sensor sees, and where bristles bend first it has no beginning at all.  So it
is taken to begin where it is faster than a slider at rest may be, or than a tenth of its peak if that is less.
"""

import numpy as np

from ...core.arrays import Numbers

_SHARE = 0.1        # of the peak of the speed
_REST_PART = 0.15   # of the rest: so much of its end says what the force is in the end
_FEWEST = 6         # readings for that


def begin_of_slip(times: Numbers, speeds: Numbers, still: float) -> float:
    """Return when a slip begins, s: the last of times (n,) before its peak at which it is as slow as at rest."""
    peak = int(speeds.argmax())
    limit = min(still, _SHARE * float(speeds[peak]))
    below = np.flatnonzero(speeds[:peak] < limit)
    if not len(below):
        return float(times[0])
    row = int(below[-1])
    low, high = speeds[row:row + 2].tolist()
    return float(times[row] + (limit - low) / (high - low) * (times[row + 1] - times[row]))


def force_of_slip(times: Numbers, forces: Numbers, begin: float, since: float) -> float:
    """Return the force when a slip begins, after a rest `since` a time (s), by a parabola through those before."""
    last = int(np.searchsorted(times, begin, 'right'))
    first = min(int(np.searchsorted(times, begin - _REST_PART * (begin - since))), last - _FEWEST)
    first = max(first, int(np.searchsorted(times, since)))
    if last - first < _FEWEST:
        return float(np.interp(begin, times, forces))
    at = times[first:last] - begin
    return float(np.polyfit(at / at[0], forces[first:last], 2)[2])
