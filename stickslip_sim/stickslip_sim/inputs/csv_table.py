# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A table of measured numbers from a CSV file: a preamble, a line of names, perhaps one of units, then numbers.

Separated by commas, semicolons, tabs or spaces; with all but commas a decimal comma is read too.  What follows a `#` is
a remark.  Text is UTF-8, UTF-16 with its mark, or else Latin-1.  Numbers are read by numpy, in blocks; only a block
that it refuses is gone through line by line, to say where.
"""

import codecs
import csv
import math
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError, paths_beside, suggestion
from .units import Wanted, all_in_si, in_unit_of, named_unit, unit_in, wanted_column

MOST_BYTES = 256 << 20


class Rows(NamedTuple):
    """Which rows are taken: from `begin` to `end` (s), of them `every` so many; and of a file, all behind `skip` lines.

    `drops_bad` leaves out rows without a finite number, or whose time is not after those before it.
    """

    begin: float = -math.inf
    end: float = math.inf
    every: int = 1
    skip: int = 0
    drops_bad: bool = False


ALL = Rows()
ROW = 'row'                  # a column that every table has: the number of its row, from 0 on
_ENDS = 'EOF', '//END'       # the last lines of exports of TwinCAT and SIMATIC
_CHUNK = 8 << 20             # characters that are read at once
_HEAD = 1 << 20, 500         # characters and lines in which the numbers must begin
_FEW = 64                    # lines that are gone through one by one
_NONE = 'a line of names, then lines of numbers'
_MOST_COLUMNS = 10_000
_ARRAY_ROWS = 1 << 18


class Table:
    """The chosen columns of a table in SI; raises InputError that names the row.

    `option` named the source, `name` does in refusals.  All numbers are finite; the first column is the time, and
    rises.  `columns` are in the order of `wanted`, which says the units; `remarks` say what was not taken.
    """

    def __init__(self, option: str, name: str, wanted: Sequence[Wanted], most_rows: int, rows: Rows) -> None:
        self._option, self._name, self._taken, self._dropped = option, name, rows, 0
        self._headings: list[str] = []
        self._places: list[int | None] = []     # None: the number of the row
        self.remarks: list[str] = []
        units = self._begin(wanted)
        self.wanted = [one if place is None else in_unit_of(one, self._heading(place), [row[place] for row in units])
                       for one, place in zip(wanted, self._places, strict=True)]
        self._used = [place for place in self._places if place is not None]
        found = [np.empty(0) for _ in wanted]
        count = 0
        for block in self._blocks():
            begin, count = count, count + len(block)
            if count > most_rows:
                raise InputError(option, name, f'at most {most_rows} rows', 'leave rows out: every second, or a part')
            for column, numbers in zip(found, block.T, strict=True):
                column.resize(count, refcheck=False)    # where it is: parts put together would need the room twice
                column[begin:] = numbers
        if not count:
            raise InputError(option, name, _NONE, 'it has no numbers' if rows[:3] == ALL[:3] else 'there are none')
        if self._dropped:
            self.remarks.append(f'{self._dropped} bad rows are left out')
        self.columns = [all_in_si(found.pop(0), one.in_si) for one in self.wanted]

    def _begin(self, wanted: Sequence[Wanted]) -> list[list[str]]:
        """Find headings and places; return lines between headings and numbers that have units."""
        raise NotImplementedError

    def _parts(self) -> Iterator[Any]:
        """Yield parts of the table."""
        raise NotImplementedError

    def _numbers(self, part: Any) -> Numbers:
        """Return the numbers of a part in the used columns, NaN those of bad rows that are left out."""
        raise NotImplementedError

    def _at(self, part: Any, row: int) -> str:
        """Return where a row of a part is."""
        raise NotImplementedError

    def refuse(self, row: int, value: object, allowed: str, fix: str) -> NoReturn:
        """Raise the InputError for a row of the numbers of a table of which all rows are taken."""
        for part in self._parts():
            count = len(self._numbers(part))
            if row < count:
                break
            row -= count
        raise InputError(self._at(part, row), value, allowed, fix)

    def _heading(self, place: int) -> str:
        return self._headings[place] if place < len(self._headings) else ''

    def _place(self, column: Wanted) -> int | None:
        """Return where a column stands: its heading is its name, or its name and a unit in brackets; or its number."""
        if column.name == ROW and ROW not in self._headings:
            return None
        if column.name.isdecimal() and column.name not in self._headings:
            if not 1 <= int(column.name) <= _MOST_COLUMNS:
                raise InputError(column.name_option, column.name, f'a column from 1 to {_MOST_COLUMNS}', 'correct it')
            return int(column.name) - 1
        places = [i for i, heading in enumerate(self._headings) if column.name in _names_in(heading)]
        if len(places) == 1:
            return places[0]
        found = ('there are ' + ', '.join(heading or f'(nameless) {i}' for i, heading in enumerate(self._headings, 1))
                 if not places else f'{len(places)} columns have this name; take its number, '
                 + ' or '.join(str(place + 1) for place in places))
        raise InputError(column.name_option, column.name, 'the name of one column', found)

    def _blocks(self) -> Iterator[Numbers]:
        """Yield the rows that are taken, in the units of the table."""
        unit, done, latest = float(self.wanted[0].in_si), 0, -math.inf
        for part in self._parts():
            found = self._numbers(part)
            number = np.arange(done, done + len(found))
            done += len(found)
            block = np.empty((len(found), len(self._places)))
            block[:, [place is not None for place in self._places]] = found
            block[:, [place is None for place in self._places]] = number[:, np.newaxis]
            times = unit * block[:, 0]
            reached = np.fmax.accumulate(np.append(latest, times))
            within = ~((times < self._taken.begin) | (times > self._taken.end))
            bad = within & ~((times > reached[:-1]) & np.isfinite(block).all(axis=1))
            if bad.any() and not self._taken.drops_bad:
                row = int(np.argmax(bad))
                raise InputError(self._at(part, row), float(times[row]),
                                 f'a time after the one before it, {float(reached[row])!r} s',
                                 'sort the rows by time and drop duplicates')
            self._dropped += int(bad.sum())
            latest = float(reached[-1])
            yield block[within & ~bad & (number % self._taken.every == 0)]


class CsvTable(Table):
    """A table from a CSV file at a path."""

    def __init__(self, option: str, path: Path, wanted: Sequence[Wanted], most_rows: int, rows: Rows = ALL,
                 most_bytes: int = MOST_BYTES) -> None:
        self._path, self._encoding = path, _encoding(option, path, most_bytes)
        super().__init__(option, path.name, wanted, most_rows, rows)
        if self._encoding == 'latin-1':
            self.remarks.append('read as Latin-1, for it is not UTF-8')

    def _begin(self, wanted: Sequence[Wanted]) -> list[list[str]]:
        text = next(self._read(self._taken.skip, _HEAD[0]), '')
        head = list(_content(text.split('\n')[:_HEAD[1]], self._taken.skip + 1))
        if not head:
            raise InputError(self._option, self._name, _NONE, 'the file is empty')
        self._mark = _mark_of([line for _, line in head])
        lines = [(number, self._cells(line)) for number, line in head]
        names = [one.name for one in wanted if not one.name.isdecimal() and one.name != ROW]
        named = max(range(len(lines)), key=lambda k: (_matches(names, lines[k][1]), len(lines[k][1]), -k))
        if names:
            number, self._headings = lines[named]
            if all(self._number(cell) is not None for cell in self._headings):
                raise InputError(f'{self._name} line {number}', head[named][1], 'the names of the columns',
                                 'put a line above the numbers, like ' + ','.join(one.name for one in wanted)
                                 + ', or give the numbers of the columns, from 1 on, in place of names')
        self._places = [self._place(column) for column in wanted]
        places = [place for place in self._places if place is not None]
        telling = places if len(names) == len(places) else places[:1]
        between: list[list[str]] = []
        for number, cells in lines[named + 1 if names else 0:]:
            if any(self._number(cells[place]) is not None for place in telling if place < len(cells)):
                self._first = number
                if not names and between and len(between[-1]) == len(cells):
                    self._headings = between.pop()
                return [row for row in between if max(places) < len(row) and any(
                    unit_in(row[place], one.units) for place, one in zip(self._places, wanted) if place is not None)]
            between.append(cells)
        raise InputError(self._option, self._name, _NONE, 'it has no numbers')

    def _cells(self, line: str) -> list[str]:
        if self._mark is None:
            return line.split()
        try:
            (cells,) = csv.reader([line], delimiter=self._mark)
        except csv.Error as error:
            raise InputError(self._name, line, 'a line of a CSV file', str(error)) from None
        return [cell.strip() for cell in cells]

    def _number(self, cell: str) -> float | None:
        return _number(cell if self._mark == ',' else cell.replace(',', '.'))

    def _read(self, skip: int, size: int) -> Iterator[str]:
        """Yield the text of whole lines behind the first ones, so much of it at once."""
        with self._path.open(encoding=self._encoding) as file:
            for _ in range(skip):
                file.readline()
            while text := file.read(size):
                yield text if text.endswith('\n') else text + file.readline()

    def _parts(self) -> Iterator[tuple[int, list[str]]]:
        """Yield lines of numbers, with the number of the first, up to one that says that it is the last."""
        first = self._first
        for text in self._read(first - 1, _CHUNK):
            lines = (text if self._mark == ',' else text.replace(',', '.')).removesuffix('\n').split('\n')
            end = next((k for k in range(max(len(lines) - 2, 0), len(lines)) if lines[k].strip() in _ENDS), None)
            yield first, lines[:end]
            first += len(lines)

    def _at(self, part: tuple[int, list[str]], row: int) -> str:
        return f'{self._name} line {[number for number, _ in _content(part[1], part[0])][row]}'

    def _numbers(self, part: tuple[int, list[str]]) -> Numbers:
        (first, lines), reason = part, 'not finite'
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')    # lines without numbers
            try:
                found: Numbers = np.loadtxt(lines, delimiter=self._mark, comments='#', quotechar='"',
                                            usecols=self._used, ndmin=2).reshape(-1, len(self._used))
                if np.isfinite(found).all():
                    return found
            except ValueError as error:
                reason = str(error)
        if len(lines) > _FEW:
            half = len(lines) // 2
            return np.concatenate([self._numbers((first, lines[:half])), self._numbers((first + half, lines[half:]))])
        rows = [self._row(number, text) for number, text in _content(lines, first)]
        if np.isfinite(rows).all() and not self._taken.drops_bad:
            raise InputError(self._option, self._name, 'lines of numbers', reason)
        return np.array(rows).reshape(-1, len(self._used))

    def _row(self, line: int, text: str) -> list[float]:
        """Return the numbers of a line; NaN in a bad one that is left out."""
        cells = self._cells(text)
        values = [_number(cells[place]) if place < len(cells) else None for place in self._used]
        bad = next((k for k, value in enumerate(values) if value is None or not math.isfinite(value)), None)
        if bad is None or self._taken.drops_bad:
            return [math.nan if value is None else value for value in values]
        at = self._used[bad]
        if at >= len(cells):
            raise InputError(f'{self._name} line {line}', text, f'{max(self._used) + 1} columns or more',
                             'complete it, or leave it out')
        raise InputError(f'{self._name} line {line}', cells[at], 'a finite number '
                         f'in column {at + 1}, {self._heading(at)}'.rstrip(', '), _fix_of(cells[at]))


def _fix_of(cell: str) -> str:
    if ':' in cell:
        return 'a time of day: count rows instead, time=row with --unit time="1 ms"'
    return ('export it without points between thousands' if cell.count('.') > 1 else
            'correct it, or leave the line out (--drop-bad-rows)')


class ArrayTable(Table):
    """A table from `arrays` of one length by name."""

    def __init__(self, option: str, name: str, arrays: Mapping[str, Any], wanted: Sequence[Wanted], most_rows: int,
                 rows: Rows = ALL) -> None:
        self._arrays = arrays
        super().__init__(option, name, wanted, most_rows, rows)

    def _begin(self, wanted: Sequence[Wanted]) -> list[list[str]]:
        self._headings = list(self._arrays)
        self._places = [self._place(column) for column in wanted]
        self._values = []
        for column, place in zip(wanted, self._places, strict=True):
            if place is None:
                continue
            if place >= len(self._headings):
                raise InputError(column.name_option, column.name, f'a column from 1 to {len(self._headings)}',
                                 'there are ' + ', '.join(self._headings))
            try:
                self._values.append(np.asarray(self._arrays[self._headings[place]], dtype=np.float64))
            except (TypeError, ValueError):
                raise InputError(column.name_option, column.name, 'a column of numbers', 'take another') from None
            if self._values[-1].shape != self._values[0].shape or self._values[-1].ndim != 1:
                raise InputError(column.name_option, column.name, 'one number a row, as many as '
                                 f'{self._headings[self._places[0] or 0]}', f'its shape is {self._values[-1].shape}')
        return []

    def _parts(self) -> Iterator[int]:
        yield from range(0, len(self._values[0]), _ARRAY_ROWS)

    def _at(self, part: int, row: int) -> str:
        return f'{self._name} row {part + row + 1}'

    def _numbers(self, part: int) -> Numbers:
        found = np.column_stack([values[part:part + _ARRAY_ROWS] for values in self._values])
        bad = np.argwhere(~np.isfinite(found))
        if len(bad) and not self._taken.drops_bad:
            row, column = bad[0].tolist()
            raise InputError(self._at(part, row), float(found[row, column]), 'a finite number in column '
                             + self._headings[self._used[column]], 'correct it, or leave the row out')
        return found


def heading_of(path: Path) -> list[str]:
    """Return the names of the columns of a file, none of one that `CsvTable` refuses."""
    try:
        with path.open(encoding='utf-8-sig') as file:
            line = next((text for text in file if text.partition('#')[0].strip()), '').partition('#')[0].strip()
    except (OSError, ValueError):
        return []
    mark = next((mark for mark in ';\t,' if mark in line), None)
    return [cell.strip().strip('"') for cell in line.split(mark)]


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


def _encoding(option: str, path: Path, most_bytes: int) -> str:
    """Return how the text of a file is encoded; raises InputError where it is none."""
    decoder, is_utf8, count = codecs.getincrementaldecoder('utf-8')(), True, 0
    try:
        with path.open('rb') as file:
            start = file.read(2)
            file.seek(0)
            is_wide = start in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
            for data in iter(lambda: file.read(_CHUNK), b''):
                count += len(data)
                if count > most_bytes:
                    raise InputError(option, str(path), f'a file of at most {most_bytes} bytes',
                                     'is this the right file?')
                if b'\0' in data and not is_wide:
                    raise InputError(option, str(path), 'a CSV file, which is text',
                                     'export it as one' + ('; a workbook: save it as CSV' if start == b'PK' else ''))
                is_utf8 = is_utf8 and _is_decoded(decoder, data)
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        beside = [] if path.exists() else paths_beside(path, ['.csv'])
        fix = suggestion(str(path), beside, 'check the path')
        raise InputError(option, str(path), 'a readable CSV file', f'{reason}; {fix}') from None
    return 'utf-16' if is_wide else 'utf-8-sig' if is_utf8 and _is_decoded(decoder, b'', True) else 'latin-1'


def _is_decoded(decoder: codecs.IncrementalDecoder, data: bytes, final: bool = False) -> bool:
    try:
        decoder.decode(data, final)
    except UnicodeDecodeError:
        return False
    return True


def _mark_of(lines: Sequence[str]) -> str | None:
    """Return what separates the cells of the last lines of a head, None for spaces."""
    last = lines[-10:]
    mark = next((mark for mark in ';\t,' if 2 * sum(mark in line for line in last) >= len(last)), None)
    cells = [cell.split() for line in last for cell in line.split(mark)] if mark == ',' else []
    are_decimal = any(len(words) > 1 and all(_number(word) is not None for word in words) for words in cells)
    return None if are_decimal else mark


def _content(lines: Iterable[str], first: int) -> Iterator[tuple[int, str]]:
    """Yield lines that are neither empty nor remarks, with their numbers."""
    return ((number, text) for number, line in enumerate(lines, first) if (text := line.partition('#')[0].strip()))


def _names_in(heading: str) -> tuple[str, ...]:
    return heading, heading.partition('[')[0].strip(), heading.partition('(')[0].strip()


def _matches(names: Sequence[str], cells: Sequence[str]) -> int:
    found = {name for cell in cells for name in _names_in(cell)}
    return sum(name in found for name in names)



def _number(cell: str) -> float | None:
    try:
        return float(cell) if '_' not in cell else None
    except ValueError:
        return None
