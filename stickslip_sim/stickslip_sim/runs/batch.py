# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Thousands of axes at once: arrays of parameters in, arrays of cycle figures out.

    figures = run_batch(axis, 10.0, drive_velocity=np.geomspace(1e-4, 1e-2, 10_000))
    figures.period[figures.cycles > 1]

Every axis runs by itself from event to event, the same to the last bit as in a `Simulator`, with any number of
threads.
"""

import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import astuple, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..axis import Axis, InitialState, check_start
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..figures.rounds import period_repeats
from ..solvers import exact
from ..solvers.exact.axis_figures import FIGURE_NAMES, ROUND_SIZE, AxisFigures
from ..solvers.exact.many_axes import SETTLED
from .batch_columns import array_of, check_range, common_length, parameter_rows

_ROWS = 64          # of the event table
_AT_THE_START = astuple(AxisFigures())
_AT_A_TIME = 250    # axes that a thread takes


@dataclass(frozen=True, slots=True)
class BatchFigures:
    """Arrays with one entry an axis; units and meaning are those of `figures.cycles`: `Cycle` and `Summary`.

    Those from `direction` to `static_coefficient` are of the last complete cycle, NaN without one.
    """

    events: Numbers
    cycles: Numbers              # complete ones
    complete: NDArray[np.bool_]  # False: the solver gave up, or the run contradicts itself: no figures
    final_mode: Numbers          # `types.Mode`
    first_break_away: Numbers    # s
    stick_share: Numbers
    settled: NDArray[np.bool_]   # the last two periods differ by less than SETTLED of `figures.cycles`
    direction: Numbers
    rest_time: Numbers           # s
    slip_time: Numbers           # s
    stick_time: Numbers          # s
    period: Numbers              # s
    slip_travel: Numbers         # m
    jump: Numbers                # m
    peak_speed: Numbers          # m/s
    break_away_force: Numbers    # N
    static_coefficient: Numbers
    last_break_away: Numbers     # s, of the slip that goes on or was the last
    settling_time: Numbers       # s, the break-away from which on the periods settle, see `settled`


@dataclass(frozen=True, slots=True)
class Rounds:
    """Arrays with one entry an axis, of its rounds: from one break-away out of stick to the next.

    Without a round the figures of the last one are NaN.
    """

    sticks: Numbers          # rounds that do more than touch rest
    last_stick: Numbers      # s, end of the last of these sticks
    longest_pause: Numbers   # s, between the ends of two of them, in the second half of the run
    round_count: Numbers     # of all rounds
    round_period: Numbers    # s
    round_stick: Numbers     # s in stick, at its end
    round_travel: Numbers    # m, of the longest of its slips
    round_peak: Numbers      # m/s
    round_force: Numbers     # N, friction at the break-away
    round_settling: Numbers  # s, the break-away from which on each round takes as long as the one before, to SETTLED
    least_speed: Numbers     # m/s, of the latest swing of the slip that goes on
    lasts: NDArray[np.bool_]  # that slip never comes to rest again
    last_velocity: Numbers   # m/s, at the last event
    window: Numbers          # the latest rounds in turn, oldest first: (axes, rounds, 4); NaN before there were so many


def run_batch(axis: Axis, duration: float, *, drive_velocity: ArrayLike, external_force: ArrayLike = 0.0,
              initial: InitialState | None = None, threads: int | None = None, **changes: ArrayLike) -> BatchFigures:
    """Run an axis for `duration` s under every `drive_velocity` (m/s) and `external_force` (N), with `changes` to it.

    `changes` are arrays (or numbers) by the names in `batch_columns.COLUMNS`; all arrays have one length n, or 1.
    Those of velocities and coefficients have a row for each axis, or one for all.  `threads` is the number of cores to
    use (default: all).  Raises InputError on unknown names, lengths that do not match, and values without a meaning;
    nothing runs then.
    """
    return figures_in(_rows_of(axis, duration, 0, drive_velocity, external_force, initial, threads, changes))


def run_rounds(axis: Axis, duration: float, window: int, *, drive_velocity: ArrayLike, external_force: ArrayLike = 0.0,
               initial: InitialState | None = None, threads: int | None = None,
               **changes: ArrayLike) -> tuple[BatchFigures, Rounds]:
    """Run axes as `run_batch` does; return with the figures those of the rounds, and the last `window` of them."""
    out = _rows_of(axis, duration, window, drive_velocity, external_force, initial, threads, changes)
    return figures_in(out), rounds_in(out)


def rounds_in(out: Numbers) -> Rounds:
    """Return what rows of figures, filled by `solvers.exact.run_axes`, say of the rounds."""
    columns: dict[str, Any] = {name: _figure(out, name) for name in Rounds.__slots__ if name != 'window'}
    columns['lasts'] = columns['lasts'] == 1.0
    window = out[:, len(FIGURE_NAMES):].reshape(len(out), -1, ROUND_SIZE)
    kept = window.shape[1]
    turns = (columns['round_count'][:, None].astype(int) + np.arange(kept)) % max(kept, 1)
    return Rounds(**columns, window=np.take_along_axis(window, turns[:, :, None], axis=1))


def _rows_of(axis: Axis, duration: float, window: int, drive_velocity: ArrayLike, external_force: ArrayLike,
             initial: InitialState | None, threads: int | None, changes: Mapping[str, ArrayLike]) -> Numbers:
    """Return a row of figures for each axis; raises InputError."""
    initial = initial or InitialState()
    check_start(axis, initial)
    if threads is not None and not 1 <= threads <= 1024:
        raise InputError('threads', threads, '1 to 1024', 'leave it out for all cores')
    if not 0.0 < duration < np.inf:
        raise InputError('duration', duration, 'finite and > 0 s', 'give the seconds to simulate')
    velocity = _in_range('drive.velocity', 'drive_velocity', drive_velocity)
    force = _in_range('force.constant', 'external_force', external_force)
    arrays = {name: array_of(name, values) for name, values in changes.items()}
    count = common_length({'drive_velocity': velocity, 'external_force': force, **arrays})
    parameters = parameter_rows(axis, count, arrays)
    inputs = np.stack([np.broadcast_to(velocity, count), np.broadcast_to(force, count)], axis=1)
    starts = np.tile(astuple(initial), (count, 1))
    return _run(parameters, inputs, starts, float(duration), window, threads or os.cpu_count() or 1)


def _run(parameters: Numbers, inputs: Numbers, starts: Numbers, duration: float, window: int,
         threads: int) -> Numbers:
    count = len(parameters)
    out = new_rows(count, window)

    def work(first: int) -> None:
        of = exact.SOLVER.records
        state = of.State()
        state.accounting = 1.0
        exact.run_axes(parameters, inputs, starts, duration, first, min(first + _AT_A_TIME, count),
                       of.Parameters(parameters[0].tolist()), state, of.Events(_ROWS), of.Sinusoids([]), out)

    if threads == 1 or count <= _AT_A_TIME:   # starting a thread takes longer than many a run
        for first in range(0, count, _AT_A_TIME):
            work(first)
        return out
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, range(0, count, _AT_A_TIME)))
    return out


def new_rows(count: int, window: int = 0) -> Numbers:
    """Return rows for so many axes, with room for their latest `window` rounds, for `solvers.exact.run_axes`."""
    return np.tile([*_AT_THE_START, *[np.nan] * (ROUND_SIZE * window)], (count, 1))


def figures_in(out: Numbers) -> BatchFigures:
    """Return the figures in rows that were filled by `solvers.exact.run_axes`."""
    columns: dict[str, Any] = {name: _figure(out, name) for name in BatchFigures.__slots__ if name != 'settled'}
    columns['settled'] = period_repeats(_figure(out, 'period_before'), columns['period'], SETTLED)
    columns['complete'] = columns['complete'] == 1.0
    return BatchFigures(**columns)


def _figure(out: Numbers, name: str) -> Numbers:
    return out[:, FIGURE_NAMES.index(name)].copy()


def _in_range(parameter: str, name: str, values: ArrayLike) -> Numbers:
    numbers = array_of(name, values)
    check_range(parameter, name, numbers)
    return numbers
