# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""ros2_control's hardware interface at a node, over DDS, with the description that is shipped."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

from stickslip_msgs.msg import RigEvent
from stickslip_msgs.srv import InjectFault
from stickslip_sim.recording import open_bag
from stickslip_sim.scene.load import NODE
from tests.support.node_processes import recording_into
from tests.support.ros2_control_client import (
    SHIPPED,
    THRESHOLD,
    Description,
    Rule,
    States,
    always,
    hardware_interface,
    near_is_silent,
)
from tests.support.ros_nodes import Client, live_axis, nanoseconds
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

ON = ('joint_interface.enabled:=true',)


def joint_states_of(axis: Client) -> list[JointState]:
    heard: list[JointState] = []
    axis.hear(JointState, 'joint_states', heard.append, QoSProfile(depth=5000))
    return heard


def missing_steps(axis: Client, stamps: list[int]) -> list[int]:
    """Return the steps of an axis with 200 of them a second that have no stamp, between the first and the last."""
    start = nanoseconds(axis.latest('run_info').start_time)
    steps = {round((stamp - start) / 5e6) for stamp in stamps}
    return sorted(set(range(min(steps), max(steps))) - steps)


class TestShippedFiles:
    def test_description(self) -> None:
        description = Description('joint_states_topic:=/a', 'joint_commands_topic:=/b')
        assert description.hardware != NODE, 'two nodes of one name in the namespace /'
        assert description.plugin == 'joint_state_topic_hardware_interface/JointStateTopicSystem'
        assert description.parameters == {'joint_states_topic': '/a', 'joint_commands_topic': '/b', THRESHOLD: '-1'}
        assert [(joint.name, joint.commands) for joint in description.joints] == [
            ('axis_slider', []), ('axis_drive', ['velocity'])]
        links = {link.get('name') for link in description.robot.findall('link')}
        for joint in description.robot.findall('joint'):
            assert {joint.find(end).get('link') for end in ('parent', 'child')} <= links   # type: ignore[union-attr]

    def test_controllers(self) -> None:
        file = yaml.safe_load((SHIPPED / 'controllers.yaml').read_text())
        parameters = {name: section['ros__parameters'] for name, section in file.items()}
        known = [joint.name for joint in Description().joints]
        assert parameters['velocity_controller']['joints'] == ['axis_drive']
        position = parameters['position_controller']
        assert position['gains']['axis_drive']['antiwindup_strategy'] == 'none'
        assert set(position['gains']) == set(position['dof_names']) == {'axis_drive'}
        assert set(position['reference_and_state_dof_names']) <= set(known)
        assert set(parameters) - {'controller_manager'} < set(parameters['controller_manager'])


class TestJointStates:
    def test_one_a_step_with_its_stamp_but_none_of_a_lost_measurement(self, tmp_path: Path) -> None:
        with live_axis(*ON, 'time.rate:=200.0', *recording_into(tmp_path / 'run')) as (_, axis):
            heard = joint_states_of(axis)
            wait_for(lambda: heard, 'joint states')
            assert axis.call(InjectFault, 'inject_fault', kind='encoder_dropout', duration=0.1, value=1.0).success
            step = axis.latest('slider_state').step
            later = stamp(axis.next('slider_state', lambda state: state.step > step + 60))
            wait_for(lambda: stamp(heard[-1]) >= later, 'joint states of after the fault')
            missing = missing_steps(axis, [stamp(message) for message in heard])
            axis.wait_for_lost('joint_states', len(missing) - 20)
        states = {stamp(state): state for state in axis.heard['slider_state']}
        joints = {stamp(message): message for message in heard if stamp(message) in states}
        assert len(joints) > 30
        for time, message in joints.items():
            state = states[time]
            assert list(message.name) == ['axis_slider', 'axis_drive']
            assert list(message.position) == [state.position, state.drive_position]
            assert list(message.velocity) == [state.velocity, state.drive_velocity]
            assert list(message.effort) == [0.0, state.drive_force]
        assert any(end - step == 19 for step, end in zip(missing, missing[19:]))
        assert not [topic for topic in open_bag(tmp_path / 'run').topics if 'joint' in topic]

    def test_prefix_frame_and_counts(self) -> None:
        def velocities() -> set[float]:
            return {round(message.velocity[1], 9) for message in heard}

        words = ('joint_interface.prefix:=x_', 'encoder.resolution:=1.0e-4', 'time.rate:=100.0')
        with live_axis(*ON, *words) as (_, axis):
            heard = joint_states_of(axis)
            wait_for(lambda: len(velocities()) > 1, 'the drive to move on')
            assert velocities() == {0.0, 0.01}   # one count a step, or none
            assert {round(message.position[1] / 1e-4, 9) % 1.0 for message in heard} == {0.0}
            out = axis.node.create_publisher(JointState, 'joint_commands', 1)
            good = JointState(name=['x_axis_drive'], velocity=[0.004])
            wait_for(lambda: out.publish(good) or axis.latest('slider_state').drive_velocity == 0.004, 'the node')
        assert list(heard[-1].name) == ['x_axis_slider', 'x_axis_drive']
        assert heard[-1].header.frame_id == 'x_bed'


