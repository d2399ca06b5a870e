# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A measurement: columns of a file or arrays, or topics of a bag, over one time, in SI."""

import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from ..core.arrays import Numbers, has_parquet
from ..core.errors import ALLOW, InputError
from ..recording import Bag, MeasuredRun, RecordedMessage, open_bag, write_measured
from ..report.html import Shown
from ..report.model import Part, Table
from ..report.quantity import quantity
from ..scene.plausible import FASTEST, Plausible, check_number
from . import csv_table
from .csv_table import ALL, ArrayTable, CsvTable, Rows
from .units import ACCELERATIONS, FORCES, LENGTHS, SPEEDS, TIMES, Wanted, all_in_si, drive_units, wanted_column

QUANTITIES: Mapping[str, Mapping[str, Fraction]] = {
    'time': TIMES, 'position': LENGTHS, 'velocity': SPEEDS, 'acceleration': ACCELERATIONS, 'drive_position': LENGTHS,
    'drive_velocity': SPEEDS, 'drive_force': FORCES, 'friction_force': FORCES, 'external_force': FORCES,
}
MOST_ROWS = 20_000_000
_MOST_BYTES = 4 << 30
_LATEST = 9e9      # s: later, or before 0, no run begins
_PART = 1 << 18    # rows that are looked at together
_FARTHEST = 10.0   # m, of a feed axis
_APART = 20
COLUMNS_OPTION, UNIT_OPTION = '--columns', '--unit'


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


