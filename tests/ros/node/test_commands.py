# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Commands and joints as bytes: read as they come, with any header; those that are none are refused in one line."""

import math
from functools import partial
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from stickslip_msgs.msg import DriveVelocity, ExternalForce
from stickslip_sim.bags import topics
from stickslip_sim.bags.topics import DRIVE_VELOCITY, EXTERNAL_FORCE, JOINT_COMMANDS
from stickslip_sim.core.errors import InputError
from stickslip_sim.realtime.commands import CommandSlot
from stickslip_sim.recording import MessageCodec, flat_layout
from stickslip_sim.recording.messages import header
from stickslip_sim.ros.node.endpoints import command_reader, message_of, message_type, publisher
from stickslip_sim.ros.node.joints import JointNames, JointStatePacker, commanded_velocity, disregarded
from stickslip_sim.simulation import Measured
from tests.support.made_up_texts import accepts_or_refuses
from tests.support.ros_nodes import Client, live_axis
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros


@pytest.mark.parametrize('frame_id', ['', 'a', 'abc', 'axis', 'axis_drive'])
@pytest.mark.parametrize(('topic', 'field'), [(topics.DRIVE_VELOCITY, 'velocity'), (topics.EXTERNAL_FORCE, 'force')])
def test_numbers_of_a_message_of_rclpy(topic: topics.Topic, field: str, frame_id: str) -> None:
    data = serialize_message(command(topic, field, frame_id, -0.25))
    numbers = flat_layout(topic.type).numbers(data)
    assert numbers == (None if frame_id else [-0.25])


@pytest.mark.parametrize('data', [b'', b'\0\1\0\0', b'\0\0' + bytes(26), bytes(28)])
def test_other_bytes_have_no_numbers(data: bytes) -> None:
    assert flat_layout(topics.DRIVE_VELOCITY.type).numbers(data) is None


@pytest.mark.parametrize('topic', [topics.DRIVE_VELOCITY, topics.EXTERNAL_FORCE])
@pytest.mark.parametrize(('data', 'reported'), [
    (b'', '0 bytes'), (b'\0\1\0\0', 'its sender is broken'), (b'\0\1\0\0' + b'\xff' * 100, 'its sender is broken'),
    (bytes(5000), 'at most 4096 bytes'),
])
def test_bytes_that_are_no_command(topic: topics.Topic, data: bytes, reported: str) -> None:
    with pytest.raises(InputError, match=topic.name) as refusal:
        command_reader(topic)(data)
    assert reported in str(refusal.value)


def test_a_node_outlives_senders_that_mean_no_good() -> None:
    """Each publishes what is no message of its type, or far too much; one that is meant well is heard after each."""
    bad = [b'', b'\0\1\0\0', b'\0\1\0\0' + b'\xff' * 100, b'\0\1\0\0' + bytes(8) + b'\xff\xff\xff\x7f',
           JointState(name=['axis_drive'] * 100_000, velocity=[1.0] * 100_000)]
    with live_axis('joint_interface.enabled:=true') as (_, axis):
        for topic in (topics.DRIVE_VELOCITY, topics.EXTERNAL_FORCE, topics.JOINT_COMMANDS):
            sender = publisher(axis.node, topic)
            wait_for(sender.get_subscription_count, 'the axis')
            for count, message in enumerate(bad[:None if topic == topics.JOINT_COMMANDS else -1], 1):
                sender.publish(message)
                wait_for(partial(obeys, axis, 1e-3 * count), 'an axis that goes on listening')
        axis.next('timing', lambda timing: timing.total_refused > len(bad) or sender.publish(bad[1]))    # some get lost


def obeys(axis: Client, velocity: float) -> bool:
    """Send a velocity, as often as asked: one message may get lost on best-effort topics."""
    axis.send_velocity(velocity)
    return bool(axis.latest('slider_state').drive_velocity == velocity)


