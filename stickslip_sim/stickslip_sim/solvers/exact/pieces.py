# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many pieces of the inputs, and many samples, without Python in between: `solvers.walk` for this solver alone."""

import math
from dataclasses import dataclass

from ...axis.layout import Parameters
from ...axis.rows import Events, SampleRow, Sinusoids
from ...axis.state_record import State
from ...core.hot_path import compiled
from ...core.input_profile import InputProfile
from .. import DONE, FULL
from .engine import advance, sample, set_inputs, set_load


@dataclass(slots=True, init=False)
class Pieces:
    """The pieces of an input profile; none of them: an input that is not given."""

    count: int
    latest: int       # the one that was asked for last
    period: float     # s
    starts: list[float]
    values: list[float]
    rates: list[float]

    def __init__(self, profile: InputProfile | None) -> None:
        self.count, self.latest, self.period = 0, 0, math.inf
        if profile is not None:
            self.count, self.period = len(profile.starts), profile.period
            self.starts, self.values, self.rates = map(list, (profile.starts, profile.values, profile.rates))


@compiled
def piece_at(of: Pieces, time: float) -> tuple[float, float, float]:
    """Return the value, its rate and until when, as `InputProfile.pieces_at`; quick for times that rise."""
    turns, turn = 0.0, 0.0
    if of.period < math.inf:
        turns = float(math.floor(time / of.period))
        if time >= (turns + 1.0) * of.period:
            turns += 1.0
        elif time < turns * of.period:
            turns -= 1.0
        turn = turns * of.period
    i = of.latest
    if turn + of.starts[i] > time:
        i = 0
    while i + 1 < of.count and turn + of.starts[i + 1] <= time:
        i += 1
    of.latest = i
    end = turn + of.starts[i + 1] if i + 1 < of.count else (turns + 1.0) * of.period
    return of.values[i] + of.rates[i] * (time - (turn + of.starts[i])), of.rates[i], end


@compiled
def enter_pieces(p: Parameters, s: State, drive: Pieces, force: Pieces, load: Pieces, until: float, time: float,
                 sinusoids: Sinusoids, events: Events, row: int) -> tuple[float, int, int]:
    """Enter the pieces that begin up to a time; return until when they hold, the rows in use and how it ended."""
    while until <= time:
        whole = float(math.floor(until))
        row, ended = advance(p, s, whole, until - whole, events, row)
        if ended == DONE and row >= events.count:
            ended = FULL
        if ended != DONE:
            return until, row, ended
        v, v_rate, v_end = piece_at(drive, until)
        f, f_rate, f_end = piece_at(force, until)
        normal, n_rate, n_end = p.normal_force, 0.0, math.inf
        if load.count > 0:
            normal, n_rate, n_end = piece_at(load, until)
        if normal == p.normal_force and n_rate == 0.0 and p.normal_rate == 0.0:
            row = set_inputs(p, s, whole, until - whole, v, v_rate, f, f_rate, sinusoids, events, row)
        else:
            row = set_load(p, s, whole, until - whole, normal, n_rate, v, v_rate, f, f_rate, sinusoids, events, row)
        until = min(v_end, f_end, n_end)
    return until, row, DONE


@compiled
def take_samples(p: Parameters, s: State, drive: Pieces, force: Pieces, load: Pieces, until: float,
                 seconds: list[float], fractions: list[float], first: int, last: int, sinusoids: Sinusoids,
                 events: Events, out: list[SampleRow]) -> tuple[int, float, int, int]:
    """Take many samples, through the pieces of the inputs; return what `walk.sample_pieces` does."""
    row, ended, k = 0, DONE, first
    while k < last:
        until, row, ended = enter_pieces(p, s, drive, force, load, until, seconds[k] + fractions[k], sinusoids, events,
                                         row)
        if ended == DONE:
            row, ended = advance(p, s, seconds[k], fractions[k], events, row)
        if ended != DONE:
            break
        sample(p, s, seconds[k], fractions[k], out[k])
        k += 1
    return k, until, row, ended
