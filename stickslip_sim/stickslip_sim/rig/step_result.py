# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a step brings forth, and what a run counts."""

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

from ..core.types import Event, Sample
from .encoder import Measured
from .faults import Fault


class RigEventKind(IntEnum):
    """What happened to the rig; as in stickslip_msgs/RigEvent."""

    COMMAND_REFUSED = 0
    COMMAND_LIMITED = 1
    COMMAND_TIMEOUT = 2
    COMMAND_RESUMED = 3
    COMMAND_LOST = 4
    FAULT_INJECTED = 5
    FAULT_BEGIN = 6
    FAULT_END = 7
    FAULT_CLEARED = 8
    TIME_LOST = 9


class RigEvent(NamedTuple):
    """One thing that happened; `value` in the unit of the thing, `number` where only the first of many is reported."""

    kind: RigEventKind
    id: str                      # of a fault, or the name of a command
    text: str                    # for people
    value: float = 0.0
    number: int = 1
    fault: Fault | None = None


class StepResult(NamedTuple):
    """One step: what went in, and what came out.  Step n reaches from (n − 1)/rate to n/rate; step 0 is the start."""

    step: int
    velocity: float | None       # m/s: the command taken at its start, None without a new one
    force: float | None          # N
    rig_events: list[RigEvent]   # at its start
    events: list[Event]
    sample: Sample               # at its end
    measured: Measured | None    # at its end; None without encoders, or when the measurement was lost


@dataclass(slots=True)
class Counts:
    """What befell the drive velocities of a run."""

    heard: int = 0        # reached the drive
    refused: int = 0      # after a time-out with on_timeout: fault
    lost: int = 0
    limited: int = 0      # changed by a limit of the drive
    timed_out: int = 0    # times that they stopped coming
