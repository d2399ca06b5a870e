# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A node that does what sim_node does at each step except simulate: the measure of what rclpy itself costs.

    python3 -m benchmarks.hil.bare_node --rate 1000 [--bag FOLDER]

Ends with SIGINT or SIGTERM and prints how the steps kept their time.
"""

import argparse
import gc
import itertools
import json
import signal
import sys
import threading
from pathlib import Path

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.serialization import serialize_message
from rclpy.signals import SignalHandlerOptions

from stickslip_msgs.msg import DriveVelocity, ExternalForce, FrictionForce, SliderState
from stickslip_sim.bags import topics
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.realtime.pacing import Pacer, wake_precisely
from stickslip_sim.realtime.scheduling import Scheduling, StepThread
from stickslip_sim.realtime.timing_statistics import TimingStatistics
from stickslip_sim.recording import RECORDED, RecorderThread, RunFacts, open_run
from stickslip_sim.ros.node.endpoints import publisher, set_stamp, subscription
from stickslip_sim.ros.programs import make_executor

POLL = 0.1                # s
SWITCH_INTERVAL = 5e-5    # s, as in sim_node


class BareNode(Node):  # type: ignore[misc]
    """Steps in a thread with absolute deadlines; in a step, two messages are filled and published."""

    def __init__(self, rate: float, priority: int, recorder: RecorderThread | None) -> None:
        super().__init__('bare')
        self.step_thread = StepThread(Scheduling(thread_priority=priority, lock_memory=priority > 0))
        self.timing_statistics, self.pacer = TimingStatistics(), Pacer(Grid(rate))
        self._grid, self._recorder = Grid(rate), recorder
        self._velocity = self._force = 0.0
        self._state, self._friction = SliderState(), FrictionForce()
        self._ports = [(RECORDED.index(topic), publisher(self, topic), message) for topic, message in
                       ((topics.SLIDER_STATE, self._state), (topics.FRICTION_FORCE, self._friction))]
        subscription(self, topics.DRIVE_VELOCITY, self._take_velocity)
        subscription(self, topics.EXTERNAL_FORCE, self._take_force)
        self._start_ns = self.get_clock().now().nanoseconds
        self.is_over = threading.Event()
        self.thread = threading.Thread(target=self._run)

    def _take_velocity(self, message: DriveVelocity) -> None:
        self._velocity = message.velocity

    def _take_force(self, message: ExternalForce) -> None:
        self._force = message.force

    def _run(self) -> None:
        wake_precisely()
        self.step_thread.enter()
        self.pacer.restart(0)
        for step in itertools.count():
            while not self.pacer.wait(step):
                pass
            if self.is_over.is_set():
                return
            begin, lateness = self.pacer.begin(step)
            time_ns = self._grid.nanoseconds(step)
            self._step(step, time_ns)
            self.timing_statistics.add(time_ns, self.pacer.now() - begin, lateness, None, None)

    def _step(self, step: int, time_ns: int) -> None:
        self._fill(step, time_ns)
        for index, out, message in self._ports:
            out.publish(message)
            if self._recorder:
                data = serialize_message(message)
                self._recorder.put(index, data, time_ns, self._start_ns + time_ns, step)

    def _fill(self, step: int, time_ns: int) -> None:
        state, friction = self._state, self._friction
        for message in (state, friction):
            set_stamp(message.header.stamp, self._start_ns + time_ns)
            message.step = step
            message.time = time_ns * 1e-9
            message.mode = 0
            message.direction = 0
        state.position = state.velocity = state.acceleration = 0.0
        state.drive_position = state.drive_force = state.rest_time = 0.0
        state.drive_velocity = self._velocity
        friction.force = self._force
        friction.coefficient = friction.contact_deflection = 0.0


def main() -> None:
    """Run until a signal comes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--rate', type=float, default=1000.0, help='1/s')
    parser.add_argument('--priority', type=int, default=0, help='SCHED_FIFO; 0: none')
    parser.add_argument('--bag', type=Path, help='record into this folder')
    options = parser.parse_args()
    sys.setswitchinterval(SWITCH_INTERVAL)
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    facts = RunFacts('bare', '', '', 'none', 0, options.rate)
    recorder = RecorderThread(open_run(options.bag, facts)) if options.bag else None
    node = BareNode(options.rate, options.priority, recorder)
    spin(node, stop)
    if recorder:
        recorder.close()
    lateness = node.timing_statistics.take().lateness
    print(json.dumps({'lateness_p50': lateness.p50, 'lateness_p99': lateness.p99, 'lateness_max': lateness.max,
                      'overruns': node.pacer.counters.overruns / node.pacer.counters.steps}))
    rclpy.try_shutdown()


def spin(node: BareNode, stop: threading.Event) -> None:
    """Step and run callbacks until asked to stop."""
    executor = make_executor()
    executor.add_node(node)
    gc.collect()
    gc.freeze()
    node.step_thread.lead(print)
    node.thread.start()
    try:
        while not stop.is_set():
            executor.spin_once(timeout_sec=POLL)
    except ExternalShutdownException:
        pass
    finally:
        node.is_over.set()
        node.thread.join()


if __name__ == '__main__':
    main()
