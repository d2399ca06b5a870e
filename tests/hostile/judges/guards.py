# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every guard between two neighbouring events, sampled densely, and the state at the second of them.

No guard is passed before the next event; the event's guard is met there; the state is where the linear motion ends.
The bounds are those of rounding: of the state that the event reports, carried along the motion, of the parameters, of
times, and of this judge's own arithmetic.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from stickslip_sim.core.types import EventKind, Mode

from ..case import Run
from . import brute
from .motion import EPSILON, MARGIN, Long, Samples, samples
from .nodes import ONE, U, Y, elsewhere, guard_met, impossible, not_met, passed
from .segments import LOWER, UPPER, Segment, limit_along, segments

FEWEST, MOST = 32, 1024  # samples of a segment
_PER_SWING = 24
_AT_ONCE = 6_000         # samples that are worked on together
_TIME = 5e-16            # s, to which an event's time is written down
_CLOSE = 0.05            # of the height between tangents and samples: more than a cubic is off
_FINER, _ZOOMS = 32, 4   # parts of an interval in which a guard has its least value, again and again


class Guards(NamedTuple):
    """Both guards (n, K, 2), their rates, and MARGIN times their rounding."""

    values: Any
    rates: Any
    slack: Any


def judge(runs: Sequence[Run]) -> list[list[str]]:
    """Return for each run what is wrong with it, in the order of time; the brute force follows what is not linear."""
    linear = iter(_judge([run for run in runs if brute.is_linear(run)]))
    return [next(linear) if brute.is_linear(run) else brute.wrong_guards(run) for run in runs]


