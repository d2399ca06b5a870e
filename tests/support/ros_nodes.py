# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A client that talks to real nodes over DDS.  Conditions have deadlines."""

import importlib
import math
import threading
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import pairwise
from typing import Any, NamedTuple

import pytest

rclpy = pytest.importorskip('rclpy')
with warnings.catch_warnings():   # rclpy loads it at the first message, and it loads what Python wants to be rid of
    warnings.simplefilter('ignore')
    importlib.import_module('rosidl_generator_py')

from diagnostic_msgs.msg import DiagnosticArray  # noqa: E402
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParametersAtomically  # noqa: E402
from rclpy.callback_groups import CallbackGroup  # noqa: E402
from rclpy.context import Context  # noqa: E402
from rclpy.event_handler import QoSSubscriptionEventType, SubscriptionEventCallbacks  # noqa: E402
from rclpy.exceptions import InvalidHandle  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.impl.implementation_singleton import rclpy_implementation  # noqa: E402
from rclpy.node import Node  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy  # noqa: E402
from std_srvs.srv import SetBool, Trigger  # noqa: E402

from stickslip_msgs.msg import (  # noqa: E402
    DriveVelocity,
    ExternalForce,
    FrictionForce,
    ModeEvent,
    RunInfo,
    SliderState,
    StepTiming,
)
from stickslip_msgs.srv import Step  # noqa: E402
from tests.support.node_processes import NodeProcess, assert_clean, attentive, running  # noqa: E402
from tests.support.waiting import DEADLINE, first_of, wait_for  # noqa: E402

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_ALL = QoSProfile(depth=5000)
_COMMAND = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
_HEARD = {
    'slider_state': (SliderState, _ALL), 'mode_event': (ModeEvent, _ALL), 'timing': (StepTiming, _ALL),
    'run_info': (RunInfo, _LATCHED), '/diagnostics': (DiagnosticArray, _ALL),
}


def nanoseconds(time: Any) -> int:
    """Return a time of ROS as a number."""
    return int(time.sec) * 1_000_000_000 + int(time.nanosec)


# What a client hears is taken from the middleware in bulk: an executor waits anew for each message, in half a
# millisecond of CPU, and an axis sends four thousand of them a second.

_PAUSE = 0.01    # s between two looks, for the sake of the CPU alone: what comes meanwhile waits in the middleware


class _Hidden(CallbackGroup):  # type: ignore[misc]
    """Hides subscriptions from executors."""

    def can_execute(self, entity: object) -> bool:
        return False


class _Heard(NamedTuple):
    """A subscription, the event that counts its lost messages, and who wants to know that number."""

    subscription: Any
    losses: Any
    lose: Callable[[int], None]


