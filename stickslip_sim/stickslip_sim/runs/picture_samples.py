# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""When to sample a simulated run for its picture: so that no line shows the rate, however long the run is.

Where a picture has room for every slip, each stretch between two events is sampled densest after its start, where a
compliant contact rings.  Where it has not, it is made of bands: one cycle in each part of it is sampled so.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.time_grid import Instants
from ..core.types import Event, EventKind, Sample
from ..scene import Scene
from .normal_force import normal_force_of
from .run import Columns
from .simulated import columns_of_rows

_IN_STRETCH = 32     # samples between two events
_IN_BAND = 20        # where only the least and the most of a cycle are seen
_MOST = 6000         # stretches that are all sampled
_PARTS = 480         # of a window with more: two for each place that a picture has
_EVEN = 6000         # samples of a window beside those
_IN_PERIOD = 16      # of them at least in a period of a sinusoid, or none is met at the same phases throughout
_GOLDEN = 0.618033988749895   # its multiples are nowhere even


def sampled(scene: Scene, events: Sequence[Event], windows: Iterable[tuple[float, float]]) -> Columns:
    """Return samples of a run of a scene, whose events are known, for a picture of some windows (s) of it."""
    times = np.array([event.time for event in events], dtype=np.float64)
    breaks = np.array([event.time for event in events if event.kind == EventKind.BREAKAWAY], dtype=np.float64)
    fastest = max((one.frequency for profile in scene.inputs for one in profile.sinusoids), default=0.0)
    instants = np.unique(np.concatenate([part for begin, end in windows for part in (
        _evenly(fastest, begin, end), _by_events(times, breaks, begin, end))]))
    seconds = np.floor(instants)
    rows = np.empty((len(instants), len(Sample._fields)))
    scene.make_rig().take_samples(Instants(seconds, instants - seconds), rows)
    return {**columns_of_rows(rows), **normal_force_of(scene, instants)}


def _evenly(fastest: float, begin: float, end: float) -> Numbers:
    """Return times in a window, s, even ones where they resolve the fastest sinusoid (Hz)."""
    places = np.arange(_EVEN, dtype=np.float64)
    if fastest * (end - begin) * _IN_PERIOD > _EVEN:
        places += _GOLDEN * places % 1.0
    return np.append(begin + places * ((end - begin) / _EVEN), end)


def _by_events(events: Numbers, breaks: Numbers, begin: float, end: float) -> Numbers:
    """Return times in a window, s, that show what happens between its events."""
    inside = events[(events > begin) & (events < end)]
    starts, ends = np.append(begin, inside), np.append(inside, end)
    count = _IN_STRETCH
    if len(inside) > _MOST:
        chosen = _one_cycle_in_each(breaks, starts, begin, end)
        starts, ends, count = starts[chosen], ends[chosen], _IN_BAND
    share = np.linspace(0.0, 1.0, count, endpoint=False) ** 2
    return np.asarray((starts[:, None] + (ends - starts)[:, None] * share).ravel(), dtype=np.float64)


def _one_cycle_in_each(breaks: Numbers, starts: Numbers, begin: float, end: float) -> NDArray[np.bool_]:
    """Return which stretches, by their starts, belong to the first whole cycle in one of the parts of a window."""
    edges = np.linspace(begin, end, _PARTS + 1)
    chosen = np.zeros(len(starts), dtype=np.bool_)
    first = np.searchsorted(breaks, edges[:-1])
    for k, last in zip(first.tolist(), np.searchsorted(breaks, edges[1:]).tolist()):
        if last - k > 1:
            chosen[np.searchsorted(starts, breaks[k]):np.searchsorted(starts, breaks[k + 1])] = True
    return chosen
