# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""All points of a study, chunk by chunk and in their order, by one process, several, or a cluster."""

from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future
from itertools import islice
from typing import NamedTuple

import numpy as np

from ..core.callbacks import Progress
from .folder import Folder
from .point_figures import Figures
from .study import Study
from .table import TableColumns, columns, lines, read_columns, rows_of
from .workers import Workers

_AHEAD = 4   # chunks that wait for each worker
_Stretch = tuple[int, int]   # the first of some points, and the one after the last of them


class Swept(NamedTuple):
    """The columns of the table of a study, and how many of its points had to be run for it."""

    columns: TableColumns
    ran: int


def sweep_into(study: Study, folder: Folder, workers: Workers | None = None, progress: Progress = None) -> Swept:
    """Run the points of a study that its folder does not have yet, finish the folder, and return all points.

    Without `workers` this process does it.  The table is the same for any number of workers and of interruptions.
    Raises InputError where the disk refuses, and the errors of the workers; finished chunks are kept.
    """
    if folder.is_complete:
        return Swept(read_columns(folder.table, study), 0)
    with folder.taken():
        chunks = folder.whole_chunks(study)
        done = len(chunks)
        for (first, last), figures in zip(study.stretches(done), _figures(study, study.stretches(done), workers)):
            rows = rows_of(study.points(first, last), figures)
            folder.append(lines(study, rows))
            chunks.append(rows)
            if progress:
                progress(last / study.count)
        table = columns(study, np.concatenate(chunks))
        folder.finish(table)
    return Swept(table, max(study.count - done * study.chunk, 0))


def _figures(study: Study, stretches: Iterator[_Stretch], workers: Workers | None) -> Iterator[Figures]:
    """Yield the figures of stretches of points, in their order."""
    if workers is None:
        yield from (study.figures(*stretch) for stretch in stretches)
    else:
        yield from _by_workers(study, stretches, workers)


def _by_workers(study: Study, stretches: Iterator[_Stretch], workers: Workers) -> Iterator[Figures]:
    """Yield figures in the order of the stretches, with a few under way for each worker, for any number of workers."""
    waiting = deque(_submitted(study, islice(stretches, _AHEAD * workers.size), workers))
    while waiting:
        yield waiting.popleft().result()
        waiting.extend(_submitted(study, islice(stretches, 1), workers))


def _submitted(study: Study, stretches: Iterable[_Stretch], workers: Workers) -> list[Future[Figures]]:
    return [workers.pool.submit(workers.work, study, *stretch) for stretch in stretches]
