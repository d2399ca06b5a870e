# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where the machine, or who commanded, was late in a run of the node: what looks like a bad controller and is none."""

from collections.abc import Iterable, Mapping

import numpy as np

from ..core.arrays import Columns, Numbers
from ..simulation.step_result import Mark

_USUAL = 5.0      # median intervals: longer is a gap between commands
_FEWEST = 20      # intervals of which one is usual
_LONGEST = 100_000   # steps: longer ones count as that
LATE_FIELDS = 'step', 'steps', 'lateness_max', 'overruns'


def late_marks(timing: Mapping[str, Numbers], rate: float, limit: float) -> list[Mark]:
    """Return the windows of the timing reports (LATE_FIELDS) in which a step was later than a limit, s."""
    late = timing['lateness_max'] > limit
    if not late.any():
        return []
    label = f'late ≤ {1e3 * timing["lateness_max"][late].max():.3g} ms'
    return [Mark(max(step - steps, 0.0) / rate, step / rate, label, int(overruns), is_of_host=True)
            for step, steps, overruns in zip(*(timing[name][late].astype(np.float64).tolist()
                                               for name in ('step', 'steps', 'overruns')))]


def gap_marks(blocks: Iterable[Columns], rate: float, limit: float) -> list[Mark]:
    """Return where no command came for longer than a limit (s) and several times as long as is usual in the run.

    Their times (s) come in blocks.
    """
    latest: Numbers = np.empty(0)
    counts = np.zeros(_LONGEST + 1, dtype=np.int64)   # of intervals, by their steps
    longer: list[tuple[float, float]] = []
    for block in blocks:
        times = np.append(latest, block['time'])
        latest, intervals = times[-1:], np.diff(times)
        counts += np.bincount(np.rint(np.minimum(intervals * rate, _LONGEST)).astype(np.int64), minlength=_LONGEST + 1)
        places = np.flatnonzero(intervals > limit)
        longer += zip(times[places].tolist(), times[places + 1].tolist())
    if counts.sum() < _FEWEST:
        return []
    usual = int(np.searchsorted(np.cumsum(counts), 0.5 * counts.sum())) / rate
    gaps = [(begin, end) for begin, end in longer if end - begin > _USUAL * usual]
    longest = max((end - begin for begin, end in gaps), default=0.0)
    return [Mark(begin, end, f'gaps ≤ {1e3 * longest:.3g} ms', is_of_host=True) for begin, end in gaps]
