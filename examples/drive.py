# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Send a drive velocity or a force to the axis: `drive.py 0.005` (m/s) or `drive.py --force 400` (N)."""

import argparse
import sys
import time
from collections.abc import Iterable

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.utilities import remove_ros_args

from stickslip_msgs.msg import DriveVelocity, ExternalForce, RigEvent, StepTiming

_REPORTS = 2         # of the axis, one a second: what was refused comes before them
_PATIENCE = 10.0     # s to wait for these
_SILENCE = 2.0       # s without an axis, until it says so
_UNITS = {'velocity': 'm/s', 'force': 'N'}


def parse() -> dict[str, DriveVelocity | ExternalForce]:
    """Return what to send, by topic."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('velocity', type=float, nargs='?', help='drive velocity, m/s; held until the next command')
    parser.add_argument('--force', type=float, help='force on the slider, N; held until the next command')
    options = parser.parse_args(remove_ros_args()[1:])
    messages = {}
    if options.velocity is not None:
        messages['drive_velocity'] = DriveVelocity(velocity=options.velocity)
    if options.force is not None:
        messages['external_force'] = ExternalForce(force=options.force)
    if not messages:
        parser.error('give a velocity in m/s, or --force in N')
    return messages


def wait_for_axis(node: Node, topics: Iterable[str]) -> None:
    """Wait until an axis listens; say once that none does, and where others are."""
    end = time.monotonic() + _SILENCE
    while not (all(map(node.count_subscribers, topics)) and node.count_publishers('rig_event')):
        rclpy.spin_once(node, timeout_sec=0.1)
        if time.monotonic() > end:
            places = [topic.removesuffix('/slider_state') or '/' for topic, _ in node.get_topic_names_and_types()
                      if topic.endswith('/slider_state') and node.count_publishers(topic)]
            node.get_logger().warning(
                'waiting for an axis: start sim_node with this ROS_DOMAIN_ID; axes run in: '
                f'{", ".join(places) or "no namespace"} (--ros-args -r __ns:=NAMESPACE)', once=True)


def send(node: Node, messages: dict[str, DriveVelocity | ExternalForce]) -> None:
    """Send the messages until the axis has reported on them; exits with 2 on a refusal, with 1 without a report."""
    log = node.get_logger()
    names = {topic: topic.rpartition('_')[2] for topic in messages}
    mine = [f'{name} = {getattr(messages[topic], name)} ' for topic, name in names.items()]
    refused: list[str] = []
    reports: list[StepTiming] = []

    def hear(event: RigEvent) -> None:
        if event.kind != RigEvent.KIND_COMMAND_REFUSED:
            log.warning(event.text)
        elif ' = ' not in event.text or any(value in event.text for value in mine):    # not one of another sender
            refused.append(event.text)

    node.create_subscription(RigEvent, 'rig_event', hear, 10)
    latest_only = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
    out = {topic: node.create_publisher(type(message), topic, latest_only) for topic, message in messages.items()}
    wait_for_axis(node, messages)
    log.info(f'sending {" and ".join(messages)}')
    node.create_subscription(StepTiming, 'timing', reports.append, 10)
    # Best effort: an axis that has not quite found its sender yet loses the first ones.
    end = time.monotonic() + _PATIENCE
    while not (refused or is_taken(reports)) and time.monotonic() < end:
        for topic, message in messages.items():
            message.header.stamp = node.get_clock().now().to_msg()
            out[topic].publish(message)
        rclpy.spin_once(node, timeout_sec=0.1)
    if refused:
        log.error(refused[0])
        sys.exit(2)
    if not is_taken(reports):
        sys.exit(f'the axis has not reported within {_PATIENCE:g} s: whether it took the command is not known')
    log.info(f'taken: {", ".join(f"{value.strip()} {_UNITS[name]}" for value, name in zip(mine, names.values()))}')


def is_taken(reports: list[StepTiming]) -> bool:
    """Return whether the axis has received commands between reports; what it refused of them came before these."""
    return len(reports) >= _REPORTS and reports[-1].total_received > reports[0].total_received


messages = parse()
rclpy.init()
try:
    send(rclpy.create_node('driver'), messages)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
except RuntimeError:    # of rclpy, when Ctrl-C comes just before a call
    if rclpy.ok():
        raise
