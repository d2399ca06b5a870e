# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of control engineering and ISO 230-2, of a motion that comes block by block; formulas in docs/check.md.

The slider is known at the samples and, exactly, at the transitions: extremes of its motion in slip are transitions
themselves.  The drive is known at the samples.

Each figure is a generator that is sent the blocks of a span, and then None; what it returns is what they came to.
"""

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from ..core.arrays import Flags, Numbers, rows_between
from ..core.errors import InputError
from ..core.types import Event, EventKind, Mode, tuple_of
from .cycles import cycle_figures, mode_spans
from .positioning import Approaches, PositionFigures, position_figures, positioning_figures

_INSTANT = 1e-9    # s, that a time of a step may be off by rounding


class Points(NamedTuple):
    """The slider at the samples and at the transitions, in the order of time."""

    time: Numbers       # s
    position: Numbers   # m
    velocity: Numbers   # m/s


class MotionBlock(NamedTuple):
    """Some of the samples, one after the other; `points` are those and the transitions among them and before."""

    time: Numbers        # s, rising
    position: Numbers    # m, slider
    commanded: Numbers   # m, the drive or a reference
    has_moved: Flags     # whether that moved since the sample before
    way: Numbers         # in which sense it moved last: 1, -1, or 0 where it never did
    command: Numbers     # m/s, velocity of the drive
    rate: Numbers        # m/s², its change since the sample before
    points: Points

    @property
    def following_error(self) -> Numbers:
        """Commanded less actual position at the samples, m."""
        return self.commanded - self.position

    def cut(self, begin: float, end: float) -> 'MotionBlock':
        """Return the part from `begin` to `end` (s), both included."""
        of_samples, of_points = (rows_between(time, begin, end) for time in (self.time, self.points.time))
        return tuple_of(MotionBlock, (*(column[of_samples] for column in self[:-1]),
                                      Points(*(column[of_points] for column in self.points))))


@dataclass(frozen=True)
class MotionSpan:
    """The transitions of the axis from `begin` to `end` (s); `mode` holds from `begin` until the first of them."""

    begin: float
    end: float
    mode: Mode
    events: Sequence[Event]  # without those of kind knot

    def cut(self, begin: float, end: float) -> 'MotionSpan':
        """Return the part from `begin` to `end` (s), both included."""
        before = [event for event in self.events if event.time < begin]
        return MotionSpan(begin, end, before[-1].mode if before else self.mode,
                          [event for event in self.events if begin <= event.time <= end])


class MeasuredFigure(NamedTuple):
    """A figure, inf when its event never came; `remark` says what it was taken from."""

    value: float
    remark: str = ''


Found = TypeVar('Found')
Blocks = Generator[None, MotionBlock | None, Found]
Figure = Blocks[MeasuredFigure]
Column = Callable[[MotionBlock], tuple[Numbers, Numbers]]    # of a block, with its times


class Measuring(Generic[Found]):
    """A figure that is being measured."""

    def __init__(self, blocks: Blocks[Found]) -> None:
        self._blocks = blocks
        next(blocks)

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        self._blocks.send(block)

    def result(self) -> Any:
        """Return what all blocks came to."""
        try:
            self._blocks.send(None)
        except StopIteration as end:
            return end.value


def held(marks: Flags, values: Numbers, before: float) -> Numbers:
    """Return in each row the value of the latest marked one, `before` in front of the first."""
    rows = np.maximum.accumulate(np.where(marks, np.arange(len(marks)), -1))
    return np.where(rows < 0, before, values[rows])


def no_sample_in(begin: float, end: float) -> InputError:
    """Return what is said of a part of a run (s) in which there is no sample."""
    return InputError('window', [begin, end], 'long enough for one sample', 'make it longer')


class _Largest:
    """The largest of values, and when it came first; NaN once one of them is unknown."""

    def __init__(self) -> None:
        self.value, self.time = -math.inf, math.nan

    def take(self, values: Numbers, times: Numbers) -> None:
        if not len(values) or math.isnan(self.value):
            return
        if not (largest := float(values.max())) <= self.value:
            self.value, self.time = largest, float(times[values.argmax()])

    @property
    def figure(self) -> MeasuredFigure:
        """With the time."""
        return MeasuredFigure(self.value, f'at t = {self.time:.6g} s')


def largest(span: MotionSpan, column: Column) -> Figure:
    """Return the largest value in a column, with its time."""
    found = _Largest()
    while block := (yield):
        if len(block.points.time):
            found.take(*column(block))
    return found.figure


def largest_size(span: MotionSpan, column: Column) -> Figure:
    """Return the largest size in a column, with its time."""
    def sizes(block: MotionBlock) -> tuple[Numbers, Numbers]:
        values, times = column(block)
        return np.abs(values), times
    return largest(span, sizes)


def errors_to(commanded: Numbers, position: Numbers) -> list[float]:
    """Return the largest and the RMS size of the error of positions that are all there, m."""
    error = np.abs(position - commanded)
    return [float(error.max()), math.sqrt(float(np.mean(error * error)))]


def root_mean_square(span: MotionSpan, column: Column) -> Figure:
    """Return the root of the mean square of a column over the samples."""
    square, count = 0.0, 0
    while block := (yield):
        values, _ = column(block)
        square, count = square + float(values @ values), count + len(values)
    return MeasuredFigure(float(f'{math.sqrt(square / count):.13g}'))   # behind are digits of how the blocks were cut


def end_deviation(span: MotionSpan, target: float) -> Figure:
    """Actual position less target at the end, m: the positional deviation of ISO 230-2."""
    last = math.nan
    while block := (yield):
        if len(block.points.position):
            last = float(block.points.position[-1])
    return MeasuredFigure(last - target)


def end_position_error(span: MotionSpan, target: float) -> Figure:
    """Return the size of the deviation at the end, m."""
    value, _ = yield from end_deviation(span, target)
    return MeasuredFigure(abs(value))


def overshoot(span: MotionSpan, target: float) -> Figure:
    """Return how far the slider goes beyond the target in the sense of its motion, m; 0 when it does not.

    Raises InputError without a move: there is no sense then.
    """
    move, both = math.nan, {sense: _Largest() for sense in (-1.0, 1.0)}   # an event may come before the first sample
    while block := (yield):
        if math.isnan(move) and len(block.position):
            move = target - float(block.position[0])
        for sense, found in both.items():
            found.take(sense * (block.points.position - target), block.points.time)
    if move == 0.0:
        raise InputError('target', target, f'another place than that of the slider at t = {span.begin:g} s',
                         'let the window begin before the move')
    beyond = both[math.copysign(1.0, move)]
    return beyond.figure if not beyond.value <= 0.0 else MeasuredFigure(0.0, 'the target is not passed')


def settling_time(span: MotionSpan, target: float, band: float) -> Figure:
    """Return how long after the start the slider comes within ± `band` of the target to stay, s; inf if it does not."""
    is_unknown = False
    outside: Points | None = None   # the last point there, and the one after it once it came
    while block := (yield):
        points = block.points
        if not len(points.time):
            continue
        if outside and len(outside.time) == 1:
            outside = Points(*(np.append(one, column[0]) for one, column in zip(outside, points)))
        distances = np.abs(points.position - target)
        is_unknown |= bool(np.isnan(distances).any())
        rows = np.flatnonzero(distances > band)
        if rows.size:
            outside = Points(*(column[rows[-1]:rows[-1] + 2].copy() for column in points))
    if is_unknown:
        return MeasuredFigure(math.nan)
    if outside is None:
        return MeasuredFigure(0.0, 'never outside the band')
    if len(outside.time) == 1:
        return MeasuredFigure(math.inf, 'outside the band at the end')
    return MeasuredFigure(_crossing(outside, target + math.copysign(band, outside.position[0] - target)) - span.begin)


def _crossing(points: Points, level: float) -> float:
    """Return when the slider crosses a level for the last time between two points.

    In between it moves on the cubic with the positions and velocities at both.
    """
    cubic = CubicHermiteSpline(*points)
    return float(max(cubic.solve(level, extrapolate=False), default=points.time[1]))


def of_events(span: MotionSpan, figure: Callable[[MotionSpan], MeasuredFigure]) -> Figure:
    """Return a figure of the transitions alone."""
    while (yield):
        pass
    return figure(span)


def sticks(span: MotionSpan) -> MeasuredFigure:
    """Return how often the slider came to rest; a contact that yielded and holds again is no new stick."""
    before = [span.mode, *(event.mode for event in span.events)]
    return MeasuredFigure(sum(event.kind == EventKind.STICK and mode != Mode.YIELDING
                              for mode, event in zip(before, span.events)))


def longest_stick(span: MotionSpan) -> MeasuredFigure:
    """Return the longest time without slip, s; only what lies within the window counts."""
    parts = [part for part in mode_spans(span.events, span.begin, span.end, span.mode) if part.mode == Mode.STICK]
    if not parts:
        return MeasuredFigure(0.0, 'no stick')
    longest = max(parts, key=lambda part: part.end - part.begin)
    return MeasuredFigure(longest.end - longest.begin, f'from t = {longest.begin:.6g} s')


def limit_cycle_amplitude(span: MotionSpan, cycles: int) -> Figure:
    """Return the peak-to-peak following error over the last cycles (break-away to break-away), m; 0 without a cycle."""
    found, both = cycle_figures(span.events)[-cycles:], (_Largest(), _Largest())   # of the error, of its opposite
    window = (found[0].begin, found[-1].begin + found[-1].period) if found else (math.nan, math.nan)
    while block := (yield):
        part = block.cut(*window)
        for one, sense in zip(both, (1.0, -1.0)):
            one.take(sense * part.following_error, part.time)
    if not found:
        return MeasuredFigure(0.0, 'no complete cycle')
    highest, lowest = (one.value for one in both)
    if math.isinf(highest):
        raise no_sample_in(*window)
    return MeasuredFigure(highest + lowest, f'over {len(found)} cycle{"s" if len(found) > 1 else ""}')


def velocity_ripple(span: MotionSpan) -> Figure:
    """Return the largest velocity less the smallest, m/s."""
    both = {sense: _Largest() for sense in (-1.0, 1.0)}
    while block := (yield):
        for sense, found in both.items():
            found.take(sense * block.points.velocity, block.points.time)
    return MeasuredFigure(sum(found.value for found in both.values()))


def lowest_speed(span: MotionSpan) -> Figure:
    """Return the smallest speed, m/s."""
    value, remark = yield from largest(span, lambda block: (-np.abs(block.points.velocity), block.points.time))
    return MeasuredFigure(abs(value), remark)


def standstill(span: MotionSpan, speed: float) -> Figure:
    """Return the longest time between samples or transitions with a speed below `speed` (m/s) at them all, s."""
    begin, was_slow = math.nan, False

    def lasting(block: MotionBlock) -> tuple[Numbers, Numbers]:
        nonlocal begin, was_slow
        time, is_slow = block.points.time, np.abs(block.points.velocity) < speed
        since = held(is_slow & ~np.append(was_slow, is_slow[:-1]), time, begin)
        begin, was_slow = float(since[-1]), bool(is_slow[-1])
        return np.where(is_slow, time - since, 0.0), time

    value, remark = yield from largest(span, lasting)
    return MeasuredFigure(value, remark.replace('at', 'until', 1) if value else 'never so slow')


def reversal_spike(span: MotionSpan, within: float) -> Figure:
    """Return the largest size of the following error within some time after the commanded position turns, m."""
    way, latest = 0.0, -math.inf

    def errors(block: MotionBlock) -> tuple[Numbers, Numbers]:
        nonlocal way, latest
        before = np.append(way, block.way[:-1])
        turn = held((block.way != before) & (before != 0.0), block.time, latest)
        if len(turn):
            way, latest = float(block.way[-1]), float(turn[-1])
        return np.where(block.time - turn <= within + _INSTANT, np.abs(block.following_error), 0.0), block.time

    return largest(span, errors)


# Rests of the commanded position.

class _Rest(NamedTuple):
    """A rest, m, after a move in the sense `way`, from `begin` (s) on."""

    begin: float
    commanded: float
    way: float
    figure: Measuring[MeasuredFigure]


Made = Callable[[MotionSpan, float, float], Figure]    # of the span of a rest, where that is, the sense before it


def _rests(span: MotionSpan, dwell: float, made: Made) -> Blocks[list[_Rest]]:
    """Return the rests behind a move that last `dwell` (s) at least."""
    found: list[_Rest] = []
    until = span.begin
    while block := (yield):
        time = block.time
        if not len(time):
            continue
        firsts = np.union1d(0, np.flatnonzero(block.has_moved))
        lasts = np.append(firsts[1:], len(time)) - 1
        looked_at = time[lasts] - time[firsts] >= dwell
        looked_at[[0, -1]] = True        # what began before, and what goes on
        for first, last in zip(firsts[looked_at].tolist(), lasts[looked_at].tolist()):
            if block.has_moved[first] or not found:
                found = _long_ones(found, until, dwell)
                begin, commanded, way = (float(column[first]) for column in (time, block.commanded, block.way))
                found.append(_Rest(begin, commanded, way, Measuring(
                    made(MotionSpan(begin, math.inf, span.mode, ()), commanded, way))))
            until = float(time[last])
            found[-1].figure.take(block.cut(found[-1].begin, until))
    return _long_ones(found, until, dwell)


def _long_ones(rests: list[_Rest], until: float, dwell: float) -> list[_Rest]:
    """Return rests, without the last one where it was too short or is behind no move."""
    return rests if rests and rests[-1].way and until - rests[-1].begin >= dwell else rests[:-1]


def of_rests(span: MotionSpan, dwell: float, made: Made) -> Figure:
    """Return the largest figure of a rest; raises InputError without one."""
    rests = yield from _rests(span, dwell, made)
    if not rests:
        raise InputError('dwell', dwell, 'at most as long as the commanded position rests behind a move',
                         'make it shorter, check a longer run, or give the reference')
    figures = [rest.figure.result().value for rest in rests]
    row = int(np.argmax(figures))
    return MeasuredFigure(figures[row], f'behind move {row + 1} of {len(rests)}, from t = {rests[row].begin:.6g} s')


def beyond_end(span: MotionSpan, target: float, way: float) -> Figure:
    """Return how far the slider is beyond the end of a move in its sense, m."""
    return largest(span, lambda block: (np.maximum(way * (block.points.position - target), 0.0), block.points.time))


def positions_of_targets(span: MotionSpan, targets: Sequence[float], dwell: float, tolerance: float
                         ) -> Blocks[list[PositionFigures]]:
    """Return the figures of ISO 230-2 of each target, from where the slider is at the end of each rest.

    A target is where the commanded position rests after moves from both sides, or one of the `targets` (m), from which
    a rest may be `tolerance` away.  Raises InputError where there is none.
    """
    measured = yield from _rests(span, dwell, lambda rest, *_: end_deviation(rest, 0.0))
    rests = [(rest.commanded, rest.way, rest.figure.result().value) for rest in measured]
    found = []
    for target in targets or _targets_of([commanded for commanded, *_ in rests], tolerance):
        both = [np.array([actual - target for commanded, rest_way, actual in rests
                          if rest_way == way and abs(commanded - target) <= tolerance]) for way in (1, -1)]
        if min(map(len, both)):
            found.append(position_figures(Approaches(target, *both)))
        elif targets:
            raise InputError('targets', target, f'approached from both sides; {len(both[0])} moves ended there '
                             f'from below and {len(both[1])} from above', 'drop it, or give a wider tolerance')
    if not found:
        raise InputError('targets', f'{len(rests)} rests', f'at least one place where the commanded position rests '
                         f'for {dwell:g} s after moves from either side', 'check a longer run, or give '
                         'positioning: {targets: [...]}, a shorter dwell or the reference')
    return found


def positioning(span: MotionSpan, targets: Sequence[float], dwell: float, tolerance: float, name: str) -> Figure:
    """Return a figure of ISO 230-2 by its name, m; raises InputError without approaches from both sides."""
    positions = yield from positions_of_targets(span, targets, dwell, tolerance)
    value = abs(getattr(positioning_figures(positions), name))
    if math.isnan(value) and not any(math.isnan(one.mean) for one in positions):
        raise InputError('targets', len(positions), 'each approached twice or more from either side',
                         'let the run repeat its moves: s takes n - 1')
    return MeasuredFigure(value, f'of {len(positions)} targets')


def _targets_of(places: Sequence[float], tolerance: float) -> list[float]:
    """Return where rests are, those within a tolerance of the one before being one."""
    places = sorted(places)
    return [place for before, place in zip([-math.inf, *places], places) if place - before > tolerance]
