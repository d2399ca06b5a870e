# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The samples of a simulated run: held in memory, or made again whenever they are asked for."""

from collections.abc import Callable, Iterable, Iterator
from functools import cached_property
from typing import Protocol

import numpy as np

from ..core.errors import InputError
from .run import Columns

MOST_IN_MEMORY = 10_000_000   # 1.2 GB
MOST_HELD = 200_000           # that a run holds (25 MB); more are made or read again when they are asked for
GATHERED = 16_384   # rows at a time


class Samples(Protocol):
    """Samples in the order of time."""

    @property
    def columns(self) -> Columns:
        """All of them, as columns by name."""

    def blocks(self) -> Iterator[Columns]:
        """Yield them block by block."""


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
