# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A controller in a process of its own: answers states with drive velocities, and prints the figures.

    python3 -m benchmarks.hil.controller --pid PID --seconds 10

Each answer is another velocity, so that the state which it moved first can be recognised.  Prints its figures as JSON.
"""

import argparse
import json
import os
import time
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile

from stickslip_msgs.msg import DriveVelocity, SliderState
from stickslip_sim.bags import topics
from stickslip_sim.ros.node.endpoints import publisher
from stickslip_sim.ros.programs import make_executor

from ..loop import cpu_seconds
from .process import waited_seconds

SETTLE = 2.0             # s before the measurement: the start of a node is another matter
PATIENCE = 60.0          # s for a node to appear
FEED = 0.002             # m/s
DISTINCT = 1000          # velocities, within one per mille


class Controller(Node):  # type: ignore[misc]
    """Answers every `stride`-th state; counts the steps it never heard of, measures how long its answers take."""

    def __init__(self, stride: int) -> None:
        super().__init__('controller')
        self.step, self.heard, self.lost, self.sent = -1, 0, 0, 0
        self.steps_to_effect: list[float] = []
        self.ns_to_effect: list[float] = []
        self.offsets: list[float] = []         # s, of the steady clock against simulation time, when a state came
        self._stride = stride
        self._waiting: deque[tuple[float, int, int]] = deque(maxlen=DISTINCT // 2)
        self._message = DriveVelocity()
        self._out = publisher(self, topics.DRIVE_VELOCITY)
        self.create_subscription(SliderState, topics.SLIDER_STATE.name, self._take, QoSProfile(depth=1000))

    @property
    def is_connected(self) -> bool:
        """Whether the answers are heard."""
        return bool(self._out.get_subscription_count())

    def begin(self) -> None:
        """Forget what was counted so far."""
        self.heard = self.lost = self.sent = 0
        for figures in (self.steps_to_effect, self.ns_to_effect, self.offsets):
            figures.clear()

    def _take(self, state: SliderState) -> None:
        now = time.monotonic_ns()
        if self.step >= 0:
            self.lost += state.step - self.step - 1
        self.step = state.step
        self.heard += 1
        self.offsets.append(now * 1e-9 - state.time)
        self._look_for_effect(state, now)
        if state.step % self._stride == 0:
            self._answer(state.step, now)

    def _look_for_effect(self, state: SliderState, now: int) -> None:
        """Note an answer that moved the drive; those before it were overtaken."""
        velocities = [velocity for velocity, _, _ in self._waiting]
        if state.drive_velocity not in velocities:
            return
        for _ in range(velocities.index(state.drive_velocity) + 1):
            _, step, sent = self._waiting.popleft()
        self.steps_to_effect.append(state.step - step)
        self.ns_to_effect.append(now - sent)

    def _answer(self, step: int, now: int) -> None:
        velocity = FEED * (1.0 + self.sent % DISTINCT / (1000 * DISTINCT))
        self._message.velocity = velocity
        self._waiting.append((velocity, step, now))
        self.sent += 1
        self._out.publish(self._message)


def measure(controller: Controller, pid: int, seconds: float) -> dict[str, float]:
    """Return the figures of a window, with what the node's process cost; s, and 1/s."""
    executor = make_executor()
    executor.add_node(controller)
    spin(executor, PATIENCE, lambda: controller.heard and controller.is_connected)
    if not controller.heard:
        raise SystemExit(f'no {topics.SLIDER_STATE.name} within {PATIENCE:g} s')
    spin(executor, SETTLE)
    controller.begin()
    begin, cpu, waited, step = time.monotonic(), cpu_seconds(pid), waited_seconds(pid), controller.step
    spin(executor, seconds)
    wall, steps = time.monotonic() - begin, controller.step - step
    return {'steps': steps, 'rate': steps / wall, 'cpu': (cpu_seconds(pid) - cpu) / steps,
            'waited': (waited_seconds(pid) - waited) / wall, 'heard': controller.heard, 'unheard': controller.lost,
            'answers': controller.sent / wall, 'drift': drift(controller.offsets),
            **levels('answer_steps', controller.steps_to_effect),
            **levels('answer', [ns * 1e-9 for ns in controller.ns_to_effect])}


def drift(offsets: list[float]) -> float:
    """Return by how much simulation time lost on the steady clock (s), from the promptest states of both ends."""
    part = max(len(offsets) // 10, 1)
    return min(offsets[-part:]) - min(offsets[:part])


def levels(name: str, values: list[float]) -> dict[str, float]:
    """Return median, 99 % quantile and maximum."""
    if not values:
        return {}
    return dict(zip((f'{name}_p50', f'{name}_p99', f'{name}_max'), np.percentile(values, (50, 99, 100)).tolist()))


def spin(executor: Any, seconds: float, until: Callable[[], object] = lambda: False) -> None:
    """Run callbacks for a time, or until something is true."""
    end = time.monotonic() + seconds
    while time.monotonic() < end and not until():
        executor.spin_once(timeout_sec=0.1)


def main() -> None:
    """Measure one node."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--pid', type=int, required=True, help='process of the node')
    parser.add_argument('--seconds', type=float, default=10.0)
    parser.add_argument('--stride', type=int, default=1, help='answer every state of this many')
    parser.add_argument('--priority', type=int, default=0, help='SCHED_FIFO; 0: none')
    options = parser.parse_args()
    if options.priority:   # the threads of the middleware inherit it
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(options.priority))
    rclpy.init(args=[])
    controller = Controller(options.stride)
    print(json.dumps(measure(controller, options.pid, options.seconds)), flush=True)
    os._exit(0)    # some executors take seconds to come down


if __name__ == '__main__':
    main()
