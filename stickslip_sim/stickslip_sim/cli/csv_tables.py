# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Events and samples as CSV: a line of names, then numbers with 17 digits, which give the same floats back."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from numpy.typing import NDArray

from ..core.types import Event, EventKind, Mode
from ..runs import Columns
from ..runs.normal_force import LOAD_COLUMN
from .csv_numbers import rows_text

_EVENT_COLUMNS = ('time', 'kind', 'direction', 'position', 'velocity', 'drive_force', 'friction_force',
                 'static_coefficient', 'rest_time')
SAMPLE_COLUMNS = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_force', 'friction_force',
                  'mode')
_BLOCK = 10_000   # rows


def event_lines(events: Iterable[Event], knots: bool = False) -> Iterator[str]:
    """Yield the lines of an event table; `knots` lists those of kind `knot` too."""
    yield ','.join(_EVENT_COLUMNS) + '\n'
    for event in events:
        if knots or event.kind != EventKind.KNOT:
            numbers = (getattr(event, name) for name in _EVENT_COLUMNS[3:])
            yield f'{event.time:.17g},{event.kind.name.lower()},{event.direction:d},' \
                + ','.join(f'{number:.17g}' for number in numbers) + '\n'


def sample_lines(blocks: Iterable[Columns]) -> Iterator[str]:
    """Yield the text of a table of samples, which come block by block; a normal force that varies comes last."""
    names: tuple[str, ...] = ()
    for block in blocks:
        if not names:
            names = (*SAMPLE_COLUMNS, *((LOAD_COLUMN,) if LOAD_COLUMN in block else ()))
            yield ','.join(names) + '\n'
        words = [[mode.name for mode in Mode] if name == 'mode' else None for name in names]
        yield from (rows_text(part, words) for part in parts([block[name] for name in names]))


def parts(columns: Sequence[NDArray[Any]]) -> Iterator[list[NDArray[Any]]]:
    """Yield columns in parts of some thousand rows."""
    for begin in range(0, len(columns[0]), _BLOCK):
        yield [column[begin:begin + _BLOCK] for column in columns]
