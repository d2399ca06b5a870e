# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Send a drive velocity or a force to the axis: `drive.py 0.005` (m/s) or `drive.py --force 400` (N)."""

import argparse

import rclpy
from rclpy.qos import QoSProfile, ReliabilityPolicy

from stickslip_msgs.msg import DriveVelocity, ExternalForce

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('velocity', type=float, nargs='?', help='of the drive, m/s; it is held until the next one')
parser.add_argument('--force', type=float, help='on the slider, N; it is held until the next one')
options = parser.parse_args()
if options.velocity is None and options.force is None:
    parser.error('give a velocity in m/s, or --force in N')

rclpy.init()
node = rclpy.create_node('driver')
latest_only = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
messages = {}
if options.velocity is not None:
    messages['drive_velocity'] = DriveVelocity(velocity=options.velocity)
if options.force is not None:
    messages['external_force'] = ExternalForce(force=options.force)
for topic, message in messages.items():
    publisher = node.create_publisher(type(message), topic, latest_only)
    while publisher.get_subscription_count() == 0:    # wait for the axis to be found
        rclpy.spin_once(node, timeout_sec=0.1)
    message.header.stamp = node.get_clock().now().to_msg()
    publisher.publish(message)
    publisher.wait_for_all_acked()
    node.get_logger().info(f'{topic}: {message}')
node.destroy_node()
rclpy.try_shutdown()
