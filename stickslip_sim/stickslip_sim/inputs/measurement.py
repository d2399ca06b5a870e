# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A measurement: columns of a CSV file, or topics of a bag, over one time, in SI."""

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..recording import Bag, RecordedMessage, open_bag
from ..scene.plausible import FASTEST, MEANT, Plausible, check_number
from .csv_table import ACCELERATIONS, FORCES, LENGTHS, SPEEDS, TIMES, CsvTable, Wanted, all_in_si, wanted_column

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


# Numbers of a topic of a bag over time, as a table of measured numbers.

LOG_TIME = 'log_time'
_ELEMENT = re.compile(r'(\w+)\[([^\]]+)\]')   # velocity[0], or velocity[axis_drive] of a message with names


class TopicTable:
    """The chosen fields of a topic in SI, a row a message, times from the first message on, s.

    A field is named as in `ros2 topic echo`: `velocity`, `wrench.force.x`, `velocity[0]`; an element of a JointState by
    its joint, too: `velocity[axis_drive]`.  `first` is the time of the first message, s.  Raises InputError and
    RecordingError.
    """

    def __init__(self, option: str, path: Path, topic: str, time: Wanted, wanted: Sequence[Wanted], most_rows: int
                 ) -> None:
        bag = open_bag(path)
        self._option = option
        self._name = f'{path.name}:{topic}'
        messages = self._messages(bag, bag.resolved(topic), most_rows)
        decoded = [bag.decode(message) for message in messages]
        self.columns = [self._times(time, messages, decoded), *(self._numbers(column, decoded) for column in wanted)]

    def refuse(self, row: int, value: object, allowed: str, fix: str) -> NoReturn:
        """Raise the InputError for a row of the numbers."""
        raise InputError(f'{self._name} message {row + 1}', value, allowed, fix)

    def _messages(self, bag: Bag, topic: str, most: int) -> list[RecordedMessage]:
        messages: list[RecordedMessage] = []
        for message in bag.messages([topic]):
            messages.append(message)
            if len(messages) > most:
                raise InputError(self._option, self._name, f'a topic of at most {most} messages',
                                 'take a part of the bag')
        if not messages:
            raise InputError(self._option, self._name, 'a topic with messages', 'it has none')
        return messages

    def _times(self, time: Wanted, messages: Sequence[RecordedMessage], decoded: Sequence[Any]) -> Numbers:
        if time.name == LOG_TIME:
            stamps = [message.log_time for message in messages]
        elif time.name == 'header.stamp':
            stamps = [message.header.stamp.sec * 10**9 + message.header.stamp.nanosec for message in decoded]
        else:
            numbers = self._numbers(time, decoded)
            self.first = float(numbers[0])
            since_first: Numbers = numbers - numbers[0]
            return since_first
        self.first = stamps[0] / 1e9
        return np.array([(stamp - stamps[0]) / 1e9 for stamp in stamps])

    def _numbers(self, column: Wanted, decoded: Sequence[Any]) -> Numbers:
        values = np.empty(len(decoded))
        for row, message in enumerate(decoded):
            try:
                values[row] = _value(message, column.name)
            except (AttributeError, IndexError, TypeError, ValueError):
                self.refuse(row, column.name, f'a field that is a number ({column.name_option})',
                            'name it as `ros2 topic echo` does, like velocity or wrench.force.x or velocity[0]')
        if not np.isfinite(values).all():
            row = int(np.argmin(np.isfinite(values)))
            self.refuse(row, float(values[row]), 'a finite number', 'leave such messages out')
        return all_in_si(values, column.in_si)


def _value(message: Any, path: str) -> float:
    value = message
    for part in path.split('.'):
        element = _ELEMENT.fullmatch(part)
        if element is None:
            value = getattr(value, part)
        else:
            place = element[2]
            index = int(place) if place.isdecimal() else list(value.name).index(place)
            value = getattr(value, element[1])[index]
    return float(value)
