# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An axis whose node is in this process: its services answer without the middleware, at a hundredth of the cost."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from stickslip_sim.ros.node.feed_axis import FeedAxis
from stickslip_sim.ros.programs import GivenParameters
from tests.support.node_processes import ros_args
from tests.support.ros_nodes import Asker


class AxisHere(Asker):
    """Asks the services of a node that runs."""

    def __init__(self, node: FeedAxis, services: Mapping[str, Callable[[Any, Any], Any]]) -> None:
        self.node, self._services = node, services

    def call(self, kind: Any, name: str, _: str = '', /, **request: Any) -> Any:
        return self._services[name](kind.Request(**request), kind.Response())


@contextmanager
def axis_here(*words: str | Path) -> Iterator[AxisHere]:
    """Run a node with words of a command line; what it logs goes to standard error: for `capfd`."""
    services: dict[str, Callable[[Any, Any], Any]] = {}

    def offer(_: Node, __: Any, name: str, callback: Callable[[Any, Any], Any], **___: Any) -> None:
        services[name.split('/')[-1]] = callback

    args = ros_args(*words)
    given = GivenParameters.read(args)
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Node, 'create_service', offer)
            node = FeedAxis(given, lambda: False)
        node.begin()
        try:
            yield AxisHere(node, services)
        finally:
            node.end()
            node.destroy_node()
    finally:
        rclpy.shutdown()
