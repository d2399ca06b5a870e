# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One call of a service of a running node: find the node, be known to it, ask once."""

import os
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import rclpy
from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.client import Client
from rclpy.context import Context
from rclpy.exceptions import InvalidServiceNameException
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import LoggingSeverity, set_logger_level
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import SetBool, Trigger

from stickslip_msgs.srv import InjectFault, Step

from ..core.errors import InputError, StickslipError
from ..core.types import EventKind, Mode
from ..report.quantity import quantity
from .environment import refusing, variables
from .standstill import Standstill

_SET = 'set_parameters_atomically'
_TYPES = {'record': SetBool, 'set_paused': SetBool, 'reset': Trigger, 'clear_faults': Trigger, 'step': Step,
          'inject_fault': InjectFault, 'restart': Trigger, 'play_next': Trigger, _SET: SetParametersAtomically}
_GREETING = 1.0    # s until a node is greeted again
_COMPANY = 0.2     # s for a second node of the name to be heard of after the first: most come within 0.1 s
_AGAIN = 0.25      # s until both are greeted again
_PROFILES = 'FASTDDS_DEFAULT_PROFILES_FILE', 'FASTRTPS_DEFAULT_PROFILES_FILE'    # Kilted warns of the second
_POLL = 0.05       # s


def answer_of(service: str, request: Mapping[str, object], node: str, patience: float, duration: float = 0.0) -> Any:
    """Return the answer of a node to a request; `patience` and `duration` (s): to find it, and what it works on it.

    The request to set parameters is their values by name.

    Raises InputError on a name that is none, or that of several nodes; StickslipError when nobody answers.
    """
    name = f'/{node.strip("/")}'
    with _session() as session:
        client = session.client(_TYPES[service], f'{name}/{service}', node)
        session.meet(client, name, service, patience)
        fields = {'parameters': [Parameter(each, value=value).to_parameter_msg() for each, value in request.items()]
                  } if service == _SET else request
        answer = client.call_async(_TYPES[service].Request(**fields))
        session.spin_until(lambda: answer.done() or not client.service_is_ready(), patience + duration)
        if not answer.done():
            raise StickslipError(f'{name} has not answered to {service} within {patience + duration:g} s: is it busy,'
                                 ' or has it ended? raise --timeout')
        return answer.result()


def step_lines(answer: Any) -> Iterator[str]:
    """Yield the message of an answer to ~/step, the events of the steps and the state at their end."""
    yield answer.message
    for event in answer.events:
        yield f't = {event.time:.9g} s: {EventKind(event.kind).name.lower()} at {quantity(event.position, "m")}'
    state = answer.state
    yield (f't = {state.time:.9g} s: {Mode(state.mode).name.lower()}, position {quantity(state.position, "m")}, '
           f'velocity {quantity(state.velocity, "m/s")}, drive {quantity(state.drive_velocity, "m/s")}, '
           f'friction {quantity(answer.friction.force, "N")}')


