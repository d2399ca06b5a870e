# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A sweep on disk: `study.json` says what it is, and its table grows by whole chunks of lines.

Until all points are there the table is `points.partial.csv`; then it becomes `points.csv`.
"""

import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from ..errors import InputError
from .description import FORM, description
from .parquet import write_parquet
from .study import Study
from .table import header, longest_line, may_be_table, size_in_memory, size_on_disk

LONGEST = 1 << 24   # bytes of a description; nearly all of it is the scene
SIDECAR, TABLE, PARTIAL, PARQUET = 'study.json', 'points.csv', 'points.partial.csv', 'points.parquet'


class Folder:
    """The folder of a sweep; raises InputError, with a path in it, where the disk refuses."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)

    @property
    def is_complete(self) -> bool:
        """Whether all points are there."""
        return (self.path / TABLE).exists()

    def begin(self, study: Study, command: str) -> None:
        """Make the folder and say in it what will come; one that cannot be begun is not left behind."""
        if os.path.lexists(self.path):
            raise InputError('--out', str(self.path), 'a folder that does not exist',
                             'choose another name, or add --resume to go on with it')
        parent = self.path.absolute().parent
        if not parent.is_dir():
            raise InputError('--out', str(self.path), 'in a folder that exists', f'make the folder {parent} first')
        with _refusing(self.path):
            self.path.mkdir()
            try:
                self._check_room(study)
                (self.path / SIDECAR).write_text(json.dumps(description(study, command), indent=1) + '\n',
                                                 encoding='utf-8')
                (self.path / PARTIAL).write_bytes(header(study))
            except BaseException:
                shutil.rmtree(self.path, ignore_errors=True)
                raise

    def described(self) -> dict[str, Any]:
        """Return what the folder says it is; raises InputError when it is not of a sweep."""
        path = self.path / SIDECAR
        try:
            if path.is_file() and path.stat().st_size <= LONGEST:
                told = json.loads(path.read_text(encoding='utf-8'))
                if told['form'] == FORM:
                    return dict(told)
        except (OSError, ValueError, KeyError, TypeError, RecursionError):
            pass
        raise InputError('folder', str(self.path), f'that of a sweep, with {SIDECAR} in it', 'sweep into a new one')

    def check_same(self, study: Study) -> None:
        """Raise InputError unless what stands in the folder is of this study, by the same versions."""
        told = self.described()
        for name, value in json.loads(json.dumps(description(study))).items():
            if name != 'command' and told.get(name) != value:
                raise InputError('--resume', str(self.path), f'the folder of this very study; its {name} is another',
                                 f'give the command that stands in its {SIDECAR}, or another folder')

    def whole_chunks(self, study: Study) -> int:
        """Return how many chunks of points are there; what a crash left behind of another is taken away."""
        path, titles = self.path / PARTIAL, header(study)
        with _refusing(path), path.open('r+b') as file:
            if not may_be_table(path, study) or file.readline(len(titles)) != titles:
                raise InputError('points', str(path), 'the table of this study', 'it was changed; sweep into a new one')
            chunks = rows = 0
            end = place = len(titles)
            for line in iter(partial(file.readline, longest_line(study)), b''):
                if not line.endswith(b'\n'):
                    break
                place, rows = place + len(line), rows + 1
                if rows == min((chunks + 1) * study.chunk, study.count):
                    end, chunks = place, chunks + 1
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

    def finish(self) -> None:
        """Give the table its name; where pandas is installed, write it as Parquet too."""
        with _refusing(self.path):
            write_parquet(self.path / PARTIAL, self.path / PARQUET)
            (self.path / PARTIAL).replace(self.path / TABLE)

    def _check_room(self, study: Study) -> None:
        """Raise InputError when the table would not fit into memory or onto the disk."""
        memory = os.sysconf('SC_AVPHYS_PAGES') * os.sysconf('SC_PAGE_SIZE')
        _check_size(study, 'memory', size_in_memory(study), memory)
        _check_size(study, 'disk', size_on_disk(study), shutil.disk_usage(self.path).free)


def _check_size(study: Study, where: str, needed: int, free: int) -> None:
    if needed > free:
        raise InputError('points', study.count, f'at most {study.count * free // needed}: their table would take '
                         f'{needed / 1e6:,.0f} MB of {where}, of which {free / 1e6:,.0f} MB are free',
                         'take fewer values for each parameter, or --sobol N')


@contextmanager
def _refusing(path: Path) -> Iterator[None]:
    """Turn what the disk says into an InputError."""
    try:
        yield
    except OSError as error:
        raise InputError('--out', str(path), 'a place that can be written',
                         f'{error.strerror or error}; what is done is kept, --resume goes on') from None
