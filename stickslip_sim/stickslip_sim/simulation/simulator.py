# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One axis through time: advance, sample, command.  Deterministic; knows no clock, no file and no ROS."""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..axis import Axis, InitialState, check_start, pack
from ..core.energy import EnergyBalance
from ..core.errors import InputError, SolverError, UnsoundError
from ..core.input_profile import Input, InputProfile
from ..core.time_grid import Instants
from ..core.types import Event, EventKind, Instant, Mode, Sample, tuple_of
from ..solvers import DONE, FULL, OUT_OF_RANGE, UNSOUND, Solver, exact
from ..solvers.normal_load import under_load
from ..solvers.walk import walk_of
from .checkpoint import check_state, event_of, numbers_of
from .inputs import Inputs, LoadedInputs

SolverOf = Callable[[Axis], Solver]

_KINDS, _MODES = tuple(EventKind), tuple(Mode)
_MOVES = slice(4, 12)            # of a sample; the rest may be infinite
_ROWS = 64                       # of the event table; it is emptied as often as it fills
MAX_EVENTS_PER_ADVANCE = 100_000


class Simulator:
    """The state of one axis, brought from time to time.

    `drive` (m/s) and `force` (N) are input profiles over simulation time; a command replaces an input profile by a
    constant from the present time on.  Events come back from the call in which they fall, in the order of time.
    `solver` is one for any axis, or makes the one for an axis, as those must that take its smooth law.  With
    `accounting` the solver keeps the account of energy, if it can; the motion is the same to the last bit.  A `load`
    (N) is added to the normal force of the axis; raises InputError where the solver cannot follow it.
    """

    def __init__(self, axis: Axis, initial: InitialState, drive: InputProfile, force: InputProfile,
                 solver: Solver | SolverOf = exact.SOLVER, accounting: bool = False,
                 load: InputProfile | None = None) -> None:
        check_start(axis, initial, load.value_at(0.0) if load else 0.0)
        self._inputs = LoadedInputs(drive, force, load) if load else Inputs(drive, force)
        self._load = load
        self._solver_of: SolverOf = solver if callable(solver) else lambda _: solver
        self._initial = initial
        self._time = Instant(0.0, 0.0)
        self._take_axis(axis)
        records = self._solver.records
        self._state = records.State(self._inputs.most_sinusoids)
        self._state.accounting = float(accounting and self._solver.energy is not None)
        self._row = records.SampleRow()
        self._energies = records.EnergyRow()
        self._table = records.Events(_ROWS)
        self.reset()

    def reset(self) -> list[Event]:
        """Begin anew at time 0 with the initial state and the original input profiles; return the events at time 0."""
        v, f = self._inputs.reset()
        self._sinusoids = self._solver.records.Sinusoids(self._inputs.sinusoids())
        self._time = Instant(0.0, 0.0)
        if self._load is not None:
            self._take_axis(self._axis)
        start = self._initial
        rows = self._solver.start(self._parameters, self._state, start.position, start.velocity, start.rest_time,
                                  start.stretch, start.deflection, v.value, v.rate, f.value, f.rate, self._sinusoids,
                                  self._table, 0)
        self._waiting = list(self._rows(rows))
        self._counts = dict.fromkeys(EventKind, 0)
        return self._waiting

    @property
    def time(self) -> Instant:
        """The time that the state was advanced to."""
        return self._time

    @property
    def axis(self) -> Axis:
        """The axis as it is now."""
        return self._axis

    @property
    def force(self) -> Input:
        """The external force in force, N."""
        return self._inputs.force

    @property
    def root_iterations(self) -> int:
        """Iterations of all searches for event times so far."""
        return int(self._state.iterations)

    @property
    def event_counts(self) -> dict[EventKind, int]:
        """Events so far, by kind."""
        return dict(self._counts)

    @property
    def energy(self) -> EnergyBalance | None:
        """The energies from the start up to the present time; None without an account."""
        if self._solver.energy is None or not self._state.accounting:
            return None
        self._solver.energy(self._parameters, self._state, *self._time, self._energies)
        return EnergyBalance(*self._energies.tolist())

    def judge(self) -> None:
        """Raise UnsoundError when the state contradicts its own mode or balance of energy; needs an account.

        Each event is judged as the run goes on; this is for its end, or any time that its figures are looked at.
        """
        if self._solver.is_sound is not None and self._state.accounting and not self._solver.is_sound(
                self._parameters, self._state, *self._time):
            raise self._unsound()

    def _unsound(self) -> UnsoundError:
        mode = _MODES[int(self._state.mode)].name
        return UnsoundError(f'the run contradicts its own motion or balance of energy at t = {self._time.seconds!r} s, '
                            f'in mode {mode}: none of its figures can be trusted; the solver is at fault, not the '
                            'scene: please report both')

    def advance(self, to: Instant) -> list[Event]:
        """Bring the state to a time that is not before the present one; return the events up to then.

        Raises InputError when it is before or no time, SolverError when the events do not let time go on; the state is
        then that of the last event.
        """
        second, fraction = to
        events = self._set_out(to)
        if self._inputs.until <= second + fraction:
            self._enter_more(second + fraction, events)
        self._advance(to, events)
        for event in events:
            self._counts[event.kind] += 1
        return events

    def take_samples(self, at: Instants, out: NDArray[np.float64], *, with_events: bool = True) -> list[Event]:
        """Bring the state to one time after the other, as `advance` does, and fill a row with the sample at each.

        Returns the events up to the last, which are neither returned nor counted without `with_events`, as by `skip`;
        raises as `advance` and `sample` do.
        """
        events = self._set_out(Instant(float(at.seconds[0]), float(at.fractions[0])))
        inputs, reached, taken = self._inputs, 0, 0
        drive, force = inputs.pieces(self._walk.pieces_of)
        while reached < len(out):
            before = reached, inputs.until
            reached, until, rows, end = self._walk.sample(
                self._parameters, self._state, drive, force, inputs.until, *at, reached, len(out), self._sinusoids,
                self._table, out)
            if with_events:
                events.extend(self._rows(rows))
            inputs.go_on(until)
            self._check_samples(out[before[0]:reached])
            if reached > before[0]:
                self._time = Instant(float(at.seconds[reached - 1]), float(at.fractions[reached - 1]))
            taken = rows if before != (reached, until) else taken + rows
            if end != DONE:
                self._check_end(end, taken)
        for event in events:
            self._counts[event.kind] += 1
        return events

    def skip(self, to: Instant) -> None:
        """Bring the state to a time under constant inputs; its events are neither returned nor counted.

        They are the same to the last bit, and cost a fifth of what `advance` takes to make objects of them.  Raises
        SolverError as it does.
        """
        self._waiting = []
        self._advance(to, None)

    def command_drive(self, velocity: Input) -> None:
        """Let the drive move at a constant velocity (m/s), or after an input profile over simulation time, from now on.

        Events that this causes come with `advance`.  Raises InputError; an input profile must have no more sinusoids
        than that of the start.
        """
        self._inputs.command_drive(velocity)

    def command_force(self, force: Input) -> None:
        """Let a constant external force (N), or an input profile, act from now on, as `command_drive`."""
        self._inputs.command_force(force)

    def set_inputs(self, drive: Input, force: Input) -> None:
        """Let both be in force from now on, as `command_drive` and `command_force`, but without their checks.

        For the rig, which makes them of commands that were checked.
        """
        self._inputs.set(drive, force)

    def change_axis(self, axis: Axis) -> None:
        """Go on with other parameters from now on; position, velocity and the spring stay continuous."""
        if self._inputs.are_commanded:
            self._obey()
        old = self._parameters
        self._take_axis(axis)
        rows = self._solver.set_parameters(old, self._parameters, self._state, *self._time, self._table, 0)
        self._waiting.extend(self._rows(rows))

    def sample(self) -> Sample:
        """Return the state at the present time; raises SolverError when it is not finite."""
        if self._inputs.are_commanded:
            self._obey()
        second, fraction = self._time
        self._solver.sample(self._parameters, self._state, second, fraction, self._row)
        row = self._row.tolist()
        if not math.isfinite(sum(row)) and not all(map(math.isfinite, row[_MOVES])):
            raise self._out_of_range(second + fraction)
        row[2], row[3] = _MODES[int(row[2])], int(row[3])
        return tuple_of(Sample, row)

    def checkpoint(self) -> dict[str, Any]:
        """Return the state as plain data, from which a simulator of the same scene goes on to the last bit."""
        if self._inputs.are_commanded:
            self._obey()
        return {'time': list(self._time), 'until': self._inputs.until,
                'state': self._state.numbers(),
                'waiting': [[*map(float, event)] for event in self._waiting]}

    def restore(self, saved: Mapping[str, Any], axis: Axis, drive: Input, force: Input) -> None:
        """Go on from a checkpoint that was taken with this axis and these input profiles in force.

        Raises InputError on impossible input profiles; KeyError, TypeError or ValueError when it is no checkpoint.
        """
        self._inputs.command_drive(drive)
        self._inputs.command_force(force)
        second, fraction = map(float, saved['time'])
        self._time = Instant(second, fraction)
        self._take_axis(axis)
        state = self._solver.records.State(self._inputs.most_sinusoids)
        state.take(numbers_of(saved['state'], self._state))
        check_state(state, self._inputs.most_sinusoids, self._parameters)
        until, self._waiting = float(saved['until']), [event_of(event) for event in saved['waiting']]
        self._state = state
        self._inputs.go_on(until)
        self._sinusoids = self._solver.records.Sinusoids(self._inputs.sinusoids())

    def _take_axis(self, axis: Axis) -> None:
        self._axis, self._solver = axis, self._solver_of(axis)
        self._parameters = self._solver.records.Parameters(pack(axis))
        normal_force = None if self._load is None else self._load.plus(axis.normal_force)
        if normal_force is not None:
            self._solver = under_load(self._solver, normal_force)
            self._parameters.normal_force = normal_force.value_at(self._time.seconds)
        self._walk = walk_of(self._solver, normal_force)

    def _obey(self) -> None:
        """Let the commands of this instant take effect, all at once: their order does not matter."""
        if self._inputs.most_sinusoids:
            self._sinusoids = self._solver.records.Sinusoids(self._inputs.sinusoids())
        self._enter_pieces(self._waiting)

    def _advance(self, to: Instant, events: list[Event] | None) -> None:
        second, fraction = to
        taken = 0
        while True:
            rows, end = self._solver.advance(self._parameters, self._state, second, fraction, self._table, 0)
            if rows and events is not None:
                events.extend(self._rows(rows))
            taken += rows if events is not None else 0
            if end == DONE:
                self._time = to
                return
            self._check_end(end, taken)

    def _set_out(self, to: Instant) -> list[Event]:
        """Begin to go on to a time; return the events so far.  Raises InputError when it is before, or no time."""
        if not (self._time <= to and math.isfinite(to.second) and 0.0 <= to.fraction < 1.0):
            raise InputError('time', tuple(to), f'finite and not before {self._time.seconds!r} s',
                             'time does not go back: reset to begin anew')
        if self._inputs.are_commanded:
            self._obey()
        events, self._waiting = self._waiting, []
        return events

    def _check_samples(self, rows: NDArray[np.float64]) -> None:
        """Raise SolverError unless the states in rows of samples are finite."""
        lost = ~np.isfinite(rows[:, _MOVES]).all(axis=1)
        if lost.any():
            second, fraction = rows[lost.argmax(), :2].tolist()
            raise self._out_of_range(second + fraction)

    def _out_of_range(self, time: float) -> SolverError:
        return SolverError(f'the state leaves the range of numbers at t = {time!r} s; {self._solver.advice}')

    def _enter_more(self, time: float, events: list[Event]) -> None:
        """Go on through the pieces of the inputs that begin up to a time, s."""
        inputs, taken = self._inputs, 0
        drive, force = inputs.pieces(self._walk.pieces_of)
        while inputs.until <= time:
            until, rows, end = self._walk.run(self._parameters, self._state, drive, force, inputs.until, time,
                                              self._sinusoids, self._table, 0)
            events.extend(self._rows(rows))
            taken = rows if until > inputs.until else taken + rows
            inputs.go_on(until)
            if end != DONE:
                self._check_end(end, taken)

    def _check_end(self, end: int, taken: int) -> None:
        """Let a solver go on whose table of events was full; raise SolverError where it gave up."""
        self._time = max(self._time, Instant(float(self._state.second), float(self._state.fraction)))
        if end == OUT_OF_RANGE:
            raise SolverError(f'the state leaves the range of numbers after t = {self._time.seconds!r} s; '
                              f'{self._solver.advice}')
        if end == UNSOUND:
            raise self._unsound()
        if end != FULL or taken > MAX_EVENTS_PER_ADVANCE:
            raise SolverError(f'{taken} events up to t = {self._time.seconds!r} s and time hardly goes on; '
                              'friction or inputs are too extreme for this axis: check the scene')

    def _enter_pieces(self, events: list[Event]) -> None:
        second, fraction = self._time
        rows = self._solver.set_inputs(self._parameters, self._state, second, fraction,
                                       *self._inputs.enter(second + fraction), self._sinusoids, self._table, 0)
        if rows:
            events.extend(self._rows(rows))

    def _rows(self, count: int) -> Iterator[Event]:
        for i in range(count):
            second, fraction, kind, mode, direction, *rest = self._table.row(i)
            yield Event(second, fraction, _KINDS[int(kind)], _MODES[int(mode)], int(direction), *rest)
