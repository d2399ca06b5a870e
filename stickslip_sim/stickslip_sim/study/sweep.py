# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""All points of a study, chunk by chunk and in their order, by one process, several, or a cluster."""

import logging
import os
import pickle
import select
import signal
import subprocess
import sys
import threading
import traceback
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import CancelledError, Executor, Future, ThreadPoolExecutor
from contextlib import AbstractContextManager, closing, contextmanager, suppress
from functools import partial
from importlib.util import find_spec
from itertools import islice
from multiprocessing.connection import Connection, Pipe
from queue import SimpleQueue
from typing import Any, NamedTuple, NoReturn

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError, StickslipError
from ..core.hot_path import hot_path
from ..core.types import Progress
from .folder import KEPT, Folder
from .study import versions_of_a_study
from .table import TableColumns, Tabled, columns, lines, read_columns, stretches

# The workers on the chunks of a study beside this process: other processes of this machine.
#
# Each has a connection of its own, and nothing is shared: one that is killed, at any moment, leaves no lock taken and
# no message of another one cut off.  Its connection ends, and what it was at raises an error here.

class WorkerError(StickslipError):
    """A worker is gone, or cannot work."""


def _rows_of(study: Tabled, first: int, last: int) -> Numbers:
    return study.rows(first, last)


class Workers(NamedTuple):
    """So many workers behind a `pool`, and the function by which they find the rows of a stretch of points."""

    pool: Executor
    size: int
    work: Callable[[Tabled, int, int], Numbers] = _rows_of


@contextmanager
def processes(count: int) -> Iterator[Workers]:
    """Yield processes; at the end, and on any error, they are killed: their parent alone keeps what they found."""
    pool = _Processes(count)
    try:
        yield Workers(pool, count)
    finally:
        pool.kill()


class _Processes(Executor):
    """Up to `count` processes, started as they are needed; for each a thread hands over work and waits."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._started: list[_Process] = []
        self._idle: SimpleQueue[_Process] = SimpleQueue()
        self._threads = ThreadPoolExecutor(count)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Have a process call a function; raises WorkerError."""
        # what is started here inherits that Ctrl-C is held back, and leaves it to the thread that asked
        before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        try:
            if len(self._started) < self._count:
                self._started.append(_Process())
                self._idle.put(self._started[-1])
            return self._threads.submit(self._done_by_one, fn, args, kwargs)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def _done_by_one(self, *work: Any) -> Any:
        process = self._idle.get()    # there are no more threads than processes
        try:
            return process.do(work)
        finally:
            self._idle.put(process)

    def kill(self) -> None:
        """Drop all that is not done, and end the processes."""
        self._threads.shutdown(wait=False, cancel_futures=True)
        for process in self._started:
            process.kill()
        self._threads.shutdown()


class _Process:
    """A process that does one piece of work after the other for this one, and ends with it, however that ends."""

    def __init__(self) -> None:
        program = f'import sys; sys.path[:] = sys.argv[2:]; from {__name__} import {serve.__name__} as serve; '
        # plain Python here is plain Python there, without a second line that says so
        hot = {'STICKSLIP_COMPILED': '0'} if hot_path() == 'plain python' else {}
        try:
            self._connection, end = Pipe()
            with end:
                self._process = subprocess.Popen(
                    [sys.executable, '-c', f'{program}serve(int(sys.argv[1]))', str(end.fileno()), *sys.path],
                    stdin=subprocess.DEVNULL, pass_fds=[end.fileno()], env={**os.environ, **hot})
        except OSError as error:
            raise WorkerError(f'a worker process cannot be started: {error.strerror}; {KEPT}') from None

    def do(self, work: tuple[Any, ...]) -> Any:
        """Have it call a function with arguments; raises what that raises, and WorkerError when the process is gone."""
        try:
            self._connection.send(work)
            result, error, where = self._connection.recv()
        except (EOFError, OSError):
            raise WorkerError(f'a worker process {_ended(self._process.wait())}; {KEPT}') from None
        if error is not None:
            raise error from RuntimeError(where)
        return result

    def kill(self) -> None:
        """End it, and wait for that."""
        self._process.kill()
        self._process.wait()


def _ended(code: int) -> str:
    return f'was killed by signal {-code}' if code < 0 else f'ended with exit code {code}'


def serve(descriptor: int) -> None:
    """Do the work that comes over a connection, until that ends: all that a worker process does."""
    with Connection(descriptor) as parent, suppress(EOFError, OSError):
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()
        while True:
            parent.send_bytes(_answer(parent.recv_bytes()))


