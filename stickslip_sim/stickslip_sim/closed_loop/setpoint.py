# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The setpoint of a closed loop: a function of time, moves, arrays or a file, as numbers at the steps."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..controllers import Moves, Setpoint
from ..controllers.own_controller import raised
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.types import tuple_of
from ..inputs.csv_table import LENGTHS, TIMES, CsvTable, column_of
from ..scene.schema import MOST_POINTS

_KINDS = 'a function of time, Moves, arrays (times, positions), or a CSV file with the columns time and position'
_NAMES = (('time', 't'), TIMES), (('position', 'x'), LENGTHS)
Given = Callable[[float], object] | Moves | tuple[Any, Any] | str | os.PathLike[str]


def setpoints_at(given: Given, times: Numbers) -> Numbers:
    """Return position (m) and velocity (m/s) at times as columns.

    Where only positions are given, the velocity is that of the way to the next of these times.  Raises InputError.
    """
    if isinstance(given, str | os.PathLike):
        table = _table(Path(given))
        found = _interpolated(table.columns[0], table.columns[1], times)
    elif isinstance(given, Moves) or callable(given):
        found = _called(given.at if isinstance(given, Moves) else given, times)
    else:
        found = _interpolated(*_arrays(given), times)
    if found.ndim == 1:
        speeds = np.diff(found) / np.diff(times)
        found = np.stack([found, np.append(speeds, speeds[-1:])], axis=1)
    return found


def _called(function: Callable[[float], object], times: Numbers) -> Numbers:
    answers: list[Any] = []
    for time in times.tolist():
        try:
            answers.append(function(time))
        except Exception as error:
            raise InputError(f'setpoint({time:g})', raised(error), 'a position, m', 'correct the function') from None
    try:
        found = np.array(answers, dtype=np.float64)
        if found.shape in ((len(times),), (len(times), 2)) and np.isfinite(found).all():
            return found
    except (TypeError, ValueError):
        pass
    time, answer = next((time, answer) for time, answer in zip(times.tolist(), answers)
                        if not _is_setpoint(answer, np.shape(answers[0])))
    raise InputError(f'setpoint({time:g})', answer, 'a finite position, m, or (position, velocity)',
                     'return the same kind at each time')


def _is_setpoint(answer: Any, shape: tuple[int, ...]) -> bool:
    try:
        row = np.array(answer, dtype=np.float64)
    except (TypeError, ValueError):
        return False
    return row.shape == shape and shape in ((), (2,)) and bool(np.isfinite(row).all())


def _arrays(given: object) -> tuple[Numbers, Numbers]:
    try:
        times, positions = (np.asarray(part, dtype=np.float64) for part in given)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        raise InputError('setpoint', given, _KINDS, 'give one of these') from None
    if times.ndim != 1 or times.shape != positions.shape or not len(times):
        raise InputError('setpoint', f'arrays of shapes {times.shape} and {positions.shape}',
                         'times and positions, one as many as the other', 'give (times, positions)')
    for name, values in (('times', times), ('positions', positions)):
        for row in np.flatnonzero(~np.isfinite(values))[:1].tolist():
            raise InputError(f'setpoint {name}[{row}]', float(values[row]), 'finite', 'correct it')
    return times, positions


def _interpolated(times: Numbers, positions: Numbers, wanted: Numbers) -> Numbers:
    for row in np.flatnonzero(np.diff(times) <= 0.0)[:1].tolist():
        raise InputError(f'setpoint times[{row + 1}]', float(times[row + 1]), f'after the one before it, '
                         f'{float(times[row])!r} s', 'sort the rows by time, and leave out what is there twice')
    begin, end = float(times[0]), float(times[-1])
    if begin > 0.0 or end < wanted[-1]:
        raise InputError('setpoint', f'{begin:g} to {end:g} s', f'from 0 to the end of the run, {wanted[-1]:g} s',
                         'let it hold to the end, or make the run shorter')
    return np.interp(wanted, times, positions)


def _table(path: Path) -> CsvTable:
    return CsvTable('setpoint', path, [column_of(path, *names, 'setpoint') for names in _NAMES], MOST_POINTS)


def as_setpoints(columns: Numbers | None, count: int) -> list[Setpoint | None]:
    """Return them one by one, None where there is none."""
    return [None] * count if columns is None else [tuple_of(Setpoint, row) for row in columns.tolist()]
