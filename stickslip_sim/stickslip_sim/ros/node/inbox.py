# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that the step loop takes from the middleware by itself, without an executor and its callbacks.

An executor takes 40 to 80 µs for a message, and wants the interpreter for it at the same time as the step loop.

rclpy has no documented way to do this.  What is used instead, `take_message` of a handle and the property
`subscriptions` of a node, stands here alone; tests/ros/node/test_rclpy_contract.py fails where rclpy changes it.
"""

import os
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.utilities import get_rmw_implementation_identifier

SWITCH = 'STICKSLIP_COMMANDS'
_CALLBACKS = 'callbacks'
_STAMPING = ('rmw_fastrtps_cpp', 'rmw_fastrtps_dynamic_cpp')    # say when a message was received
_RECEIVED = 'received_timestamp'


class Message(NamedTuple):
    """The bytes of a message, and when the middleware received it, ns on the steady clock."""

    arrival: int
    data: bytes


class HidingNode(Node):  # type: ignore[misc]
    """A node that hides subscriptions from its executor: those that an `Inbox` takes from."""

    _hidden: Sequence[Any] = ()

    def hide(self, subscriptions: Sequence[Any]) -> None:
        """Hide these subscriptions; to be called before an executor gets the node."""
        self._hidden = tuple(subscriptions)

    @property
    def subscriptions(self) -> Iterator[Any]:
        """Those that an executor serves: it asks here."""
        return (subscription for subscription in super().subscriptions if subscription not in self._hidden)


class Inbox:
    """A subscription that no executor knows and that keeps `depth` messages; for the thread of the step loop."""

    def __init__(self, subscription: Any, depth: int) -> None:
        self._handle, self._type, self._depth = subscription.handle, subscription.msg_type, depth

    def take(self, since: int, now: int, ahead: int) -> list[Message]:
        """Return what has come since the last time, at most as many as are kept, the oldest first.

        That time, `since`, and `now` are ns on the steady clock and bound the arrivals: the clock of the middleware,
        that of the day, may be set.  The steady clock is `ahead` ns of it now; for all messages, however long taking
        them takes, so that their order stays.
        """
        messages: list[Message] = []
        try:
            with self._handle:
                while (len(messages) < self._depth
                       and (taken := _take(self._handle, self._type)) is not None):
                    since = max(since, min(taken[1][_RECEIVED] + ahead, now))
                    messages.append(Message(since, taken[0]))
        except InvalidHandle:    # the node is coming down
            pass
        return messages


def trouble(subscription: Any) -> str:
    """Return why messages cannot be taken from a new subscription, or an empty text."""
    if os.environ.get(SWITCH) == _CALLBACKS:
        return f'{SWITCH}={_CALLBACKS}'
    middleware = get_rmw_implementation_identifier()
    if middleware not in _STAMPING:
        return f'{middleware} is not known to say when a message was received'
    try:
        with subscription.handle:
            taken = _take(subscription.handle, subscription.msg_type)
        if taken is None or (isinstance(taken[0], bytes) and taken[1][_RECEIVED] > 0):
            return ''
        return f'a message comes as {taken!r:.100}'
    except (AttributeError, TypeError, LookupError) as error:
        return f'this rclpy has another way to take messages ({error})'


def _take(handle: Any, kind: Any) -> Any:
    """Return the bytes of the next message with what the middleware knows of it, or None when there is none."""
    return handle.take_message(kind, True)    # True: raw, the bytes; rclpy takes it by position only
