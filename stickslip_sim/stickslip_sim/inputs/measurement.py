# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A measurement: columns of a CSV file, or topics of a bag, over one time, in SI."""

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from .csv_table import CsvTable, Wanted
from .units import ACCELERATIONS, FORCES, LENGTHS, SPEEDS, TIMES

QUANTITIES: Mapping[str, Mapping[str, Fraction]] = {
    'time': TIMES, 'position': LENGTHS, 'velocity': SPEEDS, 'acceleration': ACCELERATIONS, 'drive_position': LENGTHS,
    'drive_velocity': SPEEDS, 'drive_force': FORCES, 'friction_force': FORCES, 'external_force': FORCES,
}
MOST_ROWS = 2_000_000
COLUMNS_OPTION, UNIT_OPTION = '--columns', '--unit'
_SCALED = re.compile(r'([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,2})?)\s*\*?\s*(.+)')   # 0.05 um
_LARGEST = 1e15    # factor


class MeasuredColumns(NamedTuple):
    """`columns` by quantity over `times` (s, rising), in SI; `remark` says what was done to them."""

    times: Numbers
    columns: dict[str, Numbers]
    remark: str = ''


def pairs_of(option: str, words: Sequence[str]) -> dict[str, str]:
    """Return quantities with their columns or units, from words like `time=t,position=x`; raises InputError."""
    found: dict[str, str] = {}
    for part in ','.join(words).split(','):
        name, equals, value = (word.strip() for word in part.partition('='))
        if not equals or not value or name not in QUANTITIES:
            raise InputError(option, part, 'QUANTITY=NAME, separated by commas', 'the quantities are '
                             + ', '.join(QUANTITIES))
        if name in found:
            raise InputError(option, part, 'each quantity once', 'drop one')
        found[name] = value
    return found


def load_measurement(path: Path, columns: Mapping[str, str], units: Mapping[str, str]) -> MeasuredColumns:
    """Return what a file measured: a CSV file with named columns, or a bag, whose columns are TOPIC:FIELD.

    Raises InputError and RecordingError.
    """
    if not {'position', 'velocity'} & set(columns):
        raise InputError(COLUMNS_OPTION, ','.join(columns), 'with a position or a velocity of the slider',
                         'without them there is no motion')
    for name in units:
        if name not in columns:
            raise InputError(UNIT_OPTION, name, f'of a quantity in {COLUMNS_OPTION}', 'add its column')
    wanted = {name: _wanted(name, column, units.get(name)) for name, column in columns.items()}
    if path.is_dir() or path.suffix == '.mcap':
        return _of_bag(path, wanted)
    if 'time' not in wanted:
        raise InputError(COLUMNS_OPTION, ','.join(columns), 'with the time of each row', 'add time=COLUMN')
    table = CsvTable('DATA', path, list(wanted.values()), MOST_ROWS)
    numbers = dict(zip(wanted, table.columns, strict=True))
    times = numbers.pop('time')
    late = np.flatnonzero(np.diff(times) <= 0.0)
    if len(late):
        row = int(late[0]) + 1
        table.refuse(row, float(times[row]), f'a time after the one before it, {float(times[row - 1])!r} s',
                     'sort the rows by time, and leave out what is there twice')
    if len(times) < 2:
        raise InputError('DATA', path.name, 'a file of two rows or more', 'a run takes time')
    return MeasuredColumns(times, numbers)


def _wanted(name: str, column: str, unit: str | None) -> Wanted:
    """Return the column of a quantity; its unit may have a factor before it: `0.05 um` a count, `-1 mm`."""
    known = QUANTITIES[name]
    scaled = None if unit is None else _SCALED.fullmatch(unit.strip())
    factor = Fraction(scaled[1]) if scaled else Fraction(1)
    if factor == 0 or abs(factor) > _LARGEST:
        raise InputError(UNIT_OPTION, unit, 'a unit, or one with a factor that is not 0', 'for example 35.15 N')
    word = scaled[2] if scaled else unit or next(iter(known))
    return Wanted(COLUMNS_OPTION, column, UNIT_OPTION, word, known, factor)


def _of_bag(path: Path, wanted: Mapping[str, Wanted]) -> MeasuredColumns:
    """Return the topics of a bag at the times of the first one, from its first message on."""
    from .topic_table import LOG_TIME, TopicTable

    fields: dict[str, dict[str, Wanted]] = {}
    for name, column in wanted.items():
        topic, colon, field = column.name.rpartition(':')
        if name != 'time' and not colon:
            raise InputError(COLUMNS_OPTION, column.name, 'TOPIC:FIELD for a bag',
                             'for example position=joint_states:position[0]')
        if name != 'time':
            fields.setdefault(topic, {})[name] = column._replace(name=field)
    time = wanted.get('time', Wanted(COLUMNS_OPTION, LOG_TIME, UNIT_OPTION, 's', TIMES))
    tables = [TopicTable('DATA', path, topic, time, list(of.values()), MOST_ROWS) for topic, of in fields.items()]
    times = tables[0].columns[0]
    columns: dict[str, Numbers] = {}
    for table, of in zip(tables, fields.values(), strict=True):
        own = table.columns[0] + (table.first - tables[0].first)
        if not (np.diff(own) > 0.0).all():
            row = int(np.argmax(np.diff(own) <= 0.0)) + 1
            table.refuse(row, float(own[row]), 'a time after the one before it', 'take header.stamp for the time')
        inside = (times >= own[0]) & (times <= own[-1])
        times = times[inside]
        columns = {name: column[inside] for name, column in columns.items()}
        columns |= {name: np.interp(times, own, column) for name, column in zip(of, table.columns[1:], strict=True)}
    if len(times) < 2:
        raise InputError('DATA', path.name, 'a bag whose topics have a time in common', 'import fewer of them')
    first, *others = fields
    return MeasuredColumns(times, columns, f'{" and ".join(others)}: linear between messages, at the times of {first}'
                       if others else '')
