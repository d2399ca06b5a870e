# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Made-up joint commands, and bytes that are nearly some: a velocity, or refused in one line."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip('rclpy')

from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

from stickslip_sim.bags.topics import JOINT_COMMANDS
from stickslip_sim.ros.node.endpoints import message_of
from stickslip_sim.ros.node.joints import JointNames, commanded_velocity, disregarded
from tests.support.refusals import accepts_or_refuses

# lark, which rosidl's Python brings in, imports modules that Python wants to rename.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

WORDS = st.sampled_from(['axis_drive', 'axis_slider', '', 'axis_drive\n', '\x1b[2J']) | st.text(max_size=5)
JOINTS = JointNames()
NUMBERS = st.lists(st.floats(), max_size=4)


@settings(max_examples=300)
@given(names=st.lists(WORDS, max_size=4), position=NUMBERS, velocity=NUMBERS, effort=NUMBERS,
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
