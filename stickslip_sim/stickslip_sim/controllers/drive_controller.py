# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A whole controller: cascade, with compensation or without, and the limit of its drive."""

from dataclasses import dataclass
from typing import NamedTuple

from ..rig import Measured
from .cascade import Cascade
from .friction_branches import BranchCompensation, Slide
from .moves import Setpoint


class Memory(NamedTuple):
    """The memory of a controller from one step to the next."""

    integral: float  # m/s, of the velocity loop
    slide: Slide


class DriveCommand(NamedTuple):
    """The velocity for the drive, and whether the limit of the drive holds it back."""

    velocity: float  # m/s
    is_limited: bool


AT_REST = Memory(0.0, Slide())


@dataclass(frozen=True, slots=True)
class Controller:
    """`compensation` may be None; `max_velocity` (m/s) is the limit of the drive."""

    cascade: Cascade
    compensation: BranchCompensation | None = None
    max_velocity: float = 1.0

    def step(self, memory: Memory, setpoint: Setpoint, measured: Measured,
             period: float) -> tuple[Memory, DriveCommand]:
        """Return the command from now on, and the new memory; `period` (s) went by since the latest.

        The integral part stands still while the limit holds the command back and it would only wind up.
        """
        wanted = self.cascade.wanted_velocity(setpoint, measured)
        integral = self.cascade.integrated(memory.integral, wanted, measured, period)
        slide, extra = self._compensate(memory.slide, setpoint, wanted, measured)
        velocity = self.cascade.drive_velocity(wanted, measured, integral) + extra
        limited = max(-self.max_velocity, min(velocity, self.max_velocity))
        if (velocity - limited) * (integral - memory.integral) > 0.0:
            integral = memory.integral
        return Memory(integral, slide), DriveCommand(limited, limited != velocity)

    def _compensate(self, slide: Slide, setpoint: Setpoint, wanted: float,
                    measured: Measured) -> tuple[Slide, float]:
        """Return how the slide goes on and the velocity that is added, m/s: none while the setpoint rests."""
        if self.compensation is None:
            return slide, 0.0
        slide = slide.going_on(measured.slider_velocity, self.compensation.drive_force(measured))
        if setpoint.velocity == 0.0:
            return slide, 0.0
        return slide, self.compensation.drive_velocity(slide, wanted, measured)
