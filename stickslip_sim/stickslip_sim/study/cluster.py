# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The workers of a Dask scheduler, on as many machines as it has; the only door to `distributed` (the extra `cluster`).

A worker that dies is the scheduler's to notice: it gives its chunks to another one.
"""

import asyncio
import logging
from collections.abc import Iterator, Mapping
from concurrent.futures import CancelledError
from contextlib import closing, contextmanager
from functools import partial
from importlib.util import find_spec
from typing import Any

from ..core.arrays import Numbers
from ..core.errors import InputError
from .folder import KEPT
from .study import versions_of_a_study
from .sweep import WorkerError, Workers
from .table import Tabled

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
