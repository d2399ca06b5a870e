# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A sweep on disk: `study.json` describes it, and its table grows by whole chunks of lines.

Until all points are there the table is `points.partial.csv`; then it becomes `points.csv`.
"""

import fcntl
import json
import os
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from ..core.arrays import Numbers
from ..core.errors import InputError, paths_beside, suggestion
from ..core.paths import made_folder
from . import table
from .study import Study
from .table import TableColumns, Tabled

LONGEST_SIDECAR = 1 << 24   # bytes of a description; nearly all of it is the scene
SIDECAR, POINTS_TABLE, PARTIAL, PARQUET = 'study.json', 'points.csv', 'points.partial.csv', 'points.parquet'
KEPT = 'what is done is kept, --resume goes on'


class Folder:
    """The folder of a sweep; raises InputError, with a path in it, where the disk refuses."""

    def __init__(self, path: str | Path, form: str = Study.form) -> None:
        self.path, self._form = Path(path), form

    @property
    def table(self) -> Path:
        """Where the table of all points stands when it is complete."""
        return self.path / POINTS_TABLE

    @property
    def is_complete(self) -> bool:
        """Whether all points are there."""
        return self.table.exists()

    def begin(self, study: Tabled, command: str) -> None:
        """Make the folder with the description of the study and an empty table: whole, or not at all."""
        if os.path.lexists(self.path):
            raise InputError('--out', str(self.path), 'a folder that does not exist',
                             'choose another name, or add --resume to continue it')
        temporary = self.path.absolute().with_name(f'.{os.getpid()}.{self.path.name}')
        with refusing(self.path, 'nothing is left behind'), made_folder(temporary):
            check_resources(study, temporary)
            (temporary / SIDECAR).write_text(json.dumps(study.described(command), indent=1) + '\n',
                                             encoding='utf-8')
            (temporary / PARTIAL).write_bytes(table.title_line(study))
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
                raise InputError('--out', str(self.path), 'a folder that no other process uses',
                                 'wait for that process, or end it and add --resume') from None
            except OSError as error:
                raise _refusal(self.path, error) from None
            yield

    def described(self) -> dict[str, Any]:
        """Return the description in the folder; raises InputError when it is not of a sweep."""
        path = self.path / SIDECAR
        try:
            if path.is_file() and path.stat().st_size <= LONGEST_SIDECAR:
                found = json.loads(path.read_text(encoding='utf-8'))
                if found['form'] == self._form:
                    return dict(found)
        except (OSError, ValueError, KeyError, TypeError, RecursionError):
            pass
        beside = paths_beside(self.path, (), folders=True)
        raise InputError('folder', str(self.path), f'that of a sweep, with {SIDECAR} in it', 'sweep into a new one'
                         if self.path.exists() else suggestion(str(self.path), beside, 'no such folder: sweep into it'))

    def check_same(self, study: Tabled) -> None:
        """Raise InputError unless the folder is of this study, by the same versions."""
        found = self.described()
        for name, value in study.described().items():
            if name != 'command' and found.get(name) != value:
                raise InputError('--resume', str(self.path), f'the folder of this study; its {name} is another',
                                 f'give the command that stands in its {SIDECAR}, or another folder')

    def whole_chunks(self, study: Tabled) -> list[Numbers]:
        """Return the rows of each whole chunk of points that is there; the remains of a crash are cut off."""
        path, titles = self.path / PARTIAL, table.title_line(study)
        with refusing(path), path.open('r+b') as file:
            if not table.may_be_table(path, study) or file.readline(len(titles)) != titles:
                raise InputError('points', str(path), 'the table of this study', 'it was changed; sweep into a new one')
            chunks, end = [], len(titles)
            for first, last in table.stretches(study):
                found = table.next_lines(file, study, first, last)
                try:
                    chunks.append(table.read_rows(found, study, first, last))
                except ValueError:
                    break
                end += sum(map(len, found))
            file.truncate(end)
        return chunks

    def append(self, lines: bytes) -> None:
        """Add lines to the table: all of them, or none when the disk refuses."""
        with refusing(self.path / PARTIAL), (self.path / PARTIAL).open('ab', buffering=0) as file:
            before = file.seek(0, os.SEEK_END)
            try:
                written = 0
                while written < len(lines):   # once; a full disk takes a part and then says why
                    written += file.write(lines[written:])
            except BaseException:
                file.truncate(before)
                raise

    def finish(self, study: Tabled, columns: TableColumns) -> None:
        """Give the table its name; where pandas is installed, write its `columns` as Parquet too."""
        with refusing(self.path):
            worded = study.figure_names[0]
            table.write_parquet(columns | {worded: table.in_words(study, columns[worded])}, self.path / PARQUET)
            (self.path / PARTIAL).replace(self.table)


@contextmanager
def refusing(path: Path, comfort: str = KEPT) -> Iterator[None]:
    """Turn an error of the disk into an InputError."""
    try:
        yield
    except OSError as error:
        raise _refusal(path, error, comfort) from None


def _refusal(path: Path, error: OSError, comfort: str = KEPT) -> InputError:
    return InputError('--out', str(path), 'a writable place', f'{error.strerror or error}; {comfort}')


# The processes, memory and disk space of a study, checked before it begins.

# How much memory can be had: of the machine, and of the container or control group that this process is in.

class _Hierarchy(NamedTuple):
    """The files in which a version of Linux' control groups keeps the limit and the use of memory."""

    root: str
    limit: str
    usage: str
    cached: str    # the entry of memory.stat that counts pages that only hold copies of files


