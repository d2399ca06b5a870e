# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X1: a slow sine on the drive whose force peak just passes the static limit, or just does not."""

import random

from ..core.types import EventKind
from ..solvers import Solver
from .grazing_drive import GRAZING_FREQUENCIES, PHASES, grazing_drive
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import CONTACTS, instant, make, paper_axis

_OVERSHOOTS = (1e-4, 1e-6, 1e-12, -1e-12, -1e-6)


def grazing(setup: Setup) -> Measurement:
    """X1: random phases and frequencies, both contacts; a peak above the limit breaks away there, one below never."""
    tally = Tally(0.0)
    for seed in range(setup.count(100_000, 100)):
        tally.measure(_grazes, setup.solver, seed, _OVERSHOOTS[seed % len(_OVERSHOOTS)])
    return tally.finding('missed or invented')


def _grazes(solver: Solver, seed: int, overshoot: float) -> float:
    rng = random.Random(seed)
    axis = paper_axis(rng.choice(CONTACTS))
    phase, frequency = rng.uniform(*PHASES), rng.uniform(*GRAZING_FREQUENCIES)
    drive = grazing_drive(axis, overshoot, frequency, phase)
    period = 1.0 / frequency
    events = make(axis, drive, solver=solver).advance(instant(2.0 * period if overshoot < 0.0 else period))
    if overshoot < 0.0:
        require(not events, f'invented at {events[0].time if events else None!r} s')
        return 0.0
    require(events and events[0].kind == EventKind.BREAKAWAY, 'missed')
    turn = events[0].time * frequency + phase / 6.283185307179586
    require(abs(turn - 0.5) < 0.1, f'a break-away {abs(turn - 0.5):.3g} periods beside the peak')
    return 0.0
