# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What may differ from axis to axis of a batch, by name, checked, and the rows of parameters that it makes."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..axis import Axis, pack
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
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..scene import PARAMETERS
from .batch_kinetic import LISTS, kinetic_rows

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
