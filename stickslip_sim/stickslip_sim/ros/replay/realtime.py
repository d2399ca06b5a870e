# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded orders into an axis in real time: each when its time has come, as a controller would give it."""

from collections.abc import Iterator, Mapping
from functools import partial
from threading import Event

from rclpy.node import Node

from ...core.errors import InputError
from ...recording import RecordedMessage, Topic
from ...recording.playback import Recording
from ..node.endpoints import publisher
from .live_axis import LiveAxis
from .player import Act, nothing, wait_until
from .replayed_orders import COMMANDS, refusal_in, request_of
from .span import PlayedSpan

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
            self._log.warning(f'the axis refused a recorded order: {refusal}')
