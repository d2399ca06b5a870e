# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A whole controller: cascade, with compensation or without, and the limit of its drive."""

import math
from dataclasses import dataclass
from typing import NamedTuple

from ..core.time_grid import NANOSECONDS
from ..simulation import Measured
from .friction_branches import BranchCompensation, Slide
from .moves import Moves, Setpoint

# The usual cascade: P for the position, PI for the velocity, the setpoint's velocity fed forward.
#
#     w = v_set + K_v (x_set − x)                       position loop
#     u = w + K_p (w − ẋ) + (K_p / T_n) ∫ (w − ẋ) dt    velocity loop; u is the velocity of the drive
#
# The drive sets the velocity of one end of the spring and the slider is measured at the other, so that K_p makes spring
# and damper of the drive act 1 + K_p times as strong: the axis gets √(1 + K_p) times its natural frequency and damping
# ratio.  (Altintas, Verl, Brecher, Uriarte and Pritschow 2011, Machine tool feed drives, CIRP Annals 60.)

@dataclass(frozen=True, slots=True)
class Cascade:
    """Gains: position K_v (1/s), velocity K_p (no unit) and its integral time T_n (s; infinite: no integral part)."""

    position_gain: float = 10.0
    velocity_gain: float = 8.0
    integral_time: float = 0.1

    def wanted_velocity(self, setpoint: Setpoint, measured: Measured) -> float:
        """Return w, the velocity that the slider should have, m/s."""
        return setpoint.velocity + self.position_gain * (setpoint.position - measured.slider_position)

    def drive_velocity(self, wanted: float, measured: Measured, integral: float) -> float:
        """Return u, m/s, `integral` (m/s) being the part of it that has been summed up so far."""
        return wanted + self.velocity_gain * (wanted - measured.slider_velocity) + integral

    def integrated(self, integral: float, wanted: float, measured: Measured, period: float) -> float:
        """Return the integral part after another `period` (s)."""
        if math.isinf(self.integral_time):
            return integral
        return integral + self.velocity_gain * (wanted - measured.slider_velocity) * period / self.integral_time


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


# A controller that follows its moves over time, from one measurement to the next.

class MoveProgress(NamedTuple):
    """How far it has come since the moves began."""

    begin_ns: int      # the time of the measurement with which they began
    origin: float      # m, the slider's position then
    latest_ns: int     # the time of the latest measurement
    memory: Memory


class Answer(NamedTuple):
    """The command and the memory after one measurement."""

    progress: MoveProgress
    setpoint: Setpoint
    command: DriveCommand
    is_new: bool       # the moves begin with it


@dataclass(frozen=True, slots=True)
class Following:
    """Lets a controller follow moves that begin where the slider is; `max_gap` (s) bounds the time that it may be deaf.

    After a longer gap, or when time goes back, it knows nothing any more and begins anew.
    """

    controller: Controller
    moves: Moves
    max_gap: float = 0.5

    def answer(self, progress: MoveProgress | None, time_ns: int, measured: Measured) -> Answer:
        """Return the answer to a measurement at a time; `progress` is that of the latest one, None for the first."""
        is_new = progress is None or not 0 <= time_ns - progress.latest_ns <= self.max_gap * NANOSECONDS
        if progress is None or is_new:
            progress = MoveProgress(time_ns, measured.slider_position, time_ns, AT_REST)
        relative = self.moves.at((time_ns - progress.begin_ns) / NANOSECONDS)
        setpoint = Setpoint(progress.origin + relative.position, relative.velocity)
        period = (time_ns - progress.latest_ns) / NANOSECONDS
        memory, command = self.controller.step(progress.memory, setpoint, measured, period)
        return Answer(progress._replace(latest_ns=time_ns, memory=memory), setpoint, command, is_new)
