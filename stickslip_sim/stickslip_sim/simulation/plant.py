# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated axis with what acts on it: friction, force and drive as the faults in force leave them."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..axis import Axis, Friction
from ..core.errors import InputError, SolverError
from ..core.input_profile import InputProfile, constant, plain_of, profile_of
from ..friction import SmoothKinetic
from .drive import Drive
from .faults import Effect, Faults
from .simulator import Simulator

# Friction of an axis scaled as a whole, as when lubrication changes.

def with_friction_scaled(axis: Axis, factor: float) -> Axis:
    """Return the axis with all its friction coefficients times a factor."""
    return axis if factor == 1.0 else replace(axis, friction=_scaled(axis.friction, factor))


def _scaled(friction: Friction, factor: float) -> Friction:
    static, kinetic, law = friction.static, friction.kinetic, friction.kinetic.law
    return replace(
        friction, static=replace(static, initial=factor * static.initial, limit=factor * static.limit),
        kinetic=replace(kinetic, coefficients=tuple(factor * value for value in kinetic.coefficients),
                        end_slope=factor * kinetic.end_slope, law=law and _scaled_law(law, factor),
                        error=factor * kinetic.error, tolerance=factor * kinetic.tolerance),
        backward=friction.backward and _scaled(friction.backward, factor))


def _scaled_law(law: SmoothKinetic, factor: float) -> SmoothKinetic:
    return replace(law, initial=factor * law.initial, limit=factor * law.limit, viscous=factor * law.viscous)


class Plant:
    """Keeps what was ordered apart from what acts; what changes between two steps takes effect with `act`, at once.

    The simulator keeps the inputs that act.  Commands are finite: `Rig.make_step` has checked them.
    """

    def __init__(self, simulator: Simulator, drive: Drive, force: InputProfile, faults: Faults) -> None:
        self.is_changed = False          # something was ordered, or other faults are in force, since `act`
        self._simulator, self._drive, self._faults = simulator, drive, faults
        self._axis = self._entered = simulator.axis      # ordered, and acting; both without faults
        self._force = force              # without faults
        self._friction_scale = 1.0
        self._acting: Effect | None = None    # of the faults, since `act`

    def rewind(self) -> None:
        """Bring the simulator back to time 0, without faults; the parameters of the axis stay as they are."""
        self._change_axis(1.0)
        self._simulator.reset()

    def follow(self, velocity: float, acceleration: float = math.inf) -> bool:
        """Let the drive make for a velocity (m/s); return whether its limits let it, within the step."""
        self.is_changed = True
        return self._drive.follow(velocity, self._simulator.time, acceleration)

    def push(self, force: float) -> None:
        """Let a force act on the slider, N."""
        self._force, self.is_changed = constant(force), True

    def change_axis(self, axis: Axis) -> None:
        """Go on with other parameters."""
        self._axis, self.is_changed = axis, True

    def act(self) -> None:
        """Let all that changed take effect at once; raises SolverError when the faults leave no axis to go on with."""
        effect = self._faults.effect
        if effect is self._acting and self._axis is self._entered:    # only the inputs changed
            self._set_inputs(effect.force_pulse)
            self.is_changed = False
            return
        scale = effect.friction_scale
        is_other = self._axis is not self._entered or scale != self._friction_scale
        falls, self._friction_scale, self._entered = scale < self._friction_scale, scale, self._axis
        self._drive.freeze(effect.drive_frozen, self._simulator.time)
        if is_other and not falls:
            self._change_axis(scale)
        self._set_inputs(effect.force_pulse)
        if falls:    # last: what held before and holds afterwards must not break away in between
            self._change_axis(scale)
        self._acting, self.is_changed = effect, False

    def checkpoint(self) -> dict[str, Any]:
        """Return what was ordered, what acts and how the axis moves, as plain data."""
        return {'drive': self._drive.checkpoint(), 'force': plain_of(self._force),
                'acting_force': plain_of(self._simulator.force), 'friction_scale': self._friction_scale,
                'simulator': self._simulator.checkpoint()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Go on from a checkpoint, with the parameters of the axis that held then."""
        self._drive.restore(saved['drive'])
        self._force, acting_force = profile_of(saved['force']), profile_of(saved['acting_force'])
        self._friction_scale, self._acting = float(saved['friction_scale']), None
        axis = with_friction_scaled(self._axis, self._friction_scale)
        self._simulator.restore(saved['simulator'], axis, self._drive.profile, acting_force)

    def _change_axis(self, friction_scale: float) -> None:
        try:
            axis = with_friction_scaled(self._axis, friction_scale)
            if axis != self._simulator.axis:
                self._simulator.change_axis(axis)
        except InputError as error:
            raise SolverError(f'the faults in force scale friction by {friction_scale:g}: {error}') from None

    def _set_inputs(self, pulse: float) -> None:
        inputs = self._simulator.inputs
        drive, force = self._drive.profile, self._force.plus(pulse) if pulse else self._force
        if force is not inputs.force and force == inputs.force:
            force = inputs.force
        if drive != inputs.drive:
            inputs.set(drive, force)
        elif force is not inputs.force:
            inputs.set(inputs.drive, force)
