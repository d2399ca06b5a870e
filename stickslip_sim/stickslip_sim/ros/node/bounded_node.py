# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A node that answers no endless request: it hears no command, and no Ctrl-C, while it answers one."""

from collections.abc import Callable
from typing import Any

from rclpy.node import Node

MOST_PARAMETERS = 1000   # that one request may set or ask for: a second or two
_LISTS = ('parameters', 'names', 'prefixes')

_Answer = Callable[[Any, Any], Any]


class BoundedNode(Node):  # type: ignore[misc]
    """A node with bounded requests, also of the services for parameters, which rclpy makes."""

    def create_service(self, srv_type: Any, srv_name: str, callback: _Answer, **options: Any) -> Any:
        """Offer a service; a request with too long a list gets the answer without results, and a warning in the log."""
        def answer(request: Any, response: Any) -> Any:
            count = max(len(getattr(request, name, ())) for name in _LISTS)
            if count <= MOST_PARAMETERS:
                return callback(request, response)
            self.get_logger().warning(f'{srv_name} = {count} parameters is refused: must be at most {MOST_PARAMETERS}'
                                      ' in one request; send several', throttle_duration_sec=1.0)
            return response

        return super().create_service(srv_type, srv_name, answer, **options)
