# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The controller of controller.py in lock-step: it advances time itself, so all runs are identical, bit for bit."""

import argparse
from signal import SIG_DFL, SIGINT, signal

import rclpy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from stickslip_sim.core.errors import StickslipError
from stickslip_sim.ros.lock_step import LockStep

_STEPS = 5    # of the axis per controller step: 200 Hz at 1 kHz

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('--duration', type=float, default=2.0, help='simulated time, s')
duration = parser.parse_args(remove_ros_args()[1:]).duration

signal(SIGINT, SIG_DFL)    # Ctrl-C ends it, also while it waits
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = rclpy.create_node('controller')
axis = LockStep(node)
try:
    axis.connect()
    axis.begin()
    while axis.state.time < duration:
        axis.step(_STEPS, min(max(20.0 * (0.010 - axis.state.position), -0.010), 0.010))    # m/s
except StickslipError as error:
    raise SystemExit(str(error)) from None
node.get_logger().info(f'{axis.state.time:g} s: {axis.state.position * 1e3:.6f} mm')
rclpy.try_shutdown()
