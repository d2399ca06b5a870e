# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The live axis that takes recorded orders: its services, called from the thread of the player."""

import threading
from collections.abc import Callable
from typing import Any

from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.exceptions import NameValidationException
from rclpy.node import Node
from std_srvs.srv import Trigger

from stickslip_msgs.msg import StepTiming
from stickslip_msgs.srv import InjectFault, Step

from ...errors import InputError
from ...recording.topics import TIMING
from ..environment import refusing
from ..topics import subscription
from .player import StoppedError, wait_until

_PATIENCE = 10.0     # s for the axis to be there
_LOOK = 0.05         # s between two looks at whether to stop
_SERVICES = {
    'get_parameters': GetParameters, 'set_parameters_atomically': SetParametersAtomically, 'reset': Trigger,
    'clear_faults': Trigger, 'inject_fault': InjectFault, 'step': Step,
}
_GREETING = 'get_parameters'


class Axis:
    """The services of a node, by the last part of their names; `name` is that of the node, `namespace` where it is.

    The methods raise StoppedError when the player is to stop, and InputError when the axis is not there.
    """

    def __init__(self, node: Node, name: str, stop: threading.Event) -> None:
        self.name = name
        self.namespace = name.rpartition('/')[0] or ('/' if name.startswith('/') else node.get_namespace())
        self._node, self._stop = node, stop
        self._has_met = False
        self._timing: StepTiming | None = None    # the latest
        with refusing('axis', name, NameValidationException):
            self._clients = {service: node.create_client(kind, f'{name}/{service}')
                             for service, kind in _SERVICES.items()}
            subscription(node, TIMING.resolved(self.namespace), self._hear)

    def meet(self) -> None:
        """Wait until the axis knows every publisher that was made so far; it would miss what comes before.

        It answers a client that is made after them, and hears of the endpoints of a node in the order of their making.
        """
        if not self._has_met:
            self._clients[_GREETING] = self._node.create_client(_SERVICES[_GREETING], f'{self.name}/{_GREETING}')
            self._has_met = True
        self.ask(_GREETING)

    def ask(self, service: str, **request: Any) -> Any:
        """Call a service and wait for the answer."""
        answers: list[Any] = []
        answered = threading.Event()

        def take(response: Any) -> None:
            answers.append(response)
            answered.set()

        self.tell(service, take, **request)
        while not answered.wait(_LOOK):
            if self._stop.is_set():
                raise StoppedError
        return answers[0]

    def tell(self, service: str, take: Callable[[Any], None], **request: Any) -> None:
        """Call a service; `take` gets the answer later, in another thread."""
        client = self._clients[service]
        if not wait_until(client.service_is_ready, self._stop, _PATIENCE):
            raise InputError('axis', self.name, f'a sim_node that runs; none answers on ~/{service}', 'start it first')
        future = client.call_async(_SERVICES[service].Request(**request))
        future.add_done_callback(lambda done: take(done.result()))

    def parameters(self, *names: str) -> list[Any]:
        """Return the values of parameters that are texts or numbers; raises InputError when the node lacks one."""
        values = self.ask('get_parameters', names=list(names)).values
        if len(values) != len(names):
            raise InputError('axis', self.name, f'a sim_node; this node has no {" or ".join(names)}', 'give its name')
        return [value.string_value or value.double_value for value in values]

    def rewind(self) -> None:
        """Bring the axis to step 0; one that records, and so is not reset, must be there already."""
        answer = self.ask('reset')
        if answer.success:
            return
        self._timing = None
        step = self._timing.step if wait_until(lambda: self._timing, self._stop, _PATIENCE) and self._timing else None
        if step != 0:
            raise InputError('axis', self.name, f'at step 0, but is at {step}', f'~/reset is {answer.message}')

    def _hear(self, timing: StepTiming) -> None:
        self._timing = timing
