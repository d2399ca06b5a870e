# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The workers on the chunks of a study beside this process: other processes of this machine."""

import os
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from typing import NamedTuple, NoReturn

from ..core.errors import StickslipError
from .folder import KEPT
from .point_figures import Figures
from .study import Study


class WorkerError(StickslipError):
    """A worker is gone, or cannot work."""


class Workers(NamedTuple):
    """So many workers behind a `pool`, and the function by which they find the figures of a stretch of points."""

    pool: Executor
    size: int
    work: Callable[[Study, int, int], Figures] = Study.figures


@contextmanager
def processes(count: int) -> Iterator[Workers]:
    """Yield processes; on any error waiting chunks are dropped and those under way are waited for."""
    pool = ProcessPoolExecutor(count, get_context('spawn'), _watch_the_parent)
    try:
        yield Workers(pool, count)
    except BrokenProcessPool:
        _stop_sending(pool)
        raise WorkerError(f'a worker process was killed; {KEPT}') from None
    finally:
        pool.shutdown(cancel_futures=True)


def _stop_sending(pool: ProcessPoolExecutor) -> None:
    """Drop what no worker will read, as Python does from 3.11.5 on; an older one waits for ever until it is written."""
    queue = getattr(pool, '_call_queue', None)
    if queue is not None:
        queue._reader.close()


def _watch_the_parent() -> None:
    """Have a worker go when its parent is gone, however it went: nothing else would end it."""
    threading.Thread(target=_go_with_the_parent, daemon=True).start()


def _go_with_the_parent() -> NoReturn:
    parent = parent_process()
    if parent is not None:
        parent.join()
    os._exit(1)
