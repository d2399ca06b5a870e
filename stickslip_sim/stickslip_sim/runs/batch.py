# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Thousands of axes at once: arrays of parameters in, arrays of cycle figures out.

    figures = run_batch(axis, 10.0, drive_velocity=np.geomspace(1e-4, 1e-2, 10_000))
    figures.period[figures.cycles > 1]

Every axis runs by itself from event to event, the same to the last bit as in a `Simulator`, with any number of
threads.
"""

import os
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import astuple, dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..axis import Axis, Friction, InitialState, check_start, layout, pack
from ..core import ranges
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..figures.rounds import period_repeats
from ..friction import KineticTable, kinetic_table
from ..friction.kinetic import default_excess
from ..friction.shapes import Decay
from ..scene import PARAMETERS
from ..solvers import exact
from ..solvers.exact.axis_figures import FIGURE_NAMES, ROUND_SIZE, AxisFigures
from ..solvers.exact.many_axes import SETTLED

# What may differ from axis to axis of a batch, by name, checked, and the rows of parameters that it makes.

# Kinetic friction that differs from axis to axis of a batch: each axis gets tables of its own.

_Values = Mapping[str, Any]

LISTS = ('velocities', 'coefficients')
_OF_A_TABLE = (*LISTS, 'end_slope')


def kinetic_rows(axis: Axis, count: int, given: Mapping[str, Numbers]) -> Numbers:
    """Return a row of `pack` for each axis with the kinetic friction of its own, all of one length.

    `given` has arrays by names as `coefficients`, and those with `backward_` before them, with one entry an axis or one
    for all.  An excess that ends linearly at v_gr, as it does where none is given, follows v_gr.  Static friction is
    left to who calls it.  Raises InputError.
    """
    friction, rows = _held(axis.friction), []
    for k in range(count):
        of_axis = {name: _plain(values[k if len(values) > 1 else 0]) for name, values in given.items()}
        try:
            rows.append(pack(replace(axis, friction=_changed(friction, of_axis))))
        except InputError as error:
            where = f'; look at index {k} of the array' if count > 1 else ''
            raise InputError(_name(error.name, given), error.value, error.allowed, error.fix + where) from None
    return np.array([[*row, *[0.0] * (max(map(len, rows)) - len(row))] for row in rows])


def _held(friction: Friction) -> Friction:
    """Return friction whose static part holds any kinetic one."""
    most = ranges.COEFFICIENT.high
    return replace(friction, static=replace(friction.static, initial=most, limit=most),
                   backward=friction.backward and _held(friction.backward))


def _plain(values: Any) -> Any:
    """Return a number of an array, or a row as a tuple of numbers."""
    return tuple(values.tolist()) if np.ndim(values) else float(values)


def _name(name: str, given: _Values) -> str:
    """Return the name in a batch of what an error of a table is about."""
    leaf = name.partition('[')[0].rpartition('.')[2]
    found = [known for known in given if known in (leaf, _BACKWARD + leaf)] or list(given)
    return f'kinetic_{found[0]}'


def _changed(friction: Friction, given: _Values) -> Friction:
    """Return the friction of an axis; what is not given backwards is as it was, or as forwards."""
    back = {name.removeprefix(_BACKWARD): value for name, value in given.items() if name.startswith(_BACKWARD)}
    ahead = {name: value for name, value in given.items() if not name.startswith(_BACKWARD)}
    forwards = _one_way(friction.sides[0], ahead)
    if friction.backward is None and not back:
        return forwards
    return replace(forwards, backward=_one_way(friction.backward or forwards, back))


def _one_way(friction: Friction, given: _Values) -> Friction:
    if not given:
        return friction
    old = friction.kinetic
    kinetic = _table(old, given) if old.law is None else _smooth(old, given)
    excess = friction.excess
    if excess is not None and excess == default_excess(old):
        excess = default_excess(kinetic)
    return replace(friction, kinetic=kinetic, excess=excess)


def _table(table: KineticTable, given: _Values) -> KineticTable:
    for name, value in given.items():
        if name not in _OF_A_TABLE:
            raise InputError(f'friction.kinetic.{name}', value, 'omitted when friction.kinetic.law is a table',
                             'give velocities and coefficients')
    return replace(table, **given)


def _smooth(table: KineticTable, given: _Values) -> KineticTable:
    law, changes = table.law, dict(given)
    assert law is not None
    for name, value in given.items():
        if name in _OF_A_TABLE or (name == 'exponent' and not isinstance(law.shape, Decay)):
            raise InputError(f'friction.kinetic.{name}', value, 'omitted with this smooth law of friction.kinetic',
                             'give the numbers of that law')
    if 'exponent' in changes:
        changes['shape'] = Decay(changes.pop('exponent'))
    return kinetic_table(replace(law, **changes), table.tolerance)


_KINETIC, _BACKWARD = 'kinetic_', 'backward_'
_STATIC = {'initial': (layout.STATIC_INITIAL, layout.BACKWARD_INITIAL),
           'limit': (layout.STATIC_LIMIT, layout.BACKWARD_LIMIT),
           'time_constant': (layout.STATIC_TAU, layout.BACKWARD_TAU),
           'exponent': (layout.STATIC_EXPONENT, layout.BACKWARD_EXPONENT)}
_OF_KINETIC = ('velocities', 'coefficients', 'end_slope', 'initial', 'limit', 'stribeck_velocity', 'exponent',
               'viscous')


class Column(NamedTuple):
    """The parameter of a scene that a column is, and where it stands in a row; None: its tables are made anew."""

    parameter: str
    at: int | None = None


BATCH_COLUMNS: Mapping[str, Column] = {
    'mass': Column('axis.mass', layout.MASS),
    'drive_stiffness': Column('axis.drive_stiffness', layout.STIFFNESS),
    'drive_damping': Column('axis.drive_damping', layout.DAMPING),
    'normal_force': Column('axis.normal_force', layout.NORMAL),
    'contact_stiffness': Column('contact.stiffness', layout.CONTACT_STIFFNESS),
    'contact_damping': Column('contact.damping', layout.CONTACT_DAMPING),
    **{f'static_{name}': Column(f'friction.static.{name}', at) for name, (at, _) in _STATIC.items()},
    **{f'static_backward_{name}': Column(f'friction.static.backward.{name}', at) for name, (_, at) in _STATIC.items()},
    **{f'kinetic_{name}': Column(f'friction.kinetic.{name}') for name in _OF_KINETIC},
    **{f'kinetic_backward_{name}': Column(f'friction.kinetic.backward.{name}') for name in _OF_KINETIC},
}


def array_of(name: str, values: ArrayLike) -> Numbers:
    """Return the values of a column, one entry an axis; raises InputError on an unknown name or shape."""
    array = np.asarray(values, dtype=np.float64)
    if name.rpartition('_')[2] in LISTS:
        if array.ndim != 2 or 0 in array.shape:
            raise InputError(name, f'shape {array.shape}', 'an array of one row an axis, or of one row for all',
                             'a row has a number for each breakpoint')
        return array
    array = np.atleast_1d(array)
    if array.ndim != 1 or len(array) == 0:
        raise InputError(name, f'shape {array.shape}', 'a number or an array of one dimension', 'flatten it')
    return array


def parameter_rows(axis: Axis, count: int, given: Mapping[str, Numbers]) -> Numbers:
    """Return a row of `pack` for each of `count` axes with the given columns; raises InputError."""
    for name, values in given.items():
        check_range(_column(name, axis).parameter, name, values)
    kinetic = {name.removeprefix(_KINETIC): values for name, values in given.items() if name.startswith(_KINETIC)}
    packed = np.array(pack(axis))
    rows = kinetic_rows(axis, count, kinetic) if kinetic else np.tile(packed, (count, 1))
    for places in _STATIC.values():
        rows[:, places] = packed[[*places]]
    for name, values in _with_backward(axis, given).items():
        at = BATCH_COLUMNS[name].at
        if at is not None:
            rows[:, at] = values
    if any(name.startswith(f'static_{_BACKWARD}') for name in given):
        rows[:, layout.SIDED] = 1.0
    _check_friction(rows)
    return rows


def check_range(parameter: str, name: str, values: Numbers) -> None:
    """Raise InputError, under a name of the batch, unless all values are such as a scene may have for a parameter."""
    known = next(known for known in PARAMETERS if known.name == parameter)
    low, high = -np.inf if known.low is None else known.low, np.inf if known.high is None else known.high
    good = np.isfinite(values) & ((values > low) if known.low_open else (values >= low)) & (values <= high)
    if not good.all():
        index = int(np.flatnonzero(~good.reshape(len(good), -1).all(axis=1))[0])
        raise InputError(name, float(values[~good][0]), f'finite and {known.range} {known.unit}'.rstrip(),
                         f'check index {index} of the array')


def common_length(arrays: Mapping[str, Numbers]) -> int:
    """Return the number of axes; raises InputError when arrays do not belong together."""
    count = max(map(len, arrays.values()))
    for name, values in arrays.items():
        if len(values) not in (1, count):
            raise InputError(name, f'{len(values)} values', f'1 or {count}, as many as the longest array',
                             'arrays belong together index by index')
    return count


def _with_backward(axis: Axis, given: Mapping[str, Numbers]) -> dict[str, Numbers]:
    """Return the columns with those backwards that are as those forwards: all of an axis that has one friction."""
    if axis.friction.backward is not None:
        return dict(given)
    both = {f'static_{_BACKWARD}{name}': given[f'static_{name}'] for name in _STATIC if f'static_{name}' in given}
    return both | dict(given)


def _column(name: str, axis: Axis) -> Column:
    if name not in BATCH_COLUMNS:
        raise InputError(name, 'given', 'one of drive_velocity, external_force, ' + ', '.join(BATCH_COLUMNS),
                         'rename it, or leave it out')
    if name.startswith('contact_') and not pack(axis)[layout.COMPLIANT]:
        raise InputError(name, 'given', 'omitted with a rigid contact', 'give the axis a compliant contact')
    return BATCH_COLUMNS[name]


def _check_friction(rows: Numbers) -> None:
    """Raise InputError where static friction is below kinetic friction at rest, or falls with the rest time."""
    at_rest = layout.TABLE + layout.SEGMENT_FIELDS.index('friction')
    backwards = (at_rest + layout.SEGMENT_SIZE * rows[:, layout.BACKWARD_SEGMENT]).astype(int)
    _check_side(rows, (layout.STATIC_INITIAL, layout.STATIC_LIMIT), rows[:, at_rest], '')
    _check_side(rows, (layout.BACKWARD_INITIAL, layout.BACKWARD_LIMIT), rows[np.arange(len(rows)), backwards],
                _BACKWARD)


def _check_side(rows: Numbers, places: Iterable[int], at_rest: Numbers, side: str) -> None:
    initial, limit = (rows[:, place] for place in places)
    for bad, values, name, allowed in (
            (at_rest > initial, initial, 'initial', '>= the kinetic coefficient at rest'),
            (limit < initial, limit, 'limit', f'>= static_{side}initial')):
        if bad.any():
            index = int(np.flatnonzero(bad)[0])
            raise InputError(f'static_{side}{name}', float(values[index]), allowed,
                             f'check index {index} of the array')


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

    `changes` are arrays (or numbers) by the names in `batch.COLUMNS`; all arrays have one length n, or 1.
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
