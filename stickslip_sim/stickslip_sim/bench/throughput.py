# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many different axes at once: how many axis-seconds a second, beside the same axes one by one through scipy."""

import os
import statistics
import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ..axis import Axis
from ..core.input_profile import constant
from ..runs.batch import run_batch
from .cases import make_case
from .measure import cost_sample
from .peers import scipy_ivp
from .peers.peer import Setting
from .problem import Problem
from .ratios import Ratio, at_least

AXES, DURATION = 10_000, 10.0   # s
_FEED = 0.001                    # m/s, of A and B
CORES = 2
_MARK, _AIM = 1e6, 4e6          # axis-seconds a second
_SEED, _ROUNDS, _FEW = 20261121, 5, 6


def drawn(axis: Axis, count: int, seed: int = _SEED) -> dict[str, Any]:
    """Return masses, stiffnesses and feeds drawn at random, each within a factor of 2 of the axis and 1 mm/s."""
    random = np.random.default_rng(seed)
    return {name: middle * 2.0 ** random.uniform(-1.0, 1.0, count) for name, middle in (
        ('mass', axis.mass), ('drive_stiffness', axis.drive_stiffness), ('drive_velocity', _FEED))}


def batch_ratios() -> Iterator[Ratio]:
    """Yield the throughput of a batch of variants of A and of B; scipy runs the first few of the same axes."""
    cores = min(CORES, os.cpu_count() or 1)
    for name in 'AB':
        axis = make_case(name).axis
        grid = drawn(axis, AXES)
        run_batch(axis, DURATION, threads=cores, **grid)
        rate = AXES * DURATION / statistics.median(_wall(axis, grid, cores) for _ in range(_ROUNDS))
        yield at_least(f'axis-seconds a second, batch of {AXES} on {cores} cores', name, rate, _MARK, _AIM)
        if scipy_ivp.SCIPY_PEERS[0].missing is None:
            rate = cores * _FEW * DURATION / sum(_by_scipy(axis, grid, k) for k in range(_FEW))
            yield Ratio(f'the same by scipy DOP853, 1e-12, extrapolated from {_FEW} axes on one core', name, rate)


def _wall(axis: Axis, grid: dict[str, Any], cores: int) -> float:
    begin = time.monotonic()
    run_batch(axis, DURATION, threads=cores, **grid)
    return time.monotonic() - begin


def _by_scipy(axis: Axis, grid: dict[str, Any], index: int) -> float:
    """Return the cost of one axis of the grid by scipy, s of processor time."""
    mass, stiffness, feed = (float(grid[name][index]) for name in ('mass', 'drive_stiffness', 'drive_velocity'))
    case = make_case('A')
    problem = Problem('one of many', '', replace(axis, mass=mass, drive_stiffness=stiffness), case.initial,
                      constant(feed), constant(0.0), DURATION)
    run = scipy_ivp.SCIPY_PEERS[0].prepare(problem, Setting(1e-12, 'tolerance'))
    if index == 0:
        run()
    return cost_sample(run)
