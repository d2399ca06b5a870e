# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The client of an axis: finds it, knows its scene, and in lock-step makes its steps."""

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

from rcl_interfaces.srv import GetParameters
from rclpy.client import Client
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from std_srvs.srv import Trigger

from stickslip_msgs.msg import ModeEvent, SliderState
from stickslip_msgs.srv import Step

from ..bags.topics import SLIDER_STATE
from ..core.errors import InputError, RefusedError, StickslipError
from ..scene import Scene, scene_from_values
from ..scene.load import NODE
from ..scene.schema import PARAMETERS
from ..simulation import Measured
from .programs import make_executor

_POLL = 0.1        # s: how soon `is_over` is acted on
_GREETING = 1.0    # s until an axis is asked again
_SILENCE = 2.0     # s without an axis, until that is said
_PATIENCE = 10.0   # s for an answer


class LockStep:
    """Makes the steps of an axis with `time.mode: lockstep`, for a `node` in its namespace.

    `state`, `measured` (None: lost, or without encoders) and `events` are those of the latest step.  While it waits,
    `is_over` ends that; then what waited returns False.  An axis that refuses raises RefusedError, one that does not
    answer any more StickslipError.
    """

    scene: Scene                      # of the axis, once it is connected
    state: SliderState
    measured: Measured | None = None
    events: Sequence[ModeEvent] = ()

    def __init__(self, node: Node, is_over: Callable[[], bool] = lambda: False) -> None:
        self._node, self._is_over = node, is_over
        self._step = node.create_client(Step, f'{NODE}/step')
        self._reset = node.create_client(Trigger, f'{NODE}/reset')
        # A server loses the answer to a client that it does not know yet.  It hears of them in the order in which they
        # were made, and a question may be put again, which a step may not.
        self._parameters = node.create_client(GetParameters, f'{NODE}/get_parameters')

    def connect(self) -> bool:
        """Wait for the axis, and say so once; raises InputError on a scene that is none."""
        self._executor = self._node.executor or make_executor()
        self._executor.add_node(self._node)    # once, if it is there already
        names, started, is_said = [entry.name for entry in PARAMETERS], time.monotonic(), False
        while not self._is_over():
            if (answer := self._answer(self._parameters, GetParameters.Request(names=names), _GREETING)) is not None:
                values = zip(names, map(parameter_value_to_python, answer.values))
                self.scene = scene_from_values({name: _plain(value) for name, value in values if value is not None})
                settings = self.scene.time
                self._node.get_logger().info(f'connected to {self._axis}: {self.scene.name}, {settings.rate:g} steps a '
                                             f'second, {settings.mode}')
                return True
            if not is_said and time.monotonic() - started > _SILENCE:
                is_said = True
                self._node.get_logger().warning(
                    'waiting for an axis: start sim_node with this ROS_DOMAIN_ID; axes run in: '
                    f'{", ".join(_places(self._node)) or "no namespace"} (--ros-args -r __ns:=NAMESPACE)')
        return False

    def begin(self) -> bool:
        """Reset the axis, and ask for the state and the measurement at its start."""
        if self.scene.time.mode != 'lockstep':
            raise InputError(f'time.mode of {self._axis}', self.scene.time.mode, 'lockstep',
                             'start it with -p time.mode:=lockstep')
        return self._call(self._reset, Trigger.Request()) is not None and self.step(0)

    def step(self, count: int, velocity: float = math.nan, force: float = math.nan) -> bool:
        """Make steps under a velocity (m/s) and a force (N); NaN leaves what is in force."""
        made = self._call(self._step, Step.Request(steps=count, velocity=velocity, force=force))
        if made is None:
            return False
        self.state, self.events = made.state, made.events
        self.measured = Measured(made.measured_slider_position, made.measured_slider_velocity,
                                 made.measured_drive_position, made.measured_drive_velocity
                                 ) if made.is_measured else None
        return True

    @property
    def _axis(self) -> str:
        return str(self._node.resolve_service_name(NODE))

    def _call(self, client: Client, request: Any) -> Any:
        answer = self._answer(client, request, _PATIENCE)
        if answer is None and not self._is_over():
            raise StickslipError(f'{self._axis} no longer answers: has it ended?')
        if answer is not None and not answer.success:
            raise RefusedError(f'{self._axis}: {answer.message}')
        return answer

    def _answer(self, client: Client, request: Any, patience: float) -> Any:
        """Return the answer, or None when there is none in time."""
        end = time.monotonic() + patience
        future = None
        while time.monotonic() < end and not self._is_over():
            if future is None and client.service_is_ready():
                future = client.call_async(request)
            self._executor.spin_once(timeout_sec=_POLL)
            if future is not None and future.done():
                return future.result()
        if future is not None:
            client.remove_pending_request(future)
        return None


def _plain(value: Any) -> object:
    return list(value) if hasattr(value, 'typecode') else value


def _places(node: Node) -> list[str]:
    """Return the namespaces in which axes are heard."""
    suffix = f'/{SLIDER_STATE.name}'
    return [topic.removesuffix(suffix) or '/' for topic, _ in node.get_topic_names_and_types()
            if topic.endswith(suffix) and node.count_publishers(topic)]
