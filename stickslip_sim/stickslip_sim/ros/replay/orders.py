# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a recording says of the orders that its axis got: commands, faults, parameters."""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from threading import Event
from typing import Any, NamedTuple

from rcl_interfaces.msg import Parameter
from rclpy.node import Node

from ...bags.topics import DRIVE_VELOCITY, EXTERNAL_FORCE, PARAMETER_EVENTS, RIG_EVENT, SLIDER_STATE
from ...core.errors import InputError, RecordingError
from ...core.time_grid import Grid
from ...recording import RecordedMessage, Topic
from ...recording.reader import Recording
from ...scene.schema import BY_NAME
from ...simulation import RigEventKind
from ..node.endpoints import deserialized, publisher
from .live_axis import LiveAxis
from .player import Act, nothing, wait_until
from .span import PlayedSpan

COMMANDS = (DRIVE_VELOCITY, EXTERNAL_FORCE)
_CLEAR = 'clear'    # what ~/inject_fault calls the end of a fault


class Request(NamedTuple):
    """A call of a service of the axis."""

    service: str
    fields: Mapping[str, Any]


def order_topics(recording: Recording, wanted: Sequence[str]) -> dict[str, Topic]:
    """Return which recorded topics hold orders, among those wanted; raises RecordingError without commands."""
    kinds = {kind.type: kind for kind in (*COMMANDS, RIG_EVENT, PARAMETER_EVENTS)}
    found = {name: kinds[recording.topics[name].type] for name in wanted if recording.topics[name].type in kinds}
    if not any(kind in COMMANDS for kind in found.values()):
        raise RecordingError(f'{recording.path}: neither drive velocities nor forces; give a recording of an axis')
    for kind in kinds.values():
        _check_single(kind, [name for name, its in found.items() if its is kind])
    return found


def state_topic(recording: Recording) -> str:
    """Return the one topic of states; raises RecordingError when there are none, InputError when there are more."""
    names = [name for name, topic in recording.topics.items() if topic.type == SLIDER_STATE.type]
    if not names:
        raise RecordingError(f'{recording.path}: no states, so its steps are unknown; replay it in real time')
    _check_single(SLIDER_STATE, names)
    return names[0]


def order_of(kind: Topic, data: bytes) -> Any:
    """Return the message that a recorded order is; raises RecordingError on bytes that are none."""
    try:
        return deserialized(kind, data)
    except ValueError:
        raise RecordingError(f'{kind.name}: {len(data)} recorded bytes are no {kind.type}; the recording is damaged: '
                             'play what is before with playback_duration') from None


def request_of(kind: Topic, data: bytes) -> Request | None:
    """Return how an order other than a command is given to an axis; None where it follows from the others."""
    message = order_of(kind, data)
    if kind is PARAMETER_EVENTS:
        changed = [parameter for parameter in message.changed_parameters if parameter.name in BY_NAME]
        return Request('set_parameters_atomically', {'parameters': changed}) if changed else None
    if message.kind == RigEventKind.FAULT_INJECTED:
        return Request('inject_fault', {'id': message.id, 'kind': message.fault, 'start': message.start,
                                        'duration': message.duration, 'value': message.value})
    if message.kind == RigEventKind.FAULT_CLEARED and message.id:
        return Request('inject_fault', {'id': message.id, 'kind': _CLEAR})
    if message.kind == RigEventKind.FAULT_CLEARED:
        return Request('clear_faults', {})
    return None


def is_timeout(kind: Topic, data: bytes) -> bool:
    """Return whether a recorded message reports a command time-out."""
    return kind is RIG_EVENT and bool(order_of(kind, data).kind == RigEventKind.COMMAND_TIMEOUT)


def refusal_in(response: Any) -> str:
    """Return why an axis did not do as it was ordered; empty when it did."""
    if hasattr(response, 'result'):
        return '' if response.result.successful else str(response.result.reason)
    return '' if response.success else str(response.message)


def _check_single(kind: Topic, names: Sequence[str]) -> None:
    if len(names) > 1:
        raise InputError('topics', list(names), f'one of type {kind.type}', 'the recording is of several axes: name'
                         ' the topics of one')


# Recorded orders into an axis in lock-step: each before the step that it was recorded with.
#
# So the axis does what it did then, to the last bit, as long as its scene is the recorded one.

_MOST = 1000    # steps at a time, so that a call takes no longer than people wait


