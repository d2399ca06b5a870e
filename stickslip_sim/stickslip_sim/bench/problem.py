# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What contestants agree on: the problem (an axis, its inputs, a duration), the result, and what a contestant is."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..axis import Axis, InitialState, pack
from ..core.arrays import Numbers
from ..core.input_profile import InputProfile

_EVENT_COLUMNS = 5   # time s, kind, direction of the slip, position m, velocity m/s


def _as_it_is(table: Any) -> Any:
    return table


@dataclass(frozen=True)
class Outcome:
    """The result of a run: a table of events that `read` understands, and the position at the end, m.

    Reading is not part of the run that is timed, and must be done before the next one.
    """

    table: Any
    position: float
    read: Callable[[Any], Numbers] = _as_it_is

    @property
    def events(self) -> Numbers:
        """Rows of EVENT_COLUMNS in the order of time."""
        return self.read(self.table)


@dataclass(frozen=True)
class Problem:
    """An axis with its inputs, and a duration (s)."""

    name: str
    summary: str
    axis: Axis
    initial: InitialState
    drive: InputProfile   # m/s
    force: InputProfile   # N
    duration: float

    @cached_property
    def parameters(self) -> Numbers:
        """The axis as the array of `axis.layout`."""
        return np.array(pack(self.axis))

    @cached_property
    def start(self) -> Numbers:
        """Position, velocity, rest time."""
        return np.array([self.initial.position, self.initial.velocity, self.initial.rest_time])

    @cached_property
    def pieces(self) -> Numbers:
        """One row for each stretch on which both inputs are linear: start, v, its rate, F_e, its rate; no sinusoids."""
        rows, time = [], 0.0
        while time < self.duration:
            v, f = self.drive.piece_at(time), self.force.piece_at(time)
            rows.append((time, v.value + v.rate * (time - v.start), v.rate, f.value + f.rate * (time - f.start),
                         f.rate))
            time = min(v.end, f.end)
        return np.array(rows)

    @cached_property
    def sinusoids(self) -> Numbers:
        """Four numbers for each sinusoid that is not 0, see `solvers.Solver`: frequency Hz, phase in turns, m/s, N."""
        rows: list[tuple[float, ...]] = [(w.frequency, 0.5 * w.phase / np.pi, w.amplitude, 0.0)
                                         for w in self.drive.sinusoids]
        rows += [(w.frequency, 0.5 * w.phase / np.pi, 0.0, w.amplitude) for w in self.force.sinusoids]
        return np.array([row for row in rows if row[2] != 0.0 or row[3] != 0.0]).reshape(-1)

    @cached_property
    def longest_step(self) -> float:
        """A quarter of the shortest period, s, so that no adaptive step jumps over one."""
        return min((0.25 / frequency for frequency in self.sinusoids[::4]), default=np.inf)

    def event_rows(self) -> Any:
        """Return an empty table that holds far more events than a sound solver finds."""
        return np.zeros((int(1000 + 300 * self.duration), _EVENT_COLUMNS))


class Setting(NamedTuple):
    """A tolerance or a step (s): `value`, and its word."""

    value: float
    unit: str

    @property
    def label(self) -> str:
        """The setting for people."""
        if self.unit == 'step':
            return f'step {self.value * 1e3:g} ms'
        return f'{self.value:.0e}'.replace('e-0', 'e-') if self.value else ''


NO_SETTING = Setting(0.0, '')


def tolerances(*values: float) -> tuple[Setting, ...]:
    """Return settings that are relative and absolute tolerances."""
    return tuple(Setting(value, 'tolerance') for value in values)


def time_steps(*values: float) -> tuple[Setting, ...]:
    """Return settings that are steps in s."""
    return tuple(Setting(value, 'step') for value in values)


class Peer(NamedTuple):
    """A contestant.

    `prepare` does what a user does once (packing, compiling) and returns the run that is timed; that may raise
    SolverError.  `missing` says which package to install, or None; `version` is only asked when nothing is missing.
    """

    name: str
    settings: tuple[Setting, ...]
    missing: str | None
    version: Callable[[], str]
    prepare: Callable[[Problem, Setting], Callable[[], Outcome]]
