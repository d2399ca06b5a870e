# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where commands come in: what arrives goes into the slots of the step loop, and what is refused is logged.

The step loop takes what has arrived by the boundary of a step; where this rclpy or its middleware does not allow that,
callbacks of the executor do.
"""

import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, NamedTuple, Protocol

from rclpy.node import Node

from ...core.errors import InputError
from ...realtime.command_slot import CommandSlot
from ...recording import topics
from .endpoints import command_reader, message_of, raw_subscription
from .inbox import Inbox, Message, trouble
from .joints import JointNames, commanded_velocity, disregarded

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