class _Session:
    """A node of this process that asks others."""

    def __init__(self, context: Context) -> None:
        without_services = [Parameter('start_type_description_service', value=False)]    # none that it would answer
        self._node = Node('stickslip_call', context=context, enable_rosout=False, start_parameter_services=False,
                          parameter_overrides=without_services)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self._node)

    def client(self, kind: Any, name: str, given: str) -> Client:
        """Return a client of a service; raises InputError when that can be no name."""
        try:
            return self._node.create_client(kind, name)
        except InvalidServiceNameException as error:
            raise InputError('--node', given, 'the name of a node, as in /cell/feed_axis',
                             ' '.join(str(error).split())) from None

    def meet(self, client: Client, name: str, service: str, patience: float) -> None:
        """Wait until a node knows all clients made so far.

        Raises StickslipError when it does not answer, InputError when several of its name do: each would do what is
        asked for.  One that was killed is in the graph for a while, but does not answer.

        An answer to a client that a server does not know yet is lost, and not every request may be made twice.  So a
        harmless question is put until it is answered, by a client that was made later: endpoints are heard of in order.
        """
        end = time.monotonic() + patience
        greeter = self.client(GetParameters, f'{name}/get_parameters', name)
        if not self.spin_until(lambda: client.service_is_ready() and greeter.service_is_ready(), patience):
            raise StickslipError(self._missing(name, service, patience))
        answers = _counted_answers(greeter)
        while time.monotonic() < end:
            greeting = greeter.call_async(GetParameters.Request())
            if self.spin_until(greeting.done, min(_GREETING, end - time.monotonic())):
                return self._check_single(name, greeter, answers)
        raise StickslipError(f'{name} exists, but does not answer within {patience:g} s; raise --timeout')

    def spin_until(self, condition: Callable[[], bool], patience: float) -> bool:
        """Let messages come in until a condition holds, for so many seconds at most; return whether it does."""
        end = time.monotonic() + patience
        while not condition() and time.monotonic() < end:
            self._executor.spin_once(timeout_sec=_POLL)
        return condition()

    def close(self) -> None:
        """End the node."""
        self._executor.shutdown()
        self._node.destroy_node()

    def _check_single(self, name: str, greeter: Client, answers: Counter[int]) -> None:
        """Raise InputError when a second node answers to what one has answered to.

        It may be heard of later than the first, and has not heard the greeting of that then: both are greeted again.
        """
        if not self.spin_until(lambda: self._node.count_services(f'{name}/get_parameters') > 1, _COMPANY):
            return
        end = time.monotonic() + _GREETING
        while time.monotonic() < end:
            if self.spin_until(lambda: max(answers.values()) > 1, _AGAIN):
                raise InputError('--node', name, 'the name of one node',
                                 f'two nodes named {name} answer: end one, or give it a namespace (-r __ns:=/cell)')
            greeter.call_async(GetParameters.Request())

    def _missing(self, name: str, service: str, patience: float) -> str:
        """Return that nobody offers a service, and who else does."""
        text = f'no node {name} offers {service} (looked for {patience:g} s)'
        offers = (offer for offer, _ in self._node.get_service_names_and_types() if offer.endswith(f'/{service}'))
        others = sorted(offer.removesuffix(f'/{service}') for offer in offers if self._node.count_services(offer))
        if others:
            return f'{text}; found {", ".join(others)}: name it with --node'
        return f'{text}; is it running, with this ROS_DOMAIN_ID? check --node, or raise --timeout'


def _counted_answers(client: Client) -> Counter[int]:
    """Return the answers to each request of a client, by its number, counted as they come: it hands on the first."""
    answers: Counter[int] = Counter()
    pending_request = client.get_pending_request

    def count(number: int) -> Any:
        answers[number] += 1
        return pending_request(number)

    client.get_pending_request = count    # which an executor asks for with each answer
    return answers


@contextmanager
def _announced_often() -> Iterator[None]:
    """Let Fast DDS announce a participant that is made ten times a second, where the user has no profiles for it.

    A second node of one name was heard of seconds after the first, and so not asked.
    """
    if any(map(os.environ.get, _PROFILES)):
        yield
        return
    names = _PROFILES if os.environ.get('ROS_DISTRO') == 'jazzy' else _PROFILES[:1]
    os.environ.update(dict.fromkeys(names, str(Path(__file__).with_name('fastdds_call.xml'))))
    try:
        yield
    finally:
        for name in names:
            del os.environ[name]


@contextmanager
def _session() -> Iterator[_Session]:
    """Make a session in a ROS of its own, which hears no signals; raises InputError when ROS cannot start."""
    context = Context()
    with closing(Standstill('stickslip call')) as standstill:
        set_logger_level('rcl', LoggingSeverity.FATAL)    # it would say half of what is refused in a line of its own
        with refusing('ROS environment', variables()), _announced_often():
            rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
            session = _Session(context)
        set_logger_level('rcl', LoggingSeverity.UNSET)
        standstill.is_up()
        try:
            yield session
        finally:
            session.close()
            context.try_shutdown()
