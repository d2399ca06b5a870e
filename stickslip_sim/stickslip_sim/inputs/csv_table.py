# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A table of measured numbers from a CSV file, whose first line has the names of its columns.

Separated by commas, semicolons, tabs or spaces; with all but commas a decimal comma is read too.  What follows a `#` is
a remark.  Numbers are read by numpy; only a file that it refuses is gone through line by line, to say where.
"""

import csv
import difflib
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from itertools import islice
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.errors import InputError, not_utf8, paths_beside, suggestion

# Units of measured data, and their numbers in SI, rounded once.

SPEEDS: Mapping[str, Fraction] = {
    'm/s': Fraction(1), 'cm/s': Fraction(1, 100), 'mm/s': Fraction(1, 1000), 'um/s': Fraction(1, 10**6),
    'm/min': Fraction(1, 60), 'mm/min': Fraction(1, 60_000), 'in/s': Fraction(254, 10**4),
    'in/min': Fraction(254, 60 * 10**4),
}
LENGTHS: Mapping[str, Fraction] = {'m': Fraction(1), 'mm': Fraction(1, 1000), 'um': Fraction(1, 10**6),
                                   'nm': Fraction(1, 10**9), 'cm': Fraction(1, 100), 'in': Fraction(254, 10**4)}
ACCELERATIONS: Mapping[str, Fraction] = {'m/s2': Fraction(1), 'mm/s2': Fraction(1, 1000),
                                         'g': Fraction(980665, 10**5)}
TIMES: Mapping[str, Fraction] = {'s': Fraction(1), 'ms': Fraction(1, 1000), 'us': Fraction(1, 10**6),
                                 'ns': Fraction(1, 10**9), 'min': Fraction(60)}
FORCES: Mapping[str, Fraction] = {'N': Fraction(1), 'mN': Fraction(1, 1000), 'kN': Fraction(1000),
                                  'lbf': Fraction(44482216152605, 10**13)}


def unit_of(option: str, word: str, units: Mapping[str, Fraction]) -> str:
    """Return a unit as it is spelled here; raises InputError on one that is not known."""
    found = word.strip().replace('µ', 'u').replace('μ', 'u')
    if found in units:
        return found
    close = difflib.get_close_matches(found, units, 1)
    raise InputError(option, word, 'one of ' + ', '.join(units),
                     f'did you mean {close[0]}?' if close else 'convert the column to one of them')


def named_unit(heading: str, units: Mapping[str, Fraction]) -> str | None:
    """Return the unit in the heading of a column, as in "speed [mm/s]" or "speed_mm_per_s"; None without one."""
    words = heading.replace('µ', 'u').replace('μ', 'u').replace('_per_', '/')
    for unit in sorted(units, key=len, reverse=True):
        if re.search(rf'(?<![A-Za-z/]){re.escape(unit)}(?![A-Za-z/])', words):
            return unit
    return None


def in_si(value: float, unit: Fraction) -> float:
    """Return a finite number of a unit in SI: 0.5 mm/s is 0.0005 m/s to the last bit."""
    return float(Fraction(repr(value)) * unit)


def all_in_si(values: NDArray[np.float64], unit: Fraction) -> NDArray[np.float64]:
    """Return finite numbers of a unit in SI, each as `in_si` does."""
    if unit == 1:
        return values
    digits = len(str(unit.denominator)) - 1
    if unit == Fraction(1, 10**digits):
        return np.array([float(Decimal(repr(value)).scaleb(-digits)) for value in values.tolist()])
    return np.array([in_si(value, unit) for value in values.tolist()])


MOST_BYTES = 256 << 20
_SCALED = re.compile(r'([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,2})?)\s*\*?\s*(.+)')   # 0.05 um
_LARGEST = 1e15    # factor


class Wanted(NamedTuple):
    """A column: its `name` and `unit`, the options that gave them, and the `units` that it may have.

    A number in it stands for so many units as `factor` says.
    """

    name_option: str
    name: str
    unit_option: str
    unit: str
    units: Mapping[str, Fraction]
    factor: Fraction = Fraction(1)

    @property
    def in_si(self) -> Fraction:
        """What a 1 in the column is in SI; raises InputError on an unknown unit."""
        return self.factor * self.units[unit_of(self.unit_option, self.unit, self.units)]


def wanted_column(name_option: str, name: str, unit_option: str, unit: str | None, units: Mapping[str, Fraction]
                  ) -> Wanted:
    """Return a column that is wanted; its unit (None: SI, the first) may have a factor before it: `0.05 um`, `-1 mm`.

    Raises InputError on a factor that is none.
    """
    scaled = None if unit is None else _SCALED.fullmatch(unit.strip())
    factor = Fraction(scaled[1]) if scaled else Fraction(1)
    if factor == 0 or abs(factor) > _LARGEST:
        raise InputError(unit_option, unit, 'a unit, or one with a factor that is not 0', 'for example 35.15 N')
    word = scaled[2] if scaled else unit or next(iter(units))
    return Wanted(name_option, name, unit_option, word, units, factor)


def column_of(path: Path, names: Sequence[str], units: Mapping[str, Fraction], option: str, unit: str | None = None,
              unit_option: str = '') -> Wanted:
    """Return the column of a file that has the first of some names; its unit (None) is that in its heading, or SI.

    Raises InputError where the heading has another one.
    """
    found = next((cell for cell in heading_of(path) if cell.split('[')[0].split('(')[0].strip() in names), names[0])
    unit = unit or named_unit(found, units)
    if unit is None and any(bracket in found for bracket in '[('):
        raise InputError(option, found, f'a heading with one of the units {", ".join(units)}',
                         'correct the unit, or leave it out for SI')
    return wanted_column(option, found, unit_option or option, unit, units)


class CsvTable:
    """The chosen columns of a file in SI; raises InputError that names the line.

    `option` named the file.  All numbers are finite.  `columns` are in the order in which they were wanted.
    """

    def __init__(self, option: str, path: Path, wanted: Sequence[Wanted], most_rows: int) -> None:
        self._option, self._path = option, path
        self._lines = _read(option, path).splitlines()
        headings = self._headings(wanted)
        places = [_place(headings, column) for column in wanted]
        rows = self._rows(places, most_rows)
        for column, place in zip(wanted, places, strict=True):
            _check_heading(headings[place], column)
        self.columns = [all_in_si(rows[:, i], column.in_si) for i, column in enumerate(wanted)]

    def refuse(self, row: int, value: object, allowed: str, fix: str) -> NoReturn:
        """Raise the InputError for a row of the numbers."""
        line = [number for number, _ in self._data()][row]
        raise InputError(f'{self._path.name} line {line}', value, allowed, fix)

    def _headings(self, wanted: Sequence[Wanted]) -> list[str]:
        """Return the names of the columns; the numbers begin behind them."""
        for index, line in enumerate(self._lines):
            if text := line.partition('#')[0].strip():
                self._mark = next((mark for mark in ';\t,' if mark in text), None)
                self._first = index + 1
                names = self._cells(text)
                if all(_number(name) is not None for name in names):
                    raise InputError(f'{self._path.name} line {index + 1}', text, 'the names of the columns',
                                     'put a line above the numbers, like ' + ','.join(one.name for one in wanted))
                return names
        raise InputError(self._option, self._path.name, 'a line of names, then lines of numbers', 'the file is empty')

    def _cells(self, line: str) -> list[str]:
        if self._mark is None:
            return line.split()
        try:
            (cells,) = csv.reader([line], delimiter=self._mark)
        except csv.Error as error:
            raise InputError(self._path.name, line, 'a line of a CSV file', str(error)) from None
        return [cell.strip() for cell in cells]

    def _rows(self, places: Sequence[int], most: int) -> Numbers:
        lines = [text for _, text in islice(self._data(), most + 1)]
        if not lines:
            raise InputError(self._option, self._path.name, 'a line of names, then lines of numbers',
                             'it has no numbers')
        try:
            rows: Numbers = np.loadtxt(lines, delimiter=self._mark, comments=None, quotechar='"', usecols=places,
                                       ndmin=2)
        except ValueError as error:
            self._refuse_line(places, str(error))
        if len(rows) > most:
            raise InputError(self._option, self._path.name, f'at most {most} rows',
                             'leave rows out: every second, or a part')
        if not np.isfinite(rows).all():
            self._refuse_line(places, 'not finite')
        return rows

    def _refuse_line(self, places: Sequence[int], reason: str) -> NoReturn:
        for number, text in self._data():
            cells = self._cells(text)
            if len(cells) <= max(places):
                raise InputError(f'{self._path.name} line {number}', text, f'{max(places) + 1} columns or more',
                                 'complete it, or leave it out')
            for place in places:
                value = _number(cells[place])
                if value is None or not math.isfinite(value):
                    raise InputError(f'{self._path.name} line {number}', cells[place], 'a finite number',
                                     'correct it, or leave the line out')
        raise InputError(self._option, self._path.name, 'lines of numbers', reason)

    def _data(self) -> Iterator[tuple[int, str]]:
        """Yield the number of each line of numbers, from 1, and its text."""
        for number, line in enumerate(self._lines[self._first:], self._first + 1):
            if text := line.partition('#')[0].strip():
                yield number, text if self._mark == ',' else text.replace(',', '.')


def heading_of(path: Path) -> list[str]:
    """Return the names of the columns of a file, none of one that `CsvTable` refuses."""
    try:
        with path.open(encoding='utf-8-sig') as file:
            line = next((text for text in file if text.partition('#')[0].strip()), '').partition('#')[0].strip()
    except (OSError, ValueError):
        return []
    mark = next((mark for mark in ';\t,' if mark in line), None)
    return [cell.strip().strip('"') for cell in line.split(mark)]


def _read(option: str, path: Path) -> str:
    try:
        with path.open('rb') as file:
            data = file.read(MOST_BYTES + 1)
        text = data.decode('utf-8-sig')
    except UnicodeDecodeError as error:
        raise InputError(option, str(path), 'text in UTF-8', not_utf8(error, 'CSV file')) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        beside = [] if path.exists() else paths_beside(path, ['.csv'])
        fix = suggestion(str(path), beside, 'check the path')
        raise InputError(option, str(path), 'a readable CSV file', f'{reason}; {fix}') from None
    if len(data) > MOST_BYTES:
        raise InputError(option, str(path), f'a file of at most {MOST_BYTES} bytes', 'is this the right file?')
    return text


def _place(headings: Sequence[str], column: Wanted) -> int:
    """Return where a column stands: its heading is its name, or its name and a unit in brackets."""
    places = [i for i, heading in enumerate(headings)
              if column.name in (heading, heading.partition('[')[0].strip(), heading.partition('(')[0].strip())]
    if len(places) != 1:
        found = 'there are ' + ', '.join(headings) if not places else f'{len(places)} columns have this name'
        raise InputError(column.name_option, column.name, 'the name of one column', found)
    return places[0]


def _check_heading(heading: str, column: Wanted) -> None:
    """Raise InputError when a heading names another unit than the one stated."""
    unit = None if heading == column.unit else named_unit(heading, column.units)
    if unit is not None and unit != unit_of(column.unit_option, column.unit, column.units):
        raise InputError(column.unit_option, column.unit, f'{unit}, as the heading says: {heading}',
                         f'give {column.unit_option} as {unit}, or correct the heading')


def _number(cell: str) -> float | None:
    try:
        return float(cell) if '_' not in cell else None
    except ValueError:
        return None
