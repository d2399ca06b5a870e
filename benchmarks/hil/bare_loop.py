# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A loop in Python that keeps time and does nothing else, without ROS: what the interpreter itself gives.

    python3 -m benchmarks.hil.bare_loop --rate 1000 --seconds 10 --priority 50

Prints how its steps kept their time.
"""

import argparse
import gc
import json
import threading
from array import array

import numpy as np

from stickslip_sim.core.time_grid import Grid
from stickslip_sim.realtime.pacing import Pacer, wake_precisely
from stickslip_sim.realtime.scheduling import Scheduling, StepThread


class Lateness:
    """Takes the lateness of each step, ns; `overruns` are those that began more than a period late."""

    def __init__(self) -> None:
        self.overruns = 0
        self._taken = array('q')

    def add(self, lateness: int) -> None:
        """Take that of a step."""
        self._taken.append(lateness)

    def figures(self) -> dict[str, float]:
        """Return the figures, s."""
        levels = np.percentile(self._taken, (50, 99, 100)) * 1e-9
        return {'lateness_p50': float(levels[0]), 'lateness_p99': float(levels[1]), 'lateness_max': float(levels[2]),
                'overruns': self.overruns / len(self._taken)}


def run(step_thread: StepThread, rate: float, steps: int, lateness: Lateness) -> None:
    """Make steps on the clock; for a thread of its own."""
    wake_precisely()
    step_thread.enter()
    pacer = Pacer(Grid(rate))
    for step in range(steps):
        while not pacer.wait(step):
            pass
        lateness.add(pacer.begin(step)[1])
    lateness.overruns = pacer.counters.overruns


def main() -> None:
    """Run for a while."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--rate', type=float, default=1000.0, help='1/s')
    parser.add_argument('--seconds', type=float, default=10.0)
    parser.add_argument('--priority', type=int, default=0, help='SCHED_FIFO; 0: none')
    options = parser.parse_args()
    step_thread = StepThread(Scheduling(thread_priority=options.priority, lock_memory=options.priority > 0))
    lateness = Lateness()
    gc.collect()
    gc.freeze()
    thread = threading.Thread(target=run, args=(step_thread, options.rate, round(options.rate * options.seconds),
                                                lateness))
    thread.start()
    thread.join()
    print(json.dumps(lateness.figures()))


if __name__ == '__main__':
    main()
