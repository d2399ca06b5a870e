# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One axis under its solver: parameters, state and table of events, brought from time to time; and what ends a run."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..axis import Axis, InitialState, pack
from ..axis.rows import SampleRow
from ..core.errors import SolverError, UnsoundError
from ..core.input_profile import InputProfile
from ..core.time_grid import Instants
from ..core.types import EnergyBalance, Event, EventKind, Instant, Mode, Sample, tuple_of
from ..solvers import DONE, FULL, OUT_OF_RANGE, UNSOUND, Solver
from ..solvers.normal_load import under_load
from ..solvers.walk import walk_of
from .inputs import Inputs

# Numbers of a simulator that were saved, checked before a solver goes on with them.
#
# A solver takes some of its numbers as places in tables and does not look twice.

def numbers_of(saved: Iterable[Any], state: Any) -> list[float]:
    """Return saved numbers for a state of this size; raises TypeError or ValueError."""
    numbers, size = [float(number) for number in saved], len(state.numbers())
    if len(numbers) != size:
        raise ValueError(f'a state of {len(numbers)} numbers where {size} are expected')
    return numbers


def check_state(state: Any, sinusoids: int, parameters: Any) -> None:
    """Raise ValueError when a state is none of an axis with these parameters and so many sinusoids."""
    for name, number, highest in (('mode', state.mode, max(Mode)),
                                  ('segment', state.segment, int(parameters.segment_count) - 1),
                                  ('sinusoids', state.sinusoid_count, sinusoids),
                                  ('sinusoids', state.given_sinusoids, sinusoids)):
        if number not in range(highest + 1):
            raise ValueError(f'{name} = {number!r} is none of this scene')


def event_of(saved: Sequence[Any]) -> Event:
    """Return a saved event; raises TypeError or ValueError."""
    second, fraction, kind, mode, direction, *numbers = saved
    return Event(float(second), float(fraction), EventKind(kind), Mode(mode), int(direction), *map(float, numbers))


SolverOf = Callable[[Axis], Solver]

_KINDS, _MODES = tuple(EventKind), tuple(Mode)
_MOVES = slice(4, 12)            # of a sample; the rest may be infinite
_ROWS = 64                       # of the event table; it is emptied as often as it fills
MAX_EVENTS_AT_ONCE = 100_000
_NO_INPUTS = 0.0, 0.0, 0.0, 0.0
_AT_ONCE = 0.01                  # s, in which so many events are more than any axis has


def sample_of(row: SampleRow) -> Sample:
    """Return the sample with these numbers."""
    second, fraction, mode, direction, *rest = row.tolist()
    return tuple_of(Sample, (second, fraction, _MODES[int(mode)], int(direction), *rest))


def events_in(table: Any, count: int) -> Iterator[Event]:
    """Yield the first events of a table."""
    for i in range(count):
        second, fraction, kind, mode, direction, *rest = table.row(i)
        yield Event(second, fraction, _KINDS[int(kind)], _MODES[int(mode)], int(direction), *rest)


class _Crowd:
    """The events of a call since its time last went on, and the time of the first."""

    def __init__(self, time: Instant) -> None:
        self.since, self.count = time, 0

    def take(self, time: Instant, count: int) -> None:
        """Take events up to a time."""
        if (time.second - self.since.second) + (time.fraction - self.since.fraction) > _AT_ONCE:
            self.since, self.count = time, 0
        self.count += count


