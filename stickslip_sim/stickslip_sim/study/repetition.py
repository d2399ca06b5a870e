# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Whether rounds of stick-slip repeat: each the one before, or a group of them the group before.

A round is known by its stick time, its period, and drive force and speed at the break-away that ends it; the last two
and the friction law decide all that follows.  A group of n rounds repeats when every one of the rounds that are judged
is the one n before it to REPEATED, and in the later half of them the differences have come down to what rounding
leaves (_STILL).  Small alone is not enough: just beyond the border at which a cycle vanishes, rounds change ever less
for thousands of times, as if they settled, and then leave.
"""

import numpy as np

from .figures import LEAST_STICK, Flags, Numbers

REPEATED = 1e-6      # of what each number is compared with
_STILL = 1e-11       # of the period, for stick times, and of the same for the others
_TURNS = 3           # so often a group has to be there
_LONGEST = 16        # rounds in a group


def group_size(window: Numbers, judged: Numbers, force: Numbers) -> Numbers:
    """Return of how many rounds the shortest group is that repeats, 0 without one.

    `window` has the latest rounds of each axis, as `batch.Rounds`; so many of them as `judged` says count, and `force`
    (N) is what drive forces are compared with.
    """
    kept = window.shape[1]
    sizes = _sizes(window, force)
    scaled, still = window / sizes, window / np.concatenate([sizes[:, :, 1:2], sizes[:, :, 1:]], axis=2)
    known = np.arange(kept) >= kept - judged[:, None]
    found: Numbers = np.zeros(len(window))
    for size in range(min(_LONGEST, kept // _TURNS), 0, -1):
        counted = known[:, :-size]   # the earlier of the two
        order = np.cumsum(counted, axis=1)
        late = counted & (2 * order > order[:, -1:])
        repeats = _agree(scaled, size, counted, REPEATED) & _agree(still, size, late, _STILL)
        found = np.where(repeats & (judged >= _TURNS * size), float(size), found)
    return found


def ends_alike(before: Numbers, now: Numbers, size: Numbers, force: Numbers) -> Flags:
    """Return whether the last round of `before` is one of the last group of `now`; both are windows."""
    kept = now.shape[1]
    sizes = _sizes(now, force)
    changes = np.abs((now - before[:, -1:]) / sizes).max(axis=2)
    alike: Flags = ((np.arange(kept) >= kept - size[:, None]) & (changes <= REPEATED)).any(axis=1)
    return alike


def _sizes(window: Numbers, force: Numbers) -> Numbers:
    """Return what the numbers of each axis are compared with, so that a short stick counts, but not a mere touch."""
    stick, period, _, speed = np.moveaxis(window[:, -1:], 2, 0)
    least = np.finfo(float).tiny
    sizes = (np.maximum(stick, LEAST_STICK * period), period, np.broadcast_to(force[:, None], stick.shape),
             np.abs(speed))
    found: Numbers = np.maximum(np.nan_to_num(np.stack(sizes, axis=2)), least)
    return found


def _agree(scaled: Numbers, size: int, counted: Flags, tolerance: float) -> Flags:
    """Return whether all rounds that count are the ones `size` later."""
    changes = np.abs(scaled[:, size:] - scaled[:, :-size]).max(axis=2)
    agree: Flags = ~(counted & ~(changes <= tolerance)).any(axis=1)
    return agree