def has_refused(count: int) -> Callable[[dict[str, str]], bool]:
    return lambda values: values['velocity refused'] == str(count)


def stamp(message: Any) -> int:
    return nanoseconds(message.header.stamp)


class TestCommands:
    def test_a_controller_brings_the_slider_to_a_position(self) -> None:
        """Without a command yet it sends NaN: refused, counted; then the loop closes over both topics."""
        target, begun = 0.002, False
        gain = yaml.safe_load((SHIPPED / 'controllers.yaml').read_text())[
            'position_controller']['ros__parameters']['gains']['axis_drive']['p']

        def update(states: States) -> float | None:
            return gain * (target - states['axis_slider/position']) if begun else None

        def is_there() -> bool:
            seen = hardware.states
            return abs(seen['axis_slider/position'] - target) < 3e-4 and abs(seen['axis_drive/velocity']) < 2e-3

        with live_axis(*ON, 'scene:=positioning', 'command.timeout:=2.0') as (process, axis), \
                hardware_interface(update, period=0.002) as hardware:
            _, values = axis.status('command', lambda values: int(values['velocity refused']) > 10)
            assert values['velocity / (m/s)'] == 'none'
            assert 'velocity = nan is refused' in values['velocity last refusal']
            begun = True
            wait_for(is_there, 'the slider at its target')
            _, values = axis.status('command')    # sent always, with what is shipped
            assert values['timed out'] == '0'
        assert process.errors.count('velocity = nan is refused') <= 5

    def test_what_cannot_be_followed_is_refused_counted_and_reported(self) -> None:
        messages = [JointState(name=['spindle'], velocity=[0.001]), JointState(),
                    JointState(name=['axis_drive'], position=[0.1]),
                    JointState(name=['axis_slider', 'axis_drive'], velocity=[math.nan])]
        with live_axis(*ON) as (process, axis):
            out = axis.node.create_publisher(JointState, 'joint_commands', 1)
            good = JointState(name=['axis_drive'], velocity=[0.004], position=[1.0])
            wait_for(lambda: out.publish(good) or axis.latest('slider_state').drive_velocity == 0.004, 'the node')
            for count, message in enumerate(messages, 1):
                before = len(axis.heard['/diagnostics'])
                out.publish(message)
                status, _ = axis.status('command', has_refused(count), b'\1', before)
                assert 'the previous command stays' in status.message
            assert axis.next('slider_state').drive_velocity == 0.004
        assert "joint_commands.name = ['spindle'] is refused" in process.errors
        assert process.errors.count('position is disregarded') == 1


class TestSilence:
    def test_a_command_near_the_state_is_not_sent_and_the_time_out_says_why(self) -> None:
        with live_axis(*ON, 'time.rate:=200.0', 'command.timeout:=0.3') as (process, axis):
            notes: list[RigEvent] = []
            axis.node.create_subscription(RigEvent, 'rig_event', notes.append, 10)
            axis.greet()
            with hardware_interface(always(0.003), near_is_silent(), Rule.ALL_COMMANDED):
                axis.next('slider_state', lambda state: state.drive_velocity == 0.003)
                status, _ = axis.status('command', lambda values: int(values['timed out']) == 1, b'\1')
        (note,) = (note for note in notes if note.kind == RigEvent.KIND_COMMAND_TIMEOUT)
        assert all(THRESHOLD in text for text in (status.message, note.text, process.errors))
