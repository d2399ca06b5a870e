# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The inputs of an axis, drive velocity and external force: what is in force, and which pieces of it."""

import math
from collections.abc import Callable, Iterator
from typing import Any

from ..core.errors import InputError
from ..core.input_profile import Input, InputProfile, Piece, constant


class Inputs:
    """Two input profiles over simulation time, and what commands made of them; `until` (s) is where their pieces end.

    `drive` and `force` are in force; the simulator has yet to enter them when `are_commanded`.  Raises InputError when
    an input profile has no meaning.
    """

    def __init__(self, drive: InputProfile, force: InputProfile) -> None:
        self._drive_pieces, self._force_pieces = _KeptPieces(), _KeptPieces()
        self.most_sinusoids = len(drive.sinusoids) + len(force.sinusoids)    # that the inputs can have
        self._first = drive, force
        self.take(drive, force)
        self.reset()

    def take(self, drive: InputProfile, force: InputProfile) -> None:
        """Let `reset` take these profiles; raises InputError when one has no meaning, or more sinusoids than before."""
        _check('drive', drive, 'm/s', self._first[0])
        _check('force', force, 'N', self._first[1])
        self._first = drive, force

    def reset(self) -> tuple[Piece, Piece]:
        """Take the original input profiles again; return their first pieces."""
        drive, force = self._first
        self.drive: Input = drive
        self.force: Input = force
        self._steady_force: Input | None = None    # one of the same value from now on
        self._steady = 0.0
        v, f = drive.piece_at(0.0), force.piece_at(0.0)
        self.go_on(min(v.end, f.end))
        return v, f

    def set(self, drive: Input, force: Input) -> None:
        """Let these be in force: finite, and with no more sinusoids than the input profiles of the start."""
        self.drive, self.force = drive, force
        self.are_commanded = True

    def command_drive(self, velocity: Input) -> None:
        """Replace the drive velocity by a constant, m/s, or a profile; raises InputError."""
        _check('velocity', velocity, 'm/s', self._first[0])
        self.set(velocity, self.force)

    def command_force(self, force: Input) -> None:
        """Replace the external force by a constant, N, or a profile; raises InputError."""
        _check('force', force, 'N', self._first[1])
        self.set(self.drive, force)

    def enter(self, time: float) -> tuple[float, float, float, float]:
        """Return drive velocity, its rate, force and its rate from a time on, s, up to where their pieces end."""
        drive, force = self.drive, self.force
        self.are_commanded = False
        if force is self._steady_force and type(drive) is float:
            self.until = math.inf
            return drive + 0.0, 0.0, self._steady, 0.0
        v, v_rate, v_end = _pieces_at(drive, time)
        f, f_rate, f_end = _pieces_at(force, time)
        if f_rate == 0.0 and f_end == math.inf:    # from now on
            self._steady_force, self._steady = force, f
        self.until = v_end if v_end <= f_end else f_end
        return v, v_rate, f, f_rate

    def pieces(self, make: Callable[[InputProfile], Any]) -> tuple[Any, Any]:
        """Return what `make` makes of both inputs in force, as profiles."""
        return self._drive_pieces.of(self.drive, make), self._force_pieces.of(self.force, make)

    def go_on(self, until: float) -> None:
        """Let pieces that were entered before be in force until a time, s."""
        self.are_commanded = False
        self.until = until

    def sinusoids(self) -> list[float]:
        """Return the sinusoids of both inputs, in a row, but for those of no amplitude."""
        return [*_rows_of(self.drive, 0), *_rows_of(self.force, 1)]


class LoadedInputs(Inputs):
    """Inputs beside a load normal to the slideway, whose pieces count in `until`, and sinusoids among those of both."""

    def __init__(self, drive: InputProfile, force: InputProfile, load: InputProfile) -> None:
        self._load = load
        super().__init__(drive, force)
        self.most_sinusoids += len(load.sinusoids)

    def reset(self) -> tuple[Piece, Piece]:
        """Take the original input profiles again; return their first pieces, without that of the load."""
        first = super().reset()
        self.go_on(min(self.until, self._load.piece_at(0.0).end))
        return first

    def enter(self, time: float) -> tuple[float, float, float, float]:
        """Return the inputs from a time on, s, up to where their pieces or that of the load end."""
        entered = super().enter(time)
        self.go_on(min(self.until, self._load.pieces_at(time)[2]))
        return entered

    def sinusoids(self) -> list[float]:
        """Return the sinusoids of both inputs and of the load, in a row, but for those of no amplitude."""
        return [*super().sinusoids(), *_rows_of(self._load, 2)]


class _KeptPieces:
    """The pieces of an input as a solver walks through them; made anew for another input only."""

    def __init__(self) -> None:
        self._given: Input | None = None
        self._pieces: Any = None

    def of(self, given: Input, make: Callable[[InputProfile], Any]) -> Any:
        if given is not self._given:
            profile = given if isinstance(given, InputProfile) else constant(given + 0.0)    # no -0.0, as in a profile
            self._given, self._pieces = given, make(profile)
        return self._pieces


def _pieces_at(given: Input, time: float) -> tuple[float, float, float]:
    if isinstance(given, InputProfile):
        return given.pieces_at(time)
    return given + 0.0, 0.0, math.inf    # no -0.0, as in a profile


def _rows_of(given: Input, place: int) -> Iterator[float]:
    """Yield the numbers of an input's sinusoids as solvers take them; `place` is that of its amplitude."""
    for one in given.sinusoids if isinstance(given, InputProfile) else ():
        if one.amplitude != 0.0:
            amplitudes = [0.0, 0.0, 0.0]
            amplitudes[place] = one.amplitude
            yield from (one.frequency, math.fmod(0.5 * one.phase / math.pi, 1.0), *amplitudes)


def _check(name: str, value: Input, unit: str, first: InputProfile) -> None:
    if isinstance(value, InputProfile):
        value.check(name)
        if len(value.sinusoids) > len(first.sinusoids):
            raise InputError(f'{name}.sinusoids', len(value.sinusoids),
                             f'at most {len(first.sinusoids)}, as at the start',
                             'give the simulator an input profile with as many sinusoids at its start')
    elif not math.isfinite(value):
        raise InputError(name, value, f'finite, in {unit}', 'the command before it stays in force')
