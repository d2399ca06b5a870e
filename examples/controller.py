# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An example controller, to be replaced by yours: moves the axis to 10 mm, at 10 mm/s at most."""

import time
from signal import SIGINT, SIGTERM, signal
from threading import Event

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions

from stickslip_msgs.msg import DriveVelocity, SliderState

_PATIENCE = 2.0    # s without a state, until it says so


class Controller(Node):
    """Answers each state with a velocity of the drive."""

    def __init__(self) -> None:
        super().__init__('controller')
        latest_only = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._out = self.create_publisher(DriveVelocity, 'drive_velocity', latest_only)
        self.create_subscription(SliderState, 'slider_state', self._answer, latest_only)
        self._silence = self.create_timer(_PATIENCE, self._complain)

    def _answer(self, state: SliderState) -> None:
        self._silence.cancel()
        self.get_logger().info('connected: the axis sends its states', once=True)
        velocity = 20.0 * (0.010 - state.position)    # m/s
        self._out.publish(DriveVelocity(velocity=min(max(velocity, -0.010), 0.010)))

    def stop(self) -> None:
        """Stop the drive; sent several times, as best effort may lose what is sent last."""
        for _ in range(5):
            self._out.publish(DriveVelocity(velocity=0.0))
            time.sleep(0.02)

    def _complain(self) -> None:
        self._silence.cancel()
        places = [topic.removesuffix('/slider_state') or '/' for topic, _ in self.get_topic_names_and_types()
                  if topic.endswith('/slider_state') and self.count_publishers(topic)]
        self.get_logger().warning('waiting for an axis: start sim_node with this ROS_DOMAIN_ID; axes run in: '
                                  f'{", ".join(places) or "no namespace"} (--ros-args -r __ns:=NAMESPACE)')


# Ctrl-C only sets a flag: raised in the midst of a message it would come out of rclpy as another error.
is_over = Event()
for number in (SIGINT, SIGTERM):
    signal(number, lambda *_: is_over.set())
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
executor, controller = SingleThreadedExecutor(), Controller()
executor.add_node(controller)
while not is_over.is_set():
    executor.spin_once(timeout_sec=0.1)
controller.stop()
