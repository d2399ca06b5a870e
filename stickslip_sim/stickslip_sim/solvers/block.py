# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many samples in one call."""

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..axis.layout import Parameters, State
from ..axis.rows import Events
from . import DONE, Solver

Numbers = NDArray[np.float64]


def sample_block_of(solver: Solver) -> Callable[..., tuple[int, int, int]]:
    """Return what takes many samples: the solver's own way, or one after the other."""
    return solver.sample_block or partial(sample_block, solver)


def sample_block(solver: Solver, p: Parameters, s: State, seconds: Numbers, fractions: Numbers, first: int, last: int,
                 events: Events, out: Numbers, /) -> tuple[int, int, int]:
    """Bring a state to the times from `first` on and before `last`, and fill the row of each with its sample.

    Returns the first time that was not reached, the rows of events in use and how it ended.
    """
    sample = solver.records.SampleRow()
    rows = 0
    for k in range(first, last):
        second, fraction = float(seconds[k]), float(fractions[k])
        rows, end = solver.advance(p, s, second, fraction, events, rows)
        if end != DONE:
            return k, rows, end
        solver.sample(p, s, second, fraction, sample)
        out[k] = sample.tolist()
    return last, rows, DONE
