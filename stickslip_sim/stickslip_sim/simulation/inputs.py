# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The inputs of an axis, drive velocity and external force: the courses in force, and which pieces of them."""

import math

from ..core.errors import InputError
from ..core.input_profile import InputProfile, Piece, constant


class Inputs:
    """Two courses over simulation time, and what commands made of them; `until` (s) is where their pieces end.

    Raises InputError when a course has no meaning.
    """

    def __init__(self, drive: InputProfile, force: InputProfile) -> None:
        drive.check('drive')
        force.check('force')
        self._first = drive, force
        self.reset()

    def reset(self) -> None:
        """Take the original courses again."""
        self._drive, self._force = self._first
        self.are_commanded = False    # since pieces were entered
        self.until = 0.0

    @property
    def most_sinusoids(self) -> int:
        """How many waves the courses can have."""
        return sum(len(profile.sinusoids) for profile in self._first)

    def command_drive(self, velocity: float | InputProfile) -> None:
        """Replace the drive velocity by a constant, m/s, or a course; raises InputError."""
        self._drive = _profile('velocity', velocity, 'm/s', self._first[0])
        self.are_commanded = True

    def command_force(self, force: float | InputProfile) -> None:
        """Replace the external force by a constant, N, or a course; raises InputError."""
        self._force = _profile('force', force, 'N', self._first[1])
        self.are_commanded = True

    def enter(self, time: float) -> tuple[Piece, Piece]:
        """Return the pieces of drive and force from a time on, s."""
        v, f = self._drive.piece_at(time), self._force.piece_at(time)
        self.go_on(min(v.end, f.end))
        return v, f

    def go_on(self, until: float) -> None:
        """Let pieces that were entered before be in force until a time, s."""
        self.are_commanded = False
        self.until = until

    def sinusoids(self) -> list[float]:
        """Return the waves of both courses as `solvers.Solver` wants them, without those that are nothing."""
        of_drive = [(sinusoid.frequency, sinusoid.phase, sinusoid.amplitude, 0.0) for sinusoid in self._drive.sinusoids]
        of_force = [(sinusoid.frequency, sinusoid.phase, 0.0, sinusoid.amplitude) for sinusoid in self._force.sinusoids]
        return [number for frequency, phase, v, f in of_drive + of_force
                if v != 0.0 or f != 0.0 for number in (frequency, math.fmod(0.5 * phase / math.pi, 1.0), v, f)]


def _profile(name: str, value: float | InputProfile, unit: str, first: InputProfile) -> InputProfile:
    if isinstance(value, InputProfile):
        value.check(name)
        if len(value.sinusoids) > len(first.sinusoids):
            raise InputError(f'{name}.sinusoids', len(value.sinusoids),
                             f'at most {len(first.sinusoids)}, as at the start',
                             'give the simulator a course with as many waves at its start')
        return value
    if not math.isfinite(value):
        raise InputError(name, value, f'finite, in {unit}', 'the command before it stays in force')
    return constant(value)
