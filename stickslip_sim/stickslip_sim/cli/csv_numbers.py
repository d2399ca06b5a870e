# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Columns of numbers as lines of CSV; 17 digits, which give the same floats back."""

import importlib
import os
from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
