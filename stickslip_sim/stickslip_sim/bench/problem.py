# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What contestants agree on: the problem (an axis, its inputs, a duration), the result, and what a contestant is."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..axis import Axis, CompliantContact, Friction, InitialState, RigidContact, pack
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.input_profile import InputProfile, constant
from ..friction import KineticTable, StaticLaw, StaticLawKind
from ..friction.kinetic import default_excess
from ..inputs import load_scene
from ..scene import scene_names

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


# The cases of the race: A to D, which span the motions of an axis, and every shipped scene.

LETTERS = ('A', 'B', 'C', 'D')
_DURATION = 60.0          # s, of A, B and C
_CHAOTIC_DURATION = 5.0   # s, of D: errors grow tenfold every 2 s, so that a longer comparison says nothing
_SCENE_DURATION = 10.0    # s
_LONG_SCENES = {'micro_feed': 60.0}   # s: it breaks away for the first time after 15 s
_TICK = 1000.0            # Hz, of the commands of D


def case_names() -> list[str]:
    """Return the names of all cases."""
    return [*LETTERS, *scene_names()]


def make_case(name: str, duration: float | None = None) -> Problem:
    """Return a case, for its own duration or another (s); raises InputError on an unknown name."""
    if name in LETTERS:
        return _letter(name, duration)
    if name not in scene_names():
        raise InputError('--scenes', name, 'one of ' + ', '.join(case_names()), 'see `stickslip scenes`')
    scene = load_scene(name)
    return Problem(name, scene.summary, scene.axis, scene.initial, scene.drive, scene.force,
                   duration or _LONG_SCENES.get(name, _SCENE_DURATION))


def _letter(name: str, duration: float | None) -> Problem:
    """Return A to D: the paper's axis from prolonged rest, with a rest-time constant of 1 s."""
    rigid, compliant = RigidContact(), CompliantContact(5e6, 15000.0)
    duration = duration or (_CHAOTIC_DURATION if name == 'D' else _DURATION)
    if name == 'A':
        return _constant('A', 'rigid contact, 1 mm/s', _axis(rigid), 0.001, duration)
    if name == 'B':
        return _constant('B', 'compliant contact, 1 mm/s', _axis(compliant), 0.001, duration)
    if name == 'C':
        return _constant('C', 'conventional characteristics, rigid, 10 mm/s', _axis(rigid, branches=False), 0.01,
                         duration)
    starts = tuple(k / _TICK for k in range(round(duration * _TICK)))
    drive = InputProfile(starts, tuple(0.005 * (1.0 + 0.5 * math.sin(2.0 * math.pi * 3.0 * t)) for t in starts),
                   (0.0,) * len(starts))
    force = InputProfile(starts, tuple(100.0 * math.sin(2.0 * math.pi * 20.0 * t) for t in starts),
                         (0.0,) * len(starts))
    return Problem('D', 'compliant contact, new feed and force 1000 times a second', _axis(compliant), InitialState(),
                   drive, force, duration)


def _constant(name: str, summary: str, axis: Axis, feed: float, duration: float) -> Problem:
    return Problem(name, summary, axis, InitialState(), constant(feed), constant(0.0), duration)


def _axis(contact: RigidContact | CompliantContact, *, branches: bool = True) -> Axis:
    kinetic = KineticTable((0.0, 0.035), (0.12, 0.05))
    static = StaticLaw(StaticLawKind.EXPONENTIAL, 0.12, 0.24, 1.0)
    return Axis(350.0, 6e5, 4000.0, 3432.3275, contact,
                Friction(static, kinetic, default_excess(kinetic) if branches else None))
