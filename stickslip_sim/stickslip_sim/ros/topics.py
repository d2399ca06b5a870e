"""ROS endpoints made from the one list of topics in `recording.topics`."""

from collections.abc import Callable
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import ParameterEvent
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from stickslip_msgs.msg import (
    DriveVelocity,
    ExternalForce,
    FrictionForce,
    ModeEvent,
    RigEvent,
    RunInfo,
    SliderState,
    StepTiming,
)

from ..recording import flat_layout
from ..recording.topics import QosProfile, Topic

_TYPES = {
    f'{kind.__module__.split(".")[0]}/msg/{kind.__name__}': kind
    for kind in (DriveVelocity, ExternalForce, FrictionForce, ModeEvent, RigEvent, RunInfo, SliderState, StepTiming,
                 Clock, JointState, ParameterEvent, DiagnosticArray)
}


def message_type(topic: Topic) -> Any:
    """Return the message class of a topic."""
    return _TYPES[topic.type]


def qos(profile: QosProfile) -> QoSProfile:
    """Return rclpy's form of a quality of service."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=profile.depth,
        reliability=ReliabilityPolicy[profile.reliability.upper()],
        durability=DurabilityPolicy[profile.durability.upper()])


def publisher(node: Node, topic: Topic) -> Any:
    """Create the publisher of a topic."""
    return node.create_publisher(message_type(topic), topic.name, qos(topic.qos))


def subscription(node: Node, topic: Topic, callback: Callable[[Any], None]) -> Any:
    """Create a subscription of a topic."""
    return node.create_subscription(message_type(topic), topic.name, callback, qos(topic.qos))


def command_subscription(node: Node, topic: Topic, callback: Callable[[float], None]) -> Any:
    """Create a subscription of a topic of commands, a header and one number; the callback gets the number.

    It is read from the bytes, so that rclpy need not make an object of each message.
    """
    kind, layout = message_type(topic), flat_layout(topic.type)
    field, = layout.names

    def take(data: bytes) -> None:
        numbers = layout.numbers(data)
        callback(numbers[0] if numbers else getattr(deserialize_message(data, kind), field))

    return node.create_subscription(kind, topic.name, take, qos(topic.qos), raw=True)
