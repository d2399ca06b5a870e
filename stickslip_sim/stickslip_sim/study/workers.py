# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The processes, memory and disk space of a study, checked before it begins."""

import asyncio
import logging
import os
import shutil
from collections.abc import Iterator, Mapping
from concurrent.futures import CancelledError
from contextlib import closing, contextmanager
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

from ..core.errors import InputError
from ..figures.point_figures import Figures
from .study import Study, versions_of_a_study
from .sweep import WorkerError, Workers
from .table import KEPT, longest_line, width

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


def check_resources(study: Study, folder: Path) -> None:
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


# The workers of a Dask scheduler, on as many machines as it has; the only door to `distributed` (the extra `cluster`).
#
# A worker that dies is the scheduler's to notice: it gives its chunks to another one.

_PATIENCE = 5.0   # s for the scheduler to answer


@contextmanager
def cluster(address: str) -> Iterator[Workers]:
    """Yield the workers of the scheduler at an address; raises InputError when there are none, and WorkerError."""
    with _quietly(), closing(_client(address)) as client, _reported(address):
        _check_workers(client, address)
        yield Workers(client.get_executor(), sum(client.nthreads().values()),
                   partial(_checked_figures, versions_of_a_study()))


@contextmanager
def _reported(address: str) -> Iterator[None]:
    """Turn an error of the cluster into a WorkerError."""
    from distributed import KilledWorker
    from distributed.comm import CommClosedError

    try:
        yield
    except KilledWorker:
        raise WorkerError(f'one worker of {address} after the other died; {KEPT}') from None
    except (CommClosedError, CancelledError):
        raise WorkerError(f'the scheduler {address} is gone; {KEPT}') from None


@contextmanager
def _quietly() -> Iterator[None]:
    """Keep Dask from logging: its errors are raised."""
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(logging.NOTSET)


def _client(address: str) -> Any:
    if find_spec('distributed') is None:
        raise InputError('--scheduler', address, "left out: Dask's distributed is not installed here",
                         'pip install distributed, or use --workers')
    from distributed import Client

    try:
        asyncio.run(asyncio.wait_for(_greet(address), _PATIENCE))
        return Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError, TypeError, MemoryError, asyncio.TimeoutError) as error:
        # MemoryError from a server that speaks another protocol; the time-out is an OSError from Python 3.11 on only
        raise InputError('--scheduler', address, 'the address of a Dask scheduler that runs, as tcp://HOST:8786',
                         f'{str(error) or "there is no answer"}; start one: dask scheduler') from None


async def _greet(address: str) -> None:
    """Return when a scheduler has answered: a client would wait for ever for a silent server."""
    from distributed.comm import connect

    comm = await connect(address, timeout=_PATIENCE)
    await comm.close()


def _check_workers(client: Any, address: str) -> None:
    """Raise InputError unless there are workers, all with this very stickslip."""
    found = client.run(versions_of_a_study, on_error='return')
    if not found:
        raise InputError('--scheduler', address, 'a scheduler with workers', f'start one: dask worker {address}')
    for worker, versions in found.items():
        other = str(versions) if isinstance(versions, BaseException) else _other(versions)
        if other:
            raise InputError('--scheduler', address, 'one whose workers all have what is installed here',
                             f'{worker}: {other}; install the same there')


def _other(versions: Mapping[str, str]) -> str:
    """Return which of a worker's versions is another than here, in words; empty if none is."""
    return ', '.join(f'{name} {versions[name]} and not {own}' for name, own in versions_of_a_study().items()
                     if versions[name] != own)


def _checked_figures(versions: Mapping[str, str], study: Study, first: int, last: int) -> Figures:
    """Return the figures of a stretch of points; raises WorkerError on a worker that came late with other versions."""
    other = _other(versions)
    if other:
        raise WorkerError(f'a worker lacks the versions of this study, {other}: its last bits might differ; {KEPT}')
    return study.figures(first, last)
