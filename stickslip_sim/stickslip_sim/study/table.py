# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The table of a study: its numbers, a row for each point, as lines of CSV, and those lines back as numbers.

Nothing here runs a point.
"""

import math
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..core.arrays import Numbers, has_parquet
from ..core.errors import InputError
from ..figures.point_figures import FIGURES, MOTIONS, Figures, Motion
from .study import Study

_BYTES_OF_A_NUMBER = 25   # 17 digits, sign, point, exponent of three digits with its sign, comma
_ROUNDING = 1e-13         # of a value: another version of numpy rounds steps of one ratio otherwise
_LARGEST = 1e150          # of a cell, by far; its square, for variances, is still a number
TableColumns = dict[str, Numbers]
_CODES = {word: float(motion) for motion, word in MOTIONS.items()}


def title_line(study: Study) -> bytes:
    """Return the line of names."""
    return (','.join((*study.names, *FIGURES)) + '\n').encode()


def rows_of(points: Numbers, figures: Figures) -> Numbers:
    """Return the numbers of points and of their figures, a row for each point."""
    return np.column_stack([points, *(getattr(figures, name) for name in FIGURES)])


def lines(study: Study, rows: Numbers) -> bytes:
    """Return a line for each row of numbers; a number that does not exist stays empty."""
    cells = [words(column) if name == 'motion' else map(_text, column.tolist())
             for name, column in columns(study, rows).items()]
    return ''.join(','.join(line) + '\n' for line in zip(*cells, strict=True)).encode()


def columns(study: Study, rows: Numbers) -> TableColumns:
    """Return the columns of rows of numbers by name; motions as numbers of `Motion`."""
    return dict(zip((*study.names, *FIGURES), rows.T, strict=True))


def words(motions: Numbers) -> list[str]:
    """Return the words for numbers of `Motion`."""
    return [MOTIONS[Motion(int(motion))] for motion in motions.tolist()]


def read_rows(found: Sequence[bytes], study: Study, first: int, last: int) -> Numbers:
    """Return the rows in the lines of the points from `first` on, up to `last`; raises ValueError for other lines."""
    place = len(study.names)
    numbers = np.array([_numbers(line, place) for line in found])
    if numbers.shape != (last - first, width(study)) or not np.allclose(
            numbers[:, :place], study.points(first, last), rtol=_ROUNDING, atol=0.0):
        raise ValueError('these are the lines of other points')
    if (np.abs(numbers) > _LARGEST).any():
        raise ValueError('these are no figures of an axis')
    return numbers


def next_lines(file: BinaryIO, study: Study, first: int, last: int) -> list[bytes]:
    """Return the next lines of a file, which may lack ends of lines."""
    return list(islice(iter(lambda: file.readline(longest_line(study)), b''), last - first))


def width(study: Study) -> int:
    """Return how many columns the table has."""
    return len(study.names) + len(FIGURES)


def may_be_table(path: Path, study: Study) -> bool:
    """Whether a file of any origin is worth reading: an ordinary one, no longer than all lines; raises OSError."""
    return path.is_file() and path.stat().st_size <= len(title_line(study)) + study.count * longest_line(study)


def longest_line(study: Study) -> int:
    """Return how many bytes a line takes at most."""
    return width(study) * _BYTES_OF_A_NUMBER


def read_columns(path: Path, study: Study) -> TableColumns:
    """Return the columns of the table of a study in a file; raises InputError."""
    try:
        if not may_be_table(path, study):
            raise ValueError('this is no table of so few points')
        with path.open('rb') as file:
            rows = _rows_in(file, study)
    except (MemoryError, OSError, ValueError):
        raise InputError('points', str(path), f'the table of its study, {study.count} whole lines',
                         'it was changed or cannot be read; sweep again') from None
    return columns(study, rows)


def figures_among(columns_of_table: TableColumns) -> Figures:
    """Return the figures among columns."""
    return Figures(**{name: columns_of_table[name] for name in FIGURES})


def _text(number: float) -> str:
    return '' if math.isnan(number) else repr(number)


def _rows_in(file: BinaryIO, study: Study) -> Numbers:
    """Return the rows of the table of a study; raises ValueError where it is another one."""
    if file.readline(len(title_line(study))) != title_line(study):
        raise ValueError('this is the table of another study')
    rows = np.empty((study.count, width(study)))
    for first, last in study.stretches():
        rows[first:last] = read_rows(next_lines(file, study, first, last), study, first, last)
    if file.read(1):
        raise ValueError('there are more lines than points')
    return rows


def _numbers(row: bytes, place: int) -> list[float]:
    """Return the numbers in a line, whose motion stands at a `place`; raises ValueError."""
    cells = row.decode('ascii').split(',')
    if not row.endswith(b'\n') or len(cells) <= place or cells[place] not in _CODES:
        raise ValueError('this is no whole line')
    cells[place] = str(_CODES[cells[place]])
    return [float(cell.strip() or 'nan') for cell in cells]


# The table of a sweep as Parquet, where pandas and a writer are installed (the extra `tables`).

def write_parquet(columns: Mapping[str, Numbers | Sequence[str]], path: Path) -> None:
    """Write columns as Parquet, to the last bit; do nothing where pandas or its writer is missing or broken."""
    if not has_parquet():
        return
    temporary = path.with_name(f'.{path.name}')
    try:
        import pandas
        pandas.DataFrame(columns).to_parquet(temporary, index=False)
        temporary.replace(path)
    except ImportError:   # there, but not in working order: no reason to leave the table of a study unfinished
        pass
    finally:
        temporary.unlink(missing_ok=True)
