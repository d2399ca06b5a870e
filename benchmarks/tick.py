# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure one tick of the exact engine against what a bare ROS 2 timer costs; add it to a bench.json.

    python3 benchmarks/tick.py --json runs/bench/bench.json

Processor time in one process, in turns: a tick of 1 ms called from Python, and a callback of an rclpy timer that
publishes two messages of the node.
"""

import argparse
import json
import pathlib
import statistics
import time
from collections.abc import Callable

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from stickslip_msgs.msg import FrictionForce, SliderState
from stickslip_sim.bench.contestants import sinusoids_for, state_for
from stickslip_sim.bench.outside import at_most
from stickslip_sim.bench.problem import make_case
from stickslip_sim.solvers import exact

MARK, AIM = 0.02, 0.005
TICKS = 20_000
CALLBACKS = 1000
ROUNDS = 7


def tick_cost() -> Callable[[], float]:
    """Return what measures a tick of 1 ms, s."""
    problem, solver = make_case('B'), exact.SOLVER
    of = solver.records
    p, state, events = of.Parameters(problem.parameters.tolist()), state_for(problem, of), of.Events(64)
    sinusoids = sinusoids_for(problem, of)
    instants = [(float(k // 1000), k % 1000 / 1000.0) for k in range(1, TICKS + 1)]

    def measure() -> float:
        solver.start(p, state, *problem.start, 0.0, 0.0, *problem.pieces[0, 1:], sinusoids, events, 0)
        advance = solver.advance
        begin = time.process_time()
        for second, fraction in instants:
            advance(p, state, second, fraction, events, 0)
        return (time.process_time() - begin) / TICKS

    return measure


def callback_cost() -> Callable[[], float]:
    """Return what measures a callback of a timer, with all that brings it about, s."""
    rclpy.init()
    node = Node('tick')
    state, friction = SliderState(), FrictionForce()
    publishers = (node.create_publisher(SliderState, 'slider_state', 10),
                  node.create_publisher(FrictionForce, 'friction_force', 10))
    left = [0]

    def publish() -> None:
        publishers[0].publish(state)
        publishers[1].publish(friction)
        left[0] -= 1

    node.create_timer(1e-3, publish)
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    def measure() -> float:
        left[0] = CALLBACKS
        begin = time.process_time()
        while left[0] > 0:
            executor.spin_once()
        return (time.process_time() - begin) / CALLBACKS

    return measure


def main() -> None:
    """Measure in turns, print, and add the ratio."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--json', type=pathlib.Path, help='a bench.json that the ratio is added to')
    path = parser.parse_args().json
    tick, callback = tick_cost(), callback_cost()
    tick(), callback()
    pairs = [(tick(), callback()) for _ in range(ROUNDS)]
    ours, bare = (statistics.median(costs) for costs in zip(*pairs))
    ratio = at_most('a tick of 1 ms from Python / a bare rclpy timer callback with two messages', 'B', ours / bare,
                    MARK, AIM)
    print(f'tick {ours * 1e6:.2f} µs, callback {bare * 1e6:.0f} µs, ratio {ratio.measured:.4f}')
    if path:
        data = json.loads(path.read_text(encoding='utf-8'))
        data['ratios'] = [known for known in data['ratios'] if known['what'] != ratio.what] + [ratio._asdict()]
        path.write_text(json.dumps(data, indent=1) + '\n', encoding='utf-8')


if __name__ == '__main__':
    main()
