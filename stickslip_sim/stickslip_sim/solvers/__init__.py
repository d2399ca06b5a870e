# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Solvers: each brings a state to a time and writes the events on the way; all behind the same functions."""

from collections.abc import Callable
from typing import Any, NamedTuple

# how `advance` ended: at its time, with a full event table, stuck, before a state beyond the range of numbers, or at an
# event that contradicts the motion or its energy
DONE, FULL, NO_PROGRESS, OUT_OF_RANGE, UNSOUND = 0, 1, 2, 3, 4


class Solver(NamedTuple):
    """The functions of a solver.  `p` parameters and `s` state are flat arrays, see `axis.layout`.

    `waves` is a flat array of four numbers a wave: frequency in Hz, phase in turns, amplitude of the drive velocity in
    m/s and of the external force in N.  Functions with `events, row` write rows into the table and return the rows in
    use.  `advice` says what to try when the solver gives up.

    | function       | arguments                                                                              |
    |----------------|----------------------------------------------------------------------------------------|
    | start          | p, s, position, velocity, rest, v, v_rate, f, f_rate, waves, events, row               |
    | advance        | p, s, second, fraction, events, row; returns (rows, how it ended)                      |
    | set_inputs     | p, s, second, fraction, v, v_rate, f, f_rate, waves, events, row                       |
    | set_parameters | p, new p, s, second, fraction, events, row                                             |
    | sample         | p, s, second, fraction, out                                                            |
    | energy         | p, s, second, fraction, out; a row of `energy.EnergyBalance`                           |
    | is_sound       | p, s, second, fraction; whether the state contradicts neither its mode nor its energy  |

    A solver with `energy` and `is_sound` keeps the account, and judges its run by it, while s[ACCOUNTING], which
    `start` leaves as it is, is not 0.
    """

    name: str
    start: Callable[..., Any]
    advance: Callable[..., Any]
    set_inputs: Callable[..., Any]
    set_parameters: Callable[..., Any]
    sample: Callable[..., Any]
    energy: Callable[..., Any] | None = None
    is_sound: Callable[..., Any] | None = None
    advice: str = 'a parameter or an input is too extreme for this axis: check the scene'
