# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a cycle or a round of stick-slip repeats.  Three meanings, each written once; callers give the tolerance.

* `period_repeats`: a cycle takes as long as the one before.  A summary and a batch ask this, as does the engine.
* `settled_round`: a group of rounds has the periods and the drive forces of the group before.  Sensitivities ask this.
* `group_size`, `ends_alike` and `drifts`: all that decides what follows is as it was, in a window of the latest rounds,
  and stays so.  A study asks this, where many points end in motions of all kinds.

That other starts end in one limit cycle is a distance of cycles (`distance.cycle_difference`).
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..core.arrays import Flags, Numbers
from ..core.types import Event
from ..solvers.exact.many_axes import LEAST_STICK
from .slips import breaks_away, elapsed

_TURNS = 3           # so often a group has to be there
_LONGEST, _MOST_IN_GROUP = 16, 8   # rounds: in a window, and of events


def period_repeats(before: Any, period: Any, tolerance: float) -> Any:
    """Return whether a period differs from the one before by less than `tolerance` of it; numbers or arrays, s."""
    return abs(period - before) < tolerance * period


# Rounds in windows of the latest ones.
#
# A round is known by its stick time, its period, and drive force and speed at the break-away that ends it; the last two
# and the friction law decide all that follows.  Small changes alone are not enough: just beyond the border at which a
# cycle vanishes, rounds change ever less for thousands of times, as if they settled, and then leave.

def group_size(window: Numbers, counts: Numbers, force: Numbers, tolerance: float, still: float) -> Numbers:
    """Return of how many rounds n the shortest group is that repeats, 0 without one.

    Each round is the one n before to `tolerance` of the scale of each number; in the later half of them the
    differences have come down to those of rounding, `still` of the same, and of the period for stick times.

    `window` has the latest rounds of each axis, as `batch.Rounds`; so many of them as `counts` says matter, and `force`
    (N) is the scale of drive forces.
    """
    found: Numbers = np.zeros(len(window))
    some = np.flatnonzero(counts >= _TURNS)
    if not len(some):
        return found
    longest = min(_LONGEST, window.shape[1] // _TURNS)
    ends = window[some, -1 - longest:]   # looked at first: mostly that is enough
    likely = _within(np.abs(ends[:, -1:] - ends[:, -2::-1]) / _sizes(ends, force[some]), tolerance)
    for size in range(1, longest + 1):
        tried = some[likely[:, size - 1] & (counts[some] >= _TURNS * size) & (found[some] == 0.0)]
        if len(tried):
            found[tried[_repeats(window[tried], counts[tried], force[tried], size, tolerance, still)]] = size
    return found


def drifts(window: Numbers, counts: Numbers, force: Numbers, tolerance: float) -> Flags:
    """Return whether rounds are nearly those before them, one by one: an axis that has not settled drifts."""
    counted = (np.arange(window.shape[1]) >= window.shape[1] - counts[:, None])[:, :-1]
    return (counts >= _TURNS) & _agree(window / _sizes(window, force), 1, counted, tolerance)


def _repeats(window: Numbers, counts: Numbers, force: Numbers, size: int, tolerance: float, still: float) -> Flags:
    """Return whether groups of one size repeat."""
    sizes = _sizes(window, force)
    counted = (np.arange(window.shape[1]) >= window.shape[1] - counts[:, None])[:, :-size]   # the earlier of the two
    order = np.cumsum(counted, axis=1)
    late = counted & (2 * order > order[:, -1:])
    by_period = window / np.concatenate([sizes[:, :, 1:2], sizes[:, :, 1:]], axis=2)
    return _agree(window / sizes, size, counted, tolerance) & _agree(by_period, size, late, still)


def ends_alike(before: Numbers, now: Numbers, size: Numbers, force: Numbers, tolerance: float) -> Flags:
    """Return whether the last round of `before` is one of the last group of `now`; both are windows."""
    kept = now.shape[1]
    sizes = _sizes(now, force)
    same = _within(np.abs((now - before[:, -1:]) / sizes), tolerance)
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


# Rounds in the events of a run.

class Settled(NamedTuple):
    """The `number` of a round, from 0, that repeats the one `size` rounds before it."""

    number: int
    size: int


def break_aways(events: Sequence[Event]) -> list[int]:
    """Return the places of the break-aways out of stick; each begins a round, and ends the one before."""
    return [k for k, event in enumerate(events) if breaks_away(event)]


def settled_round(events: Sequence[Event], tolerance: float) -> Settled | None:
    """Return the last round, and after how many it comes again to a relative `tolerance`; None while it does not."""
    def is_close(a: float, b: float) -> bool:
        return abs(a - b) <= tolerance * abs(a)

    places = break_aways(events)
    kept = places[-2 * _MOST_IN_GROUP - 1:]
    ends = [events[place] for place in kept]
    periods = [elapsed(a, b) for a, b in pairwise(ends)]
    for size in range(1, len(periods) // 2 + 1):
        pairs = [(len(periods) - k, len(periods) - k - size) for k in range(1, size + 1)]
        if all(is_close(periods[a], periods[b]) and is_close(ends[a + 1].drive_force, ends[b + 1].drive_force)
               for a, b in pairs):
            return Settled(len(places) - 2, size)
    return None
