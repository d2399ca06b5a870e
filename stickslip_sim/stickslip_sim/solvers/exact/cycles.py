# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many axes, one after the other: each runs under constant inputs, and only the figures of its cycles are kept.

The figures are those of `analysis.Cycle` and `analysis.Summary`, from the same events.
"""

import math

from ...axis.layout import (
    EVENT_DIRECTION, EVENT_FRACTION, EVENT_FRICTION, EVENT_KIND, EVENT_MODE, EVENT_POSITION, EVENT_REST, EVENT_SECOND,
    EVENT_STATIC, EVENT_VELOCITY, MODE,
)
from ...axis.motion import STICK
from ...axis.transitions import ARREST, BREAKAWAY, REVERSE
from ...compiled import compiled, compiled_without_lock
from .. import DONE, FULL
from .engine import advance, start
from .judge import is_sound

SETTLED = 1e-6   # relative change of the period from one cycle to the next

# a row of figures; `batch.BatchFigures` names the same
(EVENTS, CYCLES, COMPLETE, FINAL_MODE, FIRST_BREAK_AWAY, STICK_SHARE, PERIOD_BEFORE, DIRECTION, REST_TIME, SLIP_TIME,
 STICK_TIME, PERIOD, SLIP_TRAVEL, JUMP, PEAK_SPEED, BREAK_AWAY_FORCE, STATIC_COEFFICIENT, LAST_BREAK_AWAY,
 SETTLING_TIME) = range(19)
# behind it what is not told: since when the mode holds; the slip that goes on or was the last, whether it goes on,
# whether it ended at standstill, where it began and ended, and its figures so far
(SINCE_SECOND, SINCE_FRACTION, SLIPS, IS_OVER, BEGIN_SECOND, BEGIN_FRACTION, BEGIN_POSITION, STOP_SECOND, STOP_FRACTION,
 STOP_POSITION, PEAK, FORCE, REST, STATIC, WAY) = range(19, 34)
FIGURES = 19
ROW_SIZE = 34


@compiled_without_lock
def run_axes(p, inputs, starts, duration, first, last, s, events, waves, out):
    """Run the axes `first` to `last` of the rows of `p` (parameters), `inputs` (v, F_e), `starts` (x, ẋ, rest time).

    Rows of `out` get the figures; NaN where there is none.  `s` is a state that keeps the account of energy.
    """
    second = math.floor(duration)
    fraction = duration - second
    for i in range(first, last):
        row = out[i]
        _clear(row)
        rows = start(p[i], s, starts[i][0], starts[i][1], starts[i][2], inputs[i][0], 0.0, inputs[i][1], 0.0, waves,
                     events, 0)
        row[FINAL_MODE] = STICK if rows > 0 else s[MODE]
        ended = FULL
        while ended == FULL:
            rows, ended = advance(p[i], s, second, fraction, events, rows)
            for k in range(rows):
                _book(row, events[k])
            rows = 0
        if row[FINAL_MODE] == STICK:
            row[STICK_SHARE] += (second - row[SINCE_SECOND]) + (fraction - row[SINCE_FRACTION])
        row[STICK_SHARE] /= duration
        row[COMPLETE] = 1.0 if ended == DONE and is_sound(p[i], s, second, fraction) else 0.0


@compiled
def _clear(row):
    for k in range(ROW_SIZE):
        row[k] = math.nan if k < FIGURES else 0.0
    row[EVENTS] = row[CYCLES] = row[STICK_SHARE] = 0.0


@compiled
def _book(row, e):
    kind, mode = e[EVENT_KIND], e[EVENT_MODE]
    row[EVENTS] += 1.0
    begins = kind == REVERSE or (kind == BREAKAWAY and mode != STICK)
    if mode != row[FINAL_MODE]:
        if row[FINAL_MODE] == STICK:
            row[STICK_SHARE] += (e[EVENT_SECOND] - row[SINCE_SECOND]) + (e[EVENT_FRACTION] - row[SINCE_FRACTION])
        row[FINAL_MODE], row[SINCE_SECOND], row[SINCE_FRACTION] = mode, e[EVENT_SECOND], e[EVENT_FRACTION]
    if row[SLIPS] != 0.0:
        row[PEAK] = max(row[PEAK], abs(e[EVENT_VELOCITY]))
        if begins or mode == STICK:
            row[SLIPS] = 0.0
            row[IS_OVER] = 1.0 if kind in (ARREST, REVERSE) else 0.0
            row[STOP_SECOND], row[STOP_FRACTION] = e[EVENT_SECOND], e[EVENT_FRACTION]
            row[STOP_POSITION] = e[EVENT_POSITION]
    if begins:
        if row[IS_OVER] != 0.0:
            _end_cycle(row, e)
        _begin_slip(row, e)


@compiled
def _end_cycle(row, e):
    row[CYCLES] += 1.0
    row[PERIOD_BEFORE] = row[PERIOD]
    row[PERIOD] = (e[EVENT_SECOND] - row[BEGIN_SECOND]) + (e[EVENT_FRACTION] - row[BEGIN_FRACTION])
    if not abs(row[PERIOD] - row[PERIOD_BEFORE]) < SETTLED * row[PERIOD]:   # also after the first
        row[SETTLING_TIME] = row[BEGIN_SECOND] + row[BEGIN_FRACTION]
    row[SLIP_TIME] = (row[STOP_SECOND] - row[BEGIN_SECOND]) + (row[STOP_FRACTION] - row[BEGIN_FRACTION])
    row[STICK_TIME] = (e[EVENT_SECOND] - row[STOP_SECOND]) + (e[EVENT_FRACTION] - row[STOP_FRACTION])
    row[DIRECTION] = row[WAY]
    row[SLIP_TRAVEL] = row[WAY] * (row[STOP_POSITION] - row[BEGIN_POSITION])
    row[JUMP] = row[WAY] * (e[EVENT_POSITION] - row[BEGIN_POSITION])
    row[PEAK_SPEED] = row[PEAK]
    row[REST_TIME], row[BREAK_AWAY_FORCE], row[STATIC_COEFFICIENT] = row[REST], row[FORCE], row[STATIC]


@compiled
def _begin_slip(row, e):
    if math.isnan(row[FIRST_BREAK_AWAY]):
        row[FIRST_BREAK_AWAY] = e[EVENT_SECOND] + e[EVENT_FRACTION]
    row[LAST_BREAK_AWAY] = e[EVENT_SECOND] + e[EVENT_FRACTION]
    row[SLIPS], row[IS_OVER] = 1.0, 0.0
    row[BEGIN_SECOND], row[BEGIN_FRACTION], row[BEGIN_POSITION] = e[EVENT_SECOND], e[EVENT_FRACTION], e[EVENT_POSITION]
    row[PEAK] = abs(e[EVENT_VELOCITY])
    row[FORCE], row[REST], row[STATIC] = abs(e[EVENT_FRICTION]), e[EVENT_REST], e[EVENT_STATIC]
    row[WAY] = e[EVENT_DIRECTION]
