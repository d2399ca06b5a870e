# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many axes, one after the other: each runs under constant inputs, and only the figures of its cycles are kept.

The figures are those of `analysis.Cycle` and `analysis.Summary`, from the same events.

A round goes from one break-away out of stick to the next; a slip that reverses at once does not end it.  A round whose
stick is less than LEAST_STICK of it only touches rest.

A slip lasts for ever once its least speed grows from swing to swing.  While it goes on, under constant inputs, stretch
of the spring and speed are one autonomous motion in a plane: friction is a continuous function of the two (with two
branches, too: coasting fills what is between them), so that no two paths cross.  The border at which the slider begins
to accelerate is passed once a turn, at a speed below the drive's; a path that comes back there at a higher speed than
it had before is shut in by its own last turn, which stays clear of standstill.  After a break-away the turn begins at
the speed of that, with a force that accelerates already: the same holds.
"""

import math

from ...axis.layout import (
    EVENT_DIRECTION, EVENT_DRIVE_FORCE, EVENT_FRACTION, EVENT_FRICTION, EVENT_KIND, EVENT_MODE, EVENT_POSITION,
    EVENT_REST, EVENT_SECOND, EVENT_STATIC, EVENT_VELOCITY, MODE,
)
from ...axis.motion import ACCELERATING, STICK
from ...axis.transitions import ACCELERATE, ARREST, BREAKAWAY, DECELERATE, REVERSE
from ...core.jit import compiled, compiled_without_lock
from .. import DONE, FULL
from .engine import advance, start
from .judge import is_sound

SETTLED = 1e-6       # relative change of the period from one cycle to the next
LEAST_STICK = 1e-6   # of a round: less is a slip that only touches rest, as in motion without any damping
_SAME = 1e-12        # of the least speed of a swing: one that loses less is the same again

# a row of figures; `batch.BatchFigures` names the same
(EVENTS, CYCLES, COMPLETE, FINAL_MODE, FIRST_BREAK_AWAY, STICK_SHARE, PERIOD_BEFORE, DIRECTION, REST_TIME, SLIP_TIME,
 STICK_TIME, PERIOD, SLIP_TRAVEL, JUMP, PEAK_SPEED, BREAK_AWAY_FORCE, STATIC_COEFFICIENT, LAST_BREAK_AWAY,
 SETTLING_TIME) = range(19)
# and of rounds; `batch.Rounds` names the same
(STICKS, LAST_STICK, LONGEST_PAUSE, ROUND_COUNT, ROUND_PERIOD, ROUND_STICK, ROUND_TRAVEL, ROUND_PEAK, ROUND_FORCE,
 ROUND_SETTLING, LEAST_SPEED, LASTS, LAST_VELOCITY) = range(19, 32)
# behind it what is not told: since when the mode holds; the slip that goes on or was the last, whether it goes on,
# whether it ended at standstill, where it began and ended, and its figures so far
(SINCE_SECOND, SINCE_FRACTION, SLIPS, IS_OVER, BEGIN_SECOND, BEGIN_FRACTION, BEGIN_POSITION, STOP_SECOND, STOP_FRACTION,
 STOP_POSITION, PEAK, FORCE, REST, STATIC, WAY) = range(32, 47)
# whether it has slowed down since its speed was least; when the round began, if one did, and its figures so far
(HAS_SLOWED, HAS_ROUND, FROM_SECOND, FROM_FRACTION, TRAVEL_SO_FAR, PEAK_SO_FAR, FORCE_AT_FIRST) = range(47, 54)
FIGURES = 32
ROW_SIZE = 54
# a longer row has the latest rounds behind that, in turn: stick time, period, and drive force and speed at the end
ROUND_SIZE = 4


@compiled_without_lock
def run_axes(p, inputs, starts, duration, first, last, s, events, waves, out):
    """Run the axes `first` to `last` of the rows of `p` (parameters), `inputs` (v, F_e), `starts` (x, ẋ, rest time).

    Rows of `out` get the figures; NaN where there is none.  Pauses between sticks count in the second half alone.
    `s` is a state that keeps the account of energy.
    """
    second = math.floor(duration)
    fraction = duration - second
    for i in range(first, last):
        row = out[i]
        clear(row)
        rows = start(p[i], s, starts[i][0], starts[i][1], starts[i][2], inputs[i][0], 0.0, inputs[i][1], 0.0, waves,
                     events, 0)
        row[FINAL_MODE] = STICK if rows > 0 else s[MODE]
        ended = FULL
        while ended == FULL:
            rows, ended = advance(p[i], s, second, fraction, events, rows)
            for k in range(rows):
                book(row, events[k], 0.5 * duration)
            rows = 0
        if row[FINAL_MODE] == STICK:
            row[STICK_SHARE] += (second - row[SINCE_SECOND]) + (fraction - row[SINCE_FRACTION])
        row[STICK_SHARE] /= duration
        row[COMPLETE] = 1.0 if ended == DONE and is_sound(p[i], s, second, fraction) else 0.0


@compiled
def clear(row):
    """Begin a row."""
    for k in range(ROW_SIZE):
        row[k] = math.nan if k < FIGURES else 0.0
    row[EVENTS] = row[CYCLES] = row[STICK_SHARE] = 0.0
    row[STICKS] = row[LONGEST_PAUSE] = row[ROUND_COUNT] = row[LASTS] = 0.0


@compiled
def book(row, e, half):
    """Take the next event of a run, whose second half begins at `half` s."""
    kind, mode = e[EVENT_KIND], e[EVENT_MODE]
    row[EVENTS] += 1.0
    row[LAST_VELOCITY] = e[EVENT_VELOCITY]
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
            if row[HAS_ROUND] != 0.0:
                row[TRAVEL_SO_FAR] = max(row[TRAVEL_SO_FAR], row[SLIP_TRAVEL])
                row[PEAK_SO_FAR] = max(row[PEAK_SO_FAR], row[PEAK_SPEED])
                if kind == BREAKAWAY:
                    _end_round(row, e, half)
        _begin_slip(row, e)
        if kind == BREAKAWAY:
            _begin_round(row, e)
    elif kind == DECELERATE:
        row[HAS_SLOWED] = 1.0
    elif kind == ACCELERATE and mode == ACCELERATING:
        speed = abs(e[EVENT_VELOCITY])
        if row[HAS_SLOWED] != 0.0 and speed >= row[LEAST_SPEED] * (1.0 - _SAME):
            row[LASTS] = 1.0
        row[LEAST_SPEED], row[HAS_SLOWED] = speed, 0.0
    elif mode == STICK:
        row[LASTS] = 0.0


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
    row[LEAST_SPEED], row[HAS_SLOWED], row[LASTS] = row[PEAK], 0.0, 0.0


@compiled
def _begin_round(row, e):
    row[HAS_ROUND] = 1.0
    row[FROM_SECOND], row[FROM_FRACTION] = e[EVENT_SECOND], e[EVENT_FRACTION]
    row[TRAVEL_SO_FAR] = row[PEAK_SO_FAR] = 0.0
    row[FORCE_AT_FIRST] = row[FORCE]


@compiled
def _end_round(row, e, half):
    time = e[EVENT_SECOND] + e[EVENT_FRACTION]
    before = row[ROUND_PERIOD]
    row[ROUND_PERIOD] = (e[EVENT_SECOND] - row[FROM_SECOND]) + (e[EVENT_FRACTION] - row[FROM_FRACTION])
    if not abs(row[ROUND_PERIOD] - before) < SETTLED * row[ROUND_PERIOD]:   # also after the first
        row[ROUND_SETTLING] = row[FROM_SECOND] + row[FROM_FRACTION]
    row[ROUND_STICK], row[ROUND_TRAVEL] = row[STICK_TIME], row[TRAVEL_SO_FAR]
    row[ROUND_PEAK], row[ROUND_FORCE] = row[PEAK_SO_FAR], row[FORCE_AT_FIRST]
    if row[ROUND_STICK] > LEAST_STICK * row[ROUND_PERIOD]:
        if time >= half and row[STICKS] > 0.0:
            row[LONGEST_PAUSE] = max(row[LONGEST_PAUSE], time - row[LAST_STICK])
        row[STICKS] += 1.0
        row[LAST_STICK] = time
    kept = (len(row) - ROW_SIZE) // ROUND_SIZE
    if kept > 0:
        at = ROW_SIZE + ROUND_SIZE * int(row[ROUND_COUNT] % kept)
        row[at], row[at + 1] = row[ROUND_STICK], row[ROUND_PERIOD]
        row[at + 2], row[at + 3] = e[EVENT_DRIVE_FORCE], e[EVENT_VELOCITY]
    row[ROUND_COUNT] += 1.0
