# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Requests that would keep the node busy for minutes: answered at once, without results, and reported in the log."""

from pathlib import Path
from typing import Any

import pytest

from tests.support.node_processes import running
from tests.support.ros_nodes import Client, client

pytestmark = pytest.mark.ros

MANY = 20_000    # half a minute of work


def requests() -> list[tuple[Any, str, dict[str, Any]]]:
    from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
    from rcl_interfaces.srv import (
        DescribeParameters,
        GetParameters,
        GetParameterTypes,
        ListParameters,
        SetParameters,
        SetParametersAtomically,
    )

    mass = Parameter(name='axis.mass', value=ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=351.0))
    return [
        (SetParameters, 'set_parameters', {'parameters': [mass] * MANY}),
        (SetParametersAtomically, 'set_parameters_atomically', {'parameters': [mass] * MANY}),
        (GetParameters, 'get_parameters', {'names': ['axis.mass'] * MANY}),
        (GetParameterTypes, 'get_parameter_types', {'names': ['axis.mass'] * MANY}),
        (DescribeParameters, 'describe_parameters', {'names': ['axis.mass'] * MANY}),
        (ListParameters, 'list_parameters', {'prefixes': ['axis'] * MANY}),
    ]


def is_empty(response: Any) -> bool:
    return bool(response == type(response)())


@pytest.mark.parametrize(('program', 'node'), [('sim_node', 'feed_axis'), ('cascade_controller', 'cascade_controller')])
def test_endless_lists(program: str, node: str, tmp_path: Path) -> None:
    with client() as asker, running(program=program, folder=tmp_path) as process:
        for kind, name, request in requests():
            assert is_empty(asker.call(kind, name, node, **request)), name
        assert ordinary(asker, node)
        code, errors = process.end()
    assert code == 0
    assert f'{MANY} parameters is refused: must be at most 1000' in errors


def ordinary(asker: Client, node: str) -> bool:
    """Whether a tool that asks for everything still gets it, as `ros2 param dump` does."""
    from rcl_interfaces.srv import GetParameters, ListParameters

    names = asker.call(ListParameters, 'list_parameters', node).result.names
    return len(asker.call(GetParameters, 'get_parameters', node, names=names).values) == len(names) > 1
