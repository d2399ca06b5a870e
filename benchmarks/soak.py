# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Let the recording node and a controller run for minutes: memory flat, no drift, nothing lost: docs/data/soak.json.

    python3 -m benchmarks.soak [--minutes 10] [--priority 0] [--out docs/data/soak.json]

Exit code 1 when a limit is missed.
"""

import argparse
import os
import sys
import tempfile
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stickslip_sim.recording import open_bag

from .hil.process import bag_figures, control, node_command, node_figures, resident, running
from .hil.slow_listener import TAKES
from .loop import machine
from .measured import DATA, keep

RATE = 1000.0    # 1/s
PERIOD = 1.0     # s between two looks at the memory
PARTS = 12       # of the recording
WARM_UP = 2      # parts, before the memory is looked at
BELOW = 2        # priority of the controller, below that of the step thread; the node's other threads are 1 below


class Figure(NamedTuple):
    """A figure, and the most that its magnitude may be."""

    title: str
    name: str
    most: float | None = None


FIGURES = (
    Figure(f'memory after the first {WARM_UP} of {PARTS} parts, most less least, MiB', 'spread', 5.0),
    Figure('memory, growth in the second half, KiB/min', 'growth', 512.0),
    Figure('simulation time against the steady clock, drift, ms', 'drift_ms', 1.0),
    Figure('steps that the controller did not hear', 'unheard', 0.0),
    Figure('steps that are not in the bag', 'unrecorded', 0.0),
    Figure('messages that the recorder dropped', 'dropped', 0.0),
    Figure('steps', 'steps'),
    Figure(f'states that the slow subscriber took, in {TAKES * 1e3:g} ms each', 'slow'),
    Figure('memory at the end, MiB', 'resident'),
    Figure('steps that began more than a period late, %', 'overruns_percent'),
    Figure('lateness, p99, median of the seconds, ms', 'lateness_p99_ms'),
    Figure('lateness, maximum, ms', 'lateness_max_ms'),
    Figure('load average of the machine, 15 minutes', 'load'),
)


class MemoryWatch:
    """Looks at the memory of a process once a period, in a thread."""

    def __init__(self, pid: int) -> None:
        self.samples: list[int] = []    # bytes
        self._pid = pid
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._watch)

    def __enter__(self) -> 'MemoryWatch':
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._is_over.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._is_over.wait(PERIOD):
            self.samples.append(resident(self._pid))

    def spread(self) -> float:
        """Return by how much the most differs from the least after the warm-up, MiB."""
        warm = self.samples[len(self.samples) * WARM_UP // PARTS:]
        return (max(warm) - min(warm)) / 2**20

    def growth(self) -> float:
        """Return the slope of the second half by least squares, KiB/min."""
        half = self.samples[len(self.samples) // 2:]
        slope, _ = np.polyfit(np.arange(len(half)) * PERIOD, half, 1)
        return float(slope) * 60.0 / 1024.0


def soak(minutes: float, priority: int = 0) -> tuple[dict[str, float], str]:
    """Return the figures of a run, and the node's own verdict on its real time; `priority` of SCHED_FIFO, 0: none."""
    with tempfile.TemporaryDirectory() as parent:
        folder = Path(parent, 'run')
        split = ['-p', f'record.max_duration:={minutes * 60.0 / PARTS}']
        with (running([*node_command(RATE, folder, priority), *split]) as process, MemoryWatch(process.pid) as memory,
              running([sys.executable, '-m', 'benchmarks.hil.slow_listener']) as listener):
            figures = control(process.pid, minutes * 60.0, priority=max(priority - BELOW, 0))
        figures |= {'slow': float(listener.communicate()[0]), **node_figures(folder), **bag_figures(folder)}
        verdict = str(open_bag(folder).receipt['timing']['verdict'])
    figures = {**figures, 'growth': memory.growth(), 'spread': memory.spread(),
               'resident': memory.samples[-1] / 2**20,
               'load': os.getloadavg()[2], 'drift_ms': figures['drift'] * 1e3,
               'overruns_percent': figures['overruns'] * 1e2,
               'lateness_p99_ms': figures['lateness_p99'] * 1e3, 'lateness_max_ms': figures['lateness_max'] * 1e3}
    return figures, verdict


def missed(figures: Mapping[str, float]) -> list[str]:
    """Return the limits that the figures miss, a NaN among them."""
    return [one.title for one in FIGURES if one.most is not None and not abs(figures[one.name]) <= one.most]


def main() -> int:
    """Soak, keep the figures, return the exit code."""
    parser = argparse.ArgumentParser(prog='python3 -m benchmarks.soak', description=__doc__.splitlines()[0])
    parser.add_argument('--minutes', type=float, default=10.0, help='[%(default)g]')
    parser.add_argument('--priority', type=int, default=0, help='SCHED_FIFO of the step thread; 0: none')
    parser.add_argument('--out', type=Path, default=DATA / 'soak.json', help='[%(default)s]')
    options = parser.parse_args()
    if not 0.2 <= options.minutes <= 1e4:
        parser.error(f'argument --minutes: {options.minutes:g}; give 0.2 to 10000')
    if options.priority and not BELOW < options.priority <= 98:
        parser.error(f'argument --priority: {options.priority}; give 0, or {BELOW + 1} to 98')
    figures, verdict = soak(options.minutes, options.priority)
    rows = [{'figure': one.title, 'measured': figures[one.name], 'at_most': one.most} for one in FIGURES]
    keep(options.out, command=f'python3 -m benchmarks.soak --minutes {options.minutes:g} --priority {options.priority}',
         machine=machine(), verdict=verdict, rows=rows)
    print(*rows, *(f'missed: {title}' for title in missed(figures)), sep='\n')
    return 1 if missed(figures) else 0


if __name__ == '__main__':
    sys.exit(main())
