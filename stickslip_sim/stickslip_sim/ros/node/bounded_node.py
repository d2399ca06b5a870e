# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A node that answers no endless request: it hears no command, and no Ctrl-C, while it answers one."""

from collections.abc import Callable
from typing import Any

from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.parameter import Parameter

from ..process.environment import refusing, variables
from ..process.given_parameters import GivenParameters

SIM_TIME = 'use_sim_time'
MOST_PARAMETERS = 1000   # that one request may set or ask for: a second or two
_LISTS = ('parameters', 'names', 'prefixes')

_Answer = Callable[[Any, Any], Any]


class BoundedNode(Node):  # type: ignore[misc]
    """A node with bounded requests, also of the services for parameters, which rclpy makes.

    `given` are its parameters on the command line.  Raises InputError when ROS refuses name, parameters or environment.
    """

    def __init__(self, name: str, given: GivenParameters) -> None:
        with refusing('ROS parameters or environment', variables(), ParameterException):
            super().__init__(name)
        self.given = given.of(self.get_fully_qualified_name())
        for path in self.given.passed_over:
            self.get_logger().warning(f'{path} has no section for {self.get_fully_qualified_name()}')
        sim_time = self.given.values.get(SIM_TIME)
        if sim_time not in (None, self.get_parameter(SIM_TIME).value):    # rclpy chose another section
            super().set_parameters_atomically([Parameter(SIM_TIME, value=sim_time)])

    def is_ready(self) -> bool:
        """Return whether it may begin."""
        return True

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter; one without a value as such, where rclpy would refuse all that is asked for with it."""
        if self.has_parameter(name):
            return self.get_parameter_or(name)
        parameter: Parameter = super().get_parameter(name)
        return parameter

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
