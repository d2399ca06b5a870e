# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The command channel of drive velocities: it loses or delays them when a fault says so."""

from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any

from ..core.time_grid import Grid
from .faults import Fault
from .random_stream import Stream, restore, state_of, stream


class CommandChannel:
    """Takes commands in and lets them out, before the same step without a fault."""

    def __init__(self, grid: Grid, seed: int) -> None:
        self._grid = grid
        self._stream = stream(seed, Stream.LOSS)
        self.under_way: deque[tuple[int, float]] = deque()    # step of arrival, velocity

    def put(self, velocity: float, step: int, faults: Mapping[str, Fault]) -> bool:
        """Send a command before a step; return whether it gets through.  Those that it overtakes never arrive."""
        arrival, kept = step, 1.0
        for fault in faults.values():
            if fault.kind == 'command_delay':
                arrival += self._grid.steps(fault.value)
            elif fault.kind == 'command_loss':
                kept *= 1.0 - fault.value
        if kept < 1.0 and self._stream.random_sample() >= kept:
            return False
        while self.under_way and self.under_way[-1][0] >= arrival:
            self.under_way.pop()
        self.under_way.append((arrival, velocity))
        return True

    def checkpoint(self) -> list[Any]:
        """Return what is under way and the random numbers to come, as plain data."""
        return [[list(command) for command in self.under_way], state_of(self._stream)]

    def restore(self, saved: Sequence[Any]) -> None:
        """Go on from a checkpoint."""
        under_way, stream = saved
        self.under_way = deque((int(step), float(velocity)) for step, velocity in under_way)
        restore(self._stream, stream)

    def take(self, step: int) -> float | None:
        """Return the latest command that has arrived before a step, None without a new one."""
        arrived = None
        while self.under_way and self.under_way[0][0] <= step:
            arrived = self.under_way.popleft()[1]
        return arrived
