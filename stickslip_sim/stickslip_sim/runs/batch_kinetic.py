# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Kinetic friction that differs from axis to axis of a batch: each axis gets tables of its own."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..axis import Axis, Friction, pack
from ..core import ranges
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..friction import KineticTable, kinetic_table
from ..friction.kinetic import default_excess
from ..friction.shapes import Decay

_Values = Mapping[str, Any]

LISTS = ('velocities', 'coefficients')
_OF_A_TABLE = (*LISTS, 'end_slope')
_BACKWARD = 'backward_'


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
