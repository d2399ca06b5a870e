# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The figures that limits are set for, as control engineering and ISO 230 have them; formulas in docs/check.md.

The slider is known at the samples and, exactly, at the transitions: extremes of its motion in slip are transitions
themselves.  The drive is known at the samples.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.types import EventKind, Mode
from ..figures.catalogue import unit_of
from ..figures.circular import SENSES, CircularTest, Turn
from ..figures.cycles import cycle_figures, mode_spans
from ..figures.positioning import (
    Approaches,
    PositionFigures,
    PositioningFigures,
    position_figures,
    positioning_figures,
)
from ..scene import Parameter
from .observed_run import MotionBlock, MotionSpan, Points


class MeasuredFigure(NamedTuple):
    """A figure, inf when its event never came; `remark` says what it was taken from."""

    value: float
    remark: str = ''


class LimitMeasure:
    """Measures a figure in a part of a run; takes the motion there block by block."""

    def __init__(self, span: MotionSpan) -> None:
        self.span = span

    def take(self, block: MotionBlock) -> None:
        """Take the next block; a figure of transitions needs none."""

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        raise NotImplementedError


class _Largest:
    """The largest of values, and when it came first; NaN once one of them is unknown."""

    def __init__(self) -> None:
        self.value, self.time = -math.inf, math.nan

    def take(self, values: Numbers, times: Numbers) -> None:
        """Take the next values, at their times (s)."""
        if not len(values) or math.isnan(self.value):
            return
        if not (largest := float(values.max())) <= self.value:
            self.value, self.time = largest, float(times[values.argmax()])

    @property
    def figure(self) -> MeasuredFigure:
        """With the time."""
        return MeasuredFigure(self.value, f'at t = {self.time:.6g} s')


class LargestSize(LimitMeasure):
    """The largest size in a column of a block, which `column` returns with its times."""

    def __init__(self, span: MotionSpan, column: Callable[[MotionBlock], tuple[Numbers, Numbers]]) -> None:
        super().__init__(span)
        self._column, self._largest = column, _Largest()

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        values, times = self._column(block)
        self._largest.take(np.abs(values), times)

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        return self._largest.figure


class EndPositionError(LimitMeasure):
    """|Actual position − target| at the end, m: the positional deviation of ISO 230-2."""

    def __init__(self, span: MotionSpan, target: float) -> None:
        super().__init__(span)
        self._target, self._last = target, math.nan

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        if len(block.points.position):
            self._last = float(block.points.position[-1])

    @property
    def deviation(self) -> float:
        """With its sign, m."""
        return self._last - self._target

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        return MeasuredFigure(abs(self.deviation))


