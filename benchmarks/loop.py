# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure the loops that could drive the node: docs/data/loop.json, on which the choice rests.

    python3 -m benchmarks.loop [--seconds 4] [--repeats 3] [--out docs/data/loop.json]

Every case runs in a process of its own, which publishes two messages of the node (filled in place, serialized once) in
each step; figures are medians over the repeats.  A case with commands receives drive velocities at 1 kHz from a further
process.  The rows `sim_node` are the node itself, with figures from its topic `timing` and from the kernel.
"""

import argparse
import gc
import itertools
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from typing import Any, NoReturn

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.executors import SingleThreadedExecutor
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message

from stickslip_msgs.msg import DriveVelocity, FrictionForce, SliderState, StepTiming
from stickslip_sim.bench import report
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.realtime.pacing import Pacer, wake_precisely

from .measured import DATA, keep

LOOPS = {
    'timer-single': 'rclpy timer, SingleThreadedExecutor',
    'timer-events': 'rclpy timer, EventsExecutor',
    'coarse-events': 'own thread with the default timer slack, EventsExecutor',
    'thread-single': 'own thread, SingleThreadedExecutor',
    'thread-events': 'own thread, EventsExecutor',
    'node': '`sim_node` on `paper_fig8`, all topics',
}
RATES = (1000, 2000, 4000)
COMMANDS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class Publishing:
    """What every loop does in a step: two messages out."""

    def __init__(self, node: Node) -> None:
        self._state, self._friction = SliderState(), FrictionForce()
        self._publishers = (node.create_publisher(SliderState, 'slider_state', 10),
                            node.create_publisher(FrictionForce, 'friction_force', 10))
        self.lateness: list[int] = []

    def step(self, lateness: int) -> None:
        """Note how late the step is (ns), and publish."""
        self.lateness.append(lateness)
        state, friction = self._state, self._friction
        state.step += 1
        friction.step += 1
        state.position = friction.force = 1e-9 * lateness
        for publisher, message in zip(self._publishers, (state, friction)):
            publisher.publish(serialize_message(message))


def run_timer(node: Node, executor: Any, rate: int, seconds: float, work: Publishing) -> None:
    """Step in the callback of a timer."""
    period = 1_000_000_000 // rate
    due = [0]

    def tick() -> None:
        now = time.monotonic_ns()
        due[0] += period * max((now - due[0]) // period, 1)   # what the timer skipped is missed
        work.step(now - due[0])

    timer = node.create_timer(period * 1e-9, tick)
    due[0] = time.monotonic_ns() + timer.time_until_next_call() - period
    spin(executor, seconds)


def run_coarse(node: Node, executor: Any, rate: int, seconds: float, work: Publishing) -> None:
    """Step in a thread that the kernel may wake 50 µs late."""
    run_thread(node, executor, rate, seconds, work, with_precision=False)


def run_thread(node: Node, executor: Any, rate: int, seconds: float, work: Publishing, *,
               with_precision: bool = True) -> None:
    """Step in a thread with absolute deadlines."""
    stop = threading.Event()

    def loop() -> None:
        if with_precision:
            wake_precisely()
        pacer = Pacer(Grid(float(rate)))
        for step in itertools.count():
            while not pacer.wait(step):
                pass
            if stop.is_set():
                return
            work.step(pacer.begin(step)[1])

    thread = threading.Thread(target=loop)
    thread.start()
    spin(executor, seconds)
    stop.set()
    thread.join()


def spin(executor: Any, seconds: float) -> None:
    """Run callbacks; spin() of the EventsExecutor hangs in the wheels, so spin_once."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        executor.spin_once(timeout_sec=0.1)


def measure(case: str, rate: int, seconds: float, with_commands: bool) -> NoReturn:
    """Run one case in this process and print its figures."""
    if case == 'node':
        finish(watch_node(rate, seconds))
    form, executor_name = case.split('-')
    sys.setswitchinterval(5e-5)
    rclpy.init()
    node = Node('loop')
    executor = EventsExecutor() if executor_name == 'events' else SingleThreadedExecutor()
    executor.add_node(node)
    received = [0]

    def receive(_: DriveVelocity) -> None:
        received[0] += 1

    if with_commands:
        subscription = node.create_subscription(DriveVelocity, 'drive_velocity', receive, COMMANDS)
        while not subscription.handle.get_publisher_count():
            executor.spin_once(timeout_sec=0.1)
    work = Publishing(node)
    gc.collect()
    gc.freeze()
    start, cpu = time.monotonic(), time.process_time()
    runners: dict[str, Callable[..., None]] = {'timer': run_timer, 'thread': run_thread, 'coarse': run_coarse}
    runners[form](node, executor, rate, seconds, work)
    wall, cpu = time.monotonic() - start, time.process_time() - cpu
    late = statistics.quantiles(work.lateness, n=1000, method='inclusive')
    finish({'achieved': len(work.lateness) / wall, 'commands': received[0] / wall, 'lateness_p50': late[499] * 1e-9,
            'lateness_p99': late[989] * 1e-9, 'lateness_p999': late[998] * 1e-9, 'cpu': cpu / len(work.lateness)})