class Ears:
    """Takes the messages of topics as they come, in a thread."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._heard: list[_Heard] = []
        self._is_closing = threading.Event()
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()

    def hear(self, kind: Any, name: str, take: Callable[[Any], object], qos: QoSProfile, raw: bool,
             lose: Callable[[int], None]) -> None:
        """Let `take` have the messages of a topic, and `lose` how many of them DDS reports as lost."""
        subscription = self._node.create_subscription(
            kind, name, take, qos, raw=raw, callback_group=_Hidden(),
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False))
        with subscription.handle:
            losses = rclpy_implementation.EventHandle(
                subscription.handle, QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST)
        self._heard.append(_Heard(subscription, losses, lose))

    def close(self) -> None:
        self._is_closing.set()
        self._thread.join(DEADLINE)
        for heard in self._heard:
            heard.losses.destroy_when_not_in_use()    # it would keep the subscription

    def _listen(self) -> None:
        while not self._is_closing.wait(_PAUSE):
            for heard in tuple(self._heard):
                _take_messages(heard.subscription)
                _take_losses(heard)


def _take_messages(subscription: Any) -> None:
    with subscription.handle:
        while (taken := subscription.handle.take_message(subscription.msg_type, subscription.raw)) is not None:
            subscription.callback(taken[0])


def _take_losses(heard: _Heard) -> None:
    with heard.losses:
        report = heard.losses.take_event()
    if report is not None:
        heard.lose(report.total_count_change)


class Asker:
    """Calls services of a node; how, its heirs say."""

    def call(self, kind: Any, name: str, node: str = 'feed_axis', /, **request: Any) -> Any:
        """Return the answer of a service."""
        raise NotImplementedError

    def trigger(self, name: str) -> Any:
        return self.call(Trigger, name)

    def switch(self, name: str, on: bool) -> Any:
        return self.call(SetBool, name, data=on)

    def step(self, count: int, velocity: float = math.nan, force: float = math.nan) -> Any:
        """Make steps; return the answer."""
        answer = self.call(Step, 'step', steps=count, velocity=velocity, force=force)
        assert answer.success, answer.message
        return answer

    def set_parameters(self, node: str = 'feed_axis', /, **values: object) -> Any:
        """Set parameters of a node together; `__` in a name stands for a dot."""
        parameters = [Parameter(name.replace('__', '.'), value=value).to_parameter_msg()
                      for name, value in values.items()]
        return self.call(SetParametersAtomically, 'set_parameters_atomically', node, parameters=parameters).result

    def parameter_names(self) -> list[str]:
        names: list[str] = self.call(ListParameters, 'list_parameters').result.names
        return names

    def describe(self, *names: str) -> Any:
        return self.call(DescribeParameters, 'describe_parameters', names=list(names)).descriptors

    def values(self, *names: str) -> Any:
        return self.call(GetParameters, 'get_parameters', names=list(names)).values


class Client(Asker):
    """Hears the topics of a node, sends commands, calls services; its callbacks run in threads.

    It hears the friction when asked to: a node makes and sends nothing that nobody hears, a thousand times a second.

    `lost` counts by topic what DDS reports as lost: a node keeps its last ten states for those that are slow to listen.
    """

    def __init__(self, namespace: str = '/') -> None:
        self._context = Context()
        rclpy.init(context=self._context)
        self.node = Node('client', context=self._context, namespace=namespace)
        self._ears = Ears(self.node)
        self.heard: dict[str, list[Any]] = {name: [] for name in _HEARD}
        self.lost: Counter[str] = Counter()
        for name, (kind, qos) in _HEARD.items():
            self.hear(kind, name, self.heard[name].append, qos)
        self._velocity = self.node.create_publisher(DriveVelocity, 'drive_velocity', _COMMAND)
        self._force = self.node.create_publisher(ExternalForce, 'external_force', _COMMAND)
        self._services: dict[str, Any] = {}
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._is_closing = threading.Event()
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        while not self._is_closing.is_set():
            with suppress(InvalidHandle):    # rclpy waits for what a task has just destroyed; it looks anew
                self._executor.spin_once(timeout_sec=0.1)

    def close(self) -> None:
        self._ears.close()
        self._is_closing.set()
        self._thread.join(DEADLINE)
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()

    def connect(self, is_moving: bool = True) -> None:
        """Wait until a node knows who commands it and is heard; without states while its time stands still."""
        wait_for(lambda: self._velocity.get_subscription_count() and self._force.get_subscription_count()
                 and (self.heard['slider_state'] or not is_moving) and self.heard['run_info'], 'the node')
        self.greet()

    def hear(self, kind: Any, name: str, take: Callable[[Any], object], qos: QoSProfile, raw: bool = False) -> None:
        """Let `take` have the messages of a topic, and count what is lost of them."""
        def lose(count: int) -> None:
            self.lost[name] += count

        self._ears.hear(kind, name, take, qos, raw, lose)

    def hear_friction(self) -> None:
        heard = self.heard['friction_force'] = []
        self.hear(FrictionForce, 'friction_force', heard.append, _ALL)

    def wait_for_lost(self, name: str, count: int, before: int = 0) -> None:
        """Wait until so many messages of a topic are reported as lost since there were `before`."""
        wait_for(lambda: self.lost[name] - before >= count, f'a report of {count} lost messages on {name}')

    def states_of_run(self) -> list[Any]:
        """Return the states that were heard of the latest run, each one later than the one before.

        Those that are missing among them are waited for to be reported as lost.
        """
        start = nanoseconds(self.latest('run_info').start_time)
        states = [state for state in self.heard['slider_state'] if nanoseconds(state.header.stamp) >= start]
        gaps = [later.step - earlier.step - 1 for earlier, later in pairwise(states)]
        assert not gaps or min(gaps) >= 0
        self.wait_for_lost('slider_state', sum(gaps))
        return states

    def stop_commanding(self) -> None:
        """Leave velocity and force to others."""
        for publisher in (self._velocity, self._force):
            self.drop(publisher)

    def drop(self, publisher: Any) -> None:
        """End a publisher, in the thread of the callbacks: rclpy does not let it end while another one waits for it."""
        done = self._executor.create_task(self.node.destroy_publisher, publisher)
        wait_for(done.done, 'the end of a publisher')

    def add(self, node: Node) -> None:
        """Let the callbacks of another node of this context run too."""
        self._executor.add_node(node)

    def remove(self, node: Node) -> None:
        """End another node."""
        self._executor.remove_node(node)
        node.destroy_node()

    def latest(self, topic: str) -> Any:
        return self.heard[topic][-1]

    def next(self, topic: str, is_it: Callable[[Any], bool] = lambda _: True, deadline: float = DEADLINE,
             begin: int | None = None) -> Any:
        """Return the next message of a topic that fulfils a condition, from now or from the message `begin` on."""
        heard = self.heard[topic]
        find = first_of(heard, is_it, len(heard) if begin is None else begin)
        return wait_for(find, f'a message on {topic}', deadline)

    def send_velocity(self, velocity: float) -> None:
        self._velocity.publish(DriveVelocity(velocity=velocity))

    def send_force(self, force: float) -> None:
        self._force.publish(ExternalForce(force=force))

    def call(self, kind: Any, name: str, node: str = 'feed_axis', /, **request: Any) -> Any:
        full = f'{node}/{name}'
        if full not in self._services:
            self._services[full] = self.node.create_client(kind, full)
            assert self._services[full].wait_for_service(DEADLINE), full
            self.greet(node)
        future = self._services[full].call_async(kind.Request(**request))
        wait_for(future.done, f'the answer of {full}')
        return future.result()

    def greet(self, node: str = 'feed_axis') -> None:
        """Wait until a node knows every endpoint that was made here so far.

        An answer to a client that a server does not know yet is lost (rmw_fastrtps waits 0.1 s for it).  So a question
        is put until it is answered, by a client that was made after them all: endpoints are heard of in this order.
        """
        client = self.node.create_client(GetParameters, f'{node}/get_parameters')
        assert client.wait_for_service(DEADLINE), node
        answered = threading.Event()
        for _ in range(round(DEADLINE)):
            client.call_async(GetParameters.Request()).add_done_callback(lambda _: answered.set())
            if answered.wait(1.0):
                break
        assert answered.is_set(), f'{node} does not answer'

    def reset(self) -> Any:
        """Let a new run begin; return its first state that is heard, which the old run's come before."""
        infos, states = len(self.heard['run_info']), len(self.heard['slider_state'])
        before = nanoseconds(self.latest('run_info').start_time)
        assert self.trigger('reset').success
        info = self.next('run_info', lambda info: nanoseconds(info.start_time) > before, begin=infos)
        start = nanoseconds(info.start_time)
        return self.next('slider_state', lambda state: nanoseconds(state.header.stamp) >= start, begin=states)

    def now(self) -> float:
        """Return a simulation time that an axis which runs has reached, s; what is heard next may be older."""
        answer = self.switch('set_paused', False)
        assert answer.success
        return 1.00001 * float(answer.message.split()[-2])    # of six digits

    def status(self, name: str, is_it: Callable[[dict[str, str]], bool] = lambda _: True,
               level: bytes | None = None, begin: int | None = None) -> Any:
        """Return the next status of /diagnostics by that name, of a level, and its values that fulfil a condition.

        The values count what comes while a report is made; its level may have it in the next one only.  A level that
        one report alone has may be heard before it is asked for: `begin` is the number of messages before its cause.
        """
        def find(message: Any) -> Any:
            return next(status for status in message.status if status.name.endswith(f'/feed_axis: {name}'))

        def pairs(status: Any) -> dict[str, str]:
            return {pair.key: pair.value for pair in status.values}

        def is_meant(status: Any) -> bool:
            return level in (None, status.level) and is_it(pairs(status))

        status = find(self.next('/diagnostics', lambda message: is_meant(find(message)), begin=begin))
        return status, pairs(status)


@contextmanager
def client(namespace: str = '/') -> Iterator[Client]:
    it = Client(namespace)
    try:
        yield it
    finally:
        it.close()


@contextmanager
def bare_nodes(*names: str, kind: Any = Node) -> Iterator[list[Any]]:
    """Make nodes of a context of their own; nothing spins."""
    context = Context()
    rclpy.init(context=context)
    nodes = [kind(name, context=context) for name in names]
    try:
        yield nodes
    finally:
        for node in nodes:
            node.destroy_node()
        context.try_shutdown()


@contextmanager
def live_axis(*words: str, namespace: str = '/', prepare: Callable[[], None] = attentive, **options: Any
              ) -> Iterator[tuple[NodeProcess, Client]]:
    """Run an attentive node beside a client that it knows; it ends clean, unless the caller has waited for its end."""
    where = [] if namespace == '/' else ['-r', f'__ns:={namespace}']
    with running(*words, *where, prepare=prepare, **options) as process, client(namespace) as axis:
        axis.connect(is_moving='time.mode:=lockstep' not in words)
        yield process, axis
        if process.code is None:
            assert_clean(*process.end())
