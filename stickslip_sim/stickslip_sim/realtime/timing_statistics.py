# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Timing statistics: how each step kept its time, summed up once a second, and the worst of the run with its time."""

import math
from collections import deque
from typing import NamedTuple

import numpy as np

_NS = 1e-9
_LEVELS = (50.0, 99.0, 99.9, 100.0)


class Quantiles(NamedTuple):
    """Median, 99 %, 99.9 % and maximum, s; NaN of nothing."""

    p50: float = math.nan
    p99: float = math.nan
    p999: float = math.nan
    max: float = math.nan


class TimingWindow(NamedTuple):
    """One window: how many steps, and the quantiles of what they took."""

    steps: int
    cost: Quantiles        # begin to end of a step, publishing included
    lateness: Quantiles    # due to begin
    age: Quantiles         # of the newest command in force
    latency: Quantiles     # arrival of a command to the first published state that it moved


class Worst(NamedTuple):
    """The worst case of a run, s, and the simulation time at which it happened, s; NaN of nothing."""

    value: float = math.nan
    time: float = math.nan


class TimingStatistics:
    """Takes an entry a step; another thread looks at it."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Begin anew."""
        self._rows: deque[tuple[int, int, int | None, int | None]] = deque()
        self._worst: dict[str, tuple[int, int]] = {}

    def add(self, time: int, cost: int, lateness: int, age: int | None, latency: int | None) -> None:
        """Add a step that ends at a simulation time, all in ns; None without a command in force, or a new one."""
        self._rows.append((cost, lateness, age, latency))
        for name, value in (('cost', cost), ('lateness', lateness), ('latency', latency)):
            if value is not None and (name not in self._worst or value > self._worst[name][0]):
                self._worst[name] = value, time

    def take(self) -> TimingWindow:
        """Begin a new window; return the one until now."""
        rows = [self._rows.popleft() for _ in range(len(self._rows))]    # none is lost to a step that ends meanwhile
        columns = ([row[i] for row in rows] for i in range(4))
        return TimingWindow(len(rows), *map(quantiles, columns))

    def worst(self, name: str) -> Worst:
        """Return the worst cost, lateness or latency of the run."""
        if name not in self._worst:
            return Worst()
        value, time = self._worst[name]
        return Worst(value * _NS, time * _NS)


def quantiles(nanoseconds: list[int | None]) -> Quantiles:
    """Return the quantiles of the durations that there are."""
    there = [value for value in nanoseconds if value is not None]
    if not there:
        return Quantiles()
    return Quantiles(*(np.percentile(there, _LEVELS) * _NS).tolist())
