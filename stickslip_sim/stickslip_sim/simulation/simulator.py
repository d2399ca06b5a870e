# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One axis through time: advance, sample, command.  Deterministic; knows no clock, no file and no ROS."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..axis import Axis, InitialState, check_start
from ..axis.rows import SampleRow
from ..core.errors import InputError
from ..core.input_profile import Input, InputProfile
from ..core.time_grid import Instants
from ..core.types import EnergyBalance, Event, EventKind, Instant, Sample
from ..solvers import Solver, exact
from .inputs import Inputs, LoadedInputs
from .solved_axis import SolvedAxis, SolverOf, event_of


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
        self._load = load.value_at(0.0) if load else 0.0    # at the start
        check_start(axis, initial, self._load)
        self.inputs = self._inputs = LoadedInputs(drive, force, load) if load else Inputs(drive, force)
        self._initial = initial
        self._solved = SolvedAxis(axis, solver if callable(solver) else lambda _: solver, self._inputs, load,
                                  accounting)
        self.reset()

    def reset(self) -> list[Event]:
        """Begin anew at time 0 with the initial state and the original input profiles; return the events at time 0."""
        self._waiting = self._solved.start(self._initial)
        self._counts = dict.fromkeys(EventKind, 0)
        return self._waiting

    def restart(self, initial: InitialState, drive: InputProfile, force: InputProfile) -> None:
        """Begin anew as `reset`, with another initial state and other input profiles, of no more sinusoids each.

        Raises InputError, and leaves all as it is.
        """
        check_start(self.axis, initial, self._load)
        self._inputs.take(drive, force)
        self._initial = initial
        self.reset()

    @property
    def time(self) -> Instant:
        """The time that the state was advanced to."""
        return self._solved.time

    @property
    def axis(self) -> Axis:
        """The axis as it is now."""
        return self._solved.axis

    @property
    def drive(self) -> Input:
        """The drive velocity in force, m/s."""
        return self._inputs.drive

    @property
    def force(self) -> Input:
        """The external force in force, N."""
        return self._inputs.force

    @property
    def root_iterations(self) -> int:
        """Iterations of all searches for event times so far."""
        return self._solved.root_iterations

    @property
    def event_counts(self) -> dict[EventKind, int]:
        """Events so far, by kind."""
        return dict(self._counts)

    @property
    def energy(self) -> EnergyBalance | None:
        """The energies from the start up to the present time; None without an account."""
        return self._solved.energy

    def require_sound(self) -> None:
        """Raise UnsoundError when the state contradicts its own mode or balance of energy; needs an account.

        Each event is checked as the run goes on; this is for its end, or any time that its figures are looked at.
        """
        self._solved.require_sound()

    def advance(self, to: Instant) -> list[Event]:
        """Bring the state to a time that is not before the present one; return the events up to then.

        Raises InputError when it is before or no time, SolverError when the events do not let time go on; the state is
        then that of the last event.
        """
        events = self._set_out(to)
        second, fraction = to
        if self._inputs.until <= second + fraction:
            self._solved.enter_pieces(second + fraction, events)
        self._solved.advance(to, events)
        return self._counted(events)

    def step(self, to: Instant) -> tuple[list[Event], SampleRow]:
        """Bring the state to a time from the present one on, unchecked; return events and the record of a sample."""
        events, self._waiting = self._waiting, []
        row = self._solved.step(to, events)
        return self._counted(events) if events else events, row

    def _counted(self, events: list[Event]) -> list[Event]:
        for event in events:
            self._counts[event.kind] += 1
        return events

    def take_samples(self, at: Instants, out: NDArray[np.float64], *, with_events: bool = True) -> list[Event]:
        """Bring the state to one time after the other, as `advance` does, and fill a row with the sample at each.

        Returns the events up to the last, which are neither returned nor counted without `with_events`, as by `skip`;
        raises as `advance` and `sample` do.
        """
        events = self._set_out(Instant(float(at.seconds[0]), float(at.fractions[0])))
        self._solved.take_samples(at, out, events if with_events else None)
        return self._counted(events)

    def skip(self, to: Instant) -> None:
        """Bring the state to a time under constant inputs; its events are neither returned nor counted.

        They are the same to the last bit, and cost a fifth of what `advance` takes to make objects of them.  Raises
        SolverError as it does.
        """
        self._waiting = []
        self._solved.advance(to, None)

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
        """Let both be in force from now on, as `command_drive` and `command_force`, but without their checks."""
        self._inputs.set(drive, force)

    def change_axis(self, axis: Axis) -> None:
        """Go on with other parameters from now on; position, velocity and the spring stay continuous."""
        if self._inputs.are_commanded:
            self._solved.obey(self._waiting)
        self._solved.change(axis, self._waiting)

    def sample(self) -> Sample:
        """Return the state at the present time; raises SolverError when it is not finite."""
        if self._inputs.are_commanded:
            self._solved.obey(self._waiting)
        return self._solved.sample()

    def checkpoint(self) -> dict[str, Any]:
        """Return the state as plain data, from which a simulator of the same scene goes on to the last bit."""
        if self._inputs.are_commanded:
            self._solved.obey(self._waiting)
        return {'time': list(self._solved.time), 'until': self._inputs.until,
                'state': self._solved.numbers(),
                'waiting': [[*map(float, event)] for event in self._waiting]}

    def restore(self, saved: Mapping[str, Any], axis: Axis, drive: Input, force: Input) -> None:
        """Go on from a checkpoint that was taken with this axis and these input profiles in force.

        Raises InputError on impossible input profiles; KeyError, TypeError or ValueError when it is no checkpoint.
        """
        self._inputs.command_drive(drive)
        self._inputs.command_force(force)
        second, fraction = map(float, saved['time'])
        until, waiting = float(saved['until']), [event_of(event) for event in saved['waiting']]
        self._solved.restore(Instant(second, fraction), axis, saved['state'], until)
        self._waiting = waiting

    def _set_out(self, to: Instant) -> list[Event]:
        """Begin to go on to a time; return the events so far.  Raises InputError when it is before, or no time."""
        if not (self._solved.time <= to and math.isfinite(to.second) and 0.0 <= to.fraction < 1.0):
            raise InputError('time', tuple(to), f'finite and not before {self._solved.time.seconds!r} s',
                             'time does not go backwards: reset to start again')
        if self._inputs.are_commanded:
            self._solved.obey(self._waiting)
        events, self._waiting = self._waiting, []
        return events
