# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A measurement: columns of a CSV file, or topics of a bag, over one time, in SI."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..scene.plausible import FASTEST, MEANT, Plausible, check_number
from .csv_table import CsvTable, Wanted, wanted_column
from .units import ACCELERATIONS, FORCES, LENGTHS, SPEEDS, TIMES

QUANTITIES: Mapping[str, Mapping[str, Fraction]] = {
    'time': TIMES, 'position': LENGTHS, 'velocity': SPEEDS, 'acceleration': ACCELERATIONS, 'drive_position': LENGTHS,
    'drive_velocity': SPEEDS, 'drive_force': FORCES, 'friction_force': FORCES, 'external_force': FORCES,
}
MOST_ROWS = 2_000_000
_FARTHEST = 10.0   # m, of a feed axis
_APART = 20
COLUMNS_OPTION, UNIT_OPTION = '--columns', '--unit'


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
    wanted = {name: wanted_column(COLUMNS_OPTION, column, UNIT_OPTION, units.get(name), QUANTITIES[name])
              for name, column in columns.items()}
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


def check_plausible_motion(measured: MeasuredColumns, meant: Sequence[str]) -> None:
    """Raise InputError on a quantity that moves as far or as fast as no feed axis does, unless it is among `meant`."""
    for name in meant:
        if name not in measured.columns:
            raise InputError(MEANT, name, 'one of ' + ', '.join(measured.columns), 'nothing else was imported')
    for name, values in measured.columns.items():
        unit = f'a wrong unit is the usual mistake: {UNIT_OPTION} {name}='
        if name in meant or QUANTITIES[name] not in (LENGTHS, SPEEDS):
            continue
        if QUANTITIES[name] is SPEEDS:
            check_number(name, float(np.abs(values).max()), Plausible(FASTEST, 'm/s', f'{unit}mm/s'))
            continue
        check_number(name, float(np.ptp(values)), Plausible(_FARTHEST, 'm', f'{unit}mm'))
        apart = min(_APART, len(values) - 1)   # readings: noise of single ones makes no speed
        speeds = (values[apart:] - values[:-apart]) / (measured.times[apart:] - measured.times[:-apart])
        check_number(name, float(np.abs(speeds).max()), Plausible(FASTEST, 'm/s', f'{unit}mm'))


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
