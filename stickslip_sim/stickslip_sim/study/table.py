# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The points of a study as lines of CSV, and those lines back as columns."""

import math
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..core.errors import InputError
from .point_figures import FIGURES, MOTIONS, Figures, Motion
from .study import Study
from .variation import Numbers

_BYTES_OF_A_NUMBER = 25   # 17 digits, sign, point, exponent of three digits with its sign, comma
_ROUNDING = 1e-13         # of a value: another version of numpy rounds steps of one ratio otherwise
_LARGEST = 1e150          # of a cell, by far; its square, for variances, is still a number
_CODES = {word: float(motion) for motion, word in MOTIONS.items()}


def header(study: Study) -> bytes:
    """Return the line of names."""
    return (','.join((*study.names, *FIGURES)) + '\n').encode()


def lines(study: Study, first: int, last: int) -> bytes:
    """Run the points from `first` on, up to `last`, and return a line for each; what does not exist stays empty."""
    points, figures = study.points(first, last), study.figures(first, last)
    columns = [map(_text, column) for column in points.T.tolist()]
    columns += [map(_word if name == 'motion' else _text, getattr(figures, name).tolist()) for name in FIGURES]
    return ''.join(','.join(row) + '\n' for row in zip(*columns, strict=True)).encode()


def numbers_of(rows: Sequence[bytes], study: Study, first: int, last: int) -> Numbers:
    """Return the numbers in the lines of the points from `first` on, up to `last`; raises ValueError for any other."""
    place = len(study.names)
    numbers = np.array([_numbers(row, place) for row in rows])
    if numbers.shape != (last - first, width(study)) or not np.allclose(
            numbers[:, :place], study.points(first, last), rtol=_ROUNDING, atol=0.0):
        raise ValueError('these are the lines of other points')
    if (np.abs(numbers) > _LARGEST).any():
        raise ValueError('these are no figures of an axis')
    return numbers


def next_lines(file: BinaryIO, study: Study, first: int, last: int) -> list[bytes]:
    """Return the next lines of a file, of which nobody knows whether it has ends of lines."""
    return list(islice(iter(lambda: file.readline(longest_line(study)), b''), last - first))


def width(study: Study) -> int:
    """Return how many columns the table has."""
    return len(study.names) + len(FIGURES)


def may_be_table(path: Path, study: Study) -> bool:
    """Whether a file, whoever made it, is worth reading: an ordinary one, no longer than all lines; raises OSError."""
    return path.is_file() and path.stat().st_size <= len(header(study)) + study.count * longest_line(study)


def longest_line(study: Study) -> int:
    """Return how many bytes a line takes at most."""
    return width(study) * _BYTES_OF_A_NUMBER


def read_columns(path: Path, study: Study) -> dict[str, Numbers]:
    """Return the columns of the table of a study by name; motions as numbers of `Motion`.  Raises InputError."""
    try:
        if not may_be_table(path, study):
            raise ValueError('this is no table of so few points')
        with path.open('rb') as file:
            columns = _columns_in(file, study)
    except (MemoryError, OSError, ValueError):
        raise InputError('points', str(path), f'the table of its study, {study.count} whole lines',
                         'it was changed or cannot be read; sweep again') from None
    return dict(zip((*study.names, *FIGURES), columns))


def figures_in(columns: Mapping[str, Numbers]) -> Figures:
    """Return the figures among columns."""
    return Figures(**{name: columns[name] for name in FIGURES})


def _text(number: float) -> str:
    return '' if math.isnan(number) else repr(number)


def _word(motion: float) -> str:
    return MOTIONS[Motion(int(motion))]


def _columns_in(file: BinaryIO, study: Study) -> Numbers:
    """Return the columns of the table of a study, an array each; raises ValueError where it is another one."""
    if file.readline(len(header(study))) != header(study):
        raise ValueError('this is the table of another study')
    columns = np.empty((width(study), study.count))
    for first, last in study.stretches():
        columns[:, first:last] = numbers_of(next_lines(file, study, first, last), study, first, last).T
    if file.read(1):
        raise ValueError('there are more lines than points')
    return columns


def _numbers(row: bytes, place: int) -> list[float]:
    """Return the numbers in a line, whose motion stands at a `place`; raises ValueError."""
    cells = row.decode('ascii').split(',')
    if not row.endswith(b'\n') or len(cells) <= place or cells[place] not in _CODES:
        raise ValueError('this is no whole line')
    cells[place] = str(_CODES[cells[place]])
    return [float(cell.strip() or 'nan') for cell in cells]
