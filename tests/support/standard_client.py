# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Calls standard services of a simulator, in a process that finds their package; prints the answers as JSON.

python3 -m tests.support.standard_client 'NAME {"field": value}' ...
"""

import json
import sys
from collections.abc import Mapping
from typing import Any

import rclpy
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node
from simulation_interfaces import srv

from stickslip_sim.ros.node.endpoints import fields_of


def main() -> None:
    rclpy.init()
    node = Node('standard_client')
    answers = [ask(node, *words.split(' ', 1)) for words in sys.argv[1:]]
    print(json.dumps(answers, default=list))
    rclpy.shutdown()


def ask(node: Node, name: str, fields: str = '{}') -> Any:
    kind = getattr(srv, ''.join(part.title() for part in name.split('_')))
    client = node.create_client(kind, f'feed_axis/{name}')
    assert client.wait_for_service(20.0), name
    greet(node)
    request = kind.Request()
    fill(request, json.loads(fields))
    future = client.call_async(request)
    rclpy.spin_until_future_complete(node, future, timeout_sec=20.0)
    return fields_of(future.result())


def greet(node: Node) -> None:
    """Wait until the simulator knows every client made so far, as the client in ros_nodes.py does."""
    client = node.create_client(GetParameters, 'feed_axis/get_parameters')
    assert client.wait_for_service(20.0)
    for _ in range(20):
        future = client.call_async(GetParameters.Request())
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        if future.done():
            return
    raise AssertionError('the simulator does not answer')


def fill(message: Any, fields: Mapping[str, Any]) -> None:
    for name, value in fields.items():
        if isinstance(value, Mapping):
            fill(getattr(message, name), value)
        else:
            setattr(message, name, value)


if __name__ == '__main__':
    main()
