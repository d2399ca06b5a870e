# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A message is made when somebody hears it or a bag records it, and only then."""

from collections.abc import Iterator
from typing import Any

import pytest

from stickslip_sim.core.types import Mode
from stickslip_sim.recording.messages import Packer
from tests.support.rigs import make
from tests.support.ros_nodes import rclpy
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros


@pytest.fixture
def node() -> Iterator[Any]:
    from rclpy.context import Context
    context = Context()
    rclpy.init(context=context)
    it = rclpy.create_node('publishers', context=context)
    yield it
    it.destroy_node()
    context.try_shutdown()


class Recorder:
    """Takes messages, and forgets them."""

    def __init__(self) -> None:
        self.taken = 0

    def put(self, *_: object) -> None:
        self.taken += 1

    def wait_for_room(self) -> None:
        pass


def test_nothing_is_packed_for_nobody(node: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    from stickslip_msgs.msg import SliderState
    from stickslip_sim.ros.node.publishers import Publishers
    packed: list[int] = []
    pack = Packer.pack

    def counted(self: Packer, *given: Any) -> bytes:
        packed.append(1)
        return pack(self, *given)

    monkeypatch.setattr(Packer, 'pack', counted)
    publishers, rig = Publishers(node, lambda: 0), make()
    publishers.begin_run(0, Mode.STICK)
    publishers.take(rig.make_step())
    assert packed == []
    recorder = Recorder()
    publishers.recorder = recorder
    publishers.take(rig.make_step())
    assert (len(packed), recorder.taken) == (2, 2)    # the state and the friction force
    publishers.recorder = None
    heard: list[Any] = []
    subscription = node.create_subscription(SliderState, 'slider_state', heard.append, 10)
    wait_for(lambda: node.count_publishers('slider_state') and subscription.get_publisher_count(), 'the publisher')

    def is_packed() -> bool:
        publishers.take(rig.make_step())
        return len(packed) > 2

    wait_for(is_packed, 'a message for the one who hears')
    with subscription.handle:
        state, _ = wait_for(lambda: subscription.handle.take_message(SliderState, False), 'the state')
    assert state.step >= 2
    assert len(packed) == 3    # and none of the friction force
