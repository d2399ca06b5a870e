# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where commands come in: what arrives goes into the slots of the step loop, and what is refused is logged.

The step loop takes what has arrived by the boundary of a step; where this rclpy or its middleware does not allow that,
callbacks of the executor do.
"""

import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple, Protocol

from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.utilities import get_rmw_implementation_identifier

from ...bags import topics
from ...core.errors import InputError
from ...realtime.commands import CommandSlot
from .endpoints import command_reader, message_of, raw_subscription
from .joints import JointNames, commanded_velocity, disregarded

# Messages that the step loop takes from the middleware by itself, without an executor and its callbacks.
#
# An executor takes 40 to 80 µs for a message, and wants the interpreter for it at the same time as the step loop.
#
# rclpy has no documented way to do this.  What is used instead, `take_message` of a handle and the property
# `subscriptions` of a node, stands here alone; tests/ros/node/test_rclpy_contract.py fails where rclpy changes it.

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


_QUIET = 1_000_000_000   # ns between two warnings of refused commands of a kind


class Log(Protocol):
    """Where refusals are logged; must not keep the step loop waiting."""

    def warning(self, text: str) -> None:
        """Take a warning."""


class _Source(NamedTuple):
    """A topic of commands."""

    topic: topics.Topic
    slot: CommandSlot
    read: Callable[[bytes], float]    # raises InputError


class Subscribers:
    """Listens to the topics of commands; `now` is the steady clock of the step loop, ns.

    `joints` are those of joint_commands, None without that topic.  `hear` is for the thread of the step loop.  `hidden`
    are the subscriptions that no executor may see.
    """

    def __init__(self, node: Node, velocity: CommandSlot, force: CommandSlot, now: Callable[[], int], log: Log,
                 joints: JointNames | None) -> None:
        self._log, self._now = log, now
        self._quiet_until: dict[str, int] = {}   # by kind of command
        self._is_disregard_logged = False
        self._heard = now()
        self._inboxes: list[tuple[Inbox, _Source]] = []
        self.hidden: list[Any] = []
        self.trouble = ''                        # why callbacks hear the commands; empty where the loop does
        sources = [_Source(topics.DRIVE_VELOCITY, velocity, command_reader(topics.DRIVE_VELOCITY)),
                   _Source(topics.EXTERNAL_FORCE, force, command_reader(topics.EXTERNAL_FORCE))]
        if joints:
            sources.append(_Source(topics.JOINT_COMMANDS, velocity, partial(self._velocity_of_joints, joints)))
        self._open(node, sources)

    def hear(self) -> None:
        """Offer what has arrived to the slots, in the order of arrival."""
        now = self._now()
        ahead = now - time.time_ns()
        arrived = [(message, source) for inbox, source in self._inboxes
                   for message in inbox.take(self._heard, now, ahead)]
        self._heard = now
        if len(arrived) > 1:
            arrived.sort(key=_arrival)
        for message, source in arrived:
            self._offer(source, message)

    def _open(self, node: Node, sources: Iterable[_Source]) -> None:
        for source in sources:
            subscription = raw_subscription(node, source.topic, self._callback(source))
            self.trouble = self.trouble or trouble(subscription)
            if not self.trouble:
                self.hidden.append(subscription)
                self._inboxes.append((Inbox(subscription, source.topic.kept), source))

    def _callback(self, source: _Source) -> Callable[[bytes], None]:
        def take(data: bytes) -> None:
            self._offer(source, Message(self._now(), data))

        return take

    def _offer(self, source: _Source, message: Message) -> None:
        try:
            refusal = source.slot.offer(source.read(message.data), message.arrival)
        except InputError as error:
            refusal = source.slot.refuse(str(error))
        if refusal:
            self._log_refusal(source.slot, refusal)

    def _velocity_of_joints(self, joints: JointNames, data: bytes) -> float:
        message = message_of(topics.JOINT_COMMANDS, data)
        velocity = commanded_velocity(message, joints)
        if not self._is_disregard_logged and (other := disregarded(message, joints)):
            self._is_disregard_logged = True
            self._log.warning(f'joint_commands: {other} is disregarded; the velocity of {joints.drive} counts')
        return velocity

    def _log_refusal(self, slot: CommandSlot, refusal: str) -> None:
        now = self._now()
        if now >= self._quiet_until.get(slot.name, now):
            self._quiet_until[slot.name] = now + _QUIET
            self._log.warning(refusal)


def _arrival(arrived: tuple[Message, _Source]) -> int:
    return arrived[0].arrival
