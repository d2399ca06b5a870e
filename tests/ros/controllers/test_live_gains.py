# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Gains of the controller that compensates, changed while it runs: its model is that of the start."""

from pathlib import Path

import pytest

from stickslip_sim.inputs import load_scene
from stickslip_sim.scene.values import scene_text
from tests.support.node_processes import assert_clean, running
from tests.support.ros_nodes import Client, client
from tests.support.waiting import wait_for

from rclpy.qos import QoSProfile, ReliabilityPolicy  # isort: skip  # after tests.support.ros_nodes, which skips without ROS
from sensor_msgs.msg import JointState  # isort: skip

pytestmark = pytest.mark.ros

NAME = 'compensating_controller'
MODEL, STIFFER = (scene_text(load_scene('positioning', {'axis.drive_stiffness': stiffness}).values)
                  for stiffness in (6e5, 9e5))
BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
MS = 1_000_000


class Measurements:
    """Two of a slide whose spring lets go; the answer to the second crosses part of the gap of friction."""

    def __init__(self, asker: Client) -> None:
        self._heard: dict[int, float] = {}
        self._out = asker.node.create_publisher(JointState, 'joint_states', 10)
        asker.node.create_subscription(JointState, 'joint_commands', self._hear, BEST_EFFORT)

    def answer(self) -> float:
        """Return the velocity, m/s; said until it is answered, for a measurement said again changes nothing."""
        self._answer_to(0, 0.001)
        return self._answer_to(10 * MS, 0.0006)

    def _answer_to(self, nanoseconds: int, spring: float) -> float:
        self._heard.clear()
        message = JointState(name=['axis_slider', 'axis_drive'], position=[0.0, spring], velocity=[1e-4, 1e-4])
        message.header.stamp.nanosec = nanoseconds

        def ask() -> bool:
            self._out.publish(message)
            return nanoseconds in self._heard

        wait_for(ask, 'an answer')
        return self._heard[nanoseconds]

    def _hear(self, message: JointState) -> None:
        self._heard[message.header.stamp.nanosec] = message.velocity[0]


@pytest.mark.parametrize('text', [None, 'no scene', STIFFER])
def test_with_the_file_of_its_model_changed_or_gone(tmp_path: Path, text: str | None) -> None:
    file = tmp_path / 'model.yaml'
    file.write_text(MODEL)
    with running('-p', f'compensation.model:={file}', program=NAME) as controller, client() as asker:
        measurements = Measurements(asker)
        answers = [measurements.answer()]
        file.unlink() if text is None else file.write_text(text)
        for share in (0.5, 0.9):
            assert asker.set_parameters(NAME, compensation__share=share).successful
            answers.append(measurements.answer())
        assert_clean(*controller.end())
    first, other, same = answers
    assert first == same > other
