# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A controller that follows its moves over time, from one measurement to the next."""

from dataclasses import dataclass
from typing import NamedTuple

from ..core.time_grid import NANOSECONDS
from ..rig import Measured
from .drive_controller import AT_REST, Controller, DriveCommand, Memory
from .moves import Moves, Setpoint


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
