"""From the simulator's words to ROS messages.  Existing messages are filled, which costs a fifth of making new ones."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterEvent

from stickslip_msgs.msg import FrictionForce, ModeEvent, RunInfo, SliderState

from ..words import Event, Sample

_NANOSECONDS = 1_000_000_000
_ARRAYS = {'sequence<boolean>': np.bool_, 'sequence<octet>': np.uint8, 'sequence<int64>': np.int64,
           'sequence<double>': np.float64}


def set_stamp(stamp: Time, nanoseconds: int) -> None:
    """Set a time stamp, ns since 1970."""
    stamp.sec, stamp.nanosec = divmod(nanoseconds, _NANOSECONDS)


def fill_state(message: SliderState, step: int, sample: Sample) -> None:
    """Fill in all but the header."""
    message.step = step
    message.time = sample.time
    message.position = sample.position
    message.velocity = sample.velocity
    message.acceleration = sample.acceleration
    message.drive_position = sample.drive_position
    message.drive_velocity = sample.drive_velocity
    message.drive_force = sample.drive_force
    message.rest_time = sample.rest_time
    message.mode = sample.mode
    message.direction = sample.direction


def fill_friction(message: FrictionForce, step: int, sample: Sample) -> None:
    """Fill in all but the header."""
    message.step = step
    message.time = sample.time
    message.force = sample.friction_force
    message.coefficient = sample.friction_coefficient
    message.contact_deflection = sample.contact_deflection
    message.mode = sample.mode
    message.direction = sample.direction


def fill_event(message: ModeEvent, step: int, event: Event) -> None:
    """Fill in all but the header."""
    message.step = step
    message.time = event.time
    message.kind = event.kind
    message.mode = event.mode
    message.direction = event.direction
    message.position = event.position
    message.velocity = event.velocity
    message.drive_force = event.drive_force
    message.friction_force = event.friction_force
    message.static_coefficient = event.static_coefficient
    message.rest_time = event.rest_time


def run_info(fields: Mapping[str, Any]) -> RunInfo:
    """Return the message with these fields (`recording.RunFacts.as_message`)."""
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
    """Return the event that tells of changed parameters."""
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
