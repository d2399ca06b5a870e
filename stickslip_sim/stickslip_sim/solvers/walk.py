# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many pieces of the inputs, and many samples, in one call."""

import math
from functools import partial

from ..axis.layout import Parameters
from ..axis.rows import Events, Sinusoids
from ..axis.state_record import State
from ..core.arrays import Numbers
from ..core.input_profile import InputProfile
from . import DONE, FULL, PieceWalk, Solver


def walk_of(solver: Solver, normal_force: InputProfile | None = None) -> PieceWalk:
    """Return the way of a solver through the pieces: its own, or one piece after the other; through those of N, too."""
    way = solver.walk or PieceWalk(lambda profile: profile, partial(walk, solver), partial(sample_pieces, solver))
    if normal_force is None:
        return way
    pieces = way.pieces_of(normal_force)
    return way._replace(run=partial(way.run, normal_force=pieces), sample=partial(way.sample, normal_force=pieces))


def walk(solver: Solver, p: Parameters, s: State, drive: InputProfile, force: InputProfile, until: float, time: float,
         sinusoids: Sinusoids, events: Events, row: int, /, normal_force: InputProfile | None = None
         ) -> tuple[float, int, int]:
    """Bring a state to `until`, s, where its pieces end, enter the next ones, and so on while that is up to a time.

    `normal_force` (N) is given where it varies.

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
        inputs = v, v_rate, f, f_rate, sinusoids, events, row
        normal, n_rate, n_end = p.normal_force, 0.0, math.inf
        if normal_force is not None:
            normal, n_rate, n_end = normal_force.pieces_at(until)
        if normal == p.normal_force and n_rate == p.normal_rate == 0.0:
            row = solver.set_inputs(p, s, second, until - second, *inputs)
        else:
            row = solver.set_load(p, s, second, until - second, normal, n_rate, *inputs)
        until = min(v_end, f_end, n_end)
    return until, row, DONE


def sample_pieces(solver: Solver, p: Parameters, s: State, drive: InputProfile, force: InputProfile, until: float,
                  seconds: Numbers, fractions: Numbers, first: int, last: int, sinusoids: Sinusoids, events: Events,
                  out: Numbers, /, normal_force: InputProfile | None = None) -> tuple[int, float, int, int]:
    """Bring a state to the times from `first` on and before `last`, and fill the row of each with its sample.

    The pieces that begin up to each are entered before, as `walk` does.  Returns the first time that was not reached,
    until when the pieces hold that are in force then, the rows of events in use and how it ended.
    """
    sample = solver.records.SampleRow()
    row = 0
    for k in range(first, last):
        second, fraction = float(seconds[k]), float(fractions[k])
        until, row, end = walk(solver, p, s, drive, force, until, second + fraction, sinusoids, events, row,
                               normal_force=normal_force)
        if end == DONE:
            row, end = solver.advance(p, s, second, fraction, events, row)
        if end != DONE:
            return k, until, row, end
        solver.sample(p, s, second, fraction, sample)
        out[k] = sample.tolist()
    return last, until, row, DONE
