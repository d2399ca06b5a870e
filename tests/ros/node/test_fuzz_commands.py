# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Made-up velocities and forces, stamped at any time, and bytes that are nearly some: taken, or refused in one line."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip('rclpy')

from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message
from std_msgs.msg import Header

from stickslip_sim.bags.topics import DRIVE_VELOCITY, EXTERNAL_FORCE
from stickslip_sim.realtime.commands import CommandSlot
from stickslip_sim.ros.node.endpoints import command_reader
from tests.support.refusals import accepts_or_refuses

from stickslip_msgs.msg import DriveVelocity, ExternalForce  # isort: skip

# lark, which rosidl's Python brings in, imports modules that Python wants to rename.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

LIMIT = 1.0
STAMPS = st.builds(Time, sec=st.integers(-2**31, 2**31 - 1), nanosec=st.integers(0, 2**32 - 1))
FRAMES = st.text(st.characters(exclude_categories=['Cs'], exclude_characters='\0'), max_size=9)
NUMBERS = st.floats() | st.sampled_from((LIMIT, -LIMIT, math.nextafter(LIMIT, 2.0), 5e-324))


@settings(max_examples=300)
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