class Overshoot(LimitMeasure):
    """How far the slider goes beyond the target in the sense of its motion, m; 0 when it does not."""

    def __init__(self, span: MotionSpan, target: float) -> None:
        super().__init__(span)
        self._target, self._move = target, math.nan
        self._both = {sense: _Largest() for sense in (-1.0, 1.0)}   # an event may come before the first sample

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        if math.isnan(self._move) and len(block.position):
            self._move = self._target - float(block.position[0])
        for sense, largest in self._both.items():
            largest.take(sense * (block.points.position - self._target), block.points.time)

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to; raises InputError without a move: there is no sense then."""
        if self._move == 0.0:
            raise InputError('target', self._target,
                             f'another place than that of the slider at t = {self.span.begin:g} s',
                             'let the window begin before the move')
        beyond = self._both[math.copysign(1.0, self._move)]
        return beyond.figure if not beyond.value <= 0.0 else MeasuredFigure(0.0, 'the target is not passed')


class SettlingTime(LimitMeasure):
    """How long after the start the slider comes within ± `band` of the target to stay, s; inf if it does not."""

    def __init__(self, span: MotionSpan, target: float, band: float) -> None:
        super().__init__(span)
        self._target, self._band, self._is_unknown = target, band, False
        self._outside: Points | None = None   # the last point there, and the one after it once it came

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        points = block.points
        if not len(points.time):
            return
        if self._outside and len(self._outside.time) == 1:
            self._outside = Points(*(np.append(one, column[0]) for one, column in zip(self._outside, points)))
        distances = np.abs(points.position - self._target)
        self._is_unknown |= bool(np.isnan(distances).any())
        outside = np.flatnonzero(distances > self._band)
        if outside.size:
            last = int(outside[-1])
            self._outside = Points(*(column[last:last + 2].copy() for column in points))

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        if self._is_unknown:
            return MeasuredFigure(math.nan)
        if self._outside is None:
            return MeasuredFigure(0.0, 'never outside the band')
        if len(self._outside.time) == 1:
            return MeasuredFigure(math.inf, 'outside the band at the end')
        edge = self._target + math.copysign(self._band, self._outside.position[0] - self._target)
        return MeasuredFigure(_crossing(self._outside, edge) - self.span.begin)


class Sticks(LimitMeasure):
    """How often the slider came to rest; a contact that yielded and holds again is no new stick."""

    def figure(self) -> MeasuredFigure:
        """Count them."""
        events = self.span.events
        before = [self.span.mode, *(event.mode for event in events)]
        return MeasuredFigure(sum(event.kind == EventKind.STICK and mode != Mode.YIELDING
                                  for mode, event in zip(before, events)))


class LongestStick(LimitMeasure):
    """The longest time without slip, s; only what lies within the window counts."""

    def figure(self) -> MeasuredFigure:
        """Find it."""
        spans = [span for span in mode_spans(self.span.events, self.span.begin, self.span.end, self.span.mode)
                 if span.mode == Mode.STICK]
        if not spans:
            return MeasuredFigure(0.0, 'no stick')
        longest = max(spans, key=lambda span: span.end - span.begin)
        return MeasuredFigure(longest.end - longest.begin, f'from t = {longest.begin:.6g} s')


class LimitCycleAmplitude(LimitMeasure):
    """The peak-to-peak following error over the last cycles (break-away to break-away), m; 0 without a cycle."""

    def __init__(self, span: MotionSpan, cycles: int) -> None:
        super().__init__(span)
        self._cycles = cycle_figures(span.events)[-cycles:]
        self._both = _Largest(), _Largest()   # of the error, and of its opposite
        if self._cycles:
            last = self._cycles[-1]
            self._window = self._cycles[0].begin, last.begin + last.period

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        if self._cycles:
            part = block.cut(*self._window)
            for largest, sense in zip(self._both, (1.0, -1.0)):
                largest.take(sense * part.following_error, part.time)

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to; raises InputError when no sample fell into the cycles."""
        if not self._cycles:
            return MeasuredFigure(0.0, 'no complete cycle')
        highest, lowest = (largest.value for largest in self._both)
        if math.isinf(highest):
            raise no_sample_in(*self._window)
        count = len(self._cycles)
        return MeasuredFigure(highest + lowest, f'over {count} cycle{"s" if count > 1 else ""}')


class _Between:
    """Joins each block of samples to the last sample of the one before, so that nothing between two is lost."""

    def __init__(self) -> None:
        self._last: tuple[Numbers, ...] = ()

    def joined(self, *columns: Numbers) -> tuple[Numbers, ...]:
        """Return columns of a block behind the last row of those before."""
        if self._last:
            columns = tuple(np.append(last, column) for last, column in zip(self._last, columns))
        if len(columns[0]):
            self._last = tuple(column[-1:] for column in columns)
        return columns


class RootMeanSquare(LimitMeasure):
    """The root of the mean square over time of a column, which is linear between the samples."""

    def __init__(self, span: MotionSpan, column: Callable[[MotionBlock], Numbers]) -> None:
        super().__init__(span)
        self._column, self._between, self._square, self._time = column, _Between(), 0.0, 0.0
        self._single = math.nan     # of one sample, if no other comes

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        time, values = self._between.joined(block.time, self._column(block))
        if len(time):
            self._single = float(values[0])
        lengths, low, high = np.diff(time), values[:-1], values[1:]
        self._square += float((lengths * (low * low + low * high + high * high)).sum()) / 3.0
        self._time += float(lengths.sum())

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        return MeasuredFigure(math.sqrt(self._square / self._time) if self._time else abs(self._single))


