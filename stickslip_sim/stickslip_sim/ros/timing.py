"""How the steps kept their time: collected by the loop, summed up once a second by somebody else."""

import math
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


class Window:
    """Cost, lateness and command age of each step since the last look, ns."""

    def __init__(self) -> None:
        self._rows: list[tuple[int, int, int | None]] = []

    def add(self, cost: int, lateness: int, age: int | None) -> None:
        """Add a step; `age` is None without a command."""
        self._rows.append((cost, lateness, age))

    def take(self) -> tuple[int, Quantiles, Quantiles, Quantiles]:
        """Begin anew; return the number of steps and the quantiles of cost, lateness and command age until now."""
        rows, self._rows = self._rows, []
        ages = [age for _, _, age in rows if age is not None]
        return (len(rows), quantiles([row[0] for row in rows]), quantiles([row[1] for row in rows]), quantiles(ages))


def quantiles(nanoseconds: list[int]) -> Quantiles:
    """Return the quantiles of durations."""
    if not nanoseconds:
        return Quantiles()
    return Quantiles(*(np.percentile(nanoseconds, _LEVELS) * _NS).tolist())