def _judge(runs: Sequence[Run]) -> list[list[str]]:
    found: list[list[tuple[float, str]]] = [[] for _ in runs]
    groups: dict[tuple[int, int], list[tuple[int, Segment]]] = {}
    for k, run in enumerate(runs):
        for segment in segments(run):
            groups.setdefault((len(segment.start), _count(segment)), []).append((k, segment))
    for (_, count), members in groups.items():
        size = max(_AT_ONCE // count, 1)
        for first in range(0, len(members), size):
            some = members[first:first + size]
            for i, text in _judged([segment for _, segment in some], count):
                found[some[i][0]].append((some[i][1].begin.at.seconds, text))
    return [[text for _, text in sorted(one, key=lambda pair: pair[0])] for one in found]


def _count(segment: Segment) -> int:
    count = FEWEST
    while count < min(_PER_SWING * segment.swings, MOST):
        count *= 2
    return count


def _judged(some: list[Segment], count: int) -> Iterator[tuple[int, str]]:
    start, noise = np.stack([s.start for s in some]), np.stack([s.noise for s in some])
    pace, length = _of(some, 'pace'), _of(some, 'length')
    own = 2e-19 * (64.0 + 8.0 * pace * length)     # of this judge's arithmetic
    path = samples(np.stack([s.rates for s in some]), start, noise + own[:, None] * np.abs(start), length, 3.0 * pace,
                   count)
    with np.errstate(all='ignore'):
        lost = ~(np.isfinite(path.states).all(axis=(1, 2)) & np.isfinite(path.noise).all(axis=(1, 2)))
        path.states[lost], path.rates[lost], path.noise[lost] = 0, 0, np.inf
        noise = _all_noise(some, path, own)
        guards = _guards(some, path.times, path.states, path.rates, noise)
    for i in np.flatnonzero(lost):
        yield int(i), f'the motion from {some[i].begin.label} to {some[i].end.label} leaves the range of numbers'
    yield from _passed(some, path, noise, guards)
    yield from _ends_elsewhere(some, path, noise, guards)
    for i, segment in enumerate(some):
        for text in _wrong_limit(segment):
            yield i, text


def _of(some: list[Segment], name: str) -> Any:
    return np.array([getattr(s, name) for s in some], dtype=Long)


def _all_noise(some: list[Segment], path: Samples, own: Any) -> Any:
    """Return how far rounding may have moved each sample (n, K, d), in the units of the state."""
    times, states = path.times[..., None], path.states
    deviation = np.abs(states)
    deviation[..., [U, Y]] = np.abs(states[..., [U, Y]] - states[:, :1, [U, Y]])
    return (path.noise + _of(some, 'drift')[:, None, None] * times * np.maximum.accumulate(deviation, axis=1)
            + np.abs(path.rates) * (_TIME + 8.0 * EPSILON * times)
            + own[:, None, None] * np.abs(states).max(axis=1, keepdims=True))


def _guards(some: list[Segment], times: Any, states: Any, rates: Any, noise: Any) -> Guards:
    rows = np.stack([s.guards for s in some])
    free = ~np.isfinite(rows[:, :, ONE])
    rows[free] = 0
    turned = rows.transpose(0, 2, 1)
    values, slopes = np.matmul(states, turned), np.matmul(rates, turned)
    slack = MARGIN * (np.matmul(noise, np.abs(turned)) + np.stack([s.slack for s in some])[:, None])
    for i, segment in enumerate(some):
        if segment.begin.mode == Mode.STICK:
            for row, side in ((LOWER, 1.0), (UPPER, -1.0)):
                limit, growth = limit_along(segment, times[i], side)
                values[i, :, row] += limit
                slopes[i, :, row] += growth
                slack[i, :, row] += MARGIN * 4.0 * EPSILON * limit
    values = np.where(free[:, None], Long('inf'), values)
    return Guards(values, np.where(free[:, None], 0, slopes), slack)


def _passed(some: list[Segment], path: Samples, noise: Any, guards: Guards) -> Iterator[tuple[int, str]]:
    over = -guards.values - guards.slack
    worst = np.argmax(over, axis=1)
    for i, row in np.argwhere(over.max(axis=1) > 0):
        at = worst[i, row]
        yield int(i), _text(some[i], row, path.times[i, at], guards.values[i, at, row], guards.slack[i, at, row])
    yield from _dipped(some, path, noise, guards)


def _dipped(some: list[Segment], path: Samples, noise: Any, guards: Guards) -> Iterator[tuple[int, str]]:
    """Look closely where a guard may pass below 0 and come back between two samples."""
    g, rate, bound = guards
    step = (path.times[:, 1:] - path.times[:, :-1])[..., None]
    with np.errstate(all='ignore'):
        dips = (rate[:, :-1] < 0) & (rate[:, 1:] > 0)
        # the tangents at both ends meet below the least value
        share = (g[:, 1:] - g[:, :-1] - rate[:, 1:] * step) / ((rate[:, :-1] - rate[:, 1:]) * step)
        floor = g[:, :-1] + rate[:, :-1] * step * np.clip(share, 0, 1)
        # and the cubic through them is near it, as the samples lie close
        room = _CLOSE * (np.minimum(g[:, :-1], g[:, 1:]) - floor)
        low = _cubic_least(g[:, :-1], g[:, 1:], rate[:, :-1] * step, rate[:, 1:] * step)
        places = np.argwhere(dips & (floor < -np.maximum(bound[:, :-1], bound[:, 1:])) & (low < room)
                             & (g[:, :-1] >= -bound[:, :-1]))
    for i, k, row in places:
        lowest = _lowest(some[i], path.states[i, k], path.times[i, k], step[i, k, 0],
                         np.maximum(noise[i, k], noise[i, k + 1]), row)
        if lowest is not None:
            yield int(i), _text(some[i], row, *lowest)


def _cubic_least(g0: Any, g1: Any, d0: Any, d1: Any) -> Any:
    """Return the least value on [0, 1] of the cubic with these values and slopes at its ends, falling, then rising."""
    a, b = d0 + d1 - 2 * (g1 - g0), 3 * (g1 - g0) - 2 * d0 - d1
    root = np.sqrt(np.maximum(b * b - 3 * a * d0, 0))
    at = np.clip(-d0 / (b + np.where(root > 0, root, 1)), 0, 1)     # of the two zeros of the slope the minimum
    return np.minimum(g0 + at * (d0 + at * (b + at * a)), np.minimum(g0, g1))


def _lowest(segment: Segment, state: Any, begin: Any, length: Any, noise: Any, row: int) -> tuple[Any, Any, Any] | None:
    """Return time, value and bound of a guard where it is passed, within `length` from a state on; or None."""
    for _ in range(_ZOOMS):
        fine = samples(segment.rates[None], state[None], noise[None], length[None],
                       np.array([3.0 * segment.pace], dtype=Long), _FINER)
        times = fine.times + begin
        values, _, slack = _guards([segment], times, fine.states, fine.rates,
                                   np.broadcast_to(noise, fine.states.shape))
        g, bound = values[0, :, row], slack[0, :, row]
        least = int(np.argmin(g))
        if -g[least] > bound[least]:
            return times[0, least], g[least], bound[least]
        before, after = max(least - 1, 0), min(least + 1, len(g) - 1)
        state, begin, length = fine.states[0, before], times[0, before], times[0, after] - times[0, before]
    return None


def _ends_elsewhere(some: list[Segment], path: Samples, noise: Any, guards: Guards) -> Iterator[tuple[int, str]]:
    rows = np.stack([s.outputs for s in some])
    ends = np.matmul(rows, path.states[:, -1, :, None])[..., 0]
    moved = np.matmul(np.abs(rows), noise[:, -1, :, None])[..., 0]
    wanted = np.stack([s.wanted for s in some])
    bound = MARGIN * (moved + np.stack([s.spread for s in some]))
    for i, k in np.argwhere(np.abs(ends - wanted) > bound):
        segment = some[i]
        if k == 2 and (segment.end.event is None or segment.end.new_force):
            continue
        yield int(i), elsewhere(segment.begin, segment.end, _OUTPUTS[k], float(wanted[i, k]), float(ends[i, k]),
                                float(bound[i, k]))
    for i, segment in enumerate(some):
        if segment.end.event is not None and not segment.end.new_force:
            for text in _missed_guard(segment, guards.values[i, -1], guards.slack[i, -1]):
                yield i, text


def _missed_guard(segment: Segment, values: Any, slack: Any) -> Iterable[str]:
    begin, end = segment.begin, segment.end
    assert end.event is not None
    row = guard_met(begin.mode, end.event.kind)
    met = [] if row is None else [row]
    if begin.mode == Mode.STICK and end.event.kind == EventKind.BREAKAWAY:
        met = [LOWER, UPPER]
    if not met:
        yield impossible(begin, end)
    elif not min(abs(values[row]) - slack[row] for row in met) <= 0:
        yield not_met(begin, end, float(values[met[0]]), float(slack[met[0]]))


_OUTPUTS = 'velocity', 'travel', 'drive force'


def _text(segment: Segment, row: int, time: Any, value: Any, bound: Any) -> str:
    return passed(segment.begin, segment.end, row, float(-value), float(bound), float(time),
                  float(segment.length - time))


def _wrong_limit(segment: Segment) -> Iterable[str]:
    event = segment.end.event
    if event is None or event.kind != EventKind.BREAKAWAY or segment.end.new_force:
        return
    side = math.copysign(1.0, event.friction_force)   # also of a limit of 0
    limit, growth = limit_along(segment, np.array([segment.length], dtype=Long), side)
    normal = Long(segment.axis.normal_force)
    off = abs(Long(event.static_coefficient) * normal - limit[0])
    delay = segment.axis.friction.static.delay   # which what a rest time is beyond it has the rounding of
    if off > 1e-12 * abs(limit[0]) + (MARGIN * _TIME + 8.0 * EPSILON * delay) * growth[0]:
        yield f'mu_s at {segment.end.label} is {event.static_coefficient!r} and not {float(limit[0] / normal)!r}'
