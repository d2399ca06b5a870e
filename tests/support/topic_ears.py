# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a client of the tests hears, taken from the middleware in bulk.

An executor waits anew for each message, in half a millisecond of CPU, and an axis sends four thousand of them a second.
"""

import threading
from collections.abc import Callable
from typing import Any, NamedTuple

from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import QoSSubscriptionEventType, SubscriptionEventCallbacks
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import QoSProfile

from tests.support.waiting import DEADLINE

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
