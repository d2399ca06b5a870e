# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What verbs of many runs have in common: the folder of a study, the processes that work on it, points that failed."""

import os
import shlex
import sys
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING

import click

from .scene_changes import ClickCommand, scene_changes

if TYPE_CHECKING:
    from ..study import Study
    from ..study.folder import Folder
    from ..study.sweep import Swept
    from ..study.table import TableColumns
    from ..study.workers import Workers

_MOST_WORKERS = 1024
_OPTIONS = (
    click.option('--out', required=True, metavar='FOLDER', help='Write points.csv (with pandas .parquet too) there.'),
    click.option('--duration', type=float, metavar='S', help='Simulated time, s [default: until the motion settles].'),
    click.option('--workers', metavar='N|all', help='Processes to use [default: 1].'),
    click.option('--scheduler', metavar='ADDRESS', help='Use the workers of this Dask scheduler instead.'),
    click.option('--resume', is_flag=True, help='Go on with what was interrupted.'),
    scene_changes('Change a parameter of the scene.'),
)


def study_options(command: ClickCommand) -> ClickCommand:
    """Give a command the options of every study."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def workers_of(workers: str | None, scheduler: str | None) -> AbstractContextManager['Workers | None']:
    """Return the workers on a study: none but this process, processes, or a cluster.

    Raises InputError and UsageError.
    """
    from ..study.cluster import cluster
    from ..study.workers import processes

    if scheduler is not None:
        if workers is not None:
            raise click.UsageError('--workers and --scheduler exclude each other.')
        return cluster(scheduler)
    count = process_count('1' if workers is None else workers)
    return processes(count) if count > 1 else nullcontext()


def carry_out(study: 'Study', out: str, workers: AbstractContextManager['Workers | None'],
              resume: bool) -> tuple['Folder', 'Swept']:
    """Run a study into its folder, new or resumed; return both."""
    from ..study.folder import Folder
    from ..study.sweep import sweep_into
    from .progress import progress_bar

    folder = Folder(out)
    with workers as members:   # workers that cannot be had leave no folder behind
        if resume:
            folder.check_same(study)
        else:
            folder.begin(study, shlex.join(['stickslip', *sys.argv[1:]]))
        try:
            with progress_bar('sweeping') as progress:
                return folder, sweep_into(study, folder, members, progress)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(f'interrupted; what is done is kept in {out}, --resume goes on') from None


def print_failed(study: 'Study', columns: 'TableColumns') -> None:
    """Print how many points of a study failed, if any did."""
    from ..study.point_figures import Motion

    failed = int((columns['motion'] == Motion.FAILED).sum())
    if failed:
        engine = study.scene.solver.name
        print(f'{failed} of {study.count} points failed: the {engine} engine gave up; see column motion')


def process_count(workers: str) -> int:
    """Return how many processes `--workers` asks for; raises InputError."""
    from ..core.errors import InputError
    from ..study.resources import check_memory_for_workers

    if workers == 'all':
        count = len(os.sched_getaffinity(0))
    elif workers.isascii() and workers.isdigit() and 1 <= int(workers[:5]) <= _MOST_WORKERS:
        count = int(workers)
    else:
        raise InputError('--workers', workers, f'a whole number from 1 to {_MOST_WORKERS}, or all',
                         'leave it out for 1')
    check_memory_for_workers(count)
    return count
