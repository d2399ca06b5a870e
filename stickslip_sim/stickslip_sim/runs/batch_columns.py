# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What may differ from axis to axis of a batch, by name, checked, and the rows of parameters that it makes."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..axis import Axis, Friction, pack
from ..axis.layout import (
    BACKWARD_EXPONENT,
    BACKWARD_INITIAL,
    BACKWARD_LIMIT,
    BACKWARD_SEGMENT,
    BACKWARD_TAU,
    COMPLIANT,
    CONTACT_DAMPING,
    CONTACT_STIFFNESS,
    DAMPING,
    MASS,
    NORMAL,
    SEGMENT_FIELDS,
    SEGMENT_SIZE,
    SIDED,
    STATIC_EXPONENT,
    STATIC_INITIAL,
    STATIC_LIMIT,
    STATIC_TAU,
    STIFFNESS,
    TABLE,
)
from ..core import ranges
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..friction import KineticTable, kinetic_table
from ..friction.kinetic import default_excess
from ..friction.shapes import Decay
from ..scene import PARAMETERS

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
            raise InputError(f'friction.kinetic.{name}', value, 'left out where friction.kinetic.law is a table',
                             'give velocities and coefficients')
    return replace(table, **given)


def _smooth(table: KineticTable, given: _Values) -> KineticTable:
    law, changes = table.law, dict(given)
    assert law is not None
    for name, value in given.items():
        if name in _OF_A_TABLE or (name == 'exponent' and not isinstance(law.shape, Decay)):
            raise InputError(f'friction.kinetic.{name}', value, 'left out with this smooth law of friction.kinetic',
                             'give the numbers of that law')
    if 'exponent' in changes:
        changes['shape'] = Decay(changes.pop('exponent'))
    return kinetic_table(replace(law, **changes), table.tolerance)


_KINETIC, _BACKWARD = 'kinetic_', 'backward_'
_STATIC = {'initial': (STATIC_INITIAL, BACKWARD_INITIAL), 'limit': (STATIC_LIMIT, BACKWARD_LIMIT),
           'time_constant': (STATIC_TAU, BACKWARD_TAU), 'exponent': (STATIC_EXPONENT, BACKWARD_EXPONENT)}
_OF_KINETIC = ('velocities', 'coefficients', 'end_slope', 'initial', 'limit', 'stribeck_velocity', 'exponent',
               'viscous')


class Column(NamedTuple):
    """The parameter of a scene that a column is, and where it stands in a row; None: its tables are made anew."""

    parameter: str
    at: int | None = None


BATCH_COLUMNS: Mapping[str, Column] = {
    'mass': Column('axis.mass', MASS),
    'drive_stiffness': Column('axis.drive_stiffness', STIFFNESS),
    'drive_damping': Column('axis.drive_damping', DAMPING),
    'normal_force': Column('axis.normal_force', NORMAL),
    'contact_stiffness': Column('contact.stiffness', CONTACT_STIFFNESS),
    'contact_damping': Column('contact.damping', CONTACT_DAMPING),
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
        rows[:, SIDED] = 1.0
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
                         f'look at index {index} of the array')


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
    if name.startswith('contact_') and not pack(axis)[COMPLIANT]:
        raise InputError(name, 'given', 'left out with a rigid contact', 'give the axis a compliant contact')
    return BATCH_COLUMNS[name]


def _check_friction(rows: Numbers) -> None:
    """Raise InputError where static friction is below kinetic friction at rest, or falls with the rest time."""
    at_rest = TABLE + SEGMENT_FIELDS.index('friction')
    backwards = (at_rest + SEGMENT_SIZE * rows[:, BACKWARD_SEGMENT]).astype(int)
    _check_side(rows, (STATIC_INITIAL, STATIC_LIMIT), rows[:, at_rest], '')
    _check_side(rows, (BACKWARD_INITIAL, BACKWARD_LIMIT), rows[np.arange(len(rows)), backwards], _BACKWARD)


def _check_side(rows: Numbers, places: Iterable[int], at_rest: Numbers, side: str) -> None:
    initial, limit = (rows[:, place] for place in places)
    for bad, values, name, allowed in (
            (at_rest > initial, initial, 'initial', '>= the kinetic coefficient at rest'),
            (limit < initial, limit, 'limit', f'>= static_{side}initial')):
        if bad.any():
            index = int(np.flatnonzero(bad)[0])
            raise InputError(f'static_{side}{name}', float(values[index]), allowed,
                             f'look at index {index} of the array')
