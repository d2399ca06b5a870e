# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""ROS endpoints made from the one list of topics in `recording.topics`."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import Parameter as ParameterMessage
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

from ...bags.topics import QosProfile, Topic
from ...core.errors import InputError
from ...core.time_grid import NANOSECONDS
from ...recording import flat_layout

_HEADER = 4           # bytes before the content of a serialised message
COMMAND_SIZE = 4096   # bytes of a message that commands something; one of two joints takes some 200
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


def publisher(node: Node, topic: Topic, depth: int = 0) -> Any:
    """Create the publisher of a topic, which keeps `depth` messages for slow subscribers if that is more than usual."""
    profile = topic.qos._replace(depth=max(depth, topic.qos.depth))
    return node.create_publisher(message_type(topic), topic.name, qos(profile))


def subscription(node: Node, topic: Topic, callback: Callable[[Any], None]) -> Any:
    """Create a subscription of a topic."""
    return node.create_subscription(message_type(topic), topic.name, callback, qos(topic.qos))


def raw_subscription(node: Node, topic: Topic, callback: Callable[[bytes], None]) -> Any:
    """Create the node's subscription of a topic of commands, whose callback gets the bytes of each, unchecked."""
    return node.create_subscription(message_type(topic), topic.name, callback, qos(topic.qos_of_node), raw=True)


def message_of(topic: Topic, data: bytes) -> Any:
    """Return the message that these bytes are; raises InputError when they are too many, or none."""
    if len(data) > COMMAND_SIZE:
        raise InputError(topic.name, f'{len(data)} bytes', f'at most {COMMAND_SIZE} bytes',
                         'send commands of this axis')
    try:
        return deserialized(topic, data)
    except ValueError:
        raise InputError(topic.name, f'{len(data)} bytes', f'a {topic.type}', 'its sender is broken') from None


def deserialized(topic: Topic, data: bytes) -> Any:
    """Return the message of a topic that bytes from anyone are; raises ValueError when they are none."""
    if not _holds_its_padding(data):
        raise ValueError('shorter than its header says')
    try:
        return deserialize_message(data, message_type(topic))
    except RuntimeError as error:    # the base of what the middleware raises
        raise ValueError(str(error)) from None


def _holds_its_padding(data: bytes) -> bool:
    """Return whether behind the header of four bytes there are as many as its last two bits say (DDS-XTypes 7.6.3.1.2).

    Fast CDR from 2.3 on (Kilted) takes them off unseen, and reads beyond its memory when there are fewer.
    """
    return len(data) >= _HEADER and len(data) - _HEADER >= data[_HEADER - 1] % 4


def command_reader(topic: Topic) -> Callable[[bytes], float]:
    """Return what reads the number of a command from its bytes and raises InputError when they are no such command.

    Where it can, without an object of rclpy for each message.
    """
    layout = flat_layout(topic.type)
    field, = layout.names

    def read(data: bytes) -> float:
        numbers = layout.numbers(data)
        value: float = numbers[0] if numbers else getattr(message_of(topic, data), field)
        return value

    return read


# ROS messages that are sent now and then, to and from plain fields; `publishers` packs those of every step.

_ARRAYS = {'sequence<boolean>': np.bool_, 'sequence<octet>': np.uint8, 'sequence<int64>': np.int64,
           'sequence<double>': np.float64}


def set_stamp(stamp: Time, nanoseconds: int) -> None:
    """Set a time stamp, ns since 1970."""
    stamp.sec, stamp.nanosec = divmod(nanoseconds, NANOSECONDS)


def run_info_message(fields: Mapping[str, Any]) -> RunInfo:
    """Return the message with these fields (`recording.messages.run_info`)."""
    message = RunInfo()
    for name, value in fields.items():
        if name == 'header':
            _fill(message.header.stamp, value['stamp'])
        elif name == 'start_time':
            _fill(message.start_time, value)
        else:
            setattr(message, name, value)
    return message


def parameter_event(node_name: str, stamp_ns: int, changed: list[ParameterMessage]) -> ParameterEvent:
    """Return the event that reports changed parameters."""
    message = ParameterEvent(node=node_name, changed_parameters=changed)
    set_stamp(message.stamp, stamp_ns)
    return message


def fields_of(message: Any) -> dict[str, Any]:
    """Return the fields of any message as `recording.MessageCodec` takes them."""
    return {name: _field(getattr(message, name), kind) for name, kind in message.get_fields_and_field_types().items()}


def _field(value: Any, kind: str) -> Any:
    if hasattr(value, 'get_fields_and_field_types'):
        return fields_of(value)
    if kind in _ARRAYS:
        return np.array(value, dtype=_ARRAYS[kind])
    return [_field(item, '') for item in value] if kind.startswith('sequence') else value


def _fill(message: Any, fields: Mapping[str, Any]) -> None:
    for name, value in fields.items():
        setattr(message, name, value)
