# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The table of a study: its numbers, a row for each point, as lines of CSV, and those lines back as numbers.

Nothing here runs a point.
"""

import fcntl
import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from itertools import islice
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ..core.arrays import Numbers, has_parquet
from ..core.errors import InputError, paths_beside, suggestion
from ..core.paths import made_folder
from ..figures.point_figures import FIGURES, MOTIONS, Figures, Motion
from .study import FORM, Study, description
from .workers import check_resources

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


# A sweep on disk: `study.json` describes it, and its table grows by whole chunks of lines.
#
# Until all points are there the table is `points.partial.csv`; then it becomes `points.csv`.

LONGEST_SIDECAR = 1 << 24   # bytes of a description; nearly all of it is the scene
SIDECAR, POINTS_TABLE, PARTIAL, PARQUET = 'study.json', 'points.csv', 'points.partial.csv', 'points.parquet'
KEPT = 'what is done is kept, --resume goes on'


class Folder:
    """The folder of a sweep; raises InputError, with a path in it, where the disk refuses."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)

    @property
    def table(self) -> Path:
        """Where the table of all points stands when it is complete."""
        return self.path / POINTS_TABLE

    @property
    def is_complete(self) -> bool:
        """Whether all points are there."""
        return self.table.exists()

    def begin(self, study: Study, command: str) -> None:
        """Make the folder with the description of the study and an empty table: whole, or not at all."""
        if os.path.lexists(self.path):
            raise InputError('--out', str(self.path), 'a folder that does not exist',
                             'choose another name, or add --resume to go on with it')
        temporary = self.path.absolute().with_name(f'.{os.getpid()}.{self.path.name}')
        with _refusing(self.path, 'nothing is left behind'), made_folder(temporary):
            check_resources(study, temporary)
            (temporary / SIDECAR).write_text(json.dumps(description(study, command), indent=1) + '\n',
                                             encoding='utf-8')
            (temporary / PARTIAL).write_bytes(title_line(study))
            temporary.rename(self.path)

    @contextmanager
    def taken(self) -> Iterator[None]:
        """Keep other processes away from the folder; raises InputError where one works on it.

        The lock ends with the process that has it, however that ends.
        """
        with ExitStack() as held:
            try:
                file = held.enter_context((self.path / SIDECAR).open('r+b'))
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise InputError('--out', str(self.path), 'a folder that no other process works on',
                                 'wait for that one, or end it and add --resume') from None
            except OSError as error:
                raise _refusal(self.path, error) from None
            yield

    def described(self) -> dict[str, Any]:
        """Return the description in the folder; raises InputError when it is not of a sweep."""
        path = self.path / SIDECAR
        try:
            if path.is_file() and path.stat().st_size <= LONGEST_SIDECAR:
                found = json.loads(path.read_text(encoding='utf-8'))
                if found['form'] == FORM:
                    return dict(found)
        except (OSError, ValueError, KeyError, TypeError, RecursionError):
            pass
        beside = paths_beside(self.path, (), folders=True)
        raise InputError('folder', str(self.path), f'that of a sweep, with {SIDECAR} in it', 'sweep into a new one'
                         if self.path.exists() else suggestion(str(self.path), beside, 'no such folder: sweep into it'))

    def check_same(self, study: Study) -> None:
        """Raise InputError unless the folder is of this study, by the same versions."""
        found = self.described()
        for name, value in description(study).items():
            if name != 'command' and found.get(name) != value:
                raise InputError('--resume', str(self.path), f'the folder of this very study; its {name} is another',
                                 f'give the command that stands in its {SIDECAR}, or another folder')

    def whole_chunks(self, study: Study) -> list[Numbers]:
        """Return the rows of each whole chunk of points that is there; the remains of a crash are cut off."""
        path, titles = self.path / PARTIAL, title_line(study)
        with _refusing(path), path.open('r+b') as file:
            if not may_be_table(path, study) or file.readline(len(titles)) != titles:
                raise InputError('points', str(path), 'the table of this study', 'it was changed; sweep into a new one')
            chunks, end = [], len(titles)
            for first, last in study.stretches():
                found = next_lines(file, study, first, last)
                try:
                    chunks.append(read_rows(found, study, first, last))
                except ValueError:
                    break
                end += sum(map(len, found))
            file.truncate(end)
        return chunks

    def append(self, lines: bytes) -> None:
        """Add lines to the table: all of them, or none when the disk refuses."""
        with _refusing(self.path / PARTIAL), (self.path / PARTIAL).open('ab', buffering=0) as file:
            before = file.seek(0, os.SEEK_END)
            try:
                written = 0
                while written < len(lines):   # once; a full disk takes a part and then says why
                    written += file.write(lines[written:])
            except BaseException:
                file.truncate(before)
                raise

    def finish(self, columns: TableColumns) -> None:
        """Give the table its name; where pandas is installed, write its `columns` as Parquet too."""
        with _refusing(self.path):
            write_parquet(columns | {'motion': words(columns['motion'])}, self.path / PARQUET)
            (self.path / PARTIAL).replace(self.table)


@contextmanager
def _refusing(path: Path, comfort: str = KEPT) -> Iterator[None]:
    """Turn an error of the disk into an InputError."""
    try:
        yield
    except OSError as error:
        raise _refusal(path, error, comfort) from None


def _refusal(path: Path, error: OSError, comfort: str = KEPT) -> InputError:
    return InputError('--out', str(path), 'a place that can be written', f'{error.strerror or error}; {comfort}')
