# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Events and samples as CSV: a line of names, then numbers with 17 digits, which give the same floats back."""

import csv
import importlib
import io
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType, ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Columns
from ..core.types import Event, EventKind, Mode
from ..runs.run import LOAD_COLUMN

# Columns of numbers as lines of CSV; 17 digits, which give the same floats back.

_TRUTH = ('False', 'True')
_MOST = 2 ** 63 - 1


def _load() -> ModuleType | None:
    """Return the compiled writer of numbers; None where it was not built."""
    try:
        return None if os.environ.get('STICKSLIP_COMPILED') == '0' else importlib.import_module('stickslip_sim._text')
    except ImportError:
        return None


COMPILED = _load()


def are_numbers(columns: Sequence[NDArray[Any]]) -> bool:
    """Return whether `rows_text` takes these columns: of floats, truth values and integers of 64 bits."""
    return all(column.dtype.kind in 'bfi' or (column.dtype.kind == 'u' and column.max(initial=0) <= _MOST)
               for column in columns)


def rows_text(columns: Sequence[NDArray[Any]], words: Sequence[Sequence[str] | None] = ()) -> str:
    """Return the rows of columns; `words` that stand for the numbers of a column, from 0 on, take their place."""
    words = [_TRUTH if column.dtype.kind == 'b' else given
             for column, given in zip(columns, [*words, *[None] * (len(columns) - len(words))], strict=True)]
    plain = [np.ascontiguousarray(column, np.int64 if of_words or column.dtype.kind in 'iu' else np.float64)
             for column, of_words in zip(columns, words, strict=True)]
    if COMPILED is None:
        return _slowly(plain, words)
    coded = [given if given is None else [word.encode() for word in given] for given in words]
    return str(COMPILED.table([COMPILED.Column(*column) for column in zip(plain, coded, strict=True)]))


def _slowly(columns: Sequence[NDArray[Any]], words: Sequence[Sequence[str] | None]) -> str:
    layout = ','.join('%.17g' if column.dtype.kind == 'f' else '%s' for column in columns) + '\n'
    values = [[of_words[number] for number in column.tolist()] if of_words else column.tolist()
              for column, of_words in zip(columns, words, strict=True)]
    return ''.join(layout % row for row in zip(*values, strict=True))


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
    shown = ({name: block[name] for name in (*SAMPLE_COLUMNS, LOAD_COLUMN) if name in block} for block in blocks)
    return csv_lines(shown, {'mode': [mode.name for mode in Mode]})


def csv_lines(blocks: Iterable[Columns], words: Mapping[str, Sequence[str]] = MappingProxyType({})) -> Iterator[str]:
    """Yield a line of names, then the rows of the blocks; the `words` of a column stand for its numbers, from 0 on."""
    names = ''
    for block in blocks:
        if not names:
            yield (names := ','.join(block) + '\n')
        for part in parts([*block.values()]):
            yield rows_text(part, [words.get(name) for name in block]) if are_numbers(part) else _text(part)


def parts(columns: Sequence[NDArray[Any]]) -> Iterator[list[NDArray[Any]]]:
    """Yield columns in parts of some thousand rows."""
    for begin in range(0, len(columns[0]), _BLOCK):
        yield [column[begin:begin + _BLOCK] for column in columns]


def _text(columns: list[NDArray[Any]]) -> str:
    """Return the rows of columns with texts in them, in quotation marks where they need some."""
    text = io.StringIO()
    csv.writer(text, lineterminator='\n').writerows(zip(*map(_cells, columns), strict=True))
    return text.getvalue()


def _cells(column: NDArray[Any]) -> list[object]:
    values: list[object] = column.tolist()
    return [f'{value:.17g}' for value in values] if column.dtype.kind == 'f' else values
