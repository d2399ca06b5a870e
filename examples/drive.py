# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Send a drive velocity or a force to the axis: `drive.py 0.005` (m/s) or `drive.py --force 400` (N)."""

import argparse
import time
from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.utilities import remove_ros_args

from stickslip_msgs.msg import DriveVelocity, ExternalForce, RigEvent, StepTiming

_REPORTS = 2         # of the axis, one a second: what was refused comes before them
_PATIENCE = 10.0     # s to wait for these


def parse() -> dict[str, DriveVelocity | ExternalForce]:
    """Return what to send, by topic."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('velocity', type=float, nargs='?', help='of the drive, m/s; it is held until the next one')
    parser.add_argument('--force', type=float, help='on the slider, N; it is held until the next one')
    options = parser.parse_args(remove_ros_args()[1:])
    messages = {}
    if options.velocity is not None:
        messages['drive_velocity'] = DriveVelocity(velocity=options.velocity)
    if options.force is not None:
        messages['external_force'] = ExternalForce(force=options.force)
    if not messages:
        parser.error('give a velocity in m/s, or --force in N')
    return messages


def send(node: Node, messages: dict[str, DriveVelocity | ExternalForce]) -> None:
    """Send the messages as soon as the axis listens, until it has reported on them; exits with what it refuses."""
    log = node.get_logger()
    mine = [f' = {getattr(each, name.rpartition("_")[2])} ' for name, each in messages.items()]
    refused: list[str] = []
    reports: list[StepTiming] = []

    def hear(event: RigEvent) -> None:
        if event.kind == RigEvent.KIND_COMMAND_REFUSED:
            if any(value in event.text for value in mine):    # and not one of another sender
                refused.append(event.text)
        else:
            log.warning(event.text)

    node.create_subscription(RigEvent, 'rig_event', hear, 10)
    latest_only = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
    out = {topic: node.create_publisher(type(message), topic, latest_only) for topic, message in messages.items()}
    while not (all(each.get_subscription_count() for each in out.values()) and node.count_publishers('rig_event')):
        log.info(f'waiting for an axis that listens on {", ".join(out)}', throttle_duration_sec=5.0)
        rclpy.spin_once(node, timeout_sec=0.1)
    log.info(f'sending {" and ".join(messages)}')
    node.create_subscription(StepTiming, 'timing', reports.append, 10)
    # Best effort: an axis that has not quite found its sender yet loses the first ones.
    end = time.monotonic() + _PATIENCE
    while len(reports) < _REPORTS and not refused and time.monotonic() < end:
        for topic, message in messages.items():
            message.header.stamp = node.get_clock().now().to_msg()
            out[topic].publish(message)
        rclpy.spin_once(node, timeout_sec=0.1)
    if refused:
        raise SystemExit(refused[0])
    if len(reports) < _REPORTS:
        raise SystemExit(f'the axis has not reported within {_PATIENCE:g} s: whether it took the command is not known')


messages = parse()
rclpy.init()
with suppress(KeyboardInterrupt, ExternalShutdownException):
    send(rclpy.create_node('driver'), messages)
