# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""ROS messages that are sent now and then, to and from plain fields; `publishers` packs those of every step."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterEvent

from stickslip_msgs.msg import RunInfo

from ...core.time_grid import NANOSECONDS

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
