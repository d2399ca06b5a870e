# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded orders into an axis in lock-step: each before the step that it was recorded with.

So the axis does what it did then, to the last bit, as long as its scene is the recorded one.
"""

import math
from collections.abc import Iterator, Mapping
from functools import partial

from rcl_interfaces.msg import Parameter
from rclpy.node import Node

from ...core.errors import InputError, RecordingError
from ...core.time_grid import Grid
from ...recording import RecordedMessage, Topic
from ...recording.playback import Recording
from ...recording.topics import DRIVE_VELOCITY, EXTERNAL_FORCE
from .live_axis import LiveAxis
from .player import Act
from .replayed_orders import COMMANDS, Request, is_timeout, order_of, refusal_in, request_of, state_topic
from .span import PlayedSpan

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
            raise RecordingError(f'{self._recording.path}: step {last + 1} is missing; only a run that was recorded by'
                                 ' the node, from its start on and without loss, can be repeated in lock-step')
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
            raise RecordingError(f'{self._axis.name} is at step {answer.state.step} instead of {self._made}: somebody'
                                 ' else makes steps or resets it')

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
            raise RecordingError(f'{self._axis.name} refused a recorded order: {refusal}')
