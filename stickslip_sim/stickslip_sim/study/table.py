# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The points of a study as lines of CSV, and those lines back as columns."""

import math
from collections.abc import Mapping
from functools import partial
from pathlib import Path

import numpy as np

from ..errors import InputError
from .figures import FIGURES, MOTIONS, Figures, Motion
from .study import Study
from .variation import Numbers

_BYTES_OF_A_NUMBER = 25   # 17 digits, sign, point, exponent of three digits with its sign, comma
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


def size_on_disk(study: Study) -> int:
    """Return how many bytes all lines take at most."""
    return study.count * longest_line(study)


def longest_line(study: Study) -> int:
    """Return how many bytes a line takes at most."""
    return (len(study.names) + len(FIGURES)) * _BYTES_OF_A_NUMBER


def may_be_table(path: Path, study: Study) -> bool:
    """Whether a file, whoever made it, is worth reading: an ordinary one, no longer than all lines; raises OSError."""
    return path.is_file() and path.stat().st_size <= len(header(study)) + size_on_disk(study)


def size_in_memory(study: Study) -> int:
    """Return how many bytes the columns take when they are read."""
    return study.count * (len(study.names) + len(FIGURES)) * 8


def read_columns(path: Path, study: Study) -> dict[str, Numbers]:
    """Return the columns of the table of a study by name; motions as numbers of `Motion`.  Raises InputError."""
    titles, rows = b'', np.array([])
    try:
        if may_be_table(path, study):
            with path.open('rb') as file:
                titles = file.readline(len(header(study)))
                rows = np.array([[_number(cell) for cell in line.decode().split(',')]
                                 for line in iter(partial(file.readline, longest_line(study)), b'')])
    except (OSError, ValueError):
        titles = b''
    if titles != header(study) or rows.shape != (study.count, len(study.names) + len(FIGURES)):
        raise InputError('points', str(path), f'the table of its study, {study.count} whole lines',
                         'it was changed or cannot be read; sweep again')
    return dict(zip((*study.names, *FIGURES), rows.T.copy()))


def figures_in(columns: Mapping[str, Numbers]) -> Figures:
    """Return the figures among columns."""
    return Figures(**{name: columns[name] for name in FIGURES})


def _text(number: float) -> str:
    return '' if math.isnan(number) else repr(number)


def _word(motion: float) -> str:
    return MOTIONS[Motion(int(motion))]


def _number(cell: str) -> float:
    cell = cell.strip()
    return _CODES[cell] if cell in _CODES else float(cell or 'nan')
