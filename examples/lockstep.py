# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The controller of controller.py in lock-step: time moves when it says so; each run is the same to the last bit."""

import argparse
import math

import rclpy
from rclpy.utilities import remove_ros_args

from stickslip_msgs.srv import Step

_STEPS = 5    # of the axis for each of the controller: 200 Hz beside 1 kHz

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('--duration', type=float, default=2.0, help='of the run, s of simulation time')
duration = parser.parse_args(remove_ros_args()[1:]).duration

rclpy.init()
node = rclpy.create_node('controller')
axis = node.create_client(Step, 'feed_axis/step')
while not axis.wait_for_service(timeout_sec=5.0):
    node.get_logger().info('waiting for an axis with time.mode lockstep')
time = position = 0.0
while time < duration:
    velocity = min(max(20.0 * (0.010 - position), -0.010), 0.010)    # m/s
    answer = axis.call_async(Step.Request(steps=_STEPS, velocity=velocity, force=math.nan))    # NaN: as it is
    rclpy.spin_until_future_complete(node, answer, timeout_sec=10.0)
    if not answer.done() or not answer.result().success:
        raise SystemExit(answer.result().message if answer.done() else 'the axis does not answer any more')
    time, position = answer.result().state.time, answer.result().state.position
node.get_logger().info(f'{time:g} s: {position * 1e3:.6f} mm')
rclpy.try_shutdown()