def finish(figures: dict[str, float]) -> NoReturn:
    """Hand the figures to the parent and leave at once: some executors take seconds to come down."""
    sys.stdout.write(json.dumps(figures) + '\n')
    sys.stdout.flush()
    os._exit(0)


def send_commands() -> None:
    """Publish drive velocities at 1 kHz until killed."""
    rclpy.init()
    node = Node('client')
    publisher = node.create_publisher(DriveVelocity, 'drive_velocity', COMMANDS)
    pacer, message = Pacer(Grid(1000.0)), DriveVelocity()
    for step in itertools.count():
        while not pacer.wait(step):
            pass
        pacer.begin(step)
        publisher.publish(message)


def watch_node(rate: int, seconds: float) -> dict[str, float]:
    """Run the installed node; return its own figures and what the kernel accounts to it."""
    rclpy.init()
    node = Node('watch')
    windows: list[StepTiming] = []
    statuses: dict[str, str] = {}
    node.create_subscription(StepTiming, 'timing', windows.append, 10)
    node.create_subscription(DiagnosticArray, '/diagnostics', lambda message: statuses.update(
        {pair.key: pair.value for status in message.status for pair in status.values}), 10)
    process = subprocess.Popen([executable('sim_node'), '--ros-args', '-p', f'time.rate:={float(rate)}',
                                '--log-level', 'warn'])
    try:
        while len(windows) < 2:   # the first holds the start
            rclpy.spin_once(node, timeout_sec=0.1)
        cpu, received, first = cpu_seconds(process.pid), int(statuses['velocity received']), len(windows)
        while len(windows) < first + max(round(seconds), 1):
            rclpy.spin_once(node, timeout_sec=0.1)
        cpu, received = cpu_seconds(process.pid) - cpu, int(statuses['velocity received']) - received
    finally:
        process.terminate()
        process.wait()
    windows = windows[first:]
    steps = sum(window.steps for window in windows)
    return {'achieved': statistics.median(window.real_time_factor for window in windows) * rate,
            'commands': received / steps * rate, 'cpu': cpu / steps,
            **{name: statistics.median(getattr(window, name) for window in windows)
               for name in ('lateness_p50', 'lateness_p99', 'lateness_p999')}}


def executable(name: str) -> str:
    """Return an installed program of the package."""
    for prefix in os.environ['AMENT_PREFIX_PATH'].split(os.pathsep):
        path = pathlib.Path(prefix, 'lib', 'stickslip_sim', name)
        if path.is_file():
            return str(path)
    raise SystemExit(f'no {name} in AMENT_PREFIX_PATH: run `make build` and source ros2_ws/install/setup.bash')


def cpu_seconds(pid: int) -> float:
    """Return user and system time of a process so far."""
    fields = pathlib.Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def run_case(case: str, rate: int, seconds: float, with_commands: bool) -> dict[str, float]:
    """Run one case in a process of its own."""
    me = [sys.executable, '-m', 'benchmarks.loop', '--seconds', str(seconds)]
    client = subprocess.Popen([*me, '--send']) if with_commands else None
    try:
        flags = ['--commands'] if with_commands else []
        out = subprocess.run([*me, '--case', case, '--rate', str(rate), *flags], check=True, capture_output=True,
                             text=True, timeout=60 + seconds)
    finally:
        if client is not None:
            client.kill()
            client.wait()
    figures: dict[str, float] = json.loads(out.stdout.splitlines()[-1])
    return figures


def medians(runs: list[dict[str, float]]) -> dict[str, float]:
    """Return the median of each figure."""
    return {name: statistics.median(run[name] for run in runs) for name in runs[0]}


def machine() -> str:
    """Return what was measured on."""
    return (f'{report.machine()}, Python {platform.python_version()}, '
            f'ROS 2 {os.environ.get("ROS_DISTRO", "?")}, {rclpy.get_rmw_implementation_identifier()}')


def main() -> None:
    """Run all cases and keep their figures, or be one of the processes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--seconds', type=float, default=4.0, help='of each run')
    parser.add_argument('--repeats', type=int, default=3)
    parser.add_argument('--out', type=pathlib.Path, default=DATA / 'loop.json')
    parser.add_argument('--case', choices=LOOPS, help=argparse.SUPPRESS)
    parser.add_argument('--rate', type=int, help=argparse.SUPPRESS)
    parser.add_argument('--commands', action='store_true', help=argparse.SUPPRESS)
    parser.add_argument('--send', action='store_true', help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.send:
        send_commands()
    if options.case:
        measure(options.case, options.rate, options.seconds, options.commands)
    cases = [(case, rate, False) for rate in RATES for case in LOOPS] + [(case, RATES[0], True) for case in LOOPS]
    rows = []
    for case, rate, commands in cases:
        runs = [run_case(case, rate, options.seconds, commands) for _ in range(options.repeats)]
        rows.append({'loop': LOOPS[case], 'rate': rate, **medians(runs), **({} if commands else {'commands': None})})
        sys.stderr.write(f'{rows[-1]}\n')
    keep(options.out, command=f'python3 -m benchmarks.loop --seconds {options.seconds:g} --repeats {options.repeats}',
         machine=machine(), rows=rows)


if __name__ == '__main__':
    main()
