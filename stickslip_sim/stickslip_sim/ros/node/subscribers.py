# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where commands come in: what arrives goes into the slots of the step loop, and what is refused is logged."""

from collections.abc import Callable

from rclpy.node import Node

from ...core.errors import InputError
from ...realtime.command_slot import CommandSlot
from ...recording import topics as names
from .joints import DRIVE, commanded_velocity, disregarded
from .topics import command_reader, message_of, raw_subscription

_QUIET = 1_000_000_000   # ns between two warnings of refused commands of a kind


class Subscribers:
    """Listens to the topics of commands; `now` is the steady clock of the step loop, ns."""

    def __init__(self, node: Node, velocity: CommandSlot, force: CommandSlot, now: Callable[[], int],
                 with_joints: bool) -> None:
        self._log, self._now = node.get_logger(), now
        self._quiet_until: dict[str, int] = {}   # by kind of command
        self._hear(node, names.DRIVE_VELOCITY, velocity, command_reader(names.DRIVE_VELOCITY))
        self._hear(node, names.EXTERNAL_FORCE, force, command_reader(names.EXTERNAL_FORCE))
        if with_joints:
            self._hear(node, names.JOINT_COMMANDS, velocity, self._velocity_of_joints)

    def _hear(self, node: Node, topic: names.Topic, slot: CommandSlot, read: Callable[[bytes], float]) -> None:
        def take(data: bytes) -> None:
            try:
                refusal = slot.offer(read(data), self._now())
            except InputError as error:
                refusal = slot.refuse(str(error))
            self._log_refusal(slot, refusal)

        raw_subscription(node, topic, take)

    def _velocity_of_joints(self, data: bytes) -> float:
        message = message_of(names.JOINT_COMMANDS, data)
        velocity = commanded_velocity(message)
        if other := disregarded(message):
            self._log.warning(f'joint_commands: {other} is disregarded; the velocity of {DRIVE} counts', once=True)
        return velocity

    def _log_refusal(self, slot: CommandSlot, refusal: str) -> None:
        now = self._now()
        if refusal and now >= self._quiet_until.get(slot.name, now):
            self._quiet_until[slot.name] = now + _QUIET
            self._log.warning(refusal)