def command(topic: topics.Topic, field: str, frame_id: str, value: float) -> Any:
    message = message_type(topic)(**{field: value})
    message.header.frame_id = frame_id
    return message


AXIS, X_AXIS = JointNames(), JointNames.of('x_')
NAMES = list(AXIS.joints)


@pytest.mark.parametrize('prefix', ['', 'x_', 'left/', 'a' * 200])
def test_bytes_are_those_of_the_message(prefix: str) -> None:
    names = JointNames.of(prefix)
    assert names == tuple(prefix + name for name in ('axis_slider', 'axis_drive', 'bed'))
    measured = Measured(slider_position=1.5, slider_velocity=-0.0, drive_position=math.pi, drive_velocity=1e-300)
    stamp_ns = 1_700_000_000_123_456_789
    message = JointState(name=list(names.joints), position=[1.5, math.pi], velocity=[-0.0, 1e-300],
                         effort=[0.0, -732.25])
    message.header.frame_id = names.bed
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp_ns, 10**9)
    data = JointStatePacker(names).pack(stamp_ns, measured, -732.25)
    assert deserialize_message(data, JointState) == message
    arrays = {field: np.array(getattr(message, field)) for field in ('position', 'velocity', 'effort')}
    kind = 'sensor_msgs/msg/JointState'
    assert data == MessageCodec([kind]).encode(kind, {
        'header': header(stamp_ns, names.bed), 'name': list(names.joints), **arrays})


class TestCommandedVelocity:
    @pytest.mark.parametrize('names', [['axis_drive'], NAMES, NAMES[::-1]])
    def test_one_velocity_is_that_of_the_drive(self, names: list[str]) -> None:
        assert commanded_velocity(JointState(name=names, velocity=[0.25]), AXIS) == 0.25

    def test_as_many_as_names_go_by_name(self) -> None:
        assert commanded_velocity(JointState(name=NAMES, velocity=[0.5, 0.25]), AXIS) == 0.25
        assert commanded_velocity(JointState(name=NAMES[::-1], velocity=[0.25, 0.5]), AXIS) == 0.25

    def test_with_a_prefix(self) -> None:
        message = JointState(name=['x_axis_slider', 'x_axis_drive'], velocity=[0.5, 0.25])
        assert commanded_velocity(message, X_AXIS) == 0.25
        assert disregarded(message, X_AXIS) == 'velocity of x_axis_slider'
        for others in (NAMES, ['y_axis_drive']):
            with pytest.raises(InputError, match='must be of x_axis_slider, x_axis_drive'):
                commanded_velocity(JointState(name=others, velocity=[0.25]), X_AXIS)

    def test_none_yet(self) -> None:
        assert math.isnan(commanded_velocity(JointState(name=NAMES, velocity=[math.nan]), AXIS))

    @pytest.mark.parametrize(('message', 'reported'), [
        (JointState(), 'joint_commands.name = [] is refused: must be axis_drive'),
        (JointState(velocity=[0.1]), 'joint_commands.name = []'),
        (JointState(name=['axis_x', 'axis_drive'], velocity=[0.1]), "name = ['axis_x'] is refused: must be of axis_sl"),
        (JointState(name=['axis_slider'], velocity=[0.1]), "name = ['axis_slider']"),
        (JointState(name=['axis_drive'] * 2, velocity=[0.1, 0.2]), 'each once'),
        (JointState(name=NAMES), 'nothing came instead'),
        (JointState(name=NAMES, position=[0.1]), 'position came instead'),
        (JointState(name=NAMES, position=[0.1], effort=[2.0]), 'position and effort came instead'),
        (JointState(name=NAMES, velocity=[0.1] * 3), 'one for each of axis_slider, axis_drive'),
        (JointState(name=['axis_drive'], velocity=[0.1] * 2), 'one for each of axis_drive'),
        (JointState(name=['x' * 10_000] * 100, velocity=[0.1]), 'name the joints of this axis only'),
    ])
    def test_refused(self, message: JointState, reported: str) -> None:
        with pytest.raises(InputError) as refusal:
            commanded_velocity(message, AXIS)
        assert reported in str(refusal.value)
        assert len(str(refusal.value)) < 300

    @pytest.mark.parametrize(('message', 'reported'), [
        (JointState(name=NAMES, velocity=[0.1]), ''),
        (JointState(name=NAMES, velocity=[0.0, 0.1]), ''),
        (JointState(name=NAMES, velocity=[math.nan, 0.1], position=[math.nan]), ''),
        (JointState(name=NAMES, velocity=[0.2, 0.1]), 'velocity of axis_slider'),
        (JointState(name=NAMES[::-1], velocity=[0.2, 0.1], position=[0.0]), 'position and velocity of axis_slider'),
    ])
    def test_what_is_disregarded(self, message: JointState, reported: str) -> None:
        assert disregarded(message, AXIS) == reported