class CommandRate(LimitMeasure):
    """The largest rate of the drive velocity between two samples, m/s²; or, with `rms`, that of all of them."""

    def __init__(self, span: MotionSpan, rms: bool) -> None:
        super().__init__(span)
        self._between, self._largest, self._square, self._time = _Between(), _Largest(), 0.0, 0.0
        self._is_rms = rms

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        time, command = self._between.joined(block.time, block.command)
        lengths = np.diff(time)
        rates = np.diff(command) / lengths
        self._largest.take(np.abs(rates), time[1:])
        self._square, self._time = self._square + float((rates**2 * lengths).sum()), self._time + float(lengths.sum())

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        if not self._time:
            return MeasuredFigure(0.0, 'a single state')
        return MeasuredFigure(math.sqrt(self._square / self._time)) if self._is_rms else self._largest.figure


class SpeedRange(LimitMeasure):
    """The largest less the smallest velocity, m/s; or, with `lowest`, the smallest speed."""

    def __init__(self, span: MotionSpan, lowest: bool) -> None:
        super().__init__(span)
        self._is_lowest, self._highest, self._least = lowest, _Largest(), _Largest()

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        velocity = np.abs(block.points.velocity) if self._is_lowest else block.points.velocity
        self._highest.take(velocity, block.points.time)
        self._least.take(-velocity, block.points.time)

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        if self._is_lowest:
            return MeasuredFigure(-self._least.value + 0.0, self._least.figure.remark)
        return MeasuredFigure(self._highest.value + self._least.value)


class Standstill(LimitMeasure):
    """The longest time in which the slider is slower than `speed` (m/s), s; velocities are linear between points."""

    def __init__(self, span: MotionSpan, speed: float) -> None:
        super().__init__(span)
        self._speed, self._between = speed, _Between()
        self._since, self._longest = math.nan, (0.0, math.nan)   # s: length and begin

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        is_first = math.isnan(self._longest[1])
        time, velocity = self._between.joined(block.points.time, np.abs(block.points.velocity))
        if not len(time):
            return
        if is_first:
            self._longest = 0.0, float(time[0])
            self._since = float(time[0]) if velocity[0] < self._speed else math.nan
        slow = velocity < self._speed
        for row in np.flatnonzero(slow[1:] != slow[:-1]).tolist():
            share = (self._speed - velocity[row]) / (velocity[row + 1] - velocity[row])
            at = float(time[row] + share * (time[row + 1] - time[row]))
            if slow[row]:
                self._end(at)
            self._since = math.nan if slow[row] else at
        if slow[-1]:
            self._end(float(time[-1]))

    def _end(self, time: float) -> None:
        self._longest = max(self._longest, (time - self._since, self._since))

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        length, begin = self._longest
        return MeasuredFigure(length, f'from t = {begin:.6g} s' if length else 'never so slow')


class ReversalSpike(LimitMeasure):
    """The largest size of the following error within some time after the commanded position turns, m."""

    def __init__(self, span: MotionSpan, within: float) -> None:
        super().__init__(span)
        self._within, self._between, self._largest = within, _Between(), _Largest()
        self._way, self._until, self._turns = 0.0, -math.inf, 0

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        time, commanded, error = self._between.joined(block.time, block.commanded, block.following_error)
        steps = np.diff(commanded)
        moves = np.flatnonzero(np.abs(steps) > _STANDS)
        ways = np.append(self._way, np.sign(steps[moves]))
        turned = moves[(ways[1:] != ways[:-1]) & (ways[:-1] != 0.0)]
        begins = time[turned]     # the last sample before it goes the other way
        counts = np.zeros(len(time), dtype=np.bool_)
        counts[:int(np.searchsorted(time, self._until, 'right'))] = True
        for begin in begins.tolist():
            counts[slice(*np.searchsorted(time, [begin, begin + self._within + _INSTANT]))] = True
            self._until = begin + self._within + _INSTANT
        self._way, self._turns = float(ways[-1]), self._turns + len(begins)
        self._largest.take(np.abs(error[counts]), time[counts])

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        if not self._turns:
            return MeasuredFigure(0.0, 'no turn')
        return MeasuredFigure(self._largest.value, f'{self._largest.figure.remark}, of {self._turns} turns')