def _end_with(parent: Connection) -> NoReturn:
    """End this process, at work or not, as soon as nobody holds the other end of its connection."""
    hung_up = select.poll()
    hung_up.register(parent, 0)    # a hang-up is reported with any mask
    hung_up.poll()
    os._exit(1)    # sys.exit would end this thread alone, and the work go on for nobody


def _answer(request: bytes) -> bytes:
    """Return the result of the work that was asked for, or its error and where that came from."""
    try:
        function, args, kwargs = pickle.loads(request)
        return pickle.dumps((function(*args, **kwargs), None, ''))
    except Exception as error:
        return pickle.dumps((None, error, traceback.format_exc()))


_AHEAD = 4   # chunks that wait for each worker
_Stretch = tuple[int, int]   # the first of some points, and the one after the last of them


class Swept(NamedTuple):
    """The columns of the table of a study, and how many of its points had to be run for it."""

    columns: TableColumns
    ran: int


def carry_out(study: Tabled, folder: Folder, workers: AbstractContextManager[Workers | None], resume: bool,
              command: str, progress: Progress = None) -> Swept:
    """Run a study into its folder, new or resumed, as `sweep_into` does; `command` began it."""
    with workers as members:   # workers that cannot be had leave no folder behind
        if resume:
            folder.check_same(study)
        else:
            folder.begin(study, command)
        try:
            return sweep_into(study, folder, members, progress)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(f'interrupted; what is done is kept in {folder.path}, --resume goes on') from None


def sweep_into(study: Tabled, folder: Folder, workers: Workers | None = None, progress: Progress = None) -> Swept:
    """Run the points of a study that its folder does not have yet, finish the folder, and return all points.

    Without `workers` this process does it.  The table is the same for any number of workers and of interruptions.
    Raises InputError where the disk refuses, and the errors of the workers; finished chunks are kept.
    """
    if folder.is_complete:
        return Swept(read_columns(folder.table, study), 0)
    with folder.taken():
        chunks = folder.whole_chunks(study)
        done = len(chunks)
        for rows in _told(study, done, workers, progress):
            folder.append(lines(study, rows))
            chunks.append(rows)
        table = columns(study, np.concatenate(chunks))
        folder.finish(study, table)
    return Swept(table, max(study.count - done * study.chunk, 0))


def columns_of(study: Tabled, workers: Workers | None = None, progress: Progress = None) -> TableColumns:
    """Run all points of a study, without a folder; return its numbers and figures by name."""
    return columns(study, np.concatenate(list(_told(study, 0, workers, progress))))


def _told(study: Tabled, done: int, workers: Workers | None, progress: Progress) -> Iterator[Numbers]:
    """Yield the rows of the chunks after those that are done, and tell how far that is once they are taken."""
    for (_, last), rows in zip(stretches(study, done), rows_by(study, stretches(study, done), workers)):
        yield rows
        if progress:
            progress(last / study.count)


def rows_by(study: Tabled, wanted: Iterator[_Stretch], workers: Workers | None) -> Iterator[Numbers]:
    """Yield the rows of stretches of points, in their order."""
    if workers is None:
        yield from (study.rows(*stretch) for stretch in wanted)
    else:
        yield from _by_workers(study, wanted, workers)


def _by_workers(study: Tabled, wanted: Iterator[_Stretch], workers: Workers) -> Iterator[Numbers]:
    """Yield rows in the order of the stretches, with a few under way for each worker."""
    waiting = deque(_submitted(study, islice(wanted, _AHEAD * workers.size), workers))
    while waiting:
        yield waiting.popleft().result()
        waiting.extend(_submitted(study, islice(wanted, 1), workers))


def _submitted(study: Tabled, wanted: Iterable[_Stretch], workers: Workers) -> list[Future[Numbers]]:
    return [workers.pool.submit(workers.work, study, *stretch) for stretch in wanted]


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
                   partial(_checked_rows, versions_of_a_study()))


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
    import asyncio

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


def _checked_rows(versions: Mapping[str, str], study: Tabled, first: int, last: int) -> Numbers:
    """Return the rows of a stretch of points; raises WorkerError on a worker that came late with other versions."""
    other = _other(versions)
    if other:
        raise WorkerError(f'a worker lacks the versions of this study, {other}: its last bits might differ; {KEPT}')
    return study.rows(first, last)