def test_a_refused_message_counts_and_leaves_the_command() -> None:
    slot = CommandSlot('velocity', 'm/s', 1.0)
    slot.offer(0.5, 1)
    assert slot.refuse('no such joint') == slot.last_refusal == 'no such joint; the previous command stays'
    assert (slot.received, slot.refused) == (2, 1)
    assert slot.latest is not None
    assert slot.latest.value == 0.5


LIMIT = 1.0
STAMPS = st.builds(Time, sec=st.integers(-2**31, 2**31 - 1), nanosec=st.integers(0, 2**32 - 1))
FRAMES = st.text(st.characters(exclude_categories=['Cs'], exclude_characters='\0'), max_size=9)
NUMBERS = st.floats() | st.sampled_from((LIMIT, -LIMIT, math.nextafter(LIMIT, 2.0), 5e-324))


@settings(max_examples=150)
@given(stamp=STAMPS, frame=FRAMES, number=NUMBERS, data=st.binary(max_size=60))
def test_commands(stamp: Time, frame: str, number: float, data: bytes) -> None:
    header = Header(stamp=stamp, frame_id=frame)
    for topic, message in ((DRIVE_VELOCITY, DriveVelocity(header=header, velocity=number)),
                           (EXTERNAL_FORCE, ExternalForce(header=header, force=number))):
        whole, slot = bytes(serialize_message(message)), CommandSlot('number', 'unit', LIMIT)
        read = command_reader(topic)
        assert bool(slot.offer(read(whole), 0)) == (not abs(number) <= LIMIT)
        for sent in (whole[:len(data)], data + whole[len(data):], whole + data, data):
            found = accepts_or_refuses(read, sent)
            if isinstance(found, float):
                refusal = slot.offer(found, 0)
                assert refusal.isprintable(), refusal


WORDS = st.sampled_from(['axis_drive', 'axis_slider', '', 'axis_drive\n', '\x1b[2J']) | st.text(max_size=5)
JOINTS = JointNames()
LISTS = st.lists(st.floats(), max_size=4)


@settings(max_examples=150)
@given(names=st.lists(WORDS, max_size=4), position=LISTS, velocity=LISTS, effort=LISTS,
       data=st.binary(max_size=80))
def test_joint_commands(names: list[str], position: list[float], velocity: list[float], effort: list[float],
                        data: bytes) -> None:
    message = JointState(name=names, position=position, velocity=velocity, effort=effort)
    whole = serialize_message(message)
    for sent in (whole, whole[:len(data)] + data, data):
        found = accepts_or_refuses(message_of, JOINT_COMMANDS, sent)
        if isinstance(found, JointState) and accepts_or_refuses(commanded_velocity, found, JOINTS) is not None:
            disregarded(found, JOINTS)


@pytest.mark.parametrize('data', [b'', b'\x00\x01\x00', b'\x00\x01\x00\x01', b'\x00\x01\x00\x03ab'])
def test_fewer_bytes_than_their_header_says(data: bytes) -> None:
    assert accepts_or_refuses(message_of, JOINT_COMMANDS, data) is None
