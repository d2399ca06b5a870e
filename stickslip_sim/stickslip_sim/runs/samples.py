# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The samples of a simulated run: held in memory, or made again whenever they are asked for."""

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Protocol

import numpy as np

from .run import Columns


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

    def __init__(self, make: Callable[[], Iterator[Columns]]) -> None:
        self.blocks = make

    @cached_property
    def columns(self) -> Columns:
        """All of them, in memory from now on."""
        return joined(self.blocks())


def joined(blocks: Iterator[Columns]) -> Columns:
    """Return the columns of blocks, at least one, as columns."""
    held = list(blocks)
    return {name: np.concatenate([block[name] for block in held]) for name in held[0]}
