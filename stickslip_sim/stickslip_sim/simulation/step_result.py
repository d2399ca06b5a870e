# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a step brings forth, and what a run counts."""

from collections.abc import Iterable, Sequence
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


# When something was wrong with the rig: faults and time-outs as spans, refused and lost commands as instants.

_INSTANTS = {RigEventKind.COMMAND_REFUSED: 'refused', RigEventKind.COMMAND_LIMITED: 'limited',
             RigEventKind.COMMAND_LOST: 'lost', RigEventKind.TIME_LOST: 'time lost'}
TIME_OUT = 'time-out'


class Mark(NamedTuple):
    """Something that went on from `begin` to `end` (s; equal: an instant); `number` of them, where one is known.

    It `is_of_host` where it is about the timing of the machine or of who commands, and not about the axis.
    """

    begin: float
    end: float
    label: str
    number: int = 1
    is_of_host: bool = False

    @property
    def is_span(self) -> bool:
        """Whether it took time."""
        return self.end > self.begin


class TimedRigEvent(NamedTuple):
    """A rig event and when it was, s; `fault` is the kind of the fault, if it is about one."""

    time: float
    kind: RigEventKind
    id: str
    fault: str
    number: int


def marks_of_faults(faults: Sequence[Fault], end: float) -> list[Mark]:
    """Return when the faults of a scene are in force, up to the end of a run, s."""
    return [Mark(fault.start, min(fault.start + fault.duration, end), fault.kind) for fault in faults
            if fault.start < end]


def marks_of_events(events: Iterable[TimedRigEvent], begin: float, end: float) -> list[Mark]:
    """Return what the rig events of a run from `begin` to `end` (s) amount to, in the order in which they ended.

    What ends without a start was there before the recording; what starts without an end goes on.
    """
    marks: list[Mark] = []
    open_since: dict[str, tuple[float, str]] = {}
    timed_out = False    # whether a time-out is known of
    for event in events:
        if event.kind in _INSTANTS:
            marks.append(Mark(event.time, event.time, _INSTANTS[event.kind], max(event.number, 1)))
        elif event.kind == RigEventKind.FAULT_BEGIN:
            open_since[event.id] = event.time, event.fault
        elif event.kind == RigEventKind.COMMAND_TIMEOUT:
            open_since.setdefault('', (event.time, TIME_OUT))
            timed_out = True
        elif event.kind == RigEventKind.COMMAND_RESUMED or (event.kind == RigEventKind.FAULT_CLEARED and not event.id):
            if '' in open_since or not timed_out:    # a command after a time-out that was cleared ends none
                since, _ = open_since.pop('', (begin, ''))
                marks.append(Mark(since, event.time, TIME_OUT))
            timed_out = True
        elif event.id in open_since:      # ended or cleared; one that was cleared before it began is none
            since, label = open_since.pop(event.id)
            marks.append(Mark(since, event.time, label))
        elif event.kind == RigEventKind.FAULT_END:
            marks.append(Mark(begin, event.time, event.fault))
    return [*marks, *(Mark(since, end, label) for since, label in open_since.values())]