class _Beyond(LimitMeasure):
    """How far the slider is beyond a target in the sense of the move to it, m."""

    def __init__(self, span: MotionSpan, target: float, way: int) -> None:
        super().__init__(span)
        self._target, self._way, self._largest = target, way, _Largest()

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        self._largest.take(self._way * (block.points.position - self._target), block.points.time)

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        return MeasuredFigure(max(self._largest.value, 0.0))


class RestPart(NamedTuple):
    """A part of a rest of the commanded position; `way` the move before went: 1 up, -1 down, 0 where none was seen."""

    begin: float         # s, of the rest
    end: float           # s, of the part
    commanded: float     # m
    way: int
    is_over: bool
    block: MotionBlock


class _Rests:
    """Finds the rests of the commanded position that last at least `dwell` (s), while blocks come."""

    def __init__(self, span: MotionSpan, dwell: float) -> None:
        self._dwell, self._begin, self._way = dwell, span.begin, 0
        self._last: tuple[float, float] | tuple[()] = ()   # time and commanded position

    def parts(self, block: MotionBlock) -> Iterator[RestPart]:
        """Yield the rests in a block; the last of them may be over soon, or too short."""
        time, commanded = block.time, block.commanded
        if not len(time):
            return
        if self._last:
            time, commanded = np.append(self._last[0], time), np.append(self._last[1], commanded)
        steps = np.diff(commanded)
        moves = np.flatnonzero(np.abs(steps) > _STANDS)
        begins = np.append(self._begin, time[moves + 1])
        ways = np.append(self._way, np.sign(steps[moves]).astype(int))
        rows = np.append(moves, len(time) - 1)
        long = time[rows] - begins >= self._dwell
        long[[0, -1]] = True      # what began before, and what goes on
        for rest in np.flatnonzero(long).tolist():
            begin, end, row = float(begins[rest]), float(time[rows[rest]]), int(rows[rest])
            yield RestPart(begin, end, float(commanded[row]), int(ways[rest]), rest < len(moves), block.cut(begin, end))
        self._begin, self._way, self._last = float(begins[-1]), int(ways[-1]), (float(time[-1]), float(commanded[-1]))


class OfRests(LimitMeasure):
    """Measures each rest of the commanded position by itself, as `make` says; the largest counts."""

    def __init__(self, span: MotionSpan, dwell: float, make: Callable[[MotionSpan, RestPart], LimitMeasure]) -> None:
        super().__init__(span)
        self._dwell, self._make, self._rests = dwell, make, _Rests(span, dwell)
        self._open: tuple[RestPart, LimitMeasure] | None = None
        self.found: list[tuple[RestPart, LimitMeasure]] = []    # those that are over

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        for part in self._rests.parts(block):
            if self._open is None or self._open[0].begin != part.begin:
                self._open = part, self._make(MotionSpan(part.begin, part.end, self.span.mode, ()), part)
            measure = self._open[1]
            measure.take(part.block)
            self._open = part, measure
            if part.is_over:
                self._keep()

    def _keep(self) -> None:
        if self._open and self._open[0].way and self._open[0].end - self._open[0].begin >= self._dwell:
            self.found.append(self._open)
        self._open = None

    def figure(self) -> MeasuredFigure:
        """Return the largest figure; raises InputError without a rest."""
        self._keep()
        if not self.found:
            raise InputError('dwell', self._dwell, 'at most as long as the commanded position rests behind a move',
                             'make it shorter, check a longer run, or give the reference')
        figures = [measure.figure().value for _, measure in self.found]
        row = int(np.argmax(figures))
        return MeasuredFigure(figures[row], f'behind move {row + 1} of {len(figures)}, from t = '
                              f'{self.found[row][0].begin:.6g} s')


