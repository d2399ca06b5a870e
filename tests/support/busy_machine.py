# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a machine was too busy to measure how long something took: by what Linux says that processes waited."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest


class CoreWaits:
    """How long each thread of a process was ready to run and had no core, s; remembered when it has ended."""

    def __init__(self, pid: int | str = 'self') -> None:
        self._tasks = Path(f'/proc/{pid}/task')
        self._of_threads: dict[str, float] = {}

    def look(self) -> dict[str, float]:
        """Return what each thread waited until now, or until the last look."""
        with suppress(OSError):
            for task in self._tasks.iterdir():
                with suppress(OSError):    # it ends meanwhile
                    self._of_threads[task.name] = int((task / 'schedstat').read_text().split()[1]) * 1e-9
        return dict(self._of_threads)


@contextmanager
def judged_by_time(tolerance: float, *others: CoreWaits) -> Iterator[None]:
    """Skip what fails within while this process and others waited for a core, s, as long as the tolerance.

    Only for what truly measures time; the tolerance is the smallest delay that may let it fail.
    """
    processes = (CoreWaits(), *others)
    before = [process.look() for process in processes]
    try:
        yield
    except AssertionError as error:
        waited = sum(time - known.get(thread, 0.0) for process, known in zip(processes, before)
                     for thread, time in process.look().items())
        if waited < tolerance:
            raise
        pytest.skip(f'machine too busy to measure: {waited:.2f} s of waiting for a core; {str(error).splitlines()[0]}')
