# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The live axis that takes recorded orders: its services, called from the thread of the player."""

import threading
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from queue import Empty, SimpleQueue
from typing import Any

from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.exceptions import NameValidationException
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from std_srvs.srv import Trigger

from stickslip_msgs.msg import StepTiming
from stickslip_msgs.srv import InjectFault, Step

from ...bags.topics import TIMING
from ...core.errors import InputError
from ..environment import refusing
from ..node.endpoints import subscription
from .player import StoppedError, wait_until

PATIENCE = 10.0      # s for the axis to be there; a test of it has less
_LOOK = 0.05         # s between two looks at whether to stop
_LOOKS = 20          # before a question is put again
_SERVICES = {
    'get_parameters': GetParameters, 'set_parameters_atomically': SetParametersAtomically, 'reset': Trigger,
    'clear_faults': Trigger, 'inject_fault': InjectFault, 'step': Step,
}
_QUESTION = 'get_parameters'    # changes nothing, however often it is put


class LiveAxis:
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
        """Wait until the axis knows every publisher and client that was made so far.

        Before that it misses what is published, and its answers are lost: rmw_fastrtps gives up after 0.1 s when it
        does not know yet who asked.  So a question is put until it is answered, by a client that was made after them
        all, because an axis hears of the endpoints of a node in the order of their making.
        """
        if not self._has_met:
            self._clients[_QUESTION] = self._node.create_client(_SERVICES[_QUESTION], f'{self.name}/{_QUESTION}')
            self._has_met = True
        self.ask(_QUESTION)

    def ask(self, service: str, **request: Any) -> Any:
        """Call a service and wait for the answer; a question that stays without one is put again."""
        answers: SimpleQueue[Any] = SimpleQueue()
        while True:
            self.send(service, answers.put, **request)
            for _ in range(_LOOKS) if service == _QUESTION else count():
                with suppress(Empty):
                    return answers.get(timeout=_LOOK)
                if self._stop.is_set():
                    raise StoppedError
                if not self._clients[service].service_is_ready():
                    raise InputError('axis', self.name, 'a sim_node that runs; it has gone', 'start it, and this again')

    def send(self, service: str, take: Callable[[Any], None], **request: Any) -> None:
        """Call a service; `take` gets the answer later, in another thread."""
        client = self._clients[service]
        if not wait_until(client.service_is_ready, self._stop, PATIENCE):
            raise InputError('axis', self.name, f'a sim_node that runs; none answers on ~/{service}', 'start it first')
        future = client.call_async(_SERVICES[service].Request(**request))
        future.add_done_callback(lambda done: take(done.result()))

    def parameters(self, *names: str) -> list[Any]:
        """Return the values of parameters, None of those without one; raises InputError when the node lacks one."""
        values = self.ask('get_parameters', names=list(names)).values
        if len(values) != len(names):
            raise InputError('axis', self.name, f'a sim_node; this node has no {" or ".join(names)}', 'give its name')
        return [parameter_value_to_python(value) for value in values]

    def rewind(self) -> None:
        """Bring the axis to step 0; one that records, and so is not reset, must be there already."""
        answer = self.ask('reset')
        if answer.success:
            return
        self._timing = None
        step = self._timing.step if wait_until(lambda: self._timing, self._stop, PATIENCE) and self._timing else None
        if step != 0:
            raise InputError('axis', self.name, f'at step 0, but is at {step}', f'~/reset is {answer.message}')

    def _hear(self, timing: StepTiming) -> None:
        self._timing = timing
