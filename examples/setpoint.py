# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Follow a setpoint on the encoders: 10 mm in 1.4 s, then rest.  With --lockstep it makes the steps of the axis itself.

The axis needs joint_interface.enabled: it measures on joint_states, and in real time hears joint_commands.
"""

import argparse
import math
import time
from collections.abc import Callable
from signal import SIGINT, SIGTERM, signal
from threading import Event
from typing import Any

import rclpy
from rclpy.client import Client
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from stickslip_msgs.srv import Step

_TRAVEL, _TIME, _REST = 0.010, 1.4, 0.6    # m, s, s
_STOP = 0.1                                # s in which the drive is stopped: a command may get lost
_GAIN = 10.0                               # 1/s: velocity for an error of the position
_PATIENCE = 2.0                            # s without a measurement, until it says so
_STEPS = 5                                 # of the axis for each answer in lock-step: 200 Hz beside 1 kHz


def setpoint(time: float) -> tuple[float, float]:
    """Return where the slider should be, m, and how fast, m/s, at a time of the move, s."""
    phase = 2.0 * math.pi * min(time / _TIME, 1.0)
    return _TRAVEL * (phase - math.sin(phase)) / (2.0 * math.pi), _TRAVEL / _TIME * (1.0 - math.cos(phase))


class Follower(Node):
    """Has an answer to each measurement: the velocity of the setpoint, and more where the slider is behind."""

    def __init__(self, sends: bool) -> None:
        super().__init__('follower')
        self.stamp = -1             # ns, of the latest measurement
        self.velocity = math.nan    # m/s, the answer to it
        self.time = 0.0             # s, of the move
        self.worst = 0.0            # m, the largest error so far
        self._begin: tuple[int, float] | None = None
        self._out = self.create_publisher(JointState, 'joint_commands', 1) if sends else None
        self.create_subscription(JointState, 'joint_states', self._answer, 10)

    @property
    def is_done(self) -> bool:
        """Whether move and rest are over, and the drive is stopped."""
        return self.time >= _TIME + _REST + _STOP

    def complain(self, needed: str) -> None:
        """Say once that no axis is heard, what one needs, and where others are."""
        places = [topic.removesuffix('/slider_state') or '/' for topic, _ in self.get_topic_names_and_types()
                  if topic.endswith('/slider_state') and self.count_publishers(topic)]
        self.get_logger().warning(f'waiting for an axis: start sim_node --ros-args {needed} with this ROS_DOMAIN_ID;'
                                  f' axes run in: {", ".join(places) or "no namespace"}'
                                  ' (--ros-args -r __ns:=NAMESPACE)', once=True)

    def _answer(self, measured: JointState) -> None:
        self.stamp = measured.header.stamp.sec * 1_000_000_000 + measured.header.stamp.nanosec
        position = measured.position[measured.name.index('axis_slider')]
        begin, origin = self._begin = self._begin or (self.stamp, position)
        self.time = (self.stamp - begin) * 1e-9
        wanted, speed = setpoint(self.time)
        error = wanted - (position - origin)
        self.worst = max(self.worst, abs(error))
        self.velocity = speed + _GAIN * error if self.time < _TIME + _REST else 0.0
        if self._out is not None:
            self._out.publish(JointState(name=['axis_drive'], velocity=[self.velocity]))


def spin_until(condition: Callable[[], bool], patience: float = math.inf) -> bool:
    """Let messages come in until a condition holds, for `patience` seconds at most; return whether it does."""
    end = time.monotonic() + patience
    while not condition() and time.monotonic() < end:
        if is_over.is_set():
            raise SystemExit(130)
        executor.spin_once(timeout_sec=0.1)
    return condition()


def ask(client: Client, request: Any, patience: float) -> Any:
    """Return the answer of a service, None without one."""
    if not spin_until(client.service_is_ready, patience):
        return None
    answer = client.call_async(request)
    spin_until(answer.done, patience)
    return answer.result()


def make_steps(follower: Follower) -> None:
    """Have steps made under each answer, and wait for the measurement at the end of them."""
    step, reset = follower.create_client(Step, 'feed_axis/step'), follower.create_client(Trigger, 'feed_axis/reset')
    # A server that does not know its client yet loses the answer.  A second reset does no harm; a second step would.
    while not (begun := ask(reset, Trigger.Request(), 1.0)):
        follower.complain('-p time.mode:=lockstep -p joint_interface.enabled:=true')
    if not begun.success:
        raise SystemExit(begun.message)
    while not follower.is_done:
        # NaN: the command in force goes on.
        made = ask(step, Step.Request(steps=_STEPS, velocity=follower.velocity, force=math.nan), 10.0)
        if not made or not made.success:
            raise SystemExit(made.message if made else 'the axis does not answer any more')
        stamp = made.state.header.stamp.sec * 1_000_000_000 + made.state.header.stamp.nanosec
        if not spin_until(lambda: follower.stamp >= stamp, 10.0):  # noqa: B023
            raise SystemExit('no measurement comes: start the axis with -p joint_interface.enabled:=true')


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('--lockstep', action='store_true', help='make the steps of an axis with time.mode lockstep')
in_lock_step = parser.parse_args(remove_ros_args()[1:]).lockstep

# Ctrl-C only sets a flag: raised in the midst of a message it would come out of rclpy as another error.
is_over = Event()
for number in (SIGINT, SIGTERM):
    signal(number, lambda *_: is_over.set())
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
follower = Follower(sends=not in_lock_step)
executor = SingleThreadedExecutor()
executor.add_node(follower)
if in_lock_step:
    make_steps(follower)
else:
    if not spin_until(lambda: follower.stamp >= 0, _PATIENCE):
        follower.complain('-p joint_interface.enabled:=true')
    spin_until(lambda: follower.is_done)
    spin_until(lambda: False, 0.2)    # rest is sent again and again: the last message of a process may be lost
follower.get_logger().info(f'done: the largest error was {follower.worst * 1e3:.6f} mm')
