# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A reliable subscriber of states that takes 50 ms for each, in a process of its own: what must hold up no step.

    python3 -m benchmarks.hil.slow_listener

Ends with Ctrl-C, and prints how many states it took.
"""

import signal
import time

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from stickslip_msgs.msg import SliderState
from stickslip_sim.bags import topics
from stickslip_sim.ros.node.endpoints import subscription
from stickslip_sim.ros.programs import make_executor

TAKES = 0.05    # s for a state


def main() -> None:
    """Listen until Ctrl-C."""
    taken: list[int] = []
    ends: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _: ends.append(number))
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    node = Node('slow_listener')

    def take(state: SliderState) -> None:
        time.sleep(TAKES)
        taken.append(state.step)

    subscription(node, topics.SLIDER_STATE, take)
    executor = make_executor()
    executor.add_node(node)
    while not ends:
        executor.spin_once(timeout_sec=0.1)
    print(len(taken), flush=True)


if __name__ == '__main__':
    main()
