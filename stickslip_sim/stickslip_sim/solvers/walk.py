# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many pieces of the inputs in one call."""

import math
from functools import partial

from ..axis.layout import Parameters, State
from ..axis.rows import Events, Sinusoids
from ..core.input_profile import InputProfile
from . import DONE, FULL, PieceWalk, Solver


def walk_of(solver: Solver) -> PieceWalk:
    """Return the way of a solver through the pieces: its own, or one piece after the other."""
    return solver.walk or PieceWalk(lambda profile: profile, partial(walk, solver))


def walk(solver: Solver, p: Parameters, s: State, drive: InputProfile, force: InputProfile, until: float, time: float,
         sinusoids: Sinusoids, events: Events, row: int, /) -> tuple[float, int, int]:
    """Bring a state to `until`, s, where its pieces end, enter the next ones, and so on while that is up to a time.

    Returns until when the pieces hold that are in force then, the rows in use and how it ended: FULL also where there
    is no room for the event that a new piece may be.
    """
    while until <= time:
        second = float(math.floor(until))
        row, end = solver.advance(p, s, second, until - second, events, row)
        if end == DONE and row >= events.count:
            end = FULL
        if end != DONE:
            return until, row, end
        v, v_rate, v_end = drive.pieces_at(until)
        f, f_rate, f_end = force.pieces_at(until)
        row = solver.set_inputs(p, s, second, until - second, v, v_rate, f, f_rate, sinusoids, events, row)
        until = min(v_end, f_end)
    return until, row, DONE