class Positioning(OfRests):
    """A figure of ISO 230-2, `name`, from where the slider is at the end of each rest.

    A target is where the commanded position rests after moves from both sides, or one of the `targets` (m), from which
    a rest may be `tolerance` away.
    """

    def __init__(self, span: MotionSpan, targets: tuple[float, ...], dwell: float, tolerance: float, name: str = ''
                 ) -> None:
        super().__init__(span, dwell, lambda span, _: EndPositionError(span, 0.0))
        self._name, self._targets, self._tolerance = name, targets, tolerance

    @property
    def positions(self) -> list[PositionFigures]:
        """The figures of the targets, by position; raises InputError where there is none."""
        self._keep()
        rests = [(part.commanded, part.way, measure.deviation) for part, measure in self.found
                 if isinstance(measure, EndPositionError)]
        found = []
        for target in self._targets or _targets_of([rest[0] for rest in rests], self._tolerance):
            both = [np.array([actual - target for commanded, rest_way, actual in rests
                              if rest_way == way and abs(commanded - target) <= self._tolerance]) for way in (1, -1)]
            if min(map(len, both)):
                found.append(position_figures(Approaches(target, *both)))
            elif self._targets:
                raise InputError('targets', target, f'approached from both sides; {len(both[0])} moves ended there '
                                 f'from below and {len(both[1])} from above', 'drop it, or give a wider tolerance')
        if not found:
            raise InputError('targets', f'{len(rests)} rests', f'at least one place where the commanded position rests '
                             f'for {self._dwell:g} s after moves from either side', 'check a longer run, or give '
                             'positioning: {targets: [...]}, a shorter dwell or the reference')
        return found

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to; raises InputError without approaches from both sides."""
        positions = self.positions
        value = abs(getattr(positioning_figures(positions), self._name))
        if math.isnan(value) and not any(math.isnan(one.mean) for one in positions):
            raise InputError('targets', len(positions), 'each approached twice or more from either side',
                             'let the run repeat its moves: s takes n - 1')
        return MeasuredFigure(value, f'of {len(positions)} targets')


def _targets_of(places: Sequence[float], tolerance: float) -> list[float]:
    """Return where rests are, those within a tolerance of the one before being one."""
    places = sorted(places)
    return [place for before, place in zip([-math.inf, *places], places) if place - before > tolerance]


def no_sample_in(begin: float, end: float) -> InputError:
    """Return what is said of a part of a run (s) in which there is no sample."""
    return InputError('window', [begin, end], 'long enough for one sample', 'make it longer')


def _crossing(points: Points, level: float) -> float:
    """Return when the slider crosses a level for the last time between two points.

    In between it moves on the cubic with the positions and velocities at both.
    """
    cubic = CubicHermiteSpline(*points)
    return float(max(cubic.solve(level, extrapolate=False), default=points.time[1]))


# What can be limited: every figure, and what a limit on it must say.

_INSTANT = 1e-9    # s, that a time of a step may be off by rounding
_STANDS = 1e-12   # m, from one sample to the next: less is rounding of a drive that stands
FARTHEST = 1e12   # m, like the positions of a scene
TIMING_LIMIT = 'timing'

TARGET = Parameter('target', 'double', None, 'm', 'where the slider is to go', low=-FARTHEST, high=FARTHEST)
_BAND = Parameter('band', 'double', None, 'm', 'either side of the target', low=0.0, low_open=True, high=FARTHEST)
_SPEED = Parameter('speed', 'double', None, 'm/s', 'below which the slider stands still', low=0.0, low_open=True,
                   high=1e6)
_WITHIN = Parameter('within', 'double', None, 's', 'after the turn', low=0.0, low_open=True, high=1e6)
TARGETS = Parameter('targets', 'double_array', (), 'm', 'where the axis is to rest; left out: found', low=-FARTHEST,
                    high=FARTHEST)
DWELL = Parameter('dwell', 'double', 0.1, 's', 'the least time at rest', low=1e-6, high=1e6)
TOLERANCE = Parameter('tolerance', 'double', 1e-6, 'm', 'of the commanded position about a target', low=1e-9, high=1.0)
_CYCLES = Parameter('cycles', 'integer', 1, '', 'at the end of the window', low=1, high=1e6)


@dataclass(frozen=True)
class Kind:
    """A figure; `measure` makes what measures it of a part of a run and the values of `settings` by name."""

    name: str
    measure: Callable[..., Any]
    settings: tuple[Parameter, ...] = ()

    is_least: bool = False   # the limit is the smallest value that passes

    @property
    def unit(self) -> str:
        """SI."""
        return unit_of(self.name)

    @property
    def bound(self) -> Parameter:
        """What a limit may be."""
        whole = not self.unit
        name, text = ('min', 'smallest') if self.is_least else ('max', 'largest')
        return Parameter(name, 'integer' if whole else 'double', None, self.unit, f'{text} value that passes', low=0.0,
                         high=1e9 if whole else FARTHEST, required=True)


class CircleKind(Kind):
    """A figure of the path of two axes; `measure` returns it from a CircularTest."""


def _of_turns(test: CircularTest, figure: Callable[..., tuple[float, str]]) -> MeasuredFigure:
    """Return the largest figure of the turns, each with its remark."""
    (value, remark), turn = max(((figure(turn), turn) for turn in test.turns), key=lambda pair: pair[0][0])
    return MeasuredFigure(value, ', '.join(filter(None, [remark, SENSES[turn.sense]])))


def _of_both(test: CircularTest, name: str) -> MeasuredFigure:
    if not test.is_bidirectional:
        raise InputError('sense', SENSES[test.turns[0].sense], 'a whole turn in either sense', 'give the runs of the '
                         'other sense too: --circle X Y OTHER_X OTHER_Y, or leave this limit out')
    return MeasuredFigure(abs(getattr(test, name)), 'both senses')


def _largest_glitch(turn: Turn) -> tuple[float, str]:
    quadrant = max(turn.glitches, key=lambda name: abs(turn.glitches[name]), default='')
    if not quadrant:
        return 0.0, 'no quadrant was crossed'
    return abs(turn.glitches[quadrant]), f'{"outwards" if turn.glitches[quadrant] > 0.0 else "inwards"} at {quadrant}'


CIRCLE_KINDS: Mapping[str, Kind] = {kind.name: kind for kind in (
    CircleKind('circular_deviation', partial(_of_turns, figure=lambda turn: (turn.circular_deviation, ''))),
    CircleKind('bidirectional_circular_deviation', partial(_of_both, name='bidirectional_circular_deviation')),
    CircleKind('radial_deviation', partial(_of_turns, figure=lambda turn: (max(turn.largest, -turn.smallest), ''))),
    CircleKind('mean_radial_deviation', partial(_of_both, name='mean_radial_deviation')),
    CircleKind('quadrant_glitch', partial(_of_turns, figure=_largest_glitch)),
)}
KINDS = {kind.name: kind for kind in (
    Kind('following_error', partial(LargestSize, column=lambda block: (block.following_error, block.time))),
    Kind('end_position_error', EndPositionError, (TARGET,)),
    Kind('overshoot', Overshoot, (TARGET,)),
    Kind('settling_time', SettlingTime, (TARGET, _BAND)),
    Kind('sticks', Sticks),
    Kind('longest_stick', LongestStick),
    Kind('limit_cycle_amplitude', LimitCycleAmplitude, (_CYCLES,)),
    Kind('peak_speed', partial(LargestSize, column=lambda block: (block.points.velocity, block.points.time))),
    Kind('following_error_rms', partial(RootMeanSquare, column=lambda block: block.following_error)),
    Kind('move_settling_time', lambda span, dwell, band: OfRests(
        span, dwell, lambda rest, part: SettlingTime(rest, part.commanded, band)), (DWELL, _BAND)),
    Kind('move_overshoot', lambda span, dwell: OfRests(
        span, dwell, lambda rest, part: _Beyond(rest, part.commanded, part.way)), (DWELL,)),
    Kind('steady_state_error', lambda span, dwell: OfRests(
        span, dwell, lambda rest, part: EndPositionError(rest, part.commanded)), (DWELL,)),
    Kind('velocity_ripple', partial(SpeedRange, lowest=False)),
    Kind('lowest_speed', partial(SpeedRange, lowest=True), is_least=True),
    Kind('standstill', Standstill, (_SPEED,)),
    Kind('reversal_spike', ReversalSpike, (_WITHIN,)),
    Kind('command_peak', partial(LargestSize, column=lambda block: (block.command, block.time))),
    Kind('command_rms', partial(RootMeanSquare, column=lambda block: block.command)),
    Kind('command_rate_peak', partial(CommandRate, rms=False)),
    Kind('command_rate_rms', partial(CommandRate, rms=True)),
    *(Kind(name, partial(Positioning, name=name), (TARGETS, DWELL, TOLERANCE)) for name in PositioningFigures._fields),
)}
