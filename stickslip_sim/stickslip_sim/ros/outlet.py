"""Where the products of the steps go: each message is filled in place, serialized once, published and recorded."""

from collections import deque
from typing import Any, Protocol

from rclpy.node import Node
from rclpy.serialization import serialize_message

from stickslip_msgs.msg import DriveVelocity, ExternalForce, FrictionForce, ModeEvent, SliderState

from ..recording import topics as names
from ..recording.topics import RECORDED, Topic
from ..words import Event, EventKind, Mode, Sample
from . import conversion
from .topics import publisher

_KEPT_EVENTS = 20_000   # for the figures of a run; an hour of stick-slip at 5 events a second


class Recorder(Protocol):
    """What takes the messages of a bag; never waits."""

    def put(self, topic_index: int, data: bytes, log_time_ns: int, publish_time_ns: int, sequence: int) -> None:
        """Take a message."""


class Outlet:
    """Publishes what the step loop hands out, stamped `start_ns` (ROS time at simulation time 0) + simulation time."""

    def __init__(self, node: Node) -> None:
        self.start_ns = 0
        self.recorder: Recorder | None = None
        self.events: deque[Event] = deque(maxlen=_KEPT_EVENTS)
        self.first_mode = Mode.STICK
        self._state, self._friction, self._event = SliderState(), FrictionForce(), ModeEvent()
        self._friction.header = self._state.header    # they always share their stamp
        self._state_out = _Port(node, names.SLIDER_STATE)
        self._friction_out = _Port(node, names.FRICTION_FORCE)
        self._event_out = _Port(node, names.MODE_EVENT)
        self._commands: list[tuple[Any, str, int]] = [
            (DriveVelocity(), 'velocity', RECORDED.index(names.DRIVE_VELOCITY)),
            (ExternalForce(), 'force', RECORDED.index(names.EXTERNAL_FORCE))]

    def begin_run(self, start_ns: int) -> None:
        """Let simulation time 0 be a ROS time, ns, and forget the events."""
        self.start_ns = start_ns
        self.events.clear()

    def event(self, step: int, event: Event) -> None:
        """Publish an event that fell into a step; knots of the friction table are nobody's business."""
        if event.kind == EventKind.KNOT:
            return
        self.events.append(event)
        time_ns = event.instant.nanoseconds
        message = self._event
        conversion.set_stamp(message.header.stamp, self.start_ns + time_ns)
        conversion.fill_event(message, step, event)
        self._send(self._event_out, message, time_ns, step)

    def sample(self, step: int, sample: Sample) -> None:
        """Publish the state at the end of a step."""
        if step == 0:
            self.first_mode = sample.mode
        time_ns = int(sample.second) * 1_000_000_000 + round(sample.fraction * 1e9)
        state, friction = self._state, self._friction
        conversion.set_stamp(state.header.stamp, self.start_ns + time_ns)
        conversion.fill_state(state, step, sample)
        conversion.fill_friction(friction, step, sample)
        self._send(self._state_out, state, time_ns, step)
        self._send(self._friction_out, friction, time_ns, step)

    def command(self, kind: int, step: int, time_ns: int, value: float) -> None:
        """Record a command that holds from the begin of a step on."""
        if self.recorder is None:
            return
        message, field, index = self._commands[kind]
        setattr(message, field, value)
        conversion.set_stamp(message.header.stamp, self.start_ns + time_ns)
        self.record(index, serialize_message(message), time_ns, step)

    def record(self, index: int, data: bytes, time_ns: int, step: int) -> None:
        """Hand a message to the recorder, if there is one."""
        if self.recorder is not None:
            self.recorder.put(index, data, time_ns, self.start_ns + time_ns, step)

    def _send(self, port: '_Port', message: Any, time_ns: int, step: int) -> None:
        data = serialize_message(message)
        port.publish(data)
        if self.recorder is not None:
            self.recorder.put(port.index, data, time_ns, self.start_ns + time_ns, step)


class _Port:
    """A publisher and the place of its topic in a bag."""

    def __init__(self, node: Node, topic: Topic) -> None:
        self.index = RECORDED.index(topic)
        self.publish = publisher(node, topic).publish
