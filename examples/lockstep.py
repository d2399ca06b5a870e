# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The controller of controller.py in lock-step: time moves when it says so; each run is the same to the last bit."""

import argparse
import math
from signal import SIG_DFL, SIGINT, signal
from typing import Any

import rclpy
from rclpy.client import Client
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args
from std_srvs.srv import Trigger

from stickslip_msgs.srv import Step

_STEPS = 5    # of the axis for each of the controller: 200 Hz beside 1 kHz

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('--duration', type=float, default=2.0, help='of the run, s of simulation time')
duration = parser.parse_args(remove_ros_args()[1:]).duration

signal(SIGINT, SIG_DFL)    # Ctrl-C ends it, also while it waits
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = rclpy.create_node('controller')
step = node.create_client(Step, 'feed_axis/step')
reset = node.create_client(Trigger, 'feed_axis/reset')


def ask(client: Client, request: Any, timeout: float) -> Any:
    """Return the answer, or None when none comes in time."""
    answer = client.call_async(request)
    rclpy.spin_until_future_complete(node, answer, timeout_sec=timeout)
    return answer.result()


# A server that does not know its client yet loses the answer.  A second reset does no harm, but a second step would.
while not step.wait_for_service(timeout_sec=5.0) or not (begun := ask(reset, Trigger.Request(), timeout=1.0)):
    places = [topic.removesuffix('/slider_state') or '/' for topic, _ in node.get_topic_names_and_types()
              if topic.endswith('/slider_state') and node.count_publishers(topic)]
    node.get_logger().warning('waiting for an axis: start sim_node --ros-args -p time.mode:=lockstep with this'
                              f' ROS_DOMAIN_ID; axes run in: {", ".join(places) or "no namespace"}'
                              ' (--ros-args -r __ns:=NAMESPACE)', once=True)
if not begun.success:
    raise SystemExit(begun.message)
time = position = 0.0
while time < duration:
    velocity = min(max(20.0 * (0.010 - position), -0.010), 0.010)    # m/s
    made = ask(step, Step.Request(steps=_STEPS, velocity=velocity, force=math.nan), timeout=10.0)    # NaN: as it is
    if not made or not made.success:
        raise SystemExit(made.message if made else 'the axis does not answer any more')
    time, position = made.state.time, made.state.position
node.get_logger().info(f'{time:g} s: {position * 1e3:.6f} mm')
rclpy.try_shutdown()
