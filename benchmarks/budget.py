# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure where the time of a step of the node goes, part by part, and write it into docs/loop.md.

    python3 -m benchmarks.budget [--rate 1000] [--seconds 10] [--priority 50] [--out docs/loop.md]

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
from collections.abc import Callable, Iterable
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

HEADING = '## The budget of a step'
STEP, LATE, GARBAGE = 'step', 'late', 'garbage collector'
PARTS = {
    'hear': 'take what has arrived from the middleware, check it', 'take': 'which commands are new',
    'simulate': 'the rig: one step of the axis and what is around it', 'rig events': 'report what happened to the rig',
    'pack': 'make the bytes of the state and of the friction force', 'publish': 'hand them to the middleware',
    'record': 'hand them to the thread of the recorder', 'statistics': 'note cost, lateness, age, latency',
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
        """Return what each step spent on a part, µs."""
        return np.array([row.get(part, 0) for row in self.rows]) * 1e-3


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


def table(ring: Ring) -> Iterable[str]:
    """Yield the lines of the table."""
    def line(name: str, what: str, spent: NDArray[np.float64]) -> str:
        levels = np.percentile(spent, (50, 99, 99.9, 100))
        return f'| {name} | {what} | ' + ' | '.join(f'{level:.1f}' for level in levels) + ' |'

    whole, parts = ring.column(STEP), {part: ring.column(part) for part in PARTS}
    yield from ('| part | what | p50, µs | p99 | p99.9 | max |', '|---|---|---|---|---|---|')
    yield from (line(name, what, parts[name]) for name, what in PARTS.items())
    yield line('the rest', 'calls between these, and the stamps themselves', whole - sum(parts.values()))
    yield line('**the whole step**', 'its `cost` in `timing`', whole)
    yield line('before it: lateness', 'from when it is due, through waking and getting the interpreter, to its start',
               ring.column(LATE))
    collected = ring.column(GARBAGE)
    yield ''
    yield (f'* The garbage collector ran in {np.mean(collected > 0):.2%} of the steps, for at most'
           f' {collected.max():.0f} µs; it is part of what it fell into.')


def main() -> None:
    """Measure, and write the section."""
    parser = argparse.ArgumentParser(prog='python3 -m benchmarks.budget', description=__doc__.splitlines()[0])
    parser.add_argument('--rate', type=float, default=1000.0, help='1/s')
    parser.add_argument('--seconds', type=float, default=10.0)
    parser.add_argument('--priority', type=int, default=50, help='thread_priority; 0: none')
    parser.add_argument('--out', type=Path, default=Path('docs/loop.md'))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as parent:
        ring = measure(options, Path(parent, 'run'))
    while len(ring.rows) > options.seconds * options.rate:    # the start of node and controller is another matter
        ring.rows.popleft()
    lines = [HEADING, '', f'`python3 -m benchmarks.budget --rate {options.rate:g} --seconds {options.seconds:g}'
             f' --priority {options.priority}` wrote this section on', f'{machine()}.', '',
             f'The node on `{SCENE}`, recording, beside a controller that sends 1000 commands a second;'
             f' {len(ring.rows)} steps.', '', *table(ring), '']
    text = options.out.read_text(encoding='utf-8').partition(HEADING)[0].rstrip('\n')
    options.out.write_text('\n'.join([text, '', *lines]), encoding='utf-8')


if __name__ == '__main__':
    main()
