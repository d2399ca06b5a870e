# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Cost: medians of interleaved runs in this process, in seconds of processor time."""

import statistics
import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

SHORTEST = 2e-3   # s: shorter runs are repeated until a sample takes as long
ENOUGH = 2.5      # s: when the samples of a run have taken that long together, no more are taken


class Cost(NamedTuple):
    """Of one run: median and quartiles over `samples`, s."""

    median: float
    low: float
    high: float
    samples: int


def measure(runs: Sequence[Callable[[], object]], rounds: int) -> list[Cost]:
    """Return the cost of each run; in each round each has its turn, so that none has the quiet minutes to itself.

    The runs must have run once already.
    """
    repeats = [_repeats(run) for run in runs]
    samples: list[list[float]] = [[] for _ in runs]
    for _ in range(rounds):
        for run, count, costs in zip(runs, repeats, samples):
            if sum(costs) < ENOUGH:
                costs.append(cost_sample(run, count))
    return [_cost(costs) for costs in samples]


def cost_sample(run: Callable[[], object], count: int = 1) -> float:
    """Return the cost of a run, the mean of `count` in a row."""
    begin = time.process_time()
    for _ in range(count):
        run()
    return (time.process_time() - begin) / count


def _repeats(run: Callable[[], object]) -> int:
    return max(1, round(SHORTEST / max(cost_sample(run), 1e-7)))


def _cost(samples: Sequence[float]) -> Cost:
    if len(samples) == 1:
        return Cost(samples[0], samples[0], samples[0], 1)
    low, median, high = statistics.quantiles(samples, n=4, method='inclusive')
    return Cost(median, low, high, len(samples))