@dataclass(frozen=True, repr=False)
class Measurement(Shown):
    """What was measured: `columns` by quantity over `times` (s, rising), in SI; `remarks` say what was done to them.

    The quantities are position, velocity and acceleration of the slider (m, m/s, m/s2), drive_position,
    drive_velocity, drive_force, friction_force and external_force (N).
    """

    times: Numbers
    columns: dict[str, Numbers]
    remarks: tuple[str, ...] = ()
    facts: Mapping[str, str] = field(default_factory=dict)

    def _shown(self) -> Iterator[Part]:
        yield (f'Measurement: {len(self.times)} rows, {self.times[0]:.6g} to {self.times[-1]:.6g} s: '
               f'{", ".join(self.columns)}')
        yield Table(('', 'least', 'most'), [(name, *(quantity(end, next(iter(QUANTITIES[name])), 4) for end in (
            values.min(), values.max()))) for name, values in self.columns.items()])
        yield from self.remarks

    @classmethod
    def from_arrays(cls, *, time: Any, units: Mapping[str, str] | None = None, lead: str | None = None,
                    rated: str | None = None, **quantities: Any) -> 'Measurement':
        """Return a measurement of arrays (n,), as `from_arrays(time=t, position=x, units={'position': 'mm'})`.

        Units that are not given are SI; `lead`, as '10 mm', converts rpm, rad/s and N m, `rated`, as '2.4 N m' or
        '800 N', a force in %.  Raises InputError.
        """
        return cls.from_frame({'time': time, **quantities}, {name: name for name in ('time', *quantities)}, units,
                              lead, rated)

    @classmethod
    def from_frame(cls, frame: Any, columns: Mapping[str, str], units: Mapping[str, str] | None = None,
                   lead: str | None = None, rated: str | None = None) -> 'Measurement':
        """Return a measurement of a DataFrame, or a dict of arrays; `columns` by quantity, as {'position': 'x [mm]'}.

        Units and raises as `from_arrays`; the heading of a column may have its unit.
        """
        wanted = _wanted(columns, units or {}, lead, rated)
        arrays = {str(name): frame[name] for name in frame}
        return _of_table(wanted, ArrayTable('frame', 'frame', arrays, list(wanted.values()), MOST_ROWS))

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], columns: Mapping[str, str],
                  units: Mapping[str, str] | None = None, lead: str | None = None, rows: Rows = ALL,
                  rated: str | None = None) -> 'Measurement':
        """Return what a file measured: CSV, .mat, .parquet, .tdms, or a bag, whose columns are TOPIC:FIELD.

        A column is a name, a number from 1 on, or `row`.  Raises InputError and RecordingError.
        """
        path, wanted = Path(path), _wanted(columns, units or {}, lead, rated)
        if path.is_dir() or path.suffix == '.mcap':
            return _of_bag(path, wanted)._taken(rows)
        if 'time' not in wanted:
            raise InputError(COLUMNS_OPTION, ','.join(columns), 'with the time of each row', 'add time=COLUMN, or '
                             f'time=row, and how long a row is: {UNIT_OPTION} time="0.5 ms"')
        wanted = {'time': wanted['time'], **wanted}
        reader, given = _READERS.get(path.suffix.lower()), list(wanted.values())
        return _of_table(wanted, CsvTable('DATA', path, given, MOST_ROWS, rows, _MOST_BYTES) if reader is None else
                         ArrayTable('DATA', path.name, reader(path), given, MOST_ROWS, rows))

    def with_spring(self, stiffness: float, feed: float | None = None) -> 'Measurement':
        """Return it with the position x = s − F/k of a slider that is pulled by a spring of a `stiffness` k, N/m.

        F is the drive force; s is v t at a `feed` v, m/s, or the drive position where that was measured.
        """
        force, drive = self.columns.get('drive_force'), self.columns.get('drive_position')
        if force is None or 'position' in self.columns:
            raise InputError('--stiffness', stiffness, 'for a measurement of the force without the position',
                             'add drive_force=COLUMN' if force is None else 'leave the position, or --stiffness, out')
        if (feed is None) == (drive is None):
            raise InputError('--feed', feed, 'the feed of the spring, where its position was not measured',
                             'give it, as "2 mm/s"' if feed is None else 'leave it, or drive_position, out')
        if not 0.0 < stiffness < math.inf or not math.isfinite(feed or 0.0):
            raise InputError('--stiffness', stiffness, '> 0 N/m, and a finite feed', 'for example 600 N/mm')
        way = (feed or 0.0) * (self.times - self.times[0]) if drive is None else drive
        formula = f'x = {"s" if drive is not None else "v t"} - F/k, k = {stiffness:g} N/m' + (
            '' if feed is None else f', v = {feed:g} m/s')
        return replace(self, columns={**self.columns, 'position': way - force / stiffness, 'drive_position': way},
                       remarks=(*self.remarks, f'the position is derived, not measured: {formula}'),
                       facts={**self.facts, 'derived': 'position', 'stiffness': repr(stiffness)})

    def write(self, folder: str | os.PathLike[str], facts: Mapping[str, str] | None = None) -> None:
        """Write it as a new run folder, which every verb and `read_run` take.  Raises InputError, RecordingError."""
        if not {'position', 'velocity'} & set(self.columns):
            raise InputError(COLUMNS_OPTION, ','.join(self.columns), 'with a position or a velocity of the slider',
                             'without them there is no motion; a force and the --stiffness of its spring will do')
        remark = {'remark': '; '.join(self.remarks)} if self.remarks else {}
        write_measured(Path(folder), self.times, self.columns, {**self.facts, **(facts or {}), **remark})

    def as_run(self, folder: str | os.PathLike[str]) -> MeasuredRun:
        """Return the run of the folder that it was written to, without reading that."""
        return MeasuredRun(Bag(Path(folder)), os.fspath(folder), {'time': self.times, **self.columns})

    def _taken(self, rows: Rows) -> 'Measurement':
        of = np.flatnonzero((self.times >= rows.begin) & (self.times <= rows.end))
        of = of[of % rows.every == 0]
        if len(of) < 2:
            raise InputError('DATA', f'{len(of)} rows', 'two rows or more', 'check --from, --to and --every')
        return replace(self, times=self.times[of], columns={name: one[of] for name, one in self.columns.items()})


def _wanted(columns: Mapping[str, str], units: Mapping[str, str], lead: str | None, rated: str | None
            ) -> dict[str, Wanted]:
    for option, names in ((COLUMNS_OPTION, columns), (UNIT_OPTION, units)):
        for name in names:
            if name not in QUANTITIES:
                raise InputError(option, name, 'a quantity', 'the quantities are ' + ', '.join(QUANTITIES))
    for name in units:
        if name not in columns:
            raise InputError(UNIT_OPTION, name, f'of a quantity in {COLUMNS_OPTION}', 'add its column')
    drive = drive_units(lead, rated)
    return {name: wanted_column(COLUMNS_OPTION, str(column), UNIT_OPTION, units.get(name), drive.of(QUANTITIES[name]),
                                takes_heading=True) for name, column in columns.items()}


def _of_table(wanted: Mapping[str, Wanted], table: csv_table.Table) -> Measurement:
    numbers = dict(zip(wanted, table.columns, strict=True))
    units = ', '.join(f'{name} {one.unit}' for name, one, given in zip(wanted, table.wanted, wanted.values())
                      if one.unit != given.unit)
    times, remarks = numbers.pop('time'), [*table.remarks]
    if units:
        remarks.append(f'units of the headings: {units}')
    if len(times) < 2:
        raise InputError('DATA', f'{len(times)} rows', 'a file of two rows or more', 'a run needs a duration')
    if times[0] < 0.0 or times[-1] > _LATEST:
        remarks.append(f'times count from the first row, at {float(times[0])!r} s')
        times = times - times[0]
    return Measurement(times, numbers, tuple(remarks))


