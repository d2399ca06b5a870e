# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many axes, one after the other: each runs under constant inputs, and only the figures of its cycles are kept.

The figures are those of `simulation.cycles`: `Cycle` and `Summary`, from the same events.

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
from typing import Any

from ...axis.layout import EventRow, Events, Parameters, Row, Sinusoids, State
from ...axis.motion import ACCELERATING, STICK
from ...axis.transitions import ACCELERATE, ARREST, BREAKAWAY, DECELERATE, REVERSE
from ...core.hot_path import compiled
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
# behind it what is not reported: since when the mode holds; the slip that goes on or was the last, whether it goes on,
# whether it ended at standstill, where it began and ended, and its figures so far
(SINCE_SECOND, SINCE_FRACTION, SLIPS, IS_OVER, BEGIN_SECOND, BEGIN_FRACTION, BEGIN_POSITION, STOP_SECOND, STOP_FRACTION,
 STOP_POSITION, PEAK, FORCE, REST, STATIC, SIGN) = range(32, 47)
# whether it has slowed down since its speed was least; when the round began, if one did, and its figures so far
(HAS_SLOWED, HAS_ROUND, FROM_SECOND, FROM_FRACTION, TRAVEL_SO_FAR, PEAK_SO_FAR, FORCE_AT_FIRST) = range(47, 54)
FIGURES = 32
ROW_SIZE = 54
# a longer row has the latest rounds behind that, in turn, each with these columns; force and speed are those at its end
KEPT_STICK, KEPT_PERIOD, KEPT_FORCE, KEPT_SPEED = range(4)
ROUND_SIZE = 4


def run_axes(parameters: Any, inputs: Any, starts: Any, duration: float, first: int, last: int, p: Any, s: State,
             events: Events, sinusoids: Sinusoids, out: Any) -> None:
    """Run the axes `first` to `last` of the rows of `parameters`, `inputs` (v, F_e), `starts` (x, ẋ, rest time).

    Rows of `out` get the figures; NaN where there is none.  Pauses between sticks count in the second half alone.
    `s` is a state that keeps the account of energy, `p` room for the parameters of an axis.
    """
    second = math.floor(duration)
    fraction = duration - second
    for i in range(first, last):
        row = out[i]
        p = Parameters(parameters[i].tolist())
        clear(row)
        position, velocity, rest = map(float, starts[i])
        v, f = map(float, inputs[i])
        rows = start(p, s, position, velocity, rest, v, 0.0, f, 0.0, sinusoids, events, 0)
        row[FINAL_MODE] = STICK if rows > 0 else s.mode
        ended = FULL
        while ended == FULL:
            rows, ended = advance(p, s, second, fraction, events, rows)
            for k in range(rows):
                book(row, events.rows[k], 0.5 * duration, len(row))
            rows = 0
        if row[FINAL_MODE] == STICK:
            row[STICK_SHARE] += (second - row[SINCE_SECOND]) + (fraction - row[SINCE_FRACTION])
        row[STICK_SHARE] /= duration
        row[COMPLETE] = 1.0 if ended == DONE and is_sound(p, s, second, fraction) else 0.0


@compiled
def clear(row: Row) -> None:
    """Begin a row."""
    for k in range(ROW_SIZE):
        row[k] = math.nan if k < FIGURES else 0.0
    row[EVENTS] = row[CYCLES] = row[STICK_SHARE] = 0.0
    row[STICKS] = row[LONGEST_PAUSE] = row[ROUND_COUNT] = row[LASTS] = 0.0


@compiled
def book(row: Row, e: EventRow, half: float, width: int) -> None:
    """Take the next event of a run, whose second half begins at `half` s."""
    kind, mode = e.kind, e.mode
    row[EVENTS] += 1.0
    row[LAST_VELOCITY] = e.velocity
    begins = kind == REVERSE or (kind == BREAKAWAY and mode != STICK)
    if mode != row[FINAL_MODE]:
        if row[FINAL_MODE] == STICK:
            row[STICK_SHARE] += (e.second - row[SINCE_SECOND]) + (e.fraction - row[SINCE_FRACTION])
        row[FINAL_MODE], row[SINCE_SECOND], row[SINCE_FRACTION] = mode, e.second, e.fraction
    if row[SLIPS] != 0.0:
        row[PEAK] = max(row[PEAK], abs(e.velocity))
        if begins or mode == STICK:
            row[SLIPS] = 0.0
            row[IS_OVER] = 1.0 if kind in (ARREST, REVERSE) else 0.0
            row[STOP_SECOND], row[STOP_FRACTION] = e.second, e.fraction
            row[STOP_POSITION] = e.position
    if begins:
        if row[IS_OVER] != 0.0:
            _end_cycle(row, e)
            if row[HAS_ROUND] != 0.0:
                row[TRAVEL_SO_FAR] = max(row[TRAVEL_SO_FAR], row[SLIP_TRAVEL])
                row[PEAK_SO_FAR] = max(row[PEAK_SO_FAR], row[PEAK_SPEED])
                if kind == BREAKAWAY:
                    _end_round(row, e, half, width)
        _begin_slip(row, e)
        if kind == BREAKAWAY:
            _begin_round(row, e)
    elif kind == DECELERATE:
        row[HAS_SLOWED] = 1.0
    elif kind == ACCELERATE and mode == ACCELERATING:
        speed = abs(e.velocity)
        if row[HAS_SLOWED] != 0.0 and speed >= row[LEAST_SPEED] * (1.0 - _SAME):
            row[LASTS] = 1.0
        row[LEAST_SPEED], row[HAS_SLOWED] = speed, 0.0
    elif mode == STICK:
        row[LASTS] = 0.0


