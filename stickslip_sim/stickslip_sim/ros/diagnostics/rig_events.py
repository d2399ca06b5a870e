# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What happens to the rig, published on `rig_event` and in the bag."""

from rclpy.node import Node
from rclpy.serialization import serialize_message

from stickslip_msgs.msg import RigEvent as RigEventMessage

from ...core.types import Instant
from ...recording.topics import RECORDED, RIG_EVENT
from ...rig import RigEvent, RigEventKind, StepResult
from ..node.conversion import set_stamp
from ..node.deferred_log import DeferredLog
from ..node.endpoints import publisher
from ..node.publishers import Publishers

_WARNINGS = (RigEventKind.COMMAND_TIMEOUT, RigEventKind.COMMAND_RESUMED, RigEventKind.COMMAND_LIMITED)
_FAULTS = (RigEventKind.FAULT_BEGIN, RigEventKind.FAULT_END, RigEventKind.FAULT_CLEARED)
_QUIET = 1.0   # s of simulation time between two lines of a kind in the log


class RigEvents:
    """Publishes, records and logs the events of the steps, and those that come from elsewhere."""

    def __init__(self, node: Node, publishers: Publishers, log: DeferredLog) -> None:
        self._log = log
        self._publishers = publishers
        self._publish = publisher(node, RIG_EVENT).publish
        self._index = RECORDED.index(RIG_EVENT)
        self._reached = Instant(0.0, 0.0)                # with the latest step
        self._quiet_until: dict[RigEventKind, float] = {}

    def take(self, result: StepResult) -> None:
        """Report what happened at the start of a step; called before its state goes out."""
        if result.step == 0:
            self._reached = Instant(0.0, 0.0)
            self._quiet_until.clear()
        for event in result.rig_events:
            self.report(result.step, self._reached.nanoseconds, event)
        self._reached = result.sample.instant

    def report(self, step: int, time_ns: int, event: RigEvent) -> None:
        """Report an event that holds from the start of a step, which is at that simulation time."""
        message = RigEventMessage(step=step, time=time_ns * 1e-9, kind=int(event.kind), id=event.id, value=event.value,
                           count=event.number, text=event.text)
        if event.fault is not None:
            message.fault, message.start, message.duration = event.fault.kind, event.fault.start, event.fault.duration
        set_stamp(message.header.stamp, self._publishers.start_ns + time_ns)
        data = serialize_message(message)
        self._publish(data)
        self._publishers.record(self._index, data, time_ns, step)
        self._write(time_ns * 1e-9, event)

    def _write(self, time: float, event: RigEvent) -> None:
        line = f't = {time:g} s: {event.id + ": " if event.id else ""}{event.text}'
        if event.kind in _FAULTS:
            self._log.info(line)
        elif event.kind in _WARNINGS and time >= self._quiet_until.get(event.kind, 0.0):
            self._quiet_until[event.kind] = time + _QUIET
            self._log.warning(line)
