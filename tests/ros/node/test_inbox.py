# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The step loop takes commands from the middleware by itself: which, in which order, and when they arrived."""

import itertools
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from stickslip_sim.bags import topics
from stickslip_sim.realtime.commands import CommandSlot
from tests.support.node_processes import running
from tests.support.ros_nodes import client, rclpy
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros


class NodePair:
    """Subscribers in one node, publishers in another; nothing spins."""

    def __init__(self) -> None:
        from rclpy.context import Context

        from stickslip_sim.ros.node.endpoints import publisher
        from stickslip_sim.ros.node.joints import JointNames
        from stickslip_sim.ros.node.subscribers import Subscribers
        self.context = Context()
        rclpy.init(context=self.context)
        self.node, self.sender = (rclpy.create_node(name, context=self.context) for name in ('inbox', 'sender'))
        self.velocity = CommandSlot('velocity', 'm/s', 1.0)
        self.warnings: list[str] = []
        self.subscribers = Subscribers(self.node, self.velocity, CommandSlot('force', 'N', 1e5), time.monotonic_ns,
                                       self, JointNames())
        self.velocities, self.joints = (publisher(self.sender, topic)
                                        for topic in (topics.DRIVE_VELOCITY, topics.JOINT_COMMANDS))
        for out in (self.velocities, self.joints):
            wait_for(out.get_subscription_count, 'the inbox')

    def warning(self, text: str) -> None:
        self.warnings.append(text)

    def send(self, *velocities: float) -> None:
        from stickslip_msgs.msg import DriveVelocity
        for velocity in velocities:
            self.velocities.publish(DriveVelocity(velocity=velocity))

    def hears(self, count: int) -> bool:
        """Hear what has arrived; return whether it is as much as this since the start."""
        self.subscribers.hear()
        return self.velocity.received >= count

    def close(self) -> None:
        self.node.destroy_node()
        self.sender.destroy_node()
        self.context.try_shutdown()


@pytest.fixture
def pair() -> Iterator[NodePair]:
    pair = NodePair()
    yield pair
    pair.close()


def settle(pair: NodePair) -> None:
    """Wait until all that was sent has been received, without taking it: a later message on a topic unheard."""
    from stickslip_msgs.msg import ExternalForce
    from stickslip_sim.ros.node.endpoints import publisher
    out = publisher(pair.sender, topics.EXTERNAL_FORCE)
    wait_for(out.get_subscription_count, 'the inbox')
    force = pair.subscribers.hidden[1].handle

    def came() -> Any:
        out.publish(ExternalForce(force=1.0))
        with force:
            return force.take_message(ExternalForce, True)

    wait_for(came, 'a later message')


def test_all_that_arrived_is_heard_and_the_latest_counts(pair: NodePair) -> None:
    assert pair.subscribers.trouble == ''
    begin = time.monotonic_ns()
    pair.send(0.1, 0.2, 5.0, 0.3)
    settle(pair)
    assert pair.velocity.received == 0    # no thread of the middleware offers anything
    pair.subscribers.hear()
    assert (pair.velocity.received, pair.velocity.refused) == (4, 1)
    assert len(pair.warnings) == 1
    assert 'velocity = 5.0 is refused' in pair.warnings[0]
    assert pair.velocity.latest is not None
    assert pair.velocity.latest.value == 0.3
    assert begin < pair.velocity.latest.arrival < time.monotonic_ns()


def test_arrival_is_when_the_middleware_received_it_not_when_it_was_taken(pair: NodePair) -> None:
    pair.send(0.1)
    settle(pair)
    received = time.monotonic_ns()
    wait_for(lambda: time.monotonic_ns() > received + 100_000_000, 'a tenth of a second')
    pair.subscribers.hear()
    assert pair.velocity.latest is not None
    assert pair.velocity.latest.arrival < received


def test_of_two_topics_the_command_that_arrived_last_counts(pair: NodePair) -> None:
    from sensor_msgs.msg import JointState
    pair.joints.publish(JointState(name=['axis_drive'], velocity=[0.5]))
    settle(pair)
    pair.send(0.1)
    settle(pair)
    pair.subscribers.hear()
    assert pair.velocity.received == 2
    assert pair.velocity.latest is not None
    assert pair.velocity.latest.value == 0.1


@pytest.mark.parametrize('pause', [0, 1_000_000, 1_000_000_000], ids=['none', 'a step', 'long'])
def test_the_order_stays_when_taking_takes_long(pair: NodePair, monkeypatch: pytest.MonkeyPatch, pause: int) -> None:
    """As when a busy machine takes the core away between two messages."""
    pair.send(0.1, 0.2, 0.3)
    settle(pair)
    looks, now = itertools.count(), time.time_ns
    monkeypatch.setattr(time, 'time_ns', lambda: now() + next(looks) * pause)
    offered: list[float] = []
    monkeypatch.setattr(pair.velocity, 'offer', lambda value, _: offered.append(value))
    pair.subscribers.hear()
    assert offered == [0.1, 0.2, 0.3]


def test_of_more_than_fit_the_latest_are_heard(pair: NodePair) -> None:
    kept = topics.DRIVE_VELOCITY.kept
    pair.send(*(1e-3 * number for number in range(3 * kept)))
    settle(pair)
    pair.subscribers.hear()
    assert 1 <= pair.velocity.received <= kept

    def last_is_heard() -> bool:
        pair.send(0.9)    # again: one may get lost on a best-effort topic
        pair.subscribers.hear()
        return pair.velocity.latest is not None and pair.velocity.latest.value == 0.9

    wait_for(last_is_heard, 'the last')


@pytest.mark.parametrize('jump', [-3_600_000_000_000, 3_600_000_000_000])
def test_a_clock_that_is_set_between_moves_no_arrival_out_of_the_step(pair: NodePair, monkeypatch: pytest.MonkeyPatch,
                                                                      jump: int) -> None:
    pair.subscribers.hear()
    before, now = time.monotonic_ns(), time.time_ns
    monkeypatch.setattr(time, 'time_ns', lambda: now() + jump)
    pair.send(0.1)
    settle(pair)
    pair.subscribers.hear()
    assert pair.velocity.latest is not None
    assert before - 1_000_000_000 < pair.velocity.latest.arrival <= time.monotonic_ns()


def test_a_node_that_comes_down_hears_nothing(pair: NodePair) -> None:
    pair.send(0.1)
    settle(pair)
    pair.node.destroy_node()
    assert not pair.hears(1)


def test_an_rclpy_that_takes_messages_otherwise_is_noticed(pair: NodePair) -> None:
    from stickslip_sim.ros.node.subscribers import trouble

    class Handle:
        """One whose method wants other arguments."""

        def __enter__(self) -> None:
            pass

        def __exit__(self, *_: object) -> None:
            pass

        def take_message(self) -> None:
            pass

    other = SimpleNamespace(handle=Handle(), msg_type=pair.subscribers.hidden[0].msg_type)
    assert 'another way to take messages' in trouble(other)


def test_callbacks_hear_where_the_loop_may_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('STICKSLIP_COMMANDS', 'callbacks')
    with running(folder=tmp_path) as process:
        with client() as axis:
            axis.connect()

            def obeys() -> bool:
                axis.send_velocity(0.004)
                return bool(axis.latest('slider_state').drive_velocity == 0.004)

            wait_for(obeys, 'an axis that hears')
            axis.send_velocity(5.0)
            axis.next('timing', lambda timing: timing.total_refused == 1 and timing.latency_p50 > 0.0)
        code, errors = process.end()
    assert code == 0
    assert 'commands are heard by callbacks: STICKSLIP_COMMANDS=callbacks' in errors
