# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a request to set parameters changes, and how it is refused what may not change; the same for every node."""

from collections.abc import Mapping, Sequence
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter

from ...config.parameter import Parameter as Entry
from ...core.errors import InputError
from ...scene.text import yaml_value

_NOTHING = (None, 'None', 'null')   # what `ros2 param load` sends for a parameter that had no value


def changes_of(node: Node, request: Sequence[Parameter], entries: Mapping[str, Entry],
               in_force: Mapping[str, object]) -> list[Parameter]:
    """Return the parameters that a request sets, without those that may not change and stay as they are.

    So `ros2 param load` takes what `ros2 param dump` wrote.  Raises InputError on one that may not change and would.
    """
    wanted = [promoted(parameter, entries.get(parameter.name)) for parameter in request]
    return [parameter for parameter in wanted
            if not _stays(node, parameter, entries.get(parameter.name), in_force.get(parameter.name))]


def promoted(parameter: Parameter, entry: Entry | None) -> Parameter:
    """Return whole numbers as the doubles that they stand for, as in a scene file, and the infinity of `param load`."""
    value: Any = parameter.value
    if entry is not None and entry.type == 'double' and (parameter.type_ == Parameter.Type.INTEGER or value == 'inf'):
        return Parameter(parameter.name, Parameter.Type.DOUBLE, float(value))
    if entry is not None and entry.type == 'double_array' and parameter.type_ == Parameter.Type.INTEGER_ARRAY:
        return Parameter(parameter.name, Parameter.Type.DOUBLE_ARRAY, [float(number) for number in value])
    return parameter


def _stays(node: Node, parameter: Parameter, entry: Entry | None, now: object) -> bool:
    """Return whether to pass a parameter over, whose value is `now`; raises InputError when it may not change."""
    name, value = parameter.name, parameter.value
    if entry is None:
        if not node.has_parameter(name) or not node.describe_parameter(name).read_only:
            return False
        now = node.get_parameter(name).value
        is_same, text = value == now, str(now).lower()
    elif now in (None, ()) and value in _NOTHING:
        return True
    elif entry.live:
        return False
    else:
        is_same, text = _is_same(entry, value, now), 'left out' if now is None else yaml_value(entry, now)
    if not is_same:
        raise InputError(name, value, f'{text}, as at the start',
                         'it cannot change while the node runs: start the node with another')
    return True


def _is_same(entry: Entry, value: object, now: object) -> bool:
    try:
        return entry.checked(value) == now
    except InputError:
        return False