class InLockStep:
    """The script of orders by step; `stride` is the simulation time, s, that passes with one call of ~/step."""

    def __init__(self, node: Node, axis: LiveAxis, recording: Recording, orders: Mapping[str, Topic], span: PlayedSpan,
                 rate: float, stride: float) -> None:
        self.begin = span.begin
        self._log = node.get_logger()
        self._axis, self._recording, self._orders, self._span = axis, recording, orders, span
        self._states = state_topic(recording)
        self._grid = Grid(rate)
        self._before: dict[str, Parameter] = {}    # parameters that the recording changes, as they were
        self._most = max(1, min(_MOST, round(stride * rate)))

    def prepare(self) -> None:
        """Bring the axis to its step 0, with the parameters that it had before it was played into."""
        self._axis.meet()
        if self._before:
            self._obey(Request('set_parameters_atomically', {'parameters': list(self._before.values())}))
        self._axis.rewind()

    def acts(self) -> Iterator[Act]:
        """Yield the steps up to each order, then the order, and at last the steps that are left."""
        self._made = last = self._ahead = 0    # the last: of log times, ns, before simulation time
        self._commands = dict.fromkeys(COMMANDS, math.nan)    # for the next call of ~/step; NaN: as before
        for message in self._recording.messages((self._states, *self._orders), *self._span):
            if message.topic == self._states:
                last = self._step_of(message, last)
            else:
                yield from self._steps_to(message.sequence - 1)
                yield Act(message.log_time, partial(self._give, message))
        yield from self._steps_to(last)

    def _step_of(self, state: RecordedMessage, last: int) -> int:
        """Return the step of a state; raises an error when it does not follow the one before."""
        step = state.sequence
        if step > last + 1 or (step <= last and step):
            raise RecordingError(f'{self._recording.path}: step {last + 1} is missing; only a complete run of the node,'
                                 ' recorded from its start, can be repeated in lock-step')
        time = self._recording.simulation_time(state)
        if time != self._grid.nanoseconds(step):
            raise InputError('time.rate', self._grid.rate, f'that of the recording, whose step {step} ends at'
                             f' {time * 1e-9:g} s', 'start the axis with the recorded scene')
        self._ahead = state.log_time - time
        return step

    def _steps_to(self, step: int) -> Iterator[Act]:
        while self._made < step:
            count = min(self._most, step - self._made)
            yield Act(self._grid.nanoseconds(self._made + count) + self._ahead, partial(self._make, count))

    def _make(self, count: int) -> None:
        answer = self._axis.ask('step', steps=count, velocity=self._commands[DRIVE_VELOCITY],
                                force=self._commands[EXTERNAL_FORCE])
        self._commands = dict.fromkeys(COMMANDS, math.nan)
        self._made += count
        if not answer.success:
            raise RecordingError(f'{self._axis.name} gave up: {answer.message}')
        if answer.state.step != self._made:
            raise RecordingError(f'{self._axis.name} is at step {answer.state.step} instead of {self._made}: another'
                                 ' client steps or resets it')

    def _give(self, message: RecordedMessage) -> None:
        kind = self._orders[message.topic]
        if kind in COMMANDS:
            command = order_of(kind, message.data)
            self._commands[kind] = command.velocity if kind is DRIVE_VELOCITY else command.force
        elif request := request_of(kind, message.data):
            self._remember(request)
            self._obey(request)
        elif is_timeout(kind, message.data):
            time = self._recording.simulation_time(message) * 1e-9
            self._log.warning(f'a command time-out at {time:g} s is left to the axis, which counts'
                              ' silence in simulation time: recorded in real time, it may come a step apart')

    def _remember(self, request: Request) -> None:
        """Keep the values of parameters that are to be changed for the first time."""
        names = {parameter.name for parameter in request.fields.get('parameters', ())}
        if new := sorted(names - self._before.keys()):
            values = self._axis.ask('get_parameters', names=new).values
            self._before |= {name: Parameter(name=name, value=value) for name, value in zip(new, values)}

    def _obey(self, request: Request) -> None:
        refusal = refusal_in(self._axis.ask(request.service, **request.fields))
        if refusal:
            raise RecordingError(f'{self._axis.name} refused a recorded command: {refusal}')


# Recorded orders into an axis in real time: each when its time has come, as a controller would give it.

_PATIENCE = 10.0    # s for the axis to hear


class InRealTime:
    """The script of orders by time.  The commands in force at the start of the span are given first."""

    def __init__(self, node: Node, axis: LiveAxis, recording: Recording, orders: Mapping[str, Topic], span: PlayedSpan,
                 stop: Event) -> None:
        self.begin = span.begin
        self._log = node.get_logger()
        self._axis, self._recording, self._orders, self._span, self._stop = axis, recording, orders, span, stop
        self._out = {name: publisher(node, kind.resolved(axis.namespace))
                     for name, kind in orders.items() if kind in COMMANDS}

    def prepare(self) -> None:
        """Wait until the axis hears; raises InputError when none does."""
        for out in self._out.values():
            if not wait_until(out.get_subscription_count, self._stop, _PATIENCE):
                raise InputError('axis', self._axis.name, f'one that hears {out.topic_name}', 'start it first')
        self._axis.meet()

    def acts(self) -> Iterator[Act]:
        """Yield the orders, each at its log time."""
        for message in self._held():
            yield Act(self.begin, partial(self._give, message))
        for message in self._recording.messages(self._orders, *self._span):
            yield Act(message.log_time, partial(self._give, message))
        yield Act(self._span.end, nothing)

    def _held(self) -> list[RecordedMessage]:
        before = self._recording.messages(self._out, self._recording.begin, self.begin - 1)
        return list({message.topic: message for message in before}.values())

    def _give(self, message: RecordedMessage) -> None:
        if message.topic in self._out:
            self._out[message.topic].publish(message.data)
        elif request := request_of(self._orders[message.topic], message.data):
            self._axis.send(request.service, self._look_at, **request.fields)

    def _look_at(self, response: object) -> None:
        refusal = refusal_in(response)
        if refusal:
            self._log.warning(f'the axis refused a recorded command: {refusal}')
