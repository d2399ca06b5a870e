# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The joints of the axis: what goes out on joint_states, what is taken from joint_commands."""

import math

import numpy as np
import pytest

pytest.importorskip('rclpy')

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from stickslip_sim.core.errors import InputError
from stickslip_sim.realtime.commands import CommandSlot
from stickslip_sim.recording import MessageCodec
from stickslip_sim.recording.messages import header
from stickslip_sim.ros.node.joints import JointNames, JointStatePacker, commanded_velocity, disregarded
from stickslip_sim.simulation import Measured

# lark, which rosidl's Python brings in, imports modules that Python wants to rename.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

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
