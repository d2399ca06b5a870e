# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What ros2_control's topic-based hardware interface sends and receives, with a robot description and a controller.

Follows, in names and order, topic_based_system.cpp of PickNikRobotics/topic_based_ros2_control and
joint_state_topic_hardware_interface.cpp of ros-controls/topic_based_hardware_interfaces (docs/ros2_control.md).
"""

import math
import threading
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from enum import Enum
from typing import NamedTuple

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import JointState

from tests.support.repository import ROOT
from tests.support.robot_descriptions import expanded

SHIPPED = ROOT / 'stickslip_sim' / 'ros2_control'
THRESHOLD = 'trigger_joint_command_threshold'
_ARRAYS = ('position', 'velocity', 'effort')
_PERIOD = 0.01    # s

States = dict[str, float]
Update = Callable[[States], float | None]   # states in, a velocity for the drive out; None: none yet


class Rule(Enum):
    """Which differences of state and command, summed, must exceed the threshold for a command to be sent."""

    ALL_POSITIONS = 'topic_based_ros2_control 0.3.0, joint_state_topic_hardware_interface 0.2.1'
    COMMANDED_POSITIONS = 'joint_state_topic_hardware_interface 1.0.0'
    ALL_COMMANDED = 'joint_state_topic_hardware_interface 1.1.0'


class Joint(NamedTuple):
    name: str
    commands: list[str]
    states: list[str]


class Description:
    """The robot description that xacro makes of the words of a command line."""

    def __init__(self, *words: str) -> None:
        self.robot = ET.fromstring(expanded(SHIPPED / 'feed_axis.ros2_control.xacro', *words))
        (control,) = self.robot.findall('ros2_control')
        self.hardware = control.get('name', '')
        self.plugin = control.findtext('hardware/plugin', '')
        self.parameters = {str(tag.get('name')): str(tag.text) for tag in control.findall('hardware/param')}
        self.joints = [Joint(str(joint.get('name')), self._names(joint, 'command'), self._names(joint, 'state'))
                       for joint in control.findall('joint')]

    @staticmethod
    def _names(joint: ET.Element, kind: str) -> list[str]:
        return [str(tag.get('name')) for tag in joint.findall(f'{kind}_interface')]


def near_is_silent() -> Description:
    """Return the shipped description with the default of the C++ code, 1e-5."""
    description = Description()
    del description.parameters[THRESHOLD]
    return description


def always(velocity: float) -> Update:
    return lambda _: velocity


class HardwareInterface:
    """Reads joint_states, lets a controller update its command, and writes joint_commands, over and over."""

    def __init__(self, description: Description, update: Update, rule: Rule, name: str, period: float) -> None:
        self._description, self._update, self._rule, self._period = description, update, rule, period
        parameters = description.parameters
        self._threshold = float(parameters.get(THRESHOLD, '1e-5'))
        unset = 0.0 if rule is Rule.ALL_POSITIONS else math.nan
        self.states = {f'{joint.name}/{kind}': unset for joint in description.joints for kind in joint.states}
        self._commands = {f'{joint.name}/{kind}': unset for joint in description.joints for kind in joint.commands}
        self._latest = JointState()
        self.sent = 0
        self._context = Context()
        rclpy.init(context=self._context)
        self._node = Node(name, context=self._context)
        self._out = self._node.create_publisher(JointState, parameters['joint_commands_topic'], QoSProfile(depth=1))
        self._node.create_subscription(JointState, parameters['joint_states_topic'], self._hear,
                                       qos_profile_sensor_data)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Die as a process that ends: its publisher goes."""
        self._is_over.set()
        self._thread.join()
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def _run(self) -> None:
        while not self._is_over.wait(self._period):
            self._executor.spin_once(timeout_sec=0.0)
            self.read()
            self._command(self._update(self.states))
            self.write()

    def _hear(self, message: JointState) -> None:
        self._latest = message

    def _command(self, velocity: float | None) -> None:
        if velocity is not None:
            self._commands['axis_drive/velocity'] = velocity

    def read(self) -> None:
        """Take over the states; raises KeyError on one without an interface, where the C++ reports an error."""
        for kind in _ARRAYS:
            for name, value in zip(self._latest.name, getattr(self._latest, kind)):
                if self._rule is Rule.ALL_POSITIONS or math.isfinite(value):
                    key = f'{name}/{kind}'
                    assert key in self.states, f'no state interface {key}'
                    self.states[key] = value

    def write(self) -> None:
        """Send the commands, unless they are near the states; each array has those of that interface, in order."""
        if self._difference() <= self._threshold:    # false with NaN
            return
        message = JointState()
        for joint in self._description.joints:
            message.name.append(joint.name)
            message.header.stamp = self._node.get_clock().now().to_msg()
            for kind in joint.commands:
                getattr(message, kind).append(self._commands[f'{joint.name}/{kind}'])
        self._out.publish(message)
        self.sent += 1

    def _difference(self) -> float:
        if self._rule is Rule.ALL_POSITIONS:
            keys = [f'{joint.name}/position' for joint in self._description.joints]
        else:
            keys = [key for key in self._commands
                    if self._rule is Rule.ALL_COMMANDED or key.endswith('/position')]
        return sum(abs(self.states[key] - self._commands.get(key, 0.0)) for key in keys)


@contextmanager
def hardware_interface(update: Update, description: Description | None = None, rule: Rule = Rule.ALL_COMMANDED,
                       name: str = 'topic_based_ros2_control', period: float = _PERIOD) -> Iterator[HardwareInterface]:
    it = HardwareInterface(description or Description(), update, rule, name, period)
    try:
        yield it
    finally:
        it.close()