_V1 = _Hierarchy('sys/fs/cgroup/memory', 'memory.limit_in_bytes', 'memory.usage_in_bytes', 'total_inactive_file')
_V2 = _Hierarchy('sys/fs/cgroup', 'memory.max', 'memory.current', 'inactive_file')


def free_memory(machine: Path = Path('/')) -> int:
    """Return how many bytes can be had, those among them that only hold copies of files.

    `machine` is the root of the file system.  A limit that cannot be read is taken for none.
    """
    return min([_of_the_machine(machine), *_of_the_groups(machine)])


def _of_the_machine(machine: Path) -> int:
    for line in (machine / 'proc/meminfo').read_text(encoding='ascii').splitlines():
        if line.startswith('MemAvailable:'):
            return int(line.split()[1]) * 1024
    return os.sysconf('SC_AVPHYS_PAGES') * os.sysconf('SC_PAGE_SIZE')


def _of_the_groups(machine: Path) -> Iterator[int]:
    """Yield the bytes left to this process by its groups, from its own up to the root, which is a container's own."""
    try:
        lines = (machine / 'proc/self/cgroup').read_text(encoding='utf-8').splitlines()
    except OSError:
        return
    for line in lines:    # as 5:memory:/docker/4f1c, or 0::/user.slice
        _, controllers, path = line.split(':', 2)
        if not controllers or 'memory' in controllers.split(','):
            kind = _V1 if controllers else _V2
            group = machine / kind.root / path.strip('/')
            for folder in (group, *group.parents):
                yield from _left_in(folder, kind)
                if folder == machine / kind.root:
                    break


def _left_in(folder: Path, kind: _Hierarchy) -> Iterator[int]:
    try:
        limit, usage = int((folder / kind.limit).read_text()), int((folder / kind.usage).read_text())
        stat = dict(line.split() for line in (folder / 'memory.stat').read_text().splitlines())
    except (OSError, ValueError):    # no such group within this container, or its limit is the word max
        return
    yield max(0, limit - usage + int(stat.get(kind.cached, 0)))


_IN_MEMORY = 40   # bytes that pandas takes for a number
_MEGA = 1e6
_MOST_WORKERS = 1024
_OF_A_WORKER = 50_000_000   # bytes: Python, numpy and the compiled engine, each process for itself


def check_resources(study: Tabled, folder: Path) -> None:
    """Raise InputError when the table of a study would not fit into memory or onto the disk of a folder."""
    disk = shutil.disk_usage(folder).free
    for where, of_a_point, free in (('memory', _IN_MEMORY * table.width(study), free_memory()),
                                    ('disk', table.longest_line(study), disk)):
        if study.count * of_a_point > free:
            raise InputError('points', study.count, f'at most {free // of_a_point}: their table would take '
                             f'{_mega(study.count * of_a_point)} of {where}, of which {_mega(free)} are free',
                             'take fewer values for each parameter, or --sobol N')


def check_memory_for_workers(count: int) -> None:
    """Raise InputError when so many processes would not fit into memory."""
    free = free_memory()
    if count * _OF_A_WORKER > free:
        raise InputError('--workers', count, f'at most {free // _OF_A_WORKER}: they would take '
                         f'{_mega(count * _OF_A_WORKER)} of memory, of which {_mega(free)} are free',
                         'take fewer, or leave it out for 1')


def _mega(size: int) -> str:
    return f'{size / _MEGA:,.0f} MB'


def process_count(workers: str) -> int:
    """Return how many processes `--workers` asks for; raises InputError."""
    if workers == 'all':
        count = len(os.sched_getaffinity(0))
    elif workers.isascii() and workers.isdigit() and 1 <= int(workers[:5]) <= _MOST_WORKERS:
        count = int(workers)
    else:
        raise InputError('--workers', workers, f'a whole number from 1 to {_MOST_WORKERS}, or all',
                         'leave it out for 1')
    check_memory_for_workers(count)
    return count
