# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure where the time of a step of the node goes, part by part: docs/data/budget.json.

    python3 -m benchmarks.budget [--rate 1000] [--seconds 10] [--priority 50] [--out docs/data/budget.json]

The node runs in this process, recording, beside a controller in a process of its own.  Each part of a step leaves its
start and its end in a ring; that takes 0.2 µs a part.
"""

import argparse
import gc
import os
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from numpy.typing import NDArray
from rclpy.signals import SignalHandlerOptions

from stickslip_sim.ros.node.feed_axis import FeedAxis
from stickslip_sim.ros.programs import SWITCH_INTERVAL, GivenParameters, spin
from stickslip_sim.ros.standstill import Standstill
from stickslip_sim.ros.stop_signals import Signals

from .hil.process import SCENE
from .loop import machine
from .measured import DATA, keep

STEP, LATE, GARBAGE = 'step', 'late', 'garbage collector'
PARTS = {
    'hear': 'take and check what has arrived', 'take': 'which commands are new',
    'simulate': 'one step of the axis and its rig', 'rig events': 'report what happened to the rig',
    'pack': 'serialize state and friction force', 'publish': 'hand both to the middleware',
    'record': 'hand both to the thread of the recorder', 'statistics': 'note cost, lateness, age, latency',
}


class Ring:
    """What the latest steps spent on each part; ns."""

    def __init__(self) -> None:
        self.rows: deque[dict[str, int]] = deque(maxlen=1_000_000)
        self._row: dict[str, int] = {}

    def around(self, part: str, work: Callable[..., Any]) -> Callable[..., Any]:
        """Return work that adds its time to a part."""
        now = time.perf_counter_ns

        def timed(*given: Any) -> Any:
            begin = now()
            result = work(*given)
            self._row[part] = self._row.get(part, 0) + now() - begin
            return result

        return timed

    def around_step(self, work: Callable[[int, int], Any]) -> Callable[[int, int], Any]:
        """Return the making of a step that puts its parts into the ring."""
        timed = self.around(STEP, work)

        def step(begin: int, lateness: int) -> Any:
            self._row = {LATE: lateness}
            result = timed(begin, lateness)
            self.rows.append(self._row)
            return result

        return step

    def watch_garbage(self) -> None:
        """Let the collections that fall into a step be a part of it."""
        begin = [0]

        def collects(phase: str, _: dict[str, int]) -> None:
            if phase == 'start':
                begin[0] = time.perf_counter_ns()
            else:
                self._row[GARBAGE] = self._row.get(GARBAGE, 0) + time.perf_counter_ns() - begin[0]

        gc.callbacks.append(collects)

    def column(self, part: str) -> NDArray[np.float64]:
        """Return what each step spent on a part, s."""
        return np.array([row.get(part, 0) for row in self.rows]) * 1e-9


def instrument(node: Any, ring: Ring) -> None:
    """Let the parts of the node's steps leave their times."""
    def replace(owner: Any, name: str, part: str) -> None:
        setattr(owner, name, ring.around(part, getattr(owner, name)))

    loop, outputs = node.loop, node._outputs
    replace(loop, '_hear', 'hear')
    replace(loop._inputs, 'take', 'take')
    replace(loop.rig, 'make_step', 'simulate')
    loop._sinks[0] = ring.around('rig events', loop._sinks[0])
    for port in (outputs._state, outputs._friction):
        replace(port, 'pack', 'pack')
        replace(port, 'publish', 'publish')
    replace(outputs, 'record', 'record')
    replace(loop.timing_statistics, 'add', 'statistics')
    loop._make_step = ring.around_step(loop._make_step)
    ring.watch_garbage()


def measure(options: argparse.Namespace, folder: Path) -> Ring:
    """Run the node beside a controller; return what its steps spent."""
    sys.setswitchinterval(SWITCH_INTERVAL)
    args = ['--ros-args', '--log-level', 'error', '-p', f'time.rate:={options.rate}', '-p', f'scene:={SCENE}', '-p',
            'record.enabled:=true', '-p', f'record.folder:={folder}', '-p', f'thread_priority:={options.priority}']
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    signals, ring = Signals(), Ring()
    signals.standstill = Standstill('budget')
    node = FeedAxis(GivenParameters.read(args), lambda: signals.stop)
    instrument(node, ring)
    controller = subprocess.Popen([sys.executable, '-m', 'benchmarks.hil.controller', '--pid', str(os.getpid()),
                                   '--seconds', str(options.seconds), '--stride',
                                   str(max(round(options.rate / 1000), 1))], stdout=subprocess.DEVNULL)
    try:
        spin(node, signals, lambda: controller.poll() is not None, node.log.write)
    finally:
        controller.kill()
        controller.wait()
        rclpy.try_shutdown()
    return ring


def rows(ring: Ring) -> Iterator[dict[str, object]]:
    """Yield what each part takes, s."""
    whole, parts = ring.column(STEP), {part: ring.column(part) for part in PARTS}
    for part, what, spent in (
            *((name, what, parts[name]) for name, what in PARTS.items()),
            ('the rest', 'calls between these, and the stamps', whole - sum(parts.values())),
            ('the whole step', 'its `cost` in `timing`', whole),
            ('lateness before it', 'from due time to start: waking, GIL',
             ring.column(LATE))):
        yield {'part': part, 'what': what, **dict(zip(('p50', 'p99', 'p999', 'max'),
                                                      np.percentile(spent, (50, 99, 99.9, 100)).tolist()))}


def main() -> None:
    """Measure, and keep the figures."""
    parser = argparse.ArgumentParser(prog='python3 -m benchmarks.budget', description=__doc__.splitlines()[0])
    parser.add_argument('--rate', type=float, default=1000.0, help='1/s')
    parser.add_argument('--seconds', type=float, default=10.0)
    parser.add_argument('--priority', type=int, default=50, help='thread_priority; 0: none')
    parser.add_argument('--out', type=Path, default=DATA / 'budget.json')
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as parent:
        ring = measure(options, Path(parent, 'run'))
    while len(ring.rows) > options.seconds * options.rate:    # the start of node and controller is another matter
        ring.rows.popleft()
    collected = ring.column(GARBAGE)
    keep(options.out, command=f'python3 -m benchmarks.budget --rate {options.rate:g} --seconds {options.seconds:g}'
         f' --priority {options.priority}', machine=machine(), steps=len(ring.rows),
         garbage_share=float(np.mean(collected > 0)), garbage_longest=float(collected.max()), rows=list(rows(ring)))


if __name__ == '__main__':
    main()