@compiled
def _end_cycle(row: Row, e: EventRow) -> None:
    row[CYCLES] += 1.0
    row[PERIOD_BEFORE] = row[PERIOD]
    row[PERIOD] = (e.second - row[BEGIN_SECOND]) + (e.fraction - row[BEGIN_FRACTION])
    if not abs(row[PERIOD] - row[PERIOD_BEFORE]) < SETTLED * row[PERIOD]:   # also after the first
        row[SETTLING_TIME] = row[BEGIN_SECOND] + row[BEGIN_FRACTION]
    row[SLIP_TIME] = (row[STOP_SECOND] - row[BEGIN_SECOND]) + (row[STOP_FRACTION] - row[BEGIN_FRACTION])
    row[STICK_TIME] = (e.second - row[STOP_SECOND]) + (e.fraction - row[STOP_FRACTION])
    row[DIRECTION] = row[SIGN]
    row[SLIP_TRAVEL] = row[SIGN] * (row[STOP_POSITION] - row[BEGIN_POSITION])
    row[JUMP] = row[SIGN] * (e.position - row[BEGIN_POSITION])
    row[PEAK_SPEED] = row[PEAK]
    row[REST_TIME], row[BREAK_AWAY_FORCE], row[STATIC_COEFFICIENT] = row[REST], row[FORCE], row[STATIC]


@compiled
def _begin_slip(row: Row, e: EventRow) -> None:
    if math.isnan(row[FIRST_BREAK_AWAY]):
        row[FIRST_BREAK_AWAY] = e.second + e.fraction
    row[LAST_BREAK_AWAY] = e.second + e.fraction
    row[SLIPS], row[IS_OVER] = 1.0, 0.0
    row[BEGIN_SECOND], row[BEGIN_FRACTION], row[BEGIN_POSITION] = e.second, e.fraction, e.position
    row[PEAK] = abs(e.velocity)
    row[FORCE], row[REST], row[STATIC] = abs(e.friction), e.rest, e.static
    row[SIGN] = e.direction
    row[LEAST_SPEED], row[HAS_SLOWED], row[LASTS] = row[PEAK], 0.0, 0.0


@compiled
def _begin_round(row: Row, e: EventRow) -> None:
    row[HAS_ROUND] = 1.0
    row[FROM_SECOND], row[FROM_FRACTION] = e.second, e.fraction
    row[TRAVEL_SO_FAR] = row[PEAK_SO_FAR] = 0.0
    row[FORCE_AT_FIRST] = row[FORCE]


@compiled
def _end_round(row: Row, e: EventRow, half: float, width: int) -> None:
    time = e.second + e.fraction
    before = row[ROUND_PERIOD]
    row[ROUND_PERIOD] = (e.second - row[FROM_SECOND]) + (e.fraction - row[FROM_FRACTION])
    if not abs(row[ROUND_PERIOD] - before) < SETTLED * row[ROUND_PERIOD]:   # also after the first
        row[ROUND_SETTLING] = row[FROM_SECOND] + row[FROM_FRACTION]
    row[ROUND_STICK], row[ROUND_TRAVEL] = row[STICK_TIME], row[TRAVEL_SO_FAR]
    row[ROUND_PEAK], row[ROUND_FORCE] = row[PEAK_SO_FAR], row[FORCE_AT_FIRST]
    if row[ROUND_STICK] > LEAST_STICK * row[ROUND_PERIOD]:
        if time >= half and row[STICKS] > 0.0:
            row[LONGEST_PAUSE] = max(row[LONGEST_PAUSE], time - row[LAST_STICK])
        row[STICKS] += 1.0
        row[LAST_STICK] = time
    kept = (width - ROW_SIZE) // ROUND_SIZE
    if kept > 0:
        at = ROW_SIZE + ROUND_SIZE * int(row[ROUND_COUNT] % kept)
        row[at + KEPT_STICK], row[at + KEPT_PERIOD] = row[ROUND_STICK], row[ROUND_PERIOD]
        row[at + KEPT_FORCE], row[at + KEPT_SPEED] = e.drive_force, e.velocity
    row[ROUND_COUNT] += 1.0
