# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Profiles from files: the times and values that are in `drive.file`, `force.file`, `normal_load.file` of a scene.

So a scene, its hash, its bag and its receipt hold the numbers, and nothing needs the file any more.
"""

from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.time_grid import decimal, multiples
from ..scene.model import ProfileSource
from ..scene.schema import BY_NAME, FILE_SETTINGS, MOST_POINTS
from .csv_table import CsvTable
from .units import FORCES, LENGTHS, SPEEDS, TIMES, Wanted, wanted_column

Given = Mapping[str, object]
_POSITION = 'position'
# the first when none is stated
_FORMS = {'drive': ('table', 'steps', _POSITION), 'force': ('table', 'steps'), 'normal_load': ('table', 'steps')}


class _Kind(NamedTuple):
    """Where the values of a profile go, the column that has them when none is named, and their units; first SI."""

    values: str
    column: str
    units: Mapping[str, Fraction]


_KINDS = {'drive': _Kind('velocities', 'velocity', SPEEDS), 'force': _Kind('forces', 'force', FORCES),
          'normal_load': _Kind('forces', 'force', FORCES)}
_PLACES = _Kind('positions', 'position', LENGTHS)   # with `course: position`
_NUMBERS = {'drive': ('times', 'velocities', 'positions', 'slopes'), 'force': ('times', 'forces'),
            'normal_load': ('times', 'forces')}


class _Table(Protocol):
    columns: list[Numbers]

    def refuse(self, row: int, value: object, allowed: str, fix: str) -> Any:
        """Raise InputError for a row."""


def sections_with_file(values: Given) -> list[str]:
    """Return the sections that have a file."""
    return [section for section in _FORMS if values.get(f'{section}.file') is not None]


def prepared(base: Given, changes: Given) -> tuple[dict[str, object], dict[str, object]]:
    """Return the values of a scene and changes to them, such that a file replaces points, and points replace a file."""
    base, changes = dict(base), dict(changes)
    for section, forms in _FORMS.items():
        form = f'{section}.course'
        numbers = {f'{section}.{name}' for name in _NUMBERS[section]}
        settings = {f'{section}.{name}' for name in FILE_SETTINGS}
        if f'{section}.file' in changes:
            changes.setdefault(form, base.get(form) if base.get(form) in forms else forms[0])
            base = {name: value for name, value in base.items() if name not in numbers | settings}
        elif f'{section}.file' in base and numbers & set(changes):
            base = {form: forms[0], **{name: value for name, value in base.items() if name not in settings}}
    return base, changes


def with_profiles(values: Given, folders: Mapping[str, Path]) -> tuple[dict[str, object], dict[str, ProfileSource]]:
    """Return the values of a scene with the points of its files, which lie in the `folders` of their sections.

    Beside them come the sources by section.  Raises InputError and RecordingError.
    """
    result, sources = dict(values), {}
    for section in sections_with_file(values):
        given = {name: result.pop(f'{section}.{name}') for name in FILE_SETTINGS
                 if result.get(f'{section}.{name}') is not None}
        checked = {name: BY_NAME[f'{section}.{name}'].checked(value) for name, value in given.items()}
        result.setdefault(f'{section}.course', _FORMS[section][0])
        _check_alone(section, result, str(checked['file']))
        profile = _Profile(section, str(result[f'{section}.course']), checked, folders.get(section, Path()))
        result[f'{section}.times'], result[f'{section}.{profile.kind.values}'] = profile.points()
        sources[section] = profile.source
    return result, sources


def _check_alone(section: str, values: Given, file: str) -> None:
    if values[f'{section}.course'] not in _FORMS[section]:
        raise InputError(f'{section}.file', file, f'omitted with {section}.course: {values[f"{section}.course"]}',
                         f'drop it, or set {section}.course: table (linear between the points) or steps')
    for name in _NUMBERS[section]:
        if values.get(f'{section}.{name}') is not None:
            raise InputError(f'{section}.file', file, f'omitted with {section}.{name}', 'drop one of them')


class _Profile:
    """One profile as a file has it, and what is asked of it."""

    def __init__(self, section: str, form: str, given: Mapping[str, Any], folder: Path) -> None:
        self._section, self._held, self._given, self._folder = section, form == 'steps', given, folder
        self.kind = kind = _PLACES if form == _POSITION else _KINDS[section]
        self._file = str(given['file'])
        self._column = self._wanted('file_column', kind.column, 'file_unit', kind.units)
        self._most = BY_NAME[f'{section}.{kind.values}']
        self.source = ProfileSource(self._file, self._column.name, str(given.get('file_unit', self._column.unit)))

    def points(self) -> tuple[list[float], list[float]]:
        """Return the times and values; raises InputError."""
        table = self._table()
        self._check(table)
        times, values = self._begun(table)
        if 'file_resample' in self._given:
            times, values = self._resampled(times, values, self._given['file_resample'])
        return times.tolist(), values.tolist()

    def _table(self) -> _Table:
        option, path = f'{self._section}.file', self._folder / self._file
        bag, colon, topic = self._file.rpartition(':')
        if colon and not path.is_file():
            from .measurement import LOG_TIME, TopicTable

            return TopicTable(option, self._folder / bag, topic, self._time(LOG_TIME), [self._column], MOST_POINTS)
        return CsvTable(option, path, [self._time('time'), self._column], MOST_POINTS)

    def _time(self, default: str) -> Wanted:
        return self._wanted('file_time', default, 'file_time_unit', TIMES)

    def _wanted(self, name: str, default: str, unit: str, units: Mapping[str, Fraction]) -> Wanted:
        return wanted_column(f'{self._section}.{name}', str(self._given.get(name, default)),
                             f'{self._section}.{unit}', self._given.get(unit), units)

    def _check(self, table: _Table) -> None:
        times, values = table.columns
        late = np.flatnonzero(np.diff(times) <= 0.0)
        if len(late):
            row = int(late[0]) + 1
            table.refuse(row, float(times[row]), f'a time after the one before it, {float(times[row - 1])!r} s',
                         'sort the rows by time and drop duplicates')
        large = np.flatnonzero(np.abs(values) > (self._most.high or 0.0))
        if len(large):
            table.refuse(int(large[0]), float(values[large[0]]), self._most.range + f' {self._most.unit}',
                         f'correct it, or {self._column.unit_option}')

    def _begun(self, table: _Table) -> tuple[Numbers, Numbers]:
        """Return times and values from where the run starts."""
        times, values = table.columns
        begin, option = self._given.get('file_begin', 0.0), f'{self._section}.file_begin'
        if 'file_begin' not in self._given and times[0] != 0.0:
            table.refuse(0, float(times[0]), '0 s in the first row, where the run starts',
                         f'set {option} to start the run at another time of the file, like {float(times[0])!r}')
        if not times[0] <= begin <= times[-1]:
            raise InputError(option, begin, f'within the times of the file, {float(times[0])!r} to '
                             f'{float(times[-1])!r} s', 'give a time of the file')
        first = int(np.searchsorted(times, begin, 'right')) - 1
        value = values[first] if self._held else np.interp(begin, times, values)
        later = times[first + 1:]
        if begin:
            zero = Decimal(repr(begin))
            later = np.array([float(Decimal(repr(time)) - zero) for time in later.tolist()])
        return np.append(0.0, later), np.append(value, values[first + 1:])

    def _resampled(self, times: Numbers, values: Numbers, period: float) -> tuple[Numbers, Numbers]:
        count = int(decimal(float(times[-1])) / decimal(period)) + 1
        if count > MOST_POINTS:
            raise InputError(f'{self._section}.file_resample', period, f'long enough for at most {MOST_POINTS} points',
                             f'this would be {count}')
        grid = multiples(decimal(period), 0, count)
        if self._held:
            return grid, values[np.searchsorted(times, grid, 'right') - 1]
        return grid, np.interp(grid, times, values)
