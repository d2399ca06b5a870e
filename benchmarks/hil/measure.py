# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One run of a node beside its controller, in figures: from the controller, from the bag, from the node itself."""

import json
import statistics
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from stickslip_sim.recording import open_bag

from .process import COMMANDS, control, running

ANSWERS = 1000    # per second at most: what a servo drive takes
COUNTS = ('unheard', 'unrecorded', 'dropped')


def measure(case: str, rate: float, seconds: float, priority: int = 0) -> dict[str, float]:
    """Return the figures of a run of a case of COMMANDS; durations in s, `priority` of SCHED_FIFO, 0: none."""
    with tempfile.TemporaryDirectory() as parent:
        folder = Path(parent, 'run')
        with running(COMMANDS[case](rate, folder, priority)) as process:
            figures = control(process.pid, seconds, max(round(rate / ANSWERS), 1))
        out = process.stdout.read() if process.stdout else ''
        of_node = json.loads(out) if out else node_figures(folder)
        return {**figures, **of_node, **(bag_figures(folder) if folder.exists() else {})}


def node_figures(folder: Path) -> dict[str, float]:
    """Return what the node published on `timing`, without the second of its start and the one that was cut short.

    Of the quantiles the median over the seconds; `overruns` is their share of the steps.
    """
    run = open_bag(folder)
    table = {name: column[1:-1] for name, column in run.columns('/timing').items()}
    figures = {name: float(np.nanmedian(table[name])) for name in table if name.endswith(('_p50', '_p99'))}
    return {**figures, 'dropped': float(run.receipt['dropped_messages']),
            'lateness_max': float(table['lateness_max'].max()),
            'overruns': float(table['overruns'].sum() / table['steps'].sum())}


def bag_figures(folder: Path) -> dict[str, float]:
    """Return how many steps of the run are not in its bag."""
    steps = open_bag(folder).columns('/slider_state')['step']
    return {'unrecorded': int(steps[-1]) + 1 - len(np.unique(steps))}


def summary(runs: list[dict[str, float]]) -> dict[str, float]:
    """Return the figures of several runs as one: sums of counts, the worst of maxima, else medians."""
    return {name: _combine(name)([run[name] for run in runs]) for name in runs[0]}


def _combine(name: str) -> Callable[[list[float]], float]:
    if name in COUNTS:
        return sum
    return max if name.endswith('_max') else statistics.median