class SolvedAxis:
    """An axis, its solver and its state at `time`; all methods raise SolverError where the solver gives up.

    `solver_of` makes the solver for an axis.  A `load` (N) is added to the normal force; raises InputError where the
    solver cannot follow it.  With `accounting` the solver keeps the account of energy, if it can.  Lists of events get
    those that a call brings, in the order of time; None takes none.
    """

    def __init__(self, axis: Axis, solver_of: SolverOf, inputs: Inputs, load: InputProfile | None, accounting: bool
                 ) -> None:
        self._solver_of, self._inputs, self._load = solver_of, inputs, load
        self.time = Instant(0.0, 0.0)
        self._take(axis)
        records = self._solver.records
        self._state = records.State(inputs.most_sinusoids)
        self._state.accounting = float(accounting and self._solver.energy is not None)
        self._row = records.SampleRow()
        self._energies = records.EnergyRow()
        self._table = records.Events(_ROWS)

    def start(self, initial: InitialState) -> list[Event]:
        """Set the state at time 0 under the original inputs; return the events at time 0."""
        v, f = self._inputs.reset()
        self._take_sinusoids()
        self.time = Instant(0.0, 0.0)
        if self._load is not None:
            self._take(self.axis)
        rows = self._solver.start(self._parameters, self._state, initial.position, initial.velocity, initial.rest_time,
                                  initial.stretch, initial.deflection, v.value, v.rate, f.value, f.rate,
                                  self._sinusoids, self._table, 0)
        return list(self._events(rows))

    @property
    def root_iterations(self) -> int:
        """Iterations of all searches for event times so far."""
        return int(self._state.iterations)

    @property
    def energy(self) -> EnergyBalance | None:
        """The energies from the start up to the present time; None without an account."""
        if self._solver.energy is None or not self._state.accounting:
            return None
        self._solver.energy(self._parameters, self._state, *self.time, self._energies)
        return EnergyBalance(*self._energies.tolist())

    def require_sound(self) -> None:
        """Raise UnsoundError when the state contradicts its own mode or balance of energy; needs an account."""
        if self._solver.is_sound is not None and self._state.accounting and not self._solver.is_sound(
                self._parameters, self._state, *self.time):
            raise self._unsound()

    def obey(self, events: list[Event]) -> None:
        """Let the commands of this instant take effect, all at once: their order does not matter."""
        if self._inputs.most_sinusoids:
            self._take_sinusoids()
        self._let(self._inputs.enter(self.time.seconds), events)

    def _let(self, inputs: tuple[float, float, float, float], events: list[Event]) -> None:
        """Let inputs be in force from the present time on."""
        rows = self._solver.set_inputs(self._parameters, self._state, *self.time, *inputs, self._sinusoids,
                                       self._table, 0)
        events.extend(self._events(rows))

    def step(self, to: Instant, events: list[Event]) -> SampleRow:
        """Let the commands of this instant act and bring the state to a time, through pieces of the inputs.

        Returns the record of a sample there, which the next step fills anew.
        """
        inputs, (before, rest), (second, fraction) = self._inputs, self.time, to
        is_commanded, entered = inputs.are_commanded, _NO_INPUTS
        if is_commanded:
            if inputs.most_sinusoids:
                self._take_sinusoids()
            entered = inputs.enter(before + rest)
        if self._step is None or inputs.until <= second + fraction:
            if is_commanded:
                self._let(entered, events)
            if inputs.until <= second + fraction:
                self.enter_pieces(second + fraction, events)
            self.advance(to, events)
            self._fill()
            return self._row
        rows, end = self._step(self._parameters, self._state, before, rest, second, fraction, is_commanded, *entered,
                               self._sinusoids, self._table, self._row)
        if rows:
            events.extend(self._events(rows))
        if end == DONE:
            self.time = to
            return self._row
        if end != OUT_OF_RANGE:    # no number of the sample alone is so large
            crowd = _Crowd(self.time)
            self._check_end(end, rows, crowd)
            self.advance(to, events, crowd)
        self.time = to
        self._fill()
        return self._row

    def change(self, axis: Axis, events: list[Event]) -> None:
        """Go on with other parameters from the present time on."""
        old = self._parameters
        if self._solver.bring is not None:
            self._solver.bring(old, self._state, *self.time)
        self._take(axis)
        rows = self._solver.set_parameters(old, self._parameters, self._state, *self.time, self._table, 0)
        events.extend(self._events(rows))

    def advance(self, to: Instant, events: list[Event] | None, crowd: _Crowd | None = None) -> None:
        """Bring the state to a time under the inputs that were entered; a `crowd` goes on from events before."""
        second, fraction = to
        while True:
            rows, end = self._solver.advance(self._parameters, self._state, second, fraction, self._table, 0)
            if rows and events is not None:
                events.extend(self._events(rows))
            if end == DONE:
                self.time = to
                return
            crowd = crowd or _Crowd(self.time)
            self._check_end(end, rows, crowd)

    def enter_pieces(self, time: float, events: list[Event]) -> None:
        """Go on through the pieces of the inputs that begin up to a time, s."""
        inputs, crowd = self._inputs, _Crowd(self.time)
        drive, force = inputs.pieces(self._walk.pieces_of)
        while inputs.until <= time:
            until, rows, end = self._walk.run(self._parameters, self._state, drive, force, inputs.until, time,
                                              self._sinusoids, self._table, 0)
            events.extend(self._events(rows))
            inputs.go_on(until)
            if end != DONE:
                self._check_end(end, rows, crowd)

    def take_samples(self, at: Instants, out: NDArray[np.float64], events: list[Event] | None) -> None:
        """Bring the state to one time after the other, through the pieces of the inputs; fill a row at each."""
        inputs, reached, crowd = self._inputs, 0, _Crowd(self.time)
        drive, force = inputs.pieces(self._walk.pieces_of)
        while reached < len(out):
            before = reached
            reached, until, rows, end = self._walk.sample(
                self._parameters, self._state, drive, force, inputs.until, *at, reached, len(out), self._sinusoids,
                self._table, out)
            if events is not None:
                events.extend(self._events(rows))
            inputs.go_on(until)
            self._check_samples(out[before:reached])
            if reached > before:
                self.time = Instant(float(at.seconds[reached - 1]), float(at.fractions[reached - 1]))
            if end != DONE:
                self._check_end(end, rows, crowd)

    def sample(self) -> Sample:
        """Return the state at the present time; raises SolverError when it is not finite."""
        self._fill()
        return sample_of(self._row)

    def _fill(self) -> None:
        second, fraction = self.time
        self._solver.sample(self._parameters, self._state, second, fraction, self._row)
        if not all(map(math.isfinite, self._row.tolist()[_MOVES])):
            raise self._out_of_range(second + fraction)

    def numbers(self) -> list[float]:
        """Return all numbers of the state."""
        return self._state.numbers()

    def restore(self, time: Instant, axis: Axis, numbers: Iterable[Any], until: float) -> None:
        """Go on from a time and the numbers of a state there, whose inputs hold `until` (s).

        Raises TypeError or ValueError when they are none of this axis.
        """
        self.time = time
        self._take(axis)
        state = self._solver.records.State(self._inputs.most_sinusoids)
        state.take(numbers_of(numbers, self._state))
        check_state(state, self._inputs.most_sinusoids, self._parameters)
        self._state = state
        self._inputs.go_on(until)
        self._take_sinusoids()

    def _take(self, axis: Axis) -> None:
        self.axis, self._solver = axis, self._solver_of(axis)
        self._parameters = self._solver.records.Parameters(pack(axis))
        normal_force = None if self._load is None else self._load.plus(axis.normal_force)
        if normal_force is not None:
            self._solver = under_load(self._solver, axis, normal_force)
            self._parameters.normal_force, self._parameters.normal_rate, _ = normal_force.pieces_at(self.time.seconds)
        self._walk, self._step = walk_of(self._solver, normal_force), self._solver.step

    def _take_sinusoids(self) -> None:
        """Let the sinusoids of the inputs in force be those that are entered from now on."""
        self._sinusoids = self._solver.records.Sinusoids(self._inputs.sinusoids())

    def _events(self, count: int) -> Iterator[Event]:
        return events_in(self._table, count)

    def _check_end(self, end: int, rows: int, crowd: _Crowd) -> None:
        """Let a solver go on whose table of events was full; raise SolverError where it gave up."""
        self.time = max(self.time, Instant(float(self._state.second), float(self._state.fraction)))
        if end == OUT_OF_RANGE:
            raise SolverError(f'the state overflows after t = {self.time.seconds!r} s; '
                              f'{self._solver.advice}')
        if end == UNSOUND:
            raise self._unsound()
        crowd.take(self.time, rows)
        if end != FULL or crowd.count > MAX_EVENTS_AT_ONCE:
            raise SolverError(f'{crowd.count} events up to t = {self.time.seconds!r} s and time hardly advances; '
                              'friction or inputs are too extreme for this axis: check the scene')

    def _check_samples(self, rows: NDArray[np.float64]) -> None:
        """Raise SolverError unless the states in rows of samples are finite."""
        lost = ~np.isfinite(rows[:, _MOVES]).all(axis=1)
        if lost.any():
            second, fraction = rows[lost.argmax(), :2].tolist()
            raise self._out_of_range(second + fraction)

    def _out_of_range(self, time: float) -> SolverError:
        return SolverError(f'the state overflows at t = {time!r} s; {self._solver.advice}')

    def _unsound(self) -> UnsoundError:
        mode = _MODES[int(self._state.mode)].name
        return UnsoundError(f'the run violates its own motion or energy balance at t = {self.time.seconds!r} s, '
                            f'in mode {mode}: do not trust its figures; this is an error of the solver, not of the '
                            'scene: please report both')
