# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded orders into a live axis: by time or by step, as the clock of the axis wants it."""

import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from itertools import count
from queue import Empty, SimpleQueue
from threading import Event
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
from ...recording.playback import Recording
from ...scene import Scene
from ...scene.load import NODE
from ...scene.schema import BY_NAME
from ..environment import refusing
from ..node.endpoints import subscription
from .orders import COMMANDS, InLockStep, InRealTime, order_topics
from .player import Act, Script, StoppedError, wait_until
from .span import PlayedSpan, Settings, chosen_topics

# The live axis that takes recorded orders: its services, called from the thread of the player.

_PATIENCE = 10.0     # s for the axis to be there
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
        if not wait_until(client.service_is_ready, self._stop, _PATIENCE):
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
        step = self._timing.step if wait_until(lambda: self._timing, self._stop, _PATIENCE) and self._timing else None
        if step != 0:
            raise InputError('axis', self.name, f'at step 0, but is at {step}', f'~/reset is {answer.message}')

    def _hear(self, timing: StepTiming) -> None:
        self._timing = timing


# What a live axis has other than the scene that travels in a recording.

_SHOWN = 3
_ELSEWHERE = ('scene', 'time', 'clock', 'record', 'timing', 'joint_interface')   # sections without a say in the motion


def compared_names(scene: Scene) -> list[str]:
    """Return the parameters of a recorded scene that decide the motion."""
    return [name for name in scene.values if name in BY_NAME and name.partition('.')[0] not in _ELSEWHERE]


def difference_between(recorded: Scene, live: Mapping[str, object]) -> str:
    """Return in which parameters a live axis differs from the recorded scene, for people; empty where in none."""
    found = [f'{name} is {_plain(value)}, not {_plain(recorded.values[name])}' for name, value in live.items()
             if _plain(value) != _plain(recorded.values[name])]
    more = f', and {len(found) - _SHOWN} more' if len(found) > _SHOWN else ''
    return ', '.join(found[:_SHOWN]) + more


def _plain(value: object) -> object:
    """Return a value as ROS and scenes both have it: an empty list is none."""
    listed = list(value) if hasattr(value, '__iter__') and not isinstance(value, str) else value
    return None if listed == [] else listed


_STRIDE = 0.02    # s of the steady clock that pass with one call of ~/step


class Commands:
    """The script of all orders."""

    def __init__(self, node: Node, recording: Recording, settings: Settings, span: PlayedSpan, stop: Event) -> None:
        self.begin = span.begin
        self._node, self._recording, self._settings, self._span, self._stop = node, recording, settings, span, stop
        self._orders = order_topics(recording, chosen_topics(recording, settings.topics))
        self._axis = LiveAxis(node, settings.axis or self._recorded_axis(), stop)
        self._script: Script | None = None

    def prepare(self) -> None:
        """Ask the axis for its clock the first time; raises InputError when it is not there or goes its own way."""
        if self._script is None:
            self._script = self._make_script(*self._axis.parameters('time.mode', 'time.rate'))
            self._compare_scenes()
        self._script.prepare()

    def acts(self) -> Iterator[Act]:
        """Yield what happens, in the order of time."""
        return self._script.acts() if self._script else iter(())

    def _make_script(self, mode: str, rate: float) -> Script:
        if mode == 'realtime':
            return InRealTime(self._node, self._axis, self._recording, self._orders, self._span, self._stop)
        if mode != 'lockstep':
            raise InputError('time.mode', mode, 'realtime or lockstep for an axis that takes recorded commands',
                             'start it so')
        if self._settings.start_offset:
            raise InputError('start_offset', self._settings.start_offset, '0 in lock-step',
                             'in lock-step a run is repeated from its start')
        return InLockStep(self._node, self._axis, self._recording, self._orders, self._span, rate,
                          _STRIDE * max(1.0, self._settings.rate))

    def _compare_scenes(self) -> None:
        """Warn where the axis is not the one that was recorded: it will move in another way."""
        scene = self._recording.scene
        if scene is None:
            return
        names = compared_names(scene)
        if difference := difference_between(scene, dict(zip(names, self._axis.parameters(*names)))):
            self._node.get_logger().warning(
                f'{self._axis.name} has another scene than the recorded one: {difference}; it will not do what it did'
                ' then (docs/replay.md has how to start it with the recorded scene)')

    def _recorded_axis(self) -> str:
        command = next(name for name, kind in self._orders.items() if kind in COMMANDS)
        return f'{command.rpartition("/")[0]}/{NODE}'
