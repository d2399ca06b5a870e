# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""All points of a study, chunk by chunk and in their order, by one process, several, or a cluster."""

import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from itertools import islice

from .folder import Folder
from .study import Study
from .table import lines
from .workers import Workers

_AHEAD = 4   # chunks that wait for each worker


def sweep(study: Study, folder: Folder, crew: Workers | None = None,
          progress: Callable[[float], None] | None = None) -> int:
    """Run what of a study is not in its folder yet, and finish the folder; return how many points it had to run.

    Without a `crew` this process does it.  The table is the same whoever works and however often it was interrupted.
    Raises InputError where the disk refuses, and what the crew does; what is done is kept.
    """
    if folder.is_complete:
        return 0
    with folder.taken():
        done = folder.whole_chunks(study)
        chunks = ((study, first, last) for first, last in study.stretches(done))
        results = _in_order(crew, chunks) if crew else (lines(*chunk) for chunk in chunks)
        for (_, last), text in zip(study.stretches(done), results):
            folder.append(text)
            if progress:
                progress(last / study.count)
        folder.finish()
    return max(study.count - done * study.chunk, 0)


def _in_order(crew: Workers, chunks: Iterator[tuple[Study, int, int]]) -> Iterator[bytes]:
    """Yield results in the order of the chunks, with a few under way for each worker, whatever their number."""
    waiting = deque(_submitted(crew, islice(chunks, _AHEAD * crew.size)))
    while waiting:
        yield waiting.popleft().result()
        waiting.extend(_submitted(crew, islice(chunks, 1)))


def _submitted(crew: Workers, chunks: Iterable[tuple[Study, int, int]]) -> list[Future[bytes]]:
    """Hand out chunks; workers that this starts inherit that Ctrl-C is held back, and leave it to their parent."""
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        return [crew.pool.submit(crew.work, *chunk) for chunk in chunks]
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
