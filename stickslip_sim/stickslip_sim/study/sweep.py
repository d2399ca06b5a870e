"""All points of a study, chunk by chunk and in their order, by one process or several."""

import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from itertools import islice
from multiprocessing import get_context, parent_process
from typing import NoReturn

from ..errors import StickslipError
from .folder import Folder
from .study import Study
from .table import lines

_AHEAD = 4   # chunks that wait for each worker


class WorkerError(StickslipError):
    """A worker process died."""


def sweep(study: Study, folder: Folder, workers: int = 1, progress: Callable[[float], None] | None = None) -> int:
    """Run what of a study is not in its folder yet, and finish the folder; return how many points it had to run.

    The table is the same whatever the number of workers and however often it was interrupted.  Raises InputError where
    the disk refuses, and WorkerError; what is done is kept.
    """
    if folder.is_complete:
        return 0
    done = folder.whole_chunks(study)
    begin = min(done * study.chunk, study.count)
    starts = range(begin, study.count, study.chunk)
    with _results(study, starts, workers) as results:
        for start, text in zip(starts, results):
            folder.append(text)
            if progress:
                progress(min(start + study.chunk, study.count) / study.count)
    folder.finish()
    return study.count - begin


@contextmanager
def _results(study: Study, starts: range, workers: int) -> Iterator[Iterator[bytes]]:
    """Yield the lines of each chunk, in their order, as they are asked for."""
    chunks = ((study, start, min(start + study.chunk, study.count)) for start in starts)
    if workers == 1:
        yield (lines(*chunk) for chunk in chunks)
        return
    with _pool(workers) as pool:
        yield _in_order(pool, chunks, _AHEAD * workers)


@contextmanager
def _pool(workers: int) -> Iterator[Executor]:
    """Yield processes; on any error what waits for them is dropped and what they are at is waited for."""
    pool = ProcessPoolExecutor(workers, get_context('spawn'), _watch_the_parent)
    try:
        yield pool
    except BrokenProcessPool:
        raise WorkerError('a worker process was killed; what is done is kept, --resume goes on') from None
    finally:
        pool.shutdown(cancel_futures=True)


def _watch_the_parent() -> None:
    """Have a worker go when its parent is gone, however it went: nothing else would end it."""
    threading.Thread(target=_go_with_the_parent, daemon=True).start()


def _go_with_the_parent() -> NoReturn:
    parent = parent_process()
    if parent is not None:
        parent.join()
    os._exit(1)


def _in_order(pool: Executor, chunks: Iterator[tuple[Study, int, int]], ahead: int) -> Iterator[bytes]:
    """Yield results in the order of the chunks, with no more than `ahead` under way, whatever their number."""
    waiting = deque(_submitted(pool, islice(chunks, ahead)))
    while waiting:
        yield waiting.popleft().result()
        waiting.extend(_submitted(pool, islice(chunks, 1)))


def _submitted(pool: Executor, chunks: Iterable[tuple[Study, int, int]]) -> list[Future[bytes]]:
    """Hand out chunks; workers that this starts inherit that Ctrl-C is held back, and leave it to their parent."""
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        return [pool.submit(lines, *chunk) for chunk in chunks]
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
