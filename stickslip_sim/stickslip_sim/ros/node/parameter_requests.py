# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a request to set parameters changes, and how it is refused what may not change; the same for every node."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter

from ...config.parameter import Parameter as Entry
from ...core.errors import InputError
from ...scene.text import yaml_value

_NOTHING = (None, 'None', 'null')   # what `ros2 param load` sends for a parameter that had no value
# What may stand for a list of doubles; param load sends some as one text.
_LISTS = Parameter.Type.INTEGER_ARRAY, Parameter.Type.STRING_ARRAY, Parameter.Type.STRING


def changes_of(node: Node, request: Sequence[Parameter], entries: Mapping[str, Entry],
               in_force: Mapping[str, object]) -> list[Parameter]:
    """Return the parameters that a request sets, without those that may not change and stay as they are.

    So `ros2 param load` takes what `ros2 param dump` wrote.  Raises InputError on one that may not change and would.
    """
    wanted = [promoted(parameter, entries.get(parameter.name)) for parameter in request]
    return [parameter for parameter in wanted
            if not _stays(node, parameter, entries.get(parameter.name), in_force.get(parameter.name))]


def promoted(parameter: Parameter, entry: Entry | None) -> Parameter:
    """Return the doubles that are meant by whole numbers, as in a scene file, and by texts of `ros2 param load`."""
    value: Any = parameter.value
    kind = entry and entry.type
    if kind == 'double' and (parameter.type_ == Parameter.Type.INTEGER or _is_loaded(value)):
        return Parameter(parameter.name, Parameter.Type.DOUBLE, float(value))
    if kind == 'double_array' and parameter.type_ in _LISTS:
        numbers = value[1:-1].split(', ') if isinstance(value, str) else value
        if numbers and (parameter.type_ == Parameter.Type.INTEGER_ARRAY or all(map(_is_loaded, numbers))):
            return Parameter(parameter.name, Parameter.Type.DOUBLE_ARRAY, [float(number) for number in numbers])
    return parameter


def _is_loaded(value: object) -> bool:
    """Return whether this is Python's text of a double: `param load` sends inf and 1e-06 as such, and lists of them."""
    with suppress(ValueError):
        return isinstance(value, str) and repr(float(value)) == value
    return False


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
