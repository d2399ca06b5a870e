# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where the results of the steps go: each message is packed once, and its bytes are published and recorded.

A message that nobody hears and no bag records is not made.
"""

from collections import deque
from collections.abc import Callable
from typing import Any, Protocol

from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message

from stickslip_msgs.msg import FrictionForce, ModeEvent, SliderState
from stickslip_msgs.msg import RigEvent as RigEventMessage

from ...bags import topics
from ...bags.topics import RECORDED, RIG_EVENT, Topic
from ...core.types import Event, EventKind, Instant, Mode, Sample
from ...figures.cycles import EventTally
from ...recording import flat_layout
from ...recording.messages import Packer
from ...simulation import RigEvent, RigEventKind, StepResult
from .endpoints import publisher, set_stamp


class Recorder(Protocol):
    """What takes the messages of a bag; waits only when asked to."""

    def put(self, topic_index: int, data: bytes, log_time_ns: int, publish_time_ns: int, sequence: int) -> None:
        """Take a message."""

    def wait_for_room(self) -> None:
        """Wait while too many messages wait to be written."""


class Publishers:
    """Publishes what the step loop hands out, stamped `start_ns` (ROS time at simulation time 0) + simulation time.

    Each topic keeps `depth` messages for slow subscribers if that is more than usual.
    `delay` returns by how much simulation time has fallen behind ROS time since, ns, so that stamps do not.
    """

    def __init__(self, node: Node, delay: Callable[[], int], depth: int = 0) -> None:
        self.begin_ns, self._delay = 0, delay
        self.recorder: Recorder | None = None
        self.events = EventTally()    # of the run so far
        self._state = _Port(node, topics.SLIDER_STATE, depth)
        self._friction = _Port(node, topics.FRICTION_FORCE, depth)
        self._event = _Port(node, topics.MODE_EVENT, depth)
        self._time_ns = 0     # of the latest state
        self._commands = [(RECORDED.index(topic), flat_layout(topic.type))
                          for topic in (topics.DRIVE_VELOCITY, topics.EXTERNAL_FORCE)]

    @property
    def start_ns(self) -> int:
        """The stamp that simulation time 0 would have, had time gone on without a break: `begin_ns` and the delay."""
        return self.begin_ns + self._delay()

    def begin_run(self, start_ns: int, mode: Mode) -> None:
        """Let simulation time 0 be a ROS time, ns, at which the slider is in a mode; forget the events."""
        self.begin_ns = start_ns
        self._time_ns = 0
        self.events = EventTally(mode)

    def take(self, result: StepResult) -> None:
        """Record the commands of a step; publish and record its events, and the state at its end."""
        for kind, value in enumerate((result.velocity, result.force)):
            if value is not None and self.recorder is not None:
                self.command(kind, result.step, self._time_ns, value)
        for event in result.events:
            self.event(max(result.step, 1), event)
        self.sample(result.step, result.sample)

    def keep_pace(self, _: StepResult) -> None:
        """Let time that nothing else drives wait for the bag, so that nothing is missing from it."""
        if (recorder := self.recorder) is not None:
            recorder.wait_for_room()

    def event(self, step: int, event: Event) -> None:
        """Publish an event that fell into a step; events of kind knot are not published."""
        self.events.add(event)
        if event.kind == EventKind.KNOT:
            return
        self._send(self._event, event.instant.nanoseconds, step, event)

    def sample(self, step: int, sample: Sample) -> None:
        """Publish the state at the end of a step."""
        time_ns = self._time_ns = sample.instant.nanoseconds
        self._send(self._state, time_ns, step, sample)
        self._send(self._friction, time_ns, step, sample)

    def record_start(self, sample: Sample) -> None:
        """Record the state at simulation time 0, which was published before."""
        for port in (self._state, self._friction):
            self.record(port.index, port.pack(self.start_ns, 0, sample), 0, 0)

    def state_messages(self, step: int, sample: Sample) -> tuple[SliderState, FrictionForce]:
        """Return the messages of a state."""
        stamp_ns = self.start_ns + sample.instant.nanoseconds
        return (deserialize_message(self._state.pack(stamp_ns, step, sample), SliderState),
                deserialize_message(self._friction.pack(stamp_ns, step, sample), FrictionForce))

    def event_message(self, step: int, event: Event) -> ModeEvent | None:
        """Return the message of an event that is published."""
        if event.kind == EventKind.KNOT:
            return None
        return deserialize_message(self._event.pack(self.start_ns + event.instant.nanoseconds, step, event), ModeEvent)

    def command(self, kind: int, step: int, time_ns: int, value: float) -> None:
        """Record a command that holds from the start of a step."""
        index, layout = self._commands[kind]
        self.record(index, layout.pack(self.start_ns + time_ns, value), time_ns, step)

    def record(self, index: int, data: bytes, time_ns: int, step: int) -> None:
        """Hand a message to the recorder, if there is one."""
        if self.recorder is not None:
            self.recorder.put(index, data, time_ns, self.start_ns + time_ns, step)

    def record_message(self, topic: Topic, message: Any, time_ns: int, step: int) -> None:
        """Hand a message that is published elsewhere to the recorder, if there is one."""
        self.record(RECORDED.index(topic), serialize_message(message), time_ns, step)

    def _send(self, port: '_Port', time_ns: int, step: int, output: Sample | Event) -> None:
        is_heard = port.is_heard()
        if not is_heard and self.recorder is None:
            return
        data = port.pack(self.start_ns + time_ns, step, output)
        if is_heard:
            port.publish(data)
        self.record(port.index, data, time_ns, step)


class _Port:
    """A publisher, the packer of its messages and the place of its topic in a bag."""

    def __init__(self, node: Node, topic: Topic, depth: int) -> None:
        self.index = RECORDED.index(topic)
        self.pack = Packer(topic).pack
        out = publisher(node, topic, depth)
        self.publish, self.is_heard = out.publish, out.get_subscription_count


# Log lines of the step loop, written by the thread of the executor: to write one may take longer than a step.

class DeferredLog:
    """Takes lines from any thread; `write` hands them to `log`, that of a node."""

    def __init__(self, log: Any) -> None:
        self._log = log
        self._lines: deque[tuple[bool, str]] = deque()    # whether it warns, and its text

    def info(self, text: str) -> None:
        """Take a line for information."""
        self._lines.append((False, text))

    def warning(self, text: str) -> None:
        """Take a warning."""
        self._lines.append((True, text))

    def write(self) -> None:
        """Write what has been taken since the last time."""
        for _ in range(len(self._lines)):
            warns, text = self._lines.popleft()
            if warns:
                self._log.warning(text)
            else:    # a line of its own: rclpy refuses to log with two severities from one
                self._log.info(text)


# What happens to the rig, published on `rig_event` and in the bag.

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
