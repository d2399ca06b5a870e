# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Whether rounds of stick-slip repeat: each the one before, or a group of them the group before.

A round is known by its stick time, its period, and drive force and speed at the break-away that ends it; the last two
and the friction law decide all that follows.  A group of n rounds repeats when every one of the rounds that count
is the one n before it to REPEATED, and in the later half of them the differences have come down to those of rounding
(_STILL).  Small alone is not enough: just beyond the border at which a cycle vanishes, rounds change ever less
for thousands of times, as if they settled, and then leave.
"""

from typing import Any

import numpy as np

from ..core.arrays import Numbers
from .point_figures import LEAST_STICK, Flags

REPEATED = 1e-6      # of the scale of each number
_STILL = 1e-11       # of the period, for stick times, and of the same for the others
_TURNS = 3           # so often a group has to be there
_NEARLY = 1e-2       # the same
_LONGEST = 16        # rounds in a group


def group_size(window: Numbers, counts: Numbers, force: Numbers) -> Numbers:
    """Return of how many rounds the shortest group is that repeats, 0 without one.

    `window` has the latest rounds of each axis, as `batch.Rounds`; so many of them as `counts` says matter, and `force`
    (N) is the scale of drive forces.
    """
    found: Numbers = np.zeros(len(window))
    some = np.flatnonzero(counts >= _TURNS)
    if not len(some):
        return found
    longest = min(_LONGEST, window.shape[1] // _TURNS)
    ends = window[some, -1 - longest:]   # looked at first: mostly that is enough
    likely = _within(np.abs(ends[:, -1:] - ends[:, -2::-1]) / _sizes(ends, force[some]), REPEATED)
    for size in range(1, longest + 1):
        tried = some[likely[:, size - 1] & (counts[some] >= _TURNS * size) & (found[some] == 0.0)]
        if len(tried):
            found[tried[_repeats(window[tried], counts[tried], force[tried], size)]] = size
    return found


def drifts(window: Numbers, counts: Numbers, force: Numbers) -> Flags:
    """Return whether rounds are nearly those before them, one by one: an axis that has not settled drifts."""
    counted = (np.arange(window.shape[1]) >= window.shape[1] - counts[:, None])[:, :-1]
    return (counts >= _TURNS) & _agree(window / _sizes(window, force), 1, counted, _NEARLY)


def _repeats(window: Numbers, counts: Numbers, force: Numbers, size: int) -> Flags:
    """Return whether groups of one size repeat."""
    sizes = _sizes(window, force)
    counted = (np.arange(window.shape[1]) >= window.shape[1] - counts[:, None])[:, :-size]   # the earlier of the two
    order = np.cumsum(counted, axis=1)
    late = counted & (2 * order > order[:, -1:])
    still = window / np.concatenate([sizes[:, :, 1:2], sizes[:, :, 1:]], axis=2)
    return _agree(window / sizes, size, counted, REPEATED) & _agree(still, size, late, _STILL)


def ends_alike(before: Numbers, now: Numbers, size: Numbers, force: Numbers) -> Flags:
    """Return whether the last round of `before` is one of the last group of `now`; both are windows."""
    kept = now.shape[1]
    sizes = _sizes(now, force)
    same = _within(np.abs((now - before[:, -1:]) / sizes), REPEATED)
    alike: Flags = np.any((np.arange(kept) >= kept - size[:, None]) & same, axis=1)
    return alike


def _sizes(window: Numbers, force: Numbers) -> Numbers:
    """Return the scales of the numbers of each axis, so that a short stick counts, but not a mere touch."""
    stick, period, _, speed = np.moveaxis(window[:, -1:], 2, 0)
    least = np.finfo(float).tiny
    sizes = (np.maximum(stick, LEAST_STICK * period), period, np.broadcast_to(force[:, None], stick.shape),
             np.abs(speed))
    found: Numbers = np.maximum(np.nan_to_num(np.stack(sizes, axis=2)), least)
    return found


def _agree(scaled: Numbers, size: int, counted: Flags, tolerance: float) -> Flags:
    """Return whether all rounds that count are the ones `size` later."""
    agree: Flags = np.all(~counted | _within(np.abs(scaled[:, size:] - scaled[:, :-size]), tolerance), axis=1)
    return agree


def _within(changes: Any, tolerance: float) -> Flags:
    """Return whether all four numbers of each round change no more than that."""
    fine = changes <= tolerance
    within: Flags = np.logical_and(np.logical_and(fine[:, :, 0], fine[:, :, 1]),
                                   np.logical_and(fine[:, :, 2], fine[:, :, 3]))
    return within   # numpy's `all` over so short an axis takes five times as long
