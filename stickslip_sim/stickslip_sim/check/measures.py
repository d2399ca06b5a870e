# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What can be limited: a row for each figure, and what a limit on it must say."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from ..core.errors import InputError
from ..figures import control
from ..figures.catalogue import unit_of
from ..figures.circular import SENSES, CircularTest, Turn
from ..figures.control import MeasuredFigure
from ..figures.positioning import PositioningFigures
from ..scene import Parameter

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


def _moves(figure: Callable[..., Any]) -> Callable[..., Any]:
    """Return the largest of a figure of each rest, which takes its span, the commanded position, and its settings."""
    return lambda span, dwell, **settings: control.of_rests(
        span, dwell, lambda rest, commanded, _: figure(rest, commanded, **settings))


def _of(measure: Callable[..., Any], of: str) -> Callable[..., Any]:
    """Return a figure of a column of the samples."""
    return partial(measure, column=lambda block: (getattr(block, of), block.time))


KINDS = {kind.name: kind for kind in (
    Kind('following_error', _of(control.largest_size, 'following_error')),
    Kind('end_position_error', control.end_position_error, (TARGET,)),
    Kind('overshoot', control.overshoot, (TARGET,)),
    Kind('settling_time', control.settling_time, (TARGET, _BAND)),
    Kind('sticks', partial(control.of_events, figure=control.sticks)),
    Kind('longest_stick', partial(control.of_events, figure=control.longest_stick)),
    Kind('limit_cycle_amplitude', control.limit_cycle_amplitude, (_CYCLES,)),
    Kind('peak_speed', partial(control.largest_size, column=lambda block: (block.points.velocity, block.points.time))),
    Kind('following_error_rms', _of(control.root_mean_square, 'following_error')),
    Kind('move_settling_time', _moves(control.settling_time), (DWELL, _BAND)),
    Kind('move_overshoot', partial(control.of_rests, made=control.beyond_end), (DWELL,)),
    Kind('steady_state_error', _moves(control.end_position_error), (DWELL,)),
    Kind('velocity_ripple', control.velocity_ripple),
    Kind('lowest_speed', control.lowest_speed, is_least=True),
    Kind('standstill', control.standstill, (_SPEED,)),
    Kind('reversal_spike', control.reversal_spike, (_WITHIN,)),
    Kind('command_peak', _of(control.largest_size, 'command')),
    Kind('command_rms', _of(control.root_mean_square, 'command')),
    Kind('command_rate_peak', _of(control.largest_size, 'rate')),
    Kind('command_rate_rms', _of(control.root_mean_square, 'rate')),
    *(Kind(name, partial(control.positioning, name=name), (TARGETS, DWELL, TOLERANCE))
      for name in PositioningFigures._fields),
)}
