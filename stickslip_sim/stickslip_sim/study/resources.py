# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The memory and disk space of a study, checked before it begins."""

import shutil
from pathlib import Path

from ..core.errors import InputError
from .free_memory import free_memory
from .study import Study
from .table import longest_line, width

_IN_MEMORY = 40   # bytes that pandas takes for a number
_MEGA = 1e6
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
