# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The figures that limits are set for, as control engineering and ISO 230 have them; formulas in docs/check.md.

The slider is known at the samples and, exactly, at the transitions: extremes of its motion in slip are transitions
themselves.  The drive is known at the samples.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.types import EventKind, Mode
from ..figures.catalogue import unit_of
from ..figures.cycles import cycle_figures, mode_spans
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

    def figure(self) -> MeasuredFigure:
        """Return what all blocks came to."""
        return MeasuredFigure(abs(self._last - self._target))


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

FARTHEST = 1e12   # m, like the positions of a scene
TIMING_LIMIT = 'timing'

TARGET = Parameter('target', 'double', None, 'm', 'where the slider is to go', low=-FARTHEST, high=FARTHEST)
_BAND = Parameter('band', 'double', None, 'm', 'either side of the target', low=0.0, low_open=True, high=FARTHEST)
_CYCLES = Parameter('cycles', 'integer', 1, '', 'at the end of the window', low=1, high=1e6)


@dataclass(frozen=True)
class Kind:
    """A figure; `measure` makes what measures it of a part of a run and the values of `settings` by name."""

    name: str
    measure: Callable[..., LimitMeasure]
    settings: tuple[Parameter, ...] = ()

    @property
    def unit(self) -> str:
        """SI."""
        return unit_of(self.name)

    @property
    def maximum(self) -> Parameter:
        """What a limit may be."""
        whole = not self.unit
        return Parameter('max', 'integer' if whole else 'double', None, self.unit, 'largest value that passes', low=0.0,
                         high=1e9 if whole else FARTHEST, required=True)


KINDS = {kind.name: kind for kind in (
    Kind('following_error', partial(LargestSize, column=lambda block: (block.following_error, block.time))),
    Kind('end_position_error', EndPositionError, (TARGET,)),
    Kind('overshoot', Overshoot, (TARGET,)),
    Kind('settling_time', SettlingTime, (TARGET, _BAND)),
    Kind('sticks', Sticks),
    Kind('longest_stick', LongestStick),
    Kind('limit_cycle_amplitude', LimitCycleAmplitude, (_CYCLES,)),
    Kind('peak_speed', partial(LargestSize, column=lambda block: (block.points.velocity, block.points.time))),
)}
