# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The table of a study: its numbers, a row for each point, as lines of CSV, and those lines back as numbers.

Nothing here runs a point.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import Any, BinaryIO, Protocol

import numpy as np

from ..core.arrays import Numbers, has_parquet
from ..core.errors import InputError
from ..core.paths import replacing
from ..figures.point_figures import FIGURES, MOTIONS, Figures, Motion

_BYTES_OF_A_NUMBER = 25   # 17 digits, sign, point, exponent of three digits with its sign, comma
_ROUNDING = 1e-13         # of a value: another version of numpy rounds steps of one ratio otherwise
TableColumns = dict[str, Numbers]


class Tabled(Protocol):
    """What has a table: `count` points with the numbers `names`, each with `figure_names`.

    The first figure stands there in words: `words` of its numbers.  `form` is that of the description beside it, and no
    cell is beyond `largest`: inf where a figure may be infinite, as a time that never comes.
    """

    @property
    def form(self) -> str:
        """Of its description."""

    @property
    def largest(self) -> float:
        """Of a cell."""

    @property
    def figure_names(self) -> tuple[str, ...]:
        """What is found of each point."""

    @property
    def words(self) -> Mapping[float, str]:
        """The words of the first figure."""

    @property
    def names(self) -> tuple[str, ...]:
        """The numbers that vary."""

    @property
    def count(self) -> int:
        """How many points there are."""

    @property
    def chunk(self) -> int:
        """How many points to work on at a time."""

    def points(self, first: int, last: int) -> Numbers:
        """Return the points from `first` on, up to `last`: a row each."""

    def rows(self, first: int, last: int) -> Numbers:
        """Return these points with their figures, a row each."""

    def described(self, command: str = '') -> dict[str, Any]:
        """Return all that it is as JSON values, with the `command`."""


def stretches(study: Tabled, done: int = 0) -> Iterator[tuple[int, int]]:
    """Yield the first point of each chunk after `done` of them, and the one after its last."""
    for first in range(min(done * study.chunk, study.count), study.count, study.chunk):
        yield first, min(first + study.chunk, study.count)


def title_line(study: Tabled) -> bytes:
    """Return the line of names."""
    return (','.join((*study.names, *study.figure_names)) + '\n').encode()


def rows_of(points: Numbers, figures: Figures) -> Numbers:
    """Return the numbers of points and of their figures, a row for each point."""
    return np.column_stack([points, *(getattr(figures, name) for name in FIGURES)])


def lines(study: Tabled, rows: Numbers) -> bytes:
    """Return a line for each row of numbers; a number that does not exist stays empty."""
    cells = [in_words(study, column) if place == len(study.names) else map(_text, column.tolist())
             for place, column in enumerate(rows.T)]
    return ''.join(','.join(line) + '\n' for line in zip(*cells, strict=True)).encode()


def columns(study: Tabled, rows: Numbers) -> TableColumns:
    """Return the columns of rows of numbers by name; the figure in words is its numbers."""
    return dict(zip((*study.names, *study.figure_names), rows.T, strict=True))


def in_words(study: Tabled, figures: Numbers) -> list[str]:
    """Return the words for numbers of the first figure."""
    return [study.words[number] for number in figures.tolist()]


def words(motions: Numbers) -> list[str]:
    """Return the words for numbers of `Motion`."""
    return [MOTIONS[Motion(int(motion))] for motion in motions.tolist()]


def read_rows(found: Sequence[bytes], study: Tabled, first: int, last: int) -> Numbers:
    """Return the rows in the lines of the points from `first` on, up to `last`; raises ValueError for other lines."""
    place, codes = len(study.names), {word: number for number, word in study.words.items()}
    numbers = np.array([_numbers(line, place, codes) for line in found])
    if numbers.shape != (last - first, width(study)) or not np.allclose(
            numbers[:, :place], study.points(first, last), rtol=_ROUNDING, atol=0.0):
        raise ValueError('these are the lines of other points')
    if (np.abs(numbers) > study.largest).any():
        raise ValueError('these are no figures of an axis')
    return numbers


def next_lines(file: BinaryIO, study: Tabled, first: int, last: int) -> list[bytes]:
    """Return the next lines of a file, which may lack ends of lines."""
    return list(islice(iter(lambda: file.readline(longest_line(study)), b''), last - first))


def width(study: Tabled) -> int:
    """Return how many columns the table has."""
    return len(study.names) + len(study.figure_names)


def may_be_table(path: Path, study: Tabled) -> bool:
    """Whether a file of any origin is worth reading: an ordinary one, no longer than all lines; raises OSError."""
    return path.is_file() and path.stat().st_size <= len(title_line(study)) + study.count * longest_line(study)


def longest_line(study: Tabled) -> int:
    """Return how many bytes a line takes at most."""
    return width(study) * _BYTES_OF_A_NUMBER


def read_columns(path: Path, study: Tabled) -> TableColumns:
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


def _rows_in(file: BinaryIO, study: Tabled) -> Numbers:
    """Return the rows of the table of a study; raises ValueError where it is another one."""
    if file.readline(len(title_line(study))) != title_line(study):
        raise ValueError('this is the table of another study')
    rows = np.empty((study.count, width(study)))
    for first, last in stretches(study):
        rows[first:last] = read_rows(next_lines(file, study, first, last), study, first, last)
    if file.read(1):
        raise ValueError('there are more lines than points')
    return rows


def _numbers(row: bytes, place: int, codes: Mapping[str, float]) -> list[float]:
    """Return the numbers in a line, with a word of these `codes` at a `place`; raises ValueError."""
    cells = row.decode('ascii').split(',')
    if not row.endswith(b'\n') or len(cells) <= place or cells[place] not in codes:
        raise ValueError('this is no whole line')
    cells[place] = str(codes[cells[place]])
    return [float(cell.strip() or 'nan') for cell in cells]


# The table of a sweep as Parquet, where pandas and a writer are installed (the extra `tables`).

def write_parquet(columns: Mapping[str, Numbers | Sequence[str]], path: Path) -> None:
    """Write columns as Parquet, to the last bit; do nothing where pandas or its writer is missing or broken."""
    if not has_parquet():
        return
    with suppress(ImportError), replacing(path) as temporary:
        import pandas  # there, but not in working order: no reason to leave the table of a study unfinished

        pandas.DataFrame(columns).to_parquet(temporary, index=False)
