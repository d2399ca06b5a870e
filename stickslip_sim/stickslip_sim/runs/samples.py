# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The samples of a simulated run: held in memory, or made again whenever they are asked for."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Columns
from ..core.errors import InputError

MOST_IN_MEMORY = 10_000_000   # 1.2 GB
MOST_HELD = 200_000           # that a run holds (25 MB); more are made or read again when they are asked for
GATHERED = 16_384   # rows at a time


class HeldSamples:
    """Samples in memory."""

    def __init__(self, columns: Columns) -> None:
        self.columns = columns

    def blocks(self) -> Iterator[Columns]:
        """Yield them as one block."""
        yield self.columns


class RemadeSamples:
    """Samples that `make` yields block by block, each time that they are asked for: more than should be held."""

    def __init__(self, make: Callable[[], Iterator[Columns]], count: int) -> None:
        self.blocks, self._count = make, count

    @cached_property
    def columns(self) -> Columns:
        """All of them, in memory from now on; raises InputError on more than should be there."""
        if self._count > MOST_IN_MEMORY:
            raise InputError('samples', self._count, f'at most {MOST_IN_MEMORY} to be in memory at once',
                             'take sample_blocks(), sample less often or simulate a shorter time')
        return joined(self.blocks())


Samples = HeldSamples | RemadeSamples


def gathered(blocks: Iterable[Columns]) -> Iterator[Columns]:
    """Yield columns that come in small blocks, some of them empty, in larger ones."""
    held: list[Columns] = []
    count = 0
    for block in blocks:
        if rows := len(next(iter(block.values()))):
            held.append(block)
            count += rows
        if count >= GATHERED:
            yield joined(held)
            held, count = [], 0
    if held:
        yield joined(held)


def joined(blocks: Iterable[Columns]) -> Columns:
    """Return the columns of blocks, at least one, as columns."""
    held = list(blocks)
    if len(held) == 1:
        return held[0]
    return {name: np.concatenate([block[name] for block in held]) for name in held[0]}


# As many samples of a run as a picture of some windows can show, in memory that does not grow with the run.

_ROW = 'row'     # the number of a row
PARTS = 4000     # of a window with more rows than are held, each with its least and largest values


class ReducedWindow:
    """The rows of a window (s), with one more on either side; of the named columns those that there are.

    Of more than MOST_HELD those remain in which one of the columns, or the error of the position, has its least or its
    largest value in one of the equal `parts` of the window; with `is_whole_first` they remain after the first of them.
    """

    def __init__(self, begin: float, end: float, names: Sequence[str], is_whole_first: bool = False,
                 parts: int = PARTS) -> None:
        self.begin, self.end = begin, end
        self._names = 'time', *(name for name in names if name != 'time')
        self._whole: list[Columns] = []
        self._done: list[Columns] = []       # behind them: reduced, up to the part under way
        self._open: Columns | None = None    # of which this remains
        self._count = 0
        self._is_whole_first, self._parts = is_whole_first, parts
        self._neighbour: Columns | None = None   # the latest row before the window
        self.is_over = False                 # the row behind the window was taken

    @property
    def is_empty(self) -> bool:
        """Whether no row was taken."""
        return not self._count

    @property
    def columns(self) -> Columns:
        """What remains of the rows that were taken, at least one."""
        return joined([*self._whole, *self._done, *([self._open] if self._open else [])])

    def take(self, block: Columns) -> None:
        """Take the next rows of the run."""
        first, last = np.searchsorted(block['time'], self.begin), np.searchsorted(block['time'], self.end, 'right')
        if self.is_over or not len(block['time']):
            return
        if first == len(block['time']):
            self._neighbour = self._rows(block, slice(-1, None))
            return
        if self._neighbour and first == 0:
            self._add(self._neighbour)
        self._neighbour = None
        self.is_over = bool(last < len(block['time']))
        self._add(self._rows(block, slice(max(int(first) - 1, 0), int(last) + 1)))

    def _add(self, rows: Columns) -> None:
        self._count += len(rows['time'])
        if self._count <= MOST_HELD:
            self._whole.append(rows)
            return
        if self._whole and not self._is_whole_first:
            rows = joined([*self._whole, rows])
            self._whole = []
        if self._open:
            rows = joined([self._open, rows])
        parts = np.floor((rows['time'] - self.begin) * (self._parts / (self.end - self.begin)))
        rows = self._rows(rows, _extreme_rows(rows, parts))
        under_way = int(np.searchsorted(rows['time'], self.begin + parts[-1] * (self.end - self.begin) / self._parts))
        self._done.append(self._rows(rows, slice(under_way)))
        self._open = self._rows(rows, slice(under_way, None))

    def _rows(self, columns: Columns, rows: slice | NDArray[np.intp]) -> Columns:
        """Return rows by themselves, so that the block they are from is not held."""
        return {name: columns[name][rows].copy() for name in self._names if name in columns}


class ReducedWindows:
    """The rows of several windows (s) of a run, each row once."""

    def __init__(self, windows: Iterable[tuple[float, float]], names: Sequence[str],
                 parts: int = PARTS) -> None:
        self._windows = [ReducedWindow(*window, (*names, _ROW), parts=parts) for window in windows]
        self._nothing: Columns = {}
        self._count = 0

    def take(self, block: Columns) -> None:
        """Take the next rows of the run."""
        rows = len(block['time'])
        numbered = {**block, _ROW: np.arange(self._count, self._count + rows, dtype=np.float64)}
        self._count += rows
        for window in self._windows:
            window.take(numbered)
        self._nothing = self._nothing or {name: column[:0] for name, column in numbered.items()}

    @property
    def columns(self) -> Columns:
        """What remains of the rows that were taken, in the order of time."""
        columns = joined([window.columns for window in self._windows if not window.is_empty] or [self._nothing])
        _, rows = np.unique(columns[_ROW], return_index=True)   # some are in two windows
        return {name: column[rows] for name, column in columns.items() if name != _ROW}


def reduced(blocks: Iterable[Columns], windows: Iterable[tuple[float, float]], names: Sequence[str],
            parts: int = PARTS) -> Columns:
    """Return rows of columns of a run, which come in at least one block, for a picture of windows of it."""
    taken = ReducedWindows(windows, names, parts)
    for block in blocks:
        taken.take(block)
    return taken.columns


def _extreme_rows(columns: Columns, parts: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the first row, the last, and those where a column is least or largest in its part."""
    starts = np.flatnonzero(np.diff(parts, prepend=-np.inf) != 0.0)
    own = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(parts))))
    kept = np.zeros(len(parts), dtype=np.bool_)
    kept[[0, -1]] = True
    quantities = [column for name, column in columns.items() if name != 'time']
    if {'drive_position', 'position'} <= set(columns):
        quantities.append(columns['drive_position'] - columns['position'])
    for values in quantities:
        for least_or_largest in (np.fmin, np.fmax):
            hits = np.flatnonzero(values == least_or_largest.reduceat(values, starts)[own])
            first = np.searchsorted(hits, starts)
            kept[hits[first[first < len(hits)]]] = True
    return np.flatnonzero(kept)
