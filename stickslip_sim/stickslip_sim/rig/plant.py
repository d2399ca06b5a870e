# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated axis with what acts on it: friction, force and drive as the faults in force leave them."""

import math
from collections.abc import Mapping
from typing import Any

from ..axis import Axis
from ..core.errors import InputError, SolverError
from ..core.input_profile import InputProfile, constant, plain_of, profile_of
from ..simulation.simulator import Simulator
from .drive import Drive
from .faults import Faults
from .friction import with_friction_scaled


class Plant:
    """Keeps what was ordered apart from what acts; what changes between two steps takes effect with `act`, at once."""

    def __init__(self, simulator: Simulator, drive: Drive, force: InputProfile, faults: Faults) -> None:
        self.drive = drive
        self._simulator, self._faults = simulator, faults
        self._axis = simulator.axis           # without faults
        self._force, self._acting_force = force, force
        self._acting_drive = drive.profile
        self._friction_scale = 1.0
        self._is_changed = False              # axis, force or faults, since they last took effect

    def rewind(self) -> None:
        """Bring the simulator back to time 0, without faults; the parameters of the axis stay as they are."""
        self._change_axis(1.0)
        self._simulator.reset()

    def command_force(self, force: float) -> None:
        """Let a force act on the slider, N."""
        self._force, self._is_changed = constant(force), True

    def change_axis(self, axis: Axis) -> None:
        """Go on with other parameters."""
        self._axis, self._is_changed = axis, True

    def change_faults(self) -> None:
        """Take note that other faults are in force."""
        self._is_changed = True

    def act(self) -> None:
        """Let all that changed take effect at once; raises SolverError when the faults leave no axis to go on with."""
        if not self._is_changed:
            self._command_drive()
            return
        scale = math.prod(self._faults.values('friction_scale'))
        falls, self._friction_scale = scale < self._friction_scale, scale
        self.drive.freeze(bool(self._faults.values('drive_freeze')), self._simulator.time)
        if not falls:
            self._change_axis(scale)
        self._command_force()
        self._command_drive()
        if falls:    # last: what held before and holds afterwards must not break away in between
            self._change_axis(scale)
        self._is_changed = False

    def checkpoint(self) -> dict[str, Any]:
        """Return what was ordered, what acts and how the axis moves, as plain data."""
        return {'drive': self.drive.checkpoint(), 'force': plain_of(self._force),
                'acting_force': plain_of(self._acting_force), 'friction_scale': self._friction_scale,
                'simulator': self._simulator.checkpoint()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Go on from a checkpoint, with the parameters of the axis that held then."""
        self.drive.restore(saved['drive'])
        self._acting_drive = self.drive.profile
        self._force, self._acting_force = profile_of(saved['force']), profile_of(saved['acting_force'])
        self._friction_scale = float(saved['friction_scale'])
        axis = with_friction_scaled(self._axis, self._friction_scale)
        self._simulator.restore(saved['simulator'], axis, self._acting_drive, self._acting_force)

    def _change_axis(self, friction_scale: float) -> None:
        try:
            axis = with_friction_scaled(self._axis, friction_scale)
            if axis != self._simulator.axis:
                self._simulator.change_axis(axis)
        except InputError as error:
            raise SolverError(f'the faults in force scale friction by {friction_scale:g}: {error}') from None

    def _command_force(self) -> None:
        pulse = math.fsum(self._faults.values('force_pulse'))
        profile = self._force.plus(pulse) if pulse else self._force
        if profile != self._acting_force:
            self._acting_force = profile
            self._simulator.command_force(profile)

    def _command_drive(self) -> None:
        if self.drive.profile is not self._acting_drive:
            self._acting_drive = self.drive.profile
            self._simulator.command_drive(self._acting_drive)
