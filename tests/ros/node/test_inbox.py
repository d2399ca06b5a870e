# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the step loop takes from the middleware, and when a message is made."""

import itertools
import time
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from sensor_msgs.msg import JointState

from stickslip_msgs.msg import DriveVelocity, ExternalForce, SliderState
from stickslip_sim.bags import topics
from stickslip_sim.core.types import Mode
from stickslip_sim.realtime.commands import CommandSlot
from stickslip_sim.recording.messages import Packer
from stickslip_sim.ros.node.endpoints import publisher
from stickslip_sim.ros.node.joints import JointNames
from stickslip_sim.ros.node.publishers import Publishers
from stickslip_sim.ros.node.subscribers import Subscribers, trouble
from tests.support.rigs import make
from tests.support.ros_nodes import bare_nodes, live_axis
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros


class NodePair:
    """Subscribers in one node, publishers in another; nothing spins."""

    def __init__(self, node: Any, sender: Any) -> None:
        self.node, self.sender = node, sender
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
        for velocity in velocities:
            self.velocities.publish(DriveVelocity(velocity=velocity))


@pytest.fixture
def pair() -> Iterator[NodePair]:
    with bare_nodes('inbox', 'sender') as nodes:
        yield NodePair(*nodes)


def settle(pair: NodePair) -> None:
    """Wait until all that was sent has been received, without taking it: a later message on a topic unheard."""
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
    pair.subscribers.hear()
    assert pair.velocity.received == 0


def test_an_rclpy_that_takes_messages_otherwise_is_noticed(pair: NodePair) -> None:

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


def test_callbacks_hear_where_the_loop_may_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('STICKSLIP_COMMANDS', 'callbacks')
    with live_axis() as (process, axis):
        def obeys() -> bool:
            axis.send_velocity(0.004)
            return bool(axis.latest('slider_state').drive_velocity == 0.004)

        wait_for(obeys, 'an axis that hears')
        axis.send_velocity(5.0)
        axis.next('timing', lambda timing: timing.total_refused == 1 and timing.latency_p50 > 0.0)
    assert 'commands are heard by callbacks: STICKSLIP_COMMANDS=callbacks' in process.errors


@pytest.fixture
def node() -> Iterator[Any]:
    with bare_nodes('publishers') as (it,):
        yield it


class Recorder:
    """Takes messages, and forgets them."""

    def __init__(self) -> None:
        self.taken = 0

    def put(self, *_: object) -> None:
        self.taken += 1

    def wait_for_room(self) -> None:
        pass


def test_nothing_is_packed_for_nobody(node: Any, monkeypatch: pytest.MonkeyPatch) -> None:
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