# Files that hold arrays by name.

def _mat(path: Path) -> Mapping[str, Any]:
    from scipy.io import loadmat

    try:
        held = loadmat(path, squeeze_me=True)
    except NotImplementedError:
        raise InputError('DATA', str(path), 'a MAT file up to version 7', "save it with save(..., '-v7')") from None
    except (OSError, ValueError, TypeError) as error:
        raise InputError('DATA', str(path), 'a readable MAT file', str(error)) from None
    return dict(_vectors({name: value for name, value in held.items() if not name.startswith('__')}))


def _vectors(held: Mapping[str, Any], of: str = '') -> Iterator[tuple[str, Any]]:
    """Yield the columns in variables: vectors, columns of matrices as x[1], fields of structures as run.x."""
    for name, value in held.items():
        array = np.asarray(value)
        if array.dtype.names and array.ndim == 0:
            yield from _vectors({part: array[part].item() for part in array.dtype.names}, f'{of}{name}.')
        elif array.ndim == 1 and array.dtype.kind in 'fiub':
            yield f'{of}{name}', array
        elif array.ndim == 2 and array.dtype.kind in 'fiub':
            yield from ((f'{of}{name}[{k}]', column) for k, column in enumerate(array.T, 1))


def _parquet(path: Path) -> Mapping[str, Any]:
    if not has_parquet():
        raise InputError('DATA', str(path), 'read by pandas with fastparquet or pyarrow, which are not installed',
                         'pip install pandas fastparquet, or export it as CSV')
    import pandas

    try:
        frame = pandas.read_parquet(path)
    except (OSError, ValueError) as error:
        raise InputError('DATA', str(path), 'a readable Parquet file', str(error)) from None
    return {str(name): frame[name].to_numpy() for name in frame}


def _tdms(path: Path) -> Mapping[str, Any]:
    try:
        from nptdms import TdmsFile  # type: ignore[import-not-found]
    except ImportError:
        raise InputError('DATA', str(path), 'read by npTDMS, which is not installed',
                         'pip install npTDMS, or export it as CSV') from None
    try:
        channels = [channel for group in TdmsFile.read(path).groups() for channel in group.channels()]
    except (OSError, ValueError) as error:
        raise InputError('DATA', str(path), 'a readable TDMS file', str(error)) from None
    names = [channel.name for channel in channels]
    heads = [(channel.name if names.count(channel.name) == 1 else f'{channel.group_name}/{channel.name}')
             + (f' [{unit}]' if (unit := channel.properties.get('unit_string')) else '') for channel in channels]
    found = {head: channel[:] for head, channel in zip(heads, channels, strict=True)}
    waves = [channel for channel in channels if 'wf_increment' in channel.properties]
    return {**({'time': waves[0].time_track()} if waves and 'time' not in found else {}), **found}


_READERS = {'.mat': _mat, '.parquet': _parquet, '.tdms': _tdms}


def check_plausible_motion(measured: Measurement, meant: Sequence[str]) -> None:
    """Raise InputError on a quantity that moves as far or as fast as no feed axis does, unless it is among `meant`."""
    for name in meant:
        if name not in measured.columns:
            raise InputError(ALLOW, name, 'one of ' + ', '.join(measured.columns), 'nothing else was imported')
    for name, values in measured.columns.items():
        unit = f'a wrong unit is the usual mistake: {UNIT_OPTION} {name}='
        if name in meant or QUANTITIES[name] not in (LENGTHS, SPEEDS):
            continue
        low, high = float(values.min()), float(values.max())
        if QUANTITIES[name] is SPEEDS:
            check_number(name, max(-low, high), Plausible(FASTEST, 'm/s', f'{unit}mm/s'))
            continue
        check_number(name, high - low, Plausible(_FARTHEST, 'm', f'{unit}mm'))
        apart = min(_APART, len(values) - 1)   # readings: noise of single ones makes no speed
        for first in range(0, len(values) - apart, _PART):
            end = min(first + _PART, len(values) - apart)
            ways, times = (one[first + apart:end + apart] - one[first:end] for one in (values, measured.times))
            check_number(name, float(np.abs(ways / times).max()), Plausible(FASTEST, 'm/s', f'{unit}mm'))


def _of_bag(path: Path, wanted: Mapping[str, Wanted]) -> Measurement:
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
    remark = f'{" and ".join(others)}: linear between messages, at the times of {first}'
    return Measurement(times, columns, (remark,) if others else ())


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
