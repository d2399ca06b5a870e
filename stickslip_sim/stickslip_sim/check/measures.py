# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The figures that limits are set for, as control engineering and ISO 230 have them; formulas in docs/check.md.

The slider is known at the samples and, exactly, at the transitions: extremes of its motion in slip are transitions
themselves.  The drive is known at the samples.
"""

import math
from collections.abc import Callable, Mapping, Sequence
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
from .observed_run import MotionBlock, MotionSpan, Points, held


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


class LargestOf(LimitMeasure):
    """The largest value that `_values` makes of a block, with its time."""

    def __init__(self, span: MotionSpan) -> None:
        super().__init__(span)
        self._largest = _Largest()

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        if len(block.points.time):
            self._largest.take(*self._values(block))

    def _values(self, block: MotionBlock) -> tuple[Numbers, Numbers]:
        """Return values and their times."""
        raise NotImplementedError

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        return self._largest.figure


class LargestSize(LargestOf):
    """The largest size in a column of a block, which `column` returns with its times."""

    def __init__(self, span: MotionSpan, column: Callable[[MotionBlock], tuple[Numbers, Numbers]]) -> None:
        super().__init__(span)
        self._column = column

    def _values(self, block: MotionBlock) -> tuple[Numbers, Numbers]:
        values, times = self._column(block)
        return np.abs(values), times


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


class RootMeanSquare(LargestSize):
    """The root of the mean square of a column over the samples."""

    def __init__(self, span: MotionSpan, column: Callable[[MotionBlock], tuple[Numbers, Numbers]]) -> None:
        super().__init__(span, column)
        self._square, self._count = 0.0, 0

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        values, _ = self._column(block)
        self._square, self._count = self._square + float(values @ values), self._count + len(values)

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        root = math.sqrt(self._square / self._count)
        return MeasuredFigure(float(f'{root:.13g}'))   # the digits behind are those of how the blocks were cut


class VelocityRipple(LimitMeasure):
    """The largest velocity less the smallest, m/s."""

    def __init__(self, span: MotionSpan) -> None:
        super().__init__(span)
        self._both = {sense: _Largest() for sense in (-1.0, 1.0)}

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        for sense, largest in self._both.items():
            largest.take(sense * block.points.velocity, block.points.time)

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        return MeasuredFigure(sum(largest.value for largest in self._both.values()))


class LowestSpeed(LargestOf):
    """The smallest speed, m/s."""

    def _values(self, block: MotionBlock) -> tuple[Numbers, Numbers]:
        return -np.abs(block.points.velocity), block.points.time

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        return super().figure()._replace(value=abs(self._largest.value))


class Standstill(LargestOf):
    """The longest time from a sample or transition to a later one with a speed below `speed` (m/s) at them all, s."""

    def __init__(self, span: MotionSpan, speed: float) -> None:
        super().__init__(span)
        self._speed, self._since, self._was_slow = speed, math.nan, False

    def _values(self, block: MotionBlock) -> tuple[Numbers, Numbers]:
        time, is_slow = block.points.time, np.abs(block.points.velocity) < self._speed
        since = held(is_slow & ~np.append(self._was_slow, is_slow[:-1]), time, self._since)
        self._since, self._was_slow = float(since[-1]), bool(is_slow[-1])
        return np.where(is_slow, time - since, 0.0), time

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        value, _ = super().figure()
        return MeasuredFigure(value, f'until t = {self._largest.time:.6g} s' if value else 'never so slow')


class ReversalSpike(LargestOf):
    """The largest size of the following error within some time after the commanded position turns, m."""

    def __init__(self, span: MotionSpan, within: float) -> None:
        super().__init__(span)
        self._within, self._way, self._turn = within, 0.0, -math.inf

    def _values(self, block: MotionBlock) -> tuple[Numbers, Numbers]:
        before = np.append(self._way, block.way[:-1])
        turn = held((block.way != before) & (before != 0.0), block.time, self._turn)
        if len(turn):
            self._way, self._turn = float(block.way[-1]), float(turn[-1])
        return np.where(block.time - turn <= self._within + _INSTANT, np.abs(block.following_error), 0.0), block.time


class _Beyond(LargestOf):
    """How far the slider is beyond the end of a move in its sense, m."""

    def __init__(self, span: MotionSpan, target: float, way: float) -> None:
        super().__init__(span)
        self._target, self._way = target, way

    def _values(self, block: MotionBlock) -> tuple[Numbers, Numbers]:
        return np.maximum(self._way * (block.points.position - self._target), 0.0), block.points.time


class Rest(NamedTuple):
    """A rest of the commanded position, m, after a move in the sense `way`, from `begin` (s) on."""

    begin: float
    commanded: float
    way: float
    measure: LimitMeasure


class OfRests(LimitMeasure):
    """Measures each rest of the commanded position that lasts `dwell` (s) at least; the largest figure counts.

    `make` returns what measures one, from its span, the commanded position and the sense of the move before.
    """

    def __init__(self, span: MotionSpan, dwell: float, make: Callable[[MotionSpan, float, float], LimitMeasure]
                 ) -> None:
        super().__init__(span)
        self._dwell, self._make = dwell, make
        self._open: Rest | None = None
        self._until = span.begin
        self._over: list[Rest] = []

    def take(self, block: MotionBlock) -> None:
        """Take the next block."""
        time = block.time
        if not len(time):
            return
        firsts = np.union1d(0, np.flatnonzero(block.has_moved))
        lasts = np.append(firsts[1:], len(time)) - 1
        looked_at = time[lasts] - time[firsts] >= self._dwell
        looked_at[[0, -1]] = True        # what began before, and what goes on
        for first, last in zip(firsts[looked_at].tolist(), lasts[looked_at].tolist()):
            if block.has_moved[first] or self._open is None:
                self._close()
                begin, commanded, way = (float(column[first]) for column in (time, block.commanded, block.way))
                measure = self._make(MotionSpan(begin, math.inf, self.span.mode, ()), commanded, way)
                self._open = Rest(begin, commanded, way, measure)
            self._until = float(time[last])
            self._open.measure.take(block.cut(self._open.begin, self._until))

    @property
    def rests(self) -> list[Rest]:
        """Those behind a move that were long enough."""
        self._close()
        return self._over

    def figure(self) -> MeasuredFigure:
        """Return the largest figure; raises InputError without a rest."""
        rests = self.rests
        if not rests:
            raise InputError('dwell', self._dwell, 'at most as long as the commanded position rests behind a move',
                             'make it shorter, check a longer run, or give the reference')
        figures = [rest.measure.figure().value for rest in rests]
        row = int(np.argmax(figures))
        return MeasuredFigure(figures[row], f'behind move {row + 1} of {len(rests)}, from t = {rests[row].begin:.6g} s')
    def _close(self) -> None:
        if self._open and self._open.way and self._until - self._open.begin >= self._dwell:
            self._over.append(self._open)
        self._open = None


class Positioning(OfRests):
    """A figure of ISO 230-2, `name`, from where the slider is at the end of each rest.

    A target is where the commanded position rests after moves from both sides, or one of the `targets` (m), from which
    a rest may be `tolerance` away.
    """

    def __init__(self, span: MotionSpan, targets: tuple[float, ...], dwell: float, tolerance: float, name: str = ''
                 ) -> None:
        super().__init__(span, dwell, lambda rest, *_: EndPositionError(rest, 0.0))
        self._name, self._targets, self._tolerance = name, targets, tolerance

    @property
    def positions(self) -> list[PositionFigures]:
        """The figures of the targets, by position; raises InputError where there is none."""
        rests = [(rest.commanded, rest.way, rest.measure.deviation) for rest in self.rests
                 if isinstance(rest.measure, EndPositionError)]
        found = []
        for target in self._targets or _targets_of([commanded for commanded, *_ in rests], self._tolerance):
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
    def needs(self) -> tuple[str, ...]:
        """The columns of a state that a measurement must have for it."""
        return ('drive_velocity',) if self.name.startswith('command_') else ('position', 'drive_position')

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
    Kind('following_error_rms', partial(RootMeanSquare, column=lambda block: (block.following_error, block.time))),
    Kind('move_settling_time', lambda span, dwell, band: OfRests(
        span, dwell, lambda rest, commanded, _: SettlingTime(rest, commanded, band)), (DWELL, _BAND)),
    Kind('move_overshoot', partial(OfRests, make=_Beyond), (DWELL,)),
    Kind('steady_state_error', partial(OfRests, make=lambda rest, commanded, _: EndPositionError(rest, commanded)),
         (DWELL,)),
    Kind('velocity_ripple', VelocityRipple),
    Kind('lowest_speed', LowestSpeed, is_least=True),
    Kind('standstill', Standstill, (_SPEED,)),
    Kind('reversal_spike', ReversalSpike, (_WITHIN,)),
    Kind('command_peak', partial(LargestSize, column=lambda block: (block.command, block.time))),
    Kind('command_rms', partial(RootMeanSquare, column=lambda block: (block.command, block.time))),
    Kind('command_rate_peak', partial(LargestSize, column=lambda block: (block.rate, block.time))),
    Kind('command_rate_rms', partial(RootMeanSquare, column=lambda block: (block.rate, block.time))),
    *(Kind(name, partial(Positioning, name=name), (TARGETS, DWELL, TOLERANCE)) for name in PositioningFigures._fields),
)}
