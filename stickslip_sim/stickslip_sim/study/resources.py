# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The processes, memory and disk space of a study, checked before it begins."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ..core.errors import InputError
from .table import Tabled, longest_line, width

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
    for where, of_a_point, free in (('memory', _IN_MEMORY * width(study), free_memory()),
                                    ('disk', longest_line(study), disk)):
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
